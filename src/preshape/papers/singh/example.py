"""Singh & Heppler, section 4: two modes at 2 and 14 rad/s, without damping and with 1 %; tables 1 and 2."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape import Shaper, design
from preshape.design.antiperiod import PaperConditions, paper_conditions
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, beyond, claim, difference, number, shown
from preshape.papers.singh.signals import (
    DAMPED,
    LOWEST,
    UNDAMPED,
    Term,
    after_the_end,
    applied,
    example_modes,
)
from preshape.plant import ModalPlant

__all__ = ["TABLE_2", "rows", "shaper_of"]

TABLE_2 = Shaper.normalised(math.pi / 2.0 * np.arange(3), [0.30644, 0.49482, 0.19874])
"""The printed three-impulse sequence; its times are printed as 0, 1.57, 3.14 s."""

FREQUENCY = LOWEST / (2.0 * math.pi)


def rows() -> list[Row]:
    """In the order of the section."""
    return [*_undamped(), *_applied_undamped(), *_two_impulses(), *_three_impulses(), *_per_mode()]


def shaper_of(which: str, terms: tuple[Term, ...]) -> Shaper:
    """ "two" or "three" impulses of the paper, "four" or "nine" of the convolved sequences."""
    modes = example_modes(terms)
    if which == "two":
        return design.antiperiod(modes, impulses="two")
    if which == "three":
        return design.antiperiod(modes, impulses="three")
    return design.zv(modes) if which == "four" else design.zvd(modes)


def _undamped() -> list[Row]:
    found = []
    for which, amplitudes in (("two", [0.5, 0.5]), ("three", [0.25, 0.5, 0.25])):
        shaper = shaper_of(which, UNDAMPED)
        gap = difference(shaper.amplitudes, amplitudes)
        gap += difference(shaper.times, math.pi / 2.0 * np.arange(len(amplitudes)))
        left = ModalPlant(example_modes(UNDAMPED)).impulse_residual(shaper.times, shaper.amplitudes)
        found.append(
            claim(
                "table 1",
                f"{which} impulses, undamped: amplitudes at 0, pi/2 ...; vibration left in both modes",
                ", ".join(f"{a:g}" for a in amplitudes),
                ", ".join(f"{a:.6g}" for a in shaper.amplitudes) + f"; {shown(float(left.max()))}",
                gap < ROUNDING and bool(left.max() < ROUNDING),
            )
        )
    period = 2.0 * math.pi / LOWEST
    found.append(
        claim(
            "4.1",
            "the common period T = 2 pi/3 = pi",
            "2 pi/3 = pi",
            f"2 pi/3 = {2.0 * math.pi / 3.0:.4f}",
            abs(2.0 * math.pi / 3.0 - math.pi) < ROUNDING,
            because=Because("Misprint: T = 2 pi/2, since w_c = 2.", abs(period - math.pi) < ROUNDING),
        )
    )
    return found


def _applied_undamped() -> list[Row]:
    two, three = shaper_of("two", UNDAMPED), shaper_of("three", UNDAMPED)
    perfect, late = after_the_end(applied(two), UNDAMPED), after_the_end(applied(two, [0, 1]), UNDAMPED)
    best, both_late = after_the_end(applied(three), UNDAMPED), after_the_end(applied(three, [0, 1, 1]), UNDAMPED)
    twice = after_the_end(applied(three, [0, 1, 2]), UNDAMPED)
    return [
        claim(
            "fig. 7",
            "two impulses applied every 0.01 s: peak left afterwards",
            "fairly good",
            f"{100.0 * perfect:.2f} % of unshaped",
            perfect < 0.01,
        ),
        claim(
            "fig. 8",
            "the second one sampling interval late: not totally eliminated",
            "residual vibration",
            f"{100.0 * late:.1f} %",
            late > 5.0 * perfect,
        ),
        claim(
            "fig. 9",
            "three impulses: marked improvement",
            "improved",
            f"{100.0 * best:.4f} %",
            best < 0.1 * perfect,
        ),
        claim(
            "fig. 10",
            "second and third one interval late: marked improvement over fig. 8",
            "improved",
            f"{100.0 * both_late:.1f} %; {100.0 * twice:.2f} % if the third is two intervals late",
            twice < 0.1 * late and both_late < 0.6 * late,
            note="The caption says only that the third impulse is applied imperfectly.",
        ),
    ]


def _two_impulses() -> list[Row]:
    factors = []
    for decay in (0.01 / math.sqrt(1.0 - 0.01**2), 0.01):
        below = sum(math.exp(-decay * m * math.pi) * m for m in (1, 7))
        factors.append(8.0 / below)
    shaper = shaper_of("two", DAMPED)
    gap = abs(shaper.amplitudes[0] / shaper.amplitudes[1] - factors[1])
    return [
        number(
            "(34)",
            "I_1 for z = 0.01",
            "1.2144",
            factors[0],
            because=Because(
                "Truncated, not rounded.", math.floor(1e4 * factors[0]) == 12144 and abs(factors[0] - factors[1]) < 2e-5
            ),
        ),
        number("table 2", "first of two amplitudes, from the printed (34)", "0.5484", factors[0] / (1.0 + factors[0])),
        number("table 2", "second, from our shaper", "0.4516", float(shaper.amplitudes[1])),
        claim(
            "(27), (40)",
            "f = z / sqrt(1 - z^2) in (27), but z in (40): difference of I_1",
            "the same",
            f"{abs(factors[0] - factors[1]):.0e}; ours, with (40): {shown(gap)}",
            abs(factors[0] - factors[1]) < 0.5e-4 and gap < ROUNDING,
            note="Too small to see in the table.",
        ),
    ]


def _three_impulses() -> list[Row]:
    ours = shaper_of("three", DAMPED)
    conditions = [_conditions(TABLE_2), _conditions(ours)]
    met = abs(conditions[1].in_phase) < 1e-9 and abs(conditions[1].quadrature) < 1e-9
    met = met and abs(conditions[1].in_phase_slope) < 1e-9
    near = difference(ours.amplitudes, TABLE_2.amplitudes)
    why = (
        "The conditions are so sensitive that the printed digits are where the authors' iteration stopped: they meet "
        f"(35) to {abs(conditions[0].in_phase):.0e} and (38) to {abs(conditions[0].in_phase_slope):.0e}; ours meet "
        "them to rounding."
    )
    found = [
        number(
            "table 2",
            f"{word} of three amplitudes, from (35), (36), (38)",
            printed,
            float(value),
            because=Because(why, met and near < 4e-4 and abs(conditions[0].in_phase) < 2e-4),
        )
        for word, printed, value in zip(
            ("first", "second", "third"), ("0.30644", "0.49482", "0.19874"), ours.amplitudes, strict=True
        )
    ]
    times, amplitudes, gap = _root_of_all_four()
    found.append(
        claim(
            "(35)-(38)",
            "solving all four for two times and two amplitudes gives table 2",
            "0.30644, 0.49482, 0.19874",
            ", ".join(f"{a:.5f}" for a in amplitudes) + " at " + ", ".join(f"{t:.5f}" for t in times) + " s",
            difference(amplitudes, TABLE_2.amplitudes) < 5e-6,
            because=Because(
                "Table 2 does not solve (37), see the next row; the root of all four lies at slightly later times.",
                gap < 1e-9 and abs(amplitudes[0] - 0.29984) < 2e-5 and 0.0 < times[1] - math.pi / 2.0 < 1e-4,
            ),
        )
    )
    found.append(
        claim(
            "(37)",
            "the printed amplitudes solve all four equations, (37) among them: its left side",
            "0",
            f"{conditions[0].quadrature_slope:.2f} s",
            abs(conditions[0].quadrature_slope) < 0.01,
            because=Because(
                "At equal spacing (35) and (38) fix the amplitudes, and (37) stays open, for the printed digits as for "
                "the exact root of the other three.",
                abs(conditions[0].quadrature) < 1e-9 and abs(conditions[1].quadrature_slope - 0.655) < 0.001,
            ),
        )
    )
    return found


def _per_mode() -> list[Row]:
    found = []
    modes = example_modes(DAMPED)
    for which, shaper, known in (
        ("two", shaper_of("two", DAMPED), (0.0799, 0.0114)),
        ("three", TABLE_2, (0.0070, 0.0010)),
    ):
        left = ModalPlant(modes).impulse_residual(shaper.times, shaper.amplitudes)
        found.append(
            claim(
                "abstract, § 5",
                f"{which} impulses eliminate all the modes, z = 0.01: left in each",
                "eliminates",
                ", ".join(f"{100.0 * v:.2f}" for v in left) + " %",
                bool(left.max() < ROUNDING),
                because=Because(
                    "(30) and (35) ask only that the sum of m_i V_i over the modes vanish, not each V_i; with "
                    "different decay rates both modes go on.",
                    difference(left, known) < 2e-4,
                ),
            )
        )
    exact = design.antiperiod(modes)
    left = ModalPlant(modes).impulse_residual(exact.times, exact.amplitudes)
    found.append(
        beyond(
            "3",
            "impulses an antiperiod apart that do eliminate both: prod (1 + K_i q)/(1 + K_i)",
            ", ".join(f"{a:.5f}" for a in exact.amplitudes) + f"; {shown(float(left.max()))} left",
            len(exact) == 3 and bool(left.max() < ROUNDING) and exact.duration < math.pi + 1e-9,
            note="One impulse more than there are different decay rates; as long as the paper's three.",
        )
    )
    return found


def _conditions(shaper: Shaper) -> PaperConditions:
    return paper_conditions(shaper.times, shaper.amplitudes, example_modes(DAMPED), FREQUENCY, [1, 7])


def _root_of_all_four() -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Times [s], amplitudes and largest left side of (35)-(38), by Newton's method from table 2."""
    from scipy.optimize import root

    def left_sides(unknown: NDArray[np.float64]) -> list[float]:
        found = paper_conditions(
            [0.0, unknown[0], unknown[1]], [unknown[2], unknown[3], 1.0], example_modes(DAMPED), FREQUENCY, [1, 7]
        )
        return [found.in_phase, found.quadrature, found.quadrature_slope, found.in_phase_slope]

    start = [*TABLE_2.times[1:], *(TABLE_2.amplitudes[:2] / TABLE_2.amplitudes[2])]
    solution = root(left_sides, start, tol=1e-13)
    amplitudes = np.array([*solution.x[2:], 1.0])
    return np.array([0.0, *solution.x[:2]]), amplitudes / amplitudes.sum(), max(map(abs, left_sides(solution.x)))
