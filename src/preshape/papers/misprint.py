"""The sign of the exponent that Hyde and the slides misprint, evaluated as printed.

A shaper leaves nothing at a mode (w, z) when  sum A_i exp(+z w t_i) exp(i w sqrt(1 - z^2) t_i) = 0;  Hyde's (2.3),
(2.6), (3.1), (3.2) and the slides print exp(-z w t_i). What solves the printed equations is the right shaper with
its time reversed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape.mode import Mode
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, beyond, claim
from preshape.plant import ModalPlant
from preshape.shaper import Shaper

__all__ = ["constraint", "printed_zero", "reversed_shapers"]

WHY = (
    "Misprint: the exponent must be +z w t_i (or -z w (t_N - t_i), as in the amplitude equation of the same text and "
    "in Singer's (6)); with it the sum is 0. Without damping both signs are the same."
)


def constraint(shaper: Shaper, mode: Mode, *, sign: int, power: int = 0) -> float:
    """|sum A_i t_i^power exp(sign z w t_i) exp(i w_d t_i)| [s^power], sign -1 as printed and +1 as it should be."""
    exponent = (sign * mode.damping * mode.omega + 1j * mode.omega_d) * shaper.times
    return float(abs(np.sum(shaper.amplitudes * shaper.times**power * np.exp(exponent))))


def printed_zero(
    source: str, what: str, cases: Sequence[tuple[Shaper, Mode, float]], *, power: int = 0, unit: str = ""
) -> Row:
    """What an equation with the printed sign gives where it should give 0.

    Each case is a shaper that is right for the mode, the mode, and what the printed sum gives in closed form.
    """
    values = [constraint(shaper, mode, sign=-1, power=power) for shaper, mode, _ in cases]
    right = [
        constraint(shaper, mode, sign=+1, power=power) * np.exp(-mode.damping * mode.omega * shaper.duration)
        for shaper, mode, _ in cases
    ]
    gaps = [abs(value - expected) for value, (_, _, expected) in zip(values, cases, strict=True)]
    return claim(
        source,
        what,
        "0",
        (", ".join(f"{value:.3g}" for value in values) + f" {unit}").strip(),
        max(values) < ROUNDING,
        because=Because(WHY, max(right) < ROUNDING and max(gaps) < ROUNDING),
    )


def reversed_shapers(source: str, damping: float) -> list[Row]:
    """What the two- and three-impulse shapers that solve the printed equations leave of the vibration."""
    mode = Mode(1.0, damping)
    k, half = mode.decay_per_half_period, 0.5 * mode.damped_period
    found = []
    for words, weights in (("two", [k, 1.0]), ("three", [k * k, 2.0 * k, 1.0])):
        shaper = Shaper.normalised(half * np.arange(len(weights)), weights)
        left = float(ModalPlant(mode).impulse_residual(shaper.times, shaper.amplitudes)[0])
        right = constraint(shaper, mode, sign=-1) < ROUNDING and abs(left - (1.0 - k) ** (len(weights) - 1)) < ROUNDING
        found.append(
            beyond(
                source,
                f"vibration left by the {words} impulses that solve the equations as printed, z = {damping:g}",
                f"{100.0 * left:.1f} %",
                right,
                note="The right shaper with time reversed. By simulation; in closed form (1 - K)^(n - 1).",
            )
        )
    return found
