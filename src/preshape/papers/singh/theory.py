"""Singh & Heppler, sections 1 to 3: antiperiods, when they exist, and the envelope."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from preshape import design
from preshape.design.antiperiod import diophantine_divisors
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, beyond, claim, difference, number, shown
from preshape.papers.singh.signals import DAMPED, ENVELOPED, LOWEST, UNDAMPED, envelope, example_modes, signal

__all__ = ["rows"]

HERTZ = 1.0 / (2.0 * math.pi)
"""Of a radian a second."""

THREE = (30.0, 105.0, 385.0)
"""Frequencies of (19) [rad/s]."""


def rows() -> list[Row]:
    """In the order of the paper."""
    return [*_impulse_counts(), *_antiperiods(), *_odd(), *_three_modes(), *_envelopes()]


def _impulse_counts() -> list[Row]:
    modes = example_modes(DAMPED)
    counts = [len(design.zv(modes)), len(design.zvd(modes))]
    shortest = [design.direct(modes, order=order) for order in (0, 1)]
    proved = all(shaper.design.status == "optimal" for shaper in shortest)
    return [
        claim(
            "1",
            "convolved sequences of N = 2 modes have 2^N or, robust, 3^N impulses",
            "4, 9",
            f"{counts[0]}, {counts[1]}",
            counts == [4, 9],
        ),
        claim(
            "1",
            "Hyde: N + 1 or 2 N + 1 impulses are enough (2 and 14 rad/s, z = 0.01, proved shortest)",
            "3, 5",
            ", ".join(str(len(shaper)) for shaper in shortest),
            proved and [len(shaper) for shaper in shortest] == [3, 5],
            note="Here they are; several of Hyde's own cases need more, see his thesis.",
        ),
    ]


def _antiperiods() -> list[Row]:
    found = design.antiperiod_analysis([(HERTZ, 0.0), (2.0 * HERTZ, 0.0)])
    shifts, t = np.linspace(0.01, 4.0 * math.pi, 2000), np.linspace(0.0, 2.0 * math.pi, 200)
    y = np.sin(t) + np.sin(2.0 * t)
    moved = np.add.outer(shifts, t)
    nearest = float(np.abs(y + np.sin(moved) + np.sin(2.0 * moved)).max(axis=1).min())
    example = design.antiperiod_analysis(example_modes(UNDAMPED))
    spacing = example.antiperiod or math.nan
    times = np.linspace(0.0, 3.0, 301)
    mismatch = float(np.abs(signal(UNDAMPED, LOWEST, times) + signal(UNDAMPED, LOWEST, times + math.pi / LOWEST)).max())
    solved = all(
        2 * b * ((a - 1) // 2) - 2 * a * ((b - 1) // 2) == a - b
        for a, b in combinations(range(1, 40, 2), 2)
        if math.gcd(a, b) == 1
    )
    return [
        claim(
            "(13), fig. 1",
            "sin t + sin 2t has no antiperiod",
            "none",
            f"none; y(t) + y(t + T) reaches {nearest:.2f} for every T",
            not found.exists and nearest > 0.5,
        ),
        claim(
            "(14), (17)",
            "v = (m - 1)/2 solves the equation for odd coprime m (all pairs below 40)",
            "a special solving pair",
            "solves it" if solved else "does not",
            solved,
        ),
        claim(
            "Result I",
            "the antiperiod of sin 2t + sin 14t is pi/w_c, half the period",
            "T/2 = pi/2",
            f"{spacing:.6f} s; y(t) + y(t + pi/2) = {shown(mismatch)}",
            mismatch < ROUNDING and abs(spacing - math.pi / 2.0) < ROUNDING,
            note='The proof\'s last line, "T = 2 T_q", means 2 T_a.',
        ),
    ]


def _odd() -> list[Row]:
    triples = [triple for triple in combinations(range(1, 30, 2), 3) if math.gcd(*triple) == 1]
    enough = sum(_divisors_of_minors(triple)[0] == _divisors_of_minors(triple)[1] for triple in triples)
    mixed = [
        triple for triple in combinations(range(1, 16), 3) if math.gcd(*triple) == 1 and any(m % 2 == 0 for m in triple)
    ]
    none = sum(_divisors_of_minors(triple)[0] == _divisors_of_minors(triple)[1] for triple in mixed)
    return [
        claim(
            "2",
            f"with an even m there is no solution ({len(mixed)} triples)",
            "necessary",
            f"{none} have one",
            none == 0,
        ),
        claim(
            "2",
            f"all m odd is not sufficient (triples of odd m below 30 without common divisor: {len(triples)})",
            "not sufficient",
            f"{enough} of {len(triples)} have a solution",
            enough < len(triples),
            because=Because(
                "It is sufficient: v_i = (m_i - 1)/2 solves every equation (12) at once. The paper's determinants, "
                "computed here for each triple, agree.",
                enough == len(triples),
            ),
        ),
    ]


def _three_modes() -> list[Row]:
    modes = [(omega * HERTZ, 0.0) for omega in THREE]
    found, pair = design.antiperiod_analysis(modes), design.antiperiod_analysis(modes[1:])
    common = found.common
    integers = common.integers if common is not None else ()
    minors = _divisors_of_minors((6, 21, 77))
    library = diophantine_divisors((6, 21, 77))
    spacing = pair.antiperiod or math.nan
    subsets, single = design.antiperiod(modes), design.zv(modes)
    largest = float(subsets.design.residual or 0.0)
    return [
        claim(
            "(19)",
            "30, 105, 385 rad/s: w_c and m",
            "5; 6, 21, 77",
            f"{common.frequency / HERTZ if common is not None else math.nan:g}; {', '.join(map(str, integers))}",
            common is not None and abs(common.frequency / HERTZ - 5.0) < 1e-9 and integers == (6, 21, 77),
        ),
        claim(
            "(20)",
            "greatest common divisors of the determinants, coefficients and augmented",
            "24 and 12",
            f"{minors[0]} and {minors[1]}",
            minors == (24, 12) and library == minors,
        ),
        claim(
            "(19)",
            "no antiperiod for all three; modes two and three together have one",
            "none; one",
            f"none; {1000.0 * spacing:.2f} ms",
            not found.exists and pair.exists and abs(spacing - math.pi / 35.0) < ROUNDING,
        ),
        claim(
            "2",
            "the pair as one permits fewer impulses than mode by mode",
            "fewer",
            f"{len(subsets)} against {len(single)}",
            len(subsets) < len(single) and largest < ROUNDING,
        ),
        beyond(
            "2",
            "but they take longer",
            f"{subsets.duration:.5f} against {single.duration:.5f} s",
            abs(subsets.duration - (math.pi / 30.0 + math.pi / 35.0)) < 1e-9
            and abs(single.duration - sum(math.pi / omega for omega in THREE)) < 1e-9,
        ),
    ]


def _envelopes() -> list[Row]:
    x = np.linspace(-3.0, 3.0, 601)
    printed = max(float(np.abs(_multiple_angle(m, x, literal=True) - np.sin(m * x)).max()) for m in (1, 3, 7))
    right = max(float(np.abs(_multiple_angle(m, x, literal=False) - np.sin(m * x)).max()) for m in (1, 3, 7))
    times = np.linspace(0.0, 12.0, 1201)
    gap = difference(signal(ENVELOPED, 1.0, times), np.sin(times) * envelope(ENVELOPED, 1.0, times))
    return [
        claim(
            "(24)",
            "sin(m x) in powers, m = 1, 3, 7: error of the sum",
            "0",
            f"{printed:.2f}",
            printed < 1e-9,
            because=Because(
                "Misprint: the exponent of -1 is (r - 1)/2; r - 1/2 makes the sum imaginary.", right < 1e-9
            ),
        ),
        claim(
            "(25), (26), fig. 2",
            "y(t) = sin(t) E(t) for exp(-0.1 t) sin t + exp(-1.2 t) sin(3 t)/3",
            "equal",
            f"difference {shown(gap)}",
            gap < ROUNDING,
        ),
        number("(26)", "E(0) of it: sum of A m", "2", float(envelope(ENVELOPED, 1.0, np.zeros(1))[0])),
    ]


def _multiple_angle(m: int, x: NDArray[np.float64], *, literal: bool) -> NDArray[np.complex128]:
    """(24), with the exponent of -1 as printed or as it should be."""
    value = np.zeros(x.size, dtype=complex)
    for r in range(1, m + 1, 2):
        exponent = r - 0.5 if literal else 0.5 * (r - 1)
        value += complex(-1.0) ** exponent * math.comb(m, r) * np.sin(x) ** r * np.cos(x) ** (m - r)
    return value


def _divisors_of_minors(integers: tuple[int, ...]) -> tuple[int, int]:
    """The paper's two divisors for three modes, from the determinants of the first two equations of (20)."""
    m1, m2, m3 = integers
    matrix = [[2 * m2, -2 * m1, 0, m1 - m2], [2 * m3, 0, -2 * m1, m1 - m3]]
    minors = {(i, j): matrix[0][i] * matrix[1][j] - matrix[0][j] * matrix[1][i] for i, j in combinations(range(4), 2)}
    coefficients = [value for (_, j), value in minors.items() if j < 3]
    return math.gcd(*coefficients), math.gcd(*minors.values())
