"""Hyde, sections 3.1 and 3.2: convolved shapers, figures 3.1 to 3.6."""

from __future__ import annotations

import numpy as np

from preshape import design
from preshape.papers.drawing import impulse_figure, sampled, vibration_figure
from preshape.papers.reproduction import Figure, Row
from preshape.papers.rows import ROUNDING, Because, claim, difference, number, shown
from preshape.vibration import residual_vibration

__all__ = ["ODD", "SHUTTLE", "TWO", "figures", "rows"]

TWO = [(1.0, 0.0), (10.0, 0.0)]
DAMPED_TWO = [(1.0, 0.1), (10.0, 0.1)]
SHUTTLE = [(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)]
"""Hyde's Shuttle arm with 7,000 lb; "very low damping (around 0.01)", zero in his sequences."""

ODD = (3.0, 5.0, 7.0, 9.0, 30.0, 50.0, 70.0)
"""Odd multiples of 1 and 10 Hz, as section 3.2.1 lists them [Hz]."""


def rows() -> list[Row]:
    """Every statement of the section that can be checked."""
    return [*_building(), *_harmonics(), *_implementing()]


def figures() -> list[Figure]:
    """Figures 3.1 to 3.6."""
    plain, damped = design.convolved(TWO), design.convolved(DAMPED_TWO)
    frequencies = sampled(0.0, 55.0, 2201)
    return [
        Figure(
            "3.1",
            "Three impulse sequence designed for 1 Hz",
            lambda: impulse_figure("Three impulses for 1 Hz", ("1 Hz", design.zvd(TWO[0]))),
        ),
        Figure(
            "3.2",
            "Three impulse sequence designed for 10 Hz",
            lambda: impulse_figure("Three impulses for 10 Hz", ("10 Hz", design.zvd(TWO[1]))),
        ),
        Figure(
            "3.3",
            "Convolved sequence designed for 1 Hz and 10 Hz, z = 0",
            lambda: impulse_figure("Convolved: nine impulses, 1.1 s", ("convolved", plain)),
        ),
        Figure(
            "3.4",
            "Insensitivity curve for convolved sequence of figure 3.3",
            lambda: vibration_figure(
                "Convolved, z = 0: odd multiples of 1 and 10 Hz are suppressed too",
                [("z = 0", plain, 0.0)],
                frequencies,
                modes=[1.0, 10.0],
            ),
        ),
        Figure(
            "3.5",
            "Convolved sequence for 1 Hz and 10 Hz, z = 0.1",
            lambda: impulse_figure("Convolved for z = 0.1", ("convolved", damped)),
        ),
        Figure(
            "3.6",
            "Insensitivity curve for sequence of figure 3.5 [for plants with z = 0.1, and with none]",
            lambda: vibration_figure(
                "Convolved for z = 0.1: odd multiples drift up",
                [("plant z = 0.1", damped, 0.1), ("plant z = 0", damped, 0.0)],
                sampled(0.0, 12.0, 1201),
                modes=[1.0, 10.0],
                top=50.0,
            ),
        ),
    ]


def _building() -> list[Row]:
    shaper = design.convolved(TWO)
    singles = [design.zvd(mode) for mode in TWO]
    closed = max(
        difference(one.amplitudes, [0.25, 0.5, 0.25]) + difference(one.times, np.arange(3) / (2.0 * f))
        for one, (f, _) in zip(singles, TWO, strict=True)
    )
    times = np.add.outer(singles[0].times, singles[1].times).ravel()
    amplitudes = np.multiply.outer(singles[0].amplitudes, singles[1].amplitudes).ravel()
    gap = difference(shaper.times, times) + difference(shaper.amplitudes, amplitudes)
    left = float(residual_vibration(shaper, [1.0, 10.0]).max())
    return [
        claim(
            "fig. 3.1, 3.2",
            "three impulses for 1 Hz and for 10 Hz, z = 0, against (2.7)",
            "0.25 0.5 0.25 at 0, T/2, T",
            f"difference {shown(closed)}",
            closed < ROUNDING,
        ),
        number("3.2.1", "impulses of the convolved sequence: 3^m", "9", float(len(shaper)), digits=0),
        claim(
            "3.2.1, fig. 3.3",
            "outer sum of the times, outer product of the amplitudes",
            "the convolution",
            f"difference {shown(gap)}",
            gap < ROUNDING,
        ),
        number("fig. 3.3", "length: the sum of the periods", "1.1 s", shaper.duration, "s"),
        claim("fig. 3.4", "zero at 1 Hz and 10 Hz", "zero", f"at most {shown(left)}", left < ROUNDING),
    ]


