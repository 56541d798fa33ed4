"""Hyde, sections 3.4.1 and 3.4.2: impulses on a time mesh by linear programming, figures 3.7 to 3.16."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from preshape import Shaper, design
from preshape.papers.hyde.convolution import ODD, SHUTTLE, TWO
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, beyond, claim, difference, number, shown
from preshape.vibration import insensitivity, residual_vibration

__all__ = ["DT", "SHUTTLE_DT", "Meshed", "adjacent", "designs", "rows", "shuttle"]

DT = 0.005
"""Hyde's mesh for 1 and 10 Hz [s]."""

SHUTTLE_DT = 0.05
"""Mesh for the Shuttle arm [s]; Hyde names none for it."""

LENGTH = 1.1
"""Of figures 3.8 and 3.10 [s]."""

MESH_ZERO = 1e-9
"""What counts as zero vibration of a linear programme."""

ONE_SLOT_MORE = (
    "In 1.055 s the optimum is symmetric about the middle between two slots, so its number is even: 12. With one slot "
    "more, 1.060 s, which he says may be needed, there are 11, and 7 when neighbours are combined."
)


@dataclass(frozen=True)
class Meshed:
    """The sequences of the section.

    Parameters
    ----------
    zero, flat : Shaper
        Figures 3.8 and 3.10: 1.1 s, zero and second-derivative cost.
    quick, shortest, squashed : Shaper
        The shortest by the zero cost; figures 3.12, by the second-derivative cost in that length; and 3.15.
    shuttle : Shaper
        Figure 3.14.
    """

    zero: Shaper
    flat: Shaper
    quick: Shaper
    shortest: Shaper
    squashed: Shaper
    shuttle: Shaper


def designs() -> Meshed:
    """Solve the programmes once for rows and figures."""
    quick = design.mesh(TWO, DT)
    shortest = design.mesh(TWO, DT, duration=quick.duration, cost="second_derivative")
    return Meshed(
        zero=design.mesh(TWO, DT, duration=LENGTH),
        flat=design.mesh(TWO, DT, duration=LENGTH, cost="second_derivative"),
        quick=quick,
        shortest=shortest,
        squashed=design.squashed(shortest, DT),
        shuttle=shuttle(),
    )


def shuttle() -> Shaper:
    """Figure 3.14: the shortest on its mesh, then the second-derivative cost in that length."""
    shortest = design.mesh(SHUTTLE, SHUTTLE_DT)
    return design.mesh(SHUTTLE, SHUTTLE_DT, duration=shortest.duration, cost="second_derivative")


def adjacent(shaper: Shaper, dt: float) -> int:
    """How many pairs of impulses are in neighbouring time slots."""
    return int(np.sum(np.diff(shaper.times) < 1.5 * dt))


def rows(meshed: Meshed) -> list[Row]:
    """Every statement of the sections that can be checked."""
    return [*_zero_cost(meshed), *_flatter(meshed), *_shortest(meshed), *_shuttle(meshed), *_squashed(meshed)]


def _zero_cost(meshed: Meshed) -> list[Row]:
    left = float(residual_vibration(meshed.zero, [1.0, 10.0]).max())
    slots = round(LENGTH / DT)
    return [
        number(
            "3.4.2.a",
            "time slots of 1.1 s at 0.005 s",
            "220",
            float(slots + 1),
            digits=0,
            because=Because("220 intervals have 221 ends; both ends may hold an impulse.", slots == 220),
        ),
        number("3.4.2.a", "rows of constraints: 4 M + 1", "9", float(4 * len(TWO) + 1), digits=0),
        number("fig. 3.8", "impulses that are not zero, zero cost", "9", float(len(meshed.zero)), digits=0),
        claim(
            "fig. 3.9",
            "zero at 1 Hz and 10 Hz",
            "zero",
            f"at most {shown(left) if left > MESH_ZERO else '0'}",
            left < MESH_ZERO,
        ),
    ]


def _flatter(meshed: Meshed) -> list[Row]:
    pairs = adjacent(meshed.flat, DT)
    near = np.linspace(9.5, 10.5, 201)
    worst = [float(residual_vibration(shaper, near).max()) for shaper in (meshed.zero, meshed.flat)]
    bands = [insensitivity(shaper, TWO[1]) for shaper in (meshed.zero, meshed.flat)]
    cost = [_cost(shaper) for shaper in (meshed.zero, meshed.flat)]
    return [
        claim(
            "fig. 3.11",
            "second-derivative cost: flatter around 10 Hz than figure 3.9",
            "flatter",
            f"5 % band {bands[1].low:.2f} to {bands[1].high:.2f} Hz, before {bands[0].low:.2f} to {bands[0].high:.2f}",
            bands[1].value > bands[0].value and worst[1] < worst[0],
        ),
        claim(
            "(3.2)",
            "cost of figures 3.10 and 3.8 (undamped, so that the sign of the exponent does not matter)",
            "minimised",
            f"{cost[1]:.2e} against {cost[0]:.2e} s^4",
            cost[1] < cost[0],
        ),
        number(
            "fig. 3.10",
            "pairs of impulses in adjacent time slots",
            "three (3)",
            float(pairs),
            digits=0,
            because=Because(
                "The optimum is symmetric in time, so its pairs come in twos. His solver stopped at a sequence that is "
                "not, or a pair was too small to be seen.",
                pairs == 4 and difference(meshed.flat.amplitudes, meshed.flat.amplitudes[::-1]) < 1e-5,
            ),
        ),
    ]


