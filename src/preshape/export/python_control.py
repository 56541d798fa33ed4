"""python-control: the shaper on samples as a transfer function in z, and its frequency response as data."""

from __future__ import annotations

import re

from preshape.errors import InputError
from preshape.export.arithmetic import as_coefficients
from preshape.export.c_source import modes_left, title
from preshape.export.read_back import numbers_in, only_text, taps_in
from preshape.export.target import Files, Limits, Placed, Taps, Target

__all__ = ["PYTHON_CONTROL"]

TEMPLATE = '''
DT = {dt!r}  # seconds
DELAYS = [{delays}]  # samples
WEIGHTS = [
{weights}
]


def fir():
    """The shaper as a transfer function in z, a python-control TransferFunction."""
    import control

    numerator = [0.0] * (DELAYS[-1] + 1)
    for delay, weight in zip(DELAYS, WEIGHTS):
        numerator[delay] = weight
    return control.tf(numerator, [1.0] + [0.0] * DELAYS[-1], DT)


def response(omega):
    """Its frequency response at the frequencies omega [rad/s], as a python-control FrequencyResponseData."""
    import control
    import numpy as np

    w = np.asarray(omega, dtype=float)
    values = np.exp(-1j * np.multiply.outer(w * DT, DELAYS)) @ np.asarray(WEIGHTS)
    return control.frd(values, w)
'''

MOST = 10_000
PERIOD = re.compile(r"^DT = ([^\s,]{1,30})  # seconds$", re.MULTILINE)
DELAYS = re.compile(r"^DELAYS = \[([0-9, ]*)\]  # samples$", re.MULTILINE)
WEIGHTS = re.compile(r"^WEIGHTS = \[\n([-+0-9.e, \n]*)\]$", re.MULTILINE)


def _render(placed: Placed) -> Files:
    head = "".join(f"# {line}\n" for line in (title(placed), *modes_left(placed)))
    body = TEMPLATE.format(
        dt=placed.dt,
        delays=", ".join(map(str, placed.delays.tolist())),
        weights="\n".join(f"    {weight!r}," for weight in placed.weights.tolist()),
    )
    return {f"{placed.name}.py": head + body}


def _parse(files: Files) -> Taps:
    text = only_text(files, ".py")
    period, delays, weights = (pattern.findall(text) for pattern in (PERIOD, DELAYS, WEIGHTS))
    if not len(period) == len(delays) == len(weights) == 1:
        raise InputError(
            "the file does not hold DT, DELAYS and WEIGHTS once each: give one that preshape export wrote."
        )
    (dt,) = numbers_in(period[0], "sample time")
    return taps_in(dt, numbers_in(delays[0], "delays"), numbers_in(weights[0], "weights"))


def _next_step(placed: Placed) -> tuple[str, ...]:
    return (f"import {placed.name}; {placed.name}.fir() is a TransferFunction, {placed.name}.response(omega) its FRD.",)


PYTHON_CONTROL = Target(
    "python-control",
    "transfer function and frequency response, a Python module",
    ("0.10",),
    Limits(taps=MOST, samples=1 << 20),
    _render,
    _parse,
    as_coefficients,
    _next_step,
)
