"""ACS SPiiPlus: arrays for InShapeOn, the only motion controller here that convolves with any impulses by itself.

Times are milliseconds and must be multiples of the controller's cycle: the impulses are placed on the cycle's grid and
their amplitudes made exact there, never just rounded.
"""

from __future__ import annotations

import re

from preshape.errors import InputError
from preshape.export.arithmetic import as_coefficients
from preshape.export.c_source import modes_left, title
from preshape.export.read_back import numbers_in, only_text, taps_in
from preshape.export.target import Files, Limits, Placed, Taps, Target

__all__ = ["ACS"]

MOST = 256
"""Impulses; what the controller's own limit is we do not know, its public example has 5."""

CYCLE = re.compile(r"^! controller cycle (\S{1,30}) s$", re.MULTILINE)
IMPULSE = re.compile(r"^(\w+)T\((\d{1,4})\) = (\d{1,9})\*(\S{1,30}); +\1A\(\2\) = (\S{1,30})$", re.MULTILINE)


def _render(placed: Placed) -> Files:
    arrays, cycle = placed.name, repr(1e3 * placed.dt)
    lines = [
        f"! {title(placed)}",
        *(f"! {line}" for line in modes_left(placed)),
        f"! controller cycle {placed.dt!r} s",
        f"global real {arrays}T({placed.delays.size}), {arrays}A({placed.delays.size})",
    ]
    for index, (delay, weight) in enumerate(zip(placed.delays.tolist(), placed.weights.tolist(), strict=True)):
        lines.append(f"{arrays}T({index}) = {delay}*{cycle}; {arrays}A({index}) = {weight!r}")
    lines += [
        "",
        f"InShapeOn 0, {arrays}T, {arrays}A    ! the axis, times [ms], amplitudes",
        "! InShapeOff 0",
        "STOP",
        "",
    ]
    return {f"{placed.name}.prg": "\n".join(lines)}


def _parse(files: Files) -> Taps:
    text = only_text(files, ".prg")
    cycles, rows = CYCLE.findall(text), IMPULSE.findall(text)
    if len(cycles) != 1 or not 1 <= len(rows) <= MOST:
        raise InputError(f"the program holds {len(cycles)} cycles and {len(rows)} impulses: give one of an export.")
    if [row[1] for row in rows] != [str(index) for index in range(len(rows))]:
        raise InputError("the impulses are not numbered from 0 on: give a program that preshape export wrote.")
    dt, *_ = numbers_in(cycles[0], "cycles")
    weights = numbers_in(",".join(row[4] for row in rows), "amplitudes")
    if any(row[3] != repr(1e3 * dt) for row in rows):
        raise InputError("the times are not multiples of the controller's cycle: give a program of an export.")
    return taps_in(dt, [int(row[2]) for row in rows], weights)


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (
        f"Run {placed.name}.prg in a buffer of the controller, with your axis in place of 0, while it stands still;",
        f"the cycle of {1e3 * placed.dt:.6g} ms must be the controller's (CTIME).",
    )


ACS = Target(
    "acs",
    "ACSPL+ program for ACS SPiiPlus: arrays for InShapeOn",
    ("SPiiPlus",),
    Limits(taps=MOST, samples=1 << 20),
    _render,
    _parse,
    as_coefficients,
    _next_step,
)