def _harmonics() -> list[Row]:
    plain, damped = design.convolved(TWO), design.convolved(DAMPED_TWO)
    odd = float(residual_vibration(plain, ODD).max())
    at_modes = float(residual_vibration(damped, [1.0, 10.0], 0.1).max())
    drifted = residual_vibration(damped, ODD[:3], 0.0)
    still = residual_vibration(damped, ODD[:3], 0.1)
    about_ten = residual_vibration(plain, np.linspace(9.0, 11.0, 401))
    alone = residual_vibration(design.zvd(TWO[1]), np.linspace(9.0, 11.0, 401))
    later = max(float(residual_vibration(design.zvd((1.0 / n, 0.0)), 1.0)) for n in (3, 5, 7))
    return [
        claim(
            "fig. 3.4",
            "z = 0: 3, 5, 7 ... and 30, 50, 70 Hz are also suppressed",
            "suppressed",
            f"at most {shown(odd)}",
            odd < ROUNDING,
        ),
        claim(
            "3.2.1",
            "t_3 at 3, 5, 7 times the period solves the equations for 1 Hz as well, z = 0",
            "an infinity",
            f"at most {shown(later)} left",
            later < ROUNDING,
        ),
        claim(
            "fig. 3.4",
            "z = 0: excellent insensitivity around 10 Hz (9 to 11 Hz)",
            "excellent",
            f"at most {100.0 * about_ten.max():.2f} %; 10 Hz impulses alone {100.0 * alone.max():.2f} %",
            bool(about_ten.max() <= alone.max() and (about_ten <= alone + ROUNDING).all()),
        ),
        claim(
            "fig. 3.6",
            "z = 0.1: 1 Hz and 10 Hz still cancelled",
            "cancelled",
            f"{shown(at_modes)}",
            at_modes < ROUNDING,
        ),
        claim(
            "fig. 3.6",
            "z = 0.1: odd multiples drift up from zero (3, 5, 7 Hz without damping, and with z = 0.1)",
            "up from zero",
            ", ".join(f"{100.0 * v:.1f}" for v in drifted)
            + " %; "
            + ", ".join(f"{100.0 * v:.1f}" for v in still)
            + " %",
            bool(drifted.min() > 0.001 and still.min() > 0.001),
        ),
    ]


def _implementing() -> list[Row]:
    rng = np.random.default_rng(0)
    command = rng.normal(size=400)
    dt = 0.005
    together = design.convolved(TWO).shape(command, dt)
    cascade = command
    for mode in TWO:
        cascade = design.zvd(mode).shape(cascade, dt)
    gap = difference(together, cascade)
    counts = [len(design.convolved(SHUTTLE[:m])) for m in (2, 3, 4)]
    length = design.convolved(SHUTTLE).duration
    return [
        claim(
            "3.2.2",
            "successive ring buffers, 3 m impulses, do what the convolved sequence does (random command)",
            "the same",
            f"difference {shown(gap)}",
            gap < ROUNDING,
        ),
        claim(
            "3.2.3, 3.3.2",
            "a convolved sequence of m = 2, 3, 4 modes has 3 m impulses",
            "6, 9, 12",
            ", ".join(map(str, counts)),
            counts == [6, 9, 12],
            because=Because(
                "3 m is the work a sample of the cascade of 3.2.2; the sequence has 3^m impulses, as 3.2.1 says.",
                counts == [9, 27, 81] and gap < ROUNDING,
            ),
        ),
        number(
            "3.2.3",
            "Shuttle arm with 7,000 lb, 0.20, 0.26, 0.45, 0.59 Hz: length of the convolved sequence",
            "about 12.76 s",
            length,
            "s",
        ),
    ]
