"""The target "st": a function block and its self-test in structured text of IEC 61131-3, third edition (2013).

Version "2013" is text to be pasted or imported; "twincat3" is the same text in files that TwinCAT 3 adds to a project.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from importlib.resources import files as resources
from string import Template

import numpy as np

from preshape.errors import InputError
from preshape.export.arithmetic import as_kernel
from preshape.export.read_back import numbers_in, only_text, taps_in
from preshape.export.st.twincat import tcpou
from preshape.export.target import PRECISIONS, Files, Limits, Placed, Taps, Target

__all__ = ["ST"]

TYPES = {"double": "LREAL", "single": "REAL"}
LARGEST = {"double": "1.0E250", "single": "1.0E18"}
BYTES = {"double": 8, "single": 4}

SAMPLES = 16
"""Golden samples at the end of the self-test."""

NUMBER = r"[+-]?\d+(?:\.\d+)?(?:E[+-]?\d+)?"
DT = re.compile(rf"Sample time \[s\]: ({NUMBER})\n")
DELAYS = re.compile(r"\bDELAYS : ARRAY\[0\.\.\d+\] OF DINT := \[ \(\* \[samples\] \*\)([^\]]*)\];")
WEIGHTS = re.compile(r"\bWEIGHTS : ARRAY\[0\.\.\d+\] OF (L?REAL) := \[ \(\* \[-\], of sum 1 \*\)([^\]]*)\];")


def _render(placed: Placed) -> Files:
    """The function block and its self-test."""
    stem = "".join(word.capitalize() for word in placed.name.split("_"))
    block, program = f"FB_{stem}", f"PRG_{stem}Test"
    taps, longest = placed.delays.size, int(placed.delays[-1])
    kind = TYPES[placed.precision]
    declared = {
        "block": block,
        "type": kind,
        "dt": _literal(placed.dt),
        "family": re.sub(r"[^A-Za-z0-9 .,%^_+-]", "?", placed.shaper.design.family)[:60],
        "taps": taps,
        "last": taps - 1,
        "longest": longest,
        "size": longest + 1,
        "bytes": BYTES[placed.precision] * (longest + 1),
        "products": taps - 1,
        "sums": 2 * taps - 1,
        "largest": LARGEST[placed.precision],
        "delays": _wrapped(str(delay) for delay in placed.delays.tolist()),
        "weights": _wrapped(_literal(weight) for weight in placed.weights.tolist()),
        "enable": "Enable := DriveIsOn, Reset := FALSE, Command := ProfilePosition",
    }
    tested = {
        "block": block,
        "program": program,
        "type": kind,
        "samples": SAMPLES,
        "most": SAMPLES - 1,
        "cycles": longest + SAMPLES,
        "longest": longest,
        "expected": _wrapped(_literal(value) for value in _golden(placed)),
    }
    units = {block: _filled("block.st", declared), program: _filled("self_test.st", tested)}
    if placed.version == "twincat3":
        return {f"{name}.TcPOU": tcpou(name, text) for name, text in units.items()}
    return {f"{name}.st": text for name, text in units.items()}


def _parse(files: Files) -> Taps:
    """The taps in a function block that :func:`_render` wrote."""
    text = only_text(files, ".st", ".tcpou", holding="END_VAR\nVAR CONSTANT\n    LARGEST")
    dt, delays, weights = DT.search(text), DELAYS.search(text), WEIGHTS.search(text)
    if dt is None or delays is None or weights is None:
        raise InputError(
            "this function block has no table of preshape's: give the FB_... file that it wrote, unchanged."
        )
    precision = "single" if weights[1] == "REAL" else "double"
    return taps_in(float(dt[1]), numbers_in(delays[1], "delays"), numbers_in(weights[2], "weights"), precision)


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (
        "Add both to your PLC project. Run the self-test in any task first: Passed says whether every bit is Python's.",
        f"Then call the function block in every cycle of a task of {1e3 * placed.dt:.6g} ms.",
    )


def _golden(placed: Placed) -> list[float]:
    """The last samples of the self-test, from its commands, in the precision of the target."""
    real = PRECISIONS[placed.precision]
    seed, commands = 0, []
    for _ in range(int(placed.delays[-1]) + SAMPLES):
        seed = (seed * 25173 + 13849) % 65536
        commands.append(seed)
    u = np.array(commands, dtype=real)
    now = np.arange(u.size - SAMPLES, u.size)
    oldest = u[now - placed.delays[-1].astype(int)]
    total = np.zeros(SAMPLES, dtype=real)
    for delay, weight in zip(placed.delays[:-1].astype(int), placed.weights[:-1].astype(real), strict=True):
        total += weight * (u[now - delay] - oldest)
    return [float(value) for value in oldest + total]


def _literal(value: float) -> str:
    """Seventeen digits, which every double is read back from."""
    return f"{value:.16E}"


def _wrapped(words: Iterable[str]) -> str:
    """A list in lines of four."""
    items = list(words)
    lines = [", ".join(items[first : first + 4]) for first in range(0, len(items), 4)]
    return ",\n        ".join(lines)


def _filled(name: str, values: dict[str, object]) -> str:
    return Template((resources(__package__) / "templates" / name).read_text(encoding="utf-8")).substitute(values)


ST = Target(
    name="st",
    summary="IEC 61131-3 function block for CODESYS, TwinCAT and other PLCs",
    versions=("2013", "twincat3"),
    limits=Limits(taps=1000, samples=100_000, precisions=("double", "single")),
    render=_render,
    parse=_parse,
    run=as_kernel,
    next_step=_next_step,
)