def _shortest(meshed: Meshed) -> list[Row]:
    convolved = design.convolved(TWO)
    exact = design.direct(TWO)
    odd = residual_vibration(meshed.shortest, ODD)
    exact_odd = residual_vibration(exact, ODD)
    saved = 100.0 * (1.0 - meshed.quick.duration / convolved.duration)
    return [
        number("fig. 3.12", "length of the shortest sequence for 1 and 10 Hz", "1.055 s", meshed.quick.duration, "s"),
        number(
            "fig. 3.12",
            "its number of impulses, second-derivative cost",
            "11",
            float(len(meshed.shortest)),
            digits=0,
            because=Because(ONE_SLOT_MORE, len(meshed.shortest) == 12 and _one_slot_more() == (11, 7)),
        ),
        number("3.4.2.b", "saving over the convolved sequence: about 4 %", "4 %", saved, "%"),
        claim(
            "fig. 3.13",
            "odd multiples not perfectly suppressed (3, 5, 7, 9, 30, 50, 70 Hz)",
            "not perfectly",
            ", ".join(f"{100.0 * v:.0f}" for v in odd) + " %",
            float(odd.max()) > 0.001,
        ),
        claim(
            "3.4.2.b",
            "an exact sequence should recover the odd multiples",
            "recovered",
            ", ".join(f"{100.0 * v:.0f}" for v in exact_odd) + " %",
            float(exact_odd.max()) < MESH_ZERO,
            because=Because(
                "The mesh is not the reason. Odd multiples vanish where impulses are half periods apart, as in "
                "convolved sequences; the shortest exact sequence is not made like that.",
                exact.design.status == "optimal" and float(residual_vibration(convolved, ODD).max()) < ROUNDING,
            ),
        ),
        beyond(
            "3.4.2.b",
            "shortest positive sequence for 1 and 10 Hz without a mesh, certified",
            f"{exact.duration:.8f} s, {len(exact)} impulses",
            exact.design.status == "optimal" and abs(exact.duration - 1.05120780) < 1e-8 and len(exact) == 7,
            printed="1.055 s",
            note="Hyde's solver found no exact solution here, see section 3.4.3.c.",
        ),
    ]


def _shuttle(meshed: Meshed) -> list[Row]:
    convolved, exact = design.convolved(SHUTTLE), design.direct(SHUTTLE)
    length = meshed.shuttle.duration
    saved = 100.0 * (1.0 - length / convolved.duration)
    finest = math.ceil(exact.duration / DT) * DT
    fine = design.mesh(SHUTTLE, DT, duration=finest)
    return [
        number(
            "fig. 3.14",
            f"Shuttle arm, four modes: length on a mesh of {SHUTTLE_DT:g} s",
            "10.70 s",
            length,
            "s",
            note="Hyde names no mesh for this sequence; 0.05 and 0.1 s give what he prints.",
        ),
        number(
            "3.4.2.c",
            "the same with the 0.005 s that he says he used",
            "10.70 s",
            fine.duration,
            "s",
            because=Because(
                "A mesh of 0.005 s comes nearer to the shortest possible, 10.674 s; his sequence must have been solved "
                "on a coarser one.",
                abs(fine.duration - 10.675) < 1e-9 and (fine.design.residual or 0.0) < MESH_ZERO,
            ),
        ),
        number("3.4.2.b", "saving over the convolved 12.76 s", "16 %", saved, "%"),
        claim(
            "3.4.3.a",
            "impulses of the raw sequence",
            "about 4 m = 16",
            str(len(meshed.shuttle)),
            abs(len(meshed.shuttle) - 16) <= 3,
        ),
        _servo(),
    ]


def _servo() -> Row:
    exact = design.direct(TWO)
    coarse = Shaper.normalised(np.rint(exact.times / DT) * DT, exact.amplitudes)
    off = float(residual_vibration(coarse, [1.0, 10.0]).max())
    meshed = design.mesh(TWO, DT)
    on = float(residual_vibration(meshed, [1.0, 10.0]).max())
    return claim(
        "3.4.2.c",
        "rounding impulse times to servo counts loses effectiveness; a sequence of the mesh loses nothing (200 Hz)",
        "some lost; none",
        f"{100.0 * off:.1f} %; {shown(on) if on > MESH_ZERO else '0'}",
        off > 0.005 and on < MESH_ZERO,
    )


def _squashed(meshed: Meshed) -> list[Row]:
    before, after = meshed.shortest, meshed.squashed
    on_mesh = float(np.abs(after.times / DT - np.rint(after.times / DT)).max())
    left = float(residual_vibration(after, [1.0, 10.0]).max())
    return [
        claim(
            "fig. 3.15",
            "neighbouring impulses combined: number before and after",
            "11, 7",
            f"{len(before)}, {len(after)}",
            (len(before), len(after)) == (11, 7),
            because=Because(ONE_SLOT_MORE, len(after) == 7 and _one_slot_more() == (11, 7)),
        ),
        claim("fig. 3.15", "the time mesh is preserved", "preserved", "all on the mesh", on_mesh < 1e-6),
        claim(
            "fig. 3.16",
            "degradation by combining them, at 1 and 10 Hz",
            "slight",
            f"at most {100.0 * left:.2f} %",
            left < 0.05,
            note='"Slight" read as below the 5 % that section 2.2 calls acceptable.',
        ),
    ]


def _one_slot_more() -> tuple[int, int]:
    """Impulses of the flattest sequence of 1.060 s, before and after combining neighbours."""
    longer = design.mesh(TWO, DT, duration=1.060, cost="second_derivative")
    return len(longer), len(design.squashed(longer, DT))


def _cost(shaper: Shaper) -> float:
    """(3.2), undamped [s^4]."""
    total = 0.0
    for frequency, _ in TWO:
        phases = 2.0 * np.pi * frequency * shaper.times
        weights = shaper.amplitudes * shaper.times**2
        total += float(weights @ np.sin(phases)) ** 2 + float(weights @ np.cos(phases)) ** 2
    return total
