"""Beckhoff TwinCAT 3: coefficient arrays of a FIR filter, for FB_CTRL_DIGITAL_FILTER of TF4100 or any other FIR block.

A shaper on samples is a FIR filter with few taps: b holds one coefficient for each sample of delay, a its leading 1.
Its FLOAT is taken for LREAL, double; a controller where it is REAL would round each coefficient once more.
"""

from __future__ import annotations

import re

import numpy as np

from preshape.errors import InputError
from preshape.export.arithmetic import as_coefficients
from preshape.export.c_source import modes_left, title
from preshape.export.read_back import numbers_in, only_text, taps_in
from preshape.export.target import Files, Limits, Placed, Taps, Target

__all__ = ["TWINCAT"]

LONGEST = 10_000
WIDTH = 100

PERIOD = re.compile(r"^// task period (\S{1,30}) s$", re.MULTILINE)
ARRAY = re.compile(r"_b : ARRAY\[1\.\.(\d{1,6})\] OF FLOAT := \[([^\[\]]*)\];")
ITEM = re.compile(r"(?:(\d{1,6})\()?([-+0-9.eE]{1,30})\)?")


def _render(placed: Placed) -> Files:
    order, name = max(placed.latency_samples, 1), placed.name
    coefficients = np.zeros(order + 1)
    coefficients[placed.delays] = placed.weights
    text = "\n".join(
        [
            f"// {title(placed)}",
            *(f"// {line}" for line in modes_left(placed)),
            f"// task period {placed.dt!r} s",
            "VAR",
            f"    n_{name}_order : UINT := {order};",
            f"    a_{name}_a : ARRAY[1..{order + 1}] OF FLOAT := [1.0, {order}(0.0)];",
            f"    a_{name}_b : ARRAY[1..{order + 1}] OF FLOAT := [",
            *_rows(coefficients),
            "    ];",
            f"    a_{name}_data : ARRAY[1..{order}] OF ST_CTRL_DIGITAL_FILTER_DATA;",
            "END_VAR",
            "",
        ]
    )
    return {f"{name}.txt": text}


def _rows(coefficients: np.ndarray) -> list[str]:
    """The coefficients, runs of zeros as n(0.0), in lines of limited width."""
    items: list[str] = []
    zeros = 0
    for value in [*coefficients.tolist(), None]:
        if value == 0.0:
            zeros += 1
            continue
        if zeros:
            items.append(f"{zeros}(0.0)")
            zeros = 0
        if value is not None:
            items.append(repr(value))
    rows, row = [], "       "
    for index, item in enumerate(items):
        row += f" {item}" + ("," if index + 1 < len(items) else "")
        if len(row) > WIDTH:
            rows.append(row)
            row = "       "
    return [*rows, row] if row.strip() else rows


def _parse(files: Files) -> Taps:
    text = only_text(files, ".txt")
    periods, arrays = PERIOD.findall(text), ARRAY.findall(text)
    if len(periods) != 1 or len(arrays) != 1:
        raise InputError(f"the file holds {len(periods)} task periods and {len(arrays)} arrays: give one of an export.")
    values: list[float] = []
    for word in arrays[0][1].split(","):
        item = ITEM.fullmatch(word.strip())
        count = int(item[1] or 1) if item is not None else 0
        if item is None or len(values) + count > LONGEST + 1:
            raise InputError(f"{word.strip()[:30]!r} is no coefficient, or there are more than {LONGEST + 1}.")
        values += numbers_in(item[2], "coefficients") * count
    if len(values) != int(arrays[0][0]):
        raise InputError(f"the array of {arrays[0][0]} holds {len(values)} coefficients: give one of an export.")
    delays = sorted({0, *np.flatnonzero(values).tolist()})  # a first one of 0 says that the shaper begins with a delay
    dt, *_ = numbers_in(periods[0], "task periods")
    return taps_in(dt, delays, [values[delay] for delay in delays])


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (
        f"Paste {placed.name}.txt into the declarations, and give order, arrays and data to FB_CTRL_DIGITAL_FILTER",
        f"(TF4100), called in a task of {1e3 * placed.dt:.6g} ms; set its state to the position before it starts.",
    )


TWINCAT = Target(
    "twincat",
    "FIR coefficient arrays for TwinCAT 3 (TF4100)",
    ("3",),
    Limits(taps=LONGEST + 1, samples=LONGEST),
    _render,
    _parse,
    as_coefficients,
    _next_step,
)
