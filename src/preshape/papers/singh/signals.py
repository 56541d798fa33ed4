"""The signals of Singh & Heppler: sums of decaying sines, their envelope (26), and impulses applied every 0.01 s."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from preshape import Mode, Modes, Shaper
from preshape.plant import ModalPlant

__all__ = [
    "DAMPED",
    "DT",
    "ENVELOPED",
    "LOWEST",
    "UNDAMPED",
    "Term",
    "after_the_end",
    "applied",
    "envelope",
    "example_modes",
    "response",
    "signal",
]

Vector: TypeAlias = NDArray[np.float64]

DT = 0.01
"""The paper's sampling interval [s]."""

END = 10.0
"""How long responses are looked at [s]; the paper does not say."""

LOWEST = 2.0
"""w_c of the example of section 4 [rad/s]; its modes are at 1 and 7 times that."""


@dataclass(frozen=True)
class Term:
    """A exp(-decay t) sin(multiple w t): amplitude [-], decay rate [1/s] and m."""

    amplitude: float
    decay: float
    multiple: int


ENVELOPED = (Term(1.0, 0.1, 1), Term(1.0 / 3.0, 1.2, 3))
"""Figure 2, with w = 1 rad/s."""

UNDAMPED = (Term(1.0, 0.0, 1), Term(1.0, 0.0, 7))
"""Equation (39), with w = 2 rad/s."""

DAMPED = (Term(1.0, 0.01 * 2.0, 1), Term(1.0, 0.01 * 14.0, 7))
"""Equation (40): the decay rate is xi times the frequency of the sine."""


def signal(terms: Sequence[Term], omega: float, times: Vector) -> Vector:
    """(23): the sum of the terms at `times` [s], omega in rad/s."""
    return np.asarray(
        sum(term.amplitude * np.exp(-term.decay * times) * np.sin(term.multiple * omega * times) for term in terms)
    )


def envelope(terms: Sequence[Term], omega: float, times: Vector) -> Vector:
    """(26), as printed: E(t) with y(t) = sin(omega t) E(t)."""
    sine, cosine = np.sin(omega * times), np.cos(omega * times)
    value = np.zeros_like(times)
    for term in terms:
        for j in range(1, (term.multiple + 1) // 2 + 1):
            value += (
                term.amplitude
                * np.exp(-term.decay * times)
                * (-1.0) ** (j - 1)
                * math.comb(term.multiple, 2 * j - 1)
                * sine ** (2 * j - 2)
                * cosine ** (term.multiple - 2 * j + 1)
            )
    return value


def example_modes(terms: Sequence[Term]) -> Modes:
    """The modes of the example of section 4 as natural frequencies [Hz] and damping ratios."""
    modes = []
    for term in terms:
        omega_d = term.multiple * LOWEST
        modes.append(
            Mode.from_damped_frequency(omega_d / (2.0 * math.pi), term.decay / math.hypot(omega_d, term.decay))
        )
    return Modes(modes)


def applied(shaper: Shaper, late: Sequence[int] | None = None) -> Shaper:
    """The shaper with its impulses at the nearest sampling instants, each `late` sampling intervals more."""
    steps = np.rint(shaper.times / DT) + np.array(late if late is not None else [0] * len(shaper))
    return Shaper(steps * DT, shaper.amplitudes)


def response(shaper: Shaper, terms: Sequence[Term], times: Vector) -> Vector:
    """(29): the response of the example to the impulses, by exact simulation of its modes."""
    modes = example_modes(terms)
    plant = ModalPlant(
        modes, [term.amplitude * mode.omega_d / mode.omega**2 for term, mode in zip(terms, modes, strict=True)]
    )
    return plant.impulse_train(shaper.times, shaper.amplitudes, at=times).output


def after_the_end(shaper: Shaper, terms: Sequence[Term]) -> float:
    """Largest response after the last impulse, to 10 s, relative to the largest one to a unit impulse then [-]."""
    times = np.arange(shaper.duration, END, 0.2 * DT)
    unshaped = response(Shaper([0.0], [1.0]), terms, times)
    return float(np.abs(response(shaper, terms, times)).max() / np.abs(unshaped).max())
