"""G2 and G3 in the XY plane: an arc from a line's words, as chords that stay close to it, and with its exact ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.workflow.gcode.words import Line

__all__ = ["ARCS", "ARC_WORDS", "Arc", "arc_of"]

ARCS = (2.0, 3.0)
"""G2 turns clockwise, seen from above, G3 the other way."""

ARC_WORDS = "IJR"
"""Words that an arc has beside those of a straight move."""

CLOSER = 20.0
"""Chords stay so many times closer to the arc than the tolerance: what the velocity turns by at a vertex is then about
what the acceleration makes in a sample, and no train of little corners."""

MOST_CHORDS = 1_000_000

MISMATCH, RELATIVE_MISMATCH = 0.005, 1e-3
"""The radii at the start and the end of an arc may differ by the larger of so much [mm] and this part of the radius, as
Grbl has it: the rounding of coordinates."""

WHOLE_TURN = 5e-7
"""An arc that turns by less [rad] is a full circle, as Grbl has it."""


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc, or a helix around an axis along Z.

    Parameters
    ----------
    chords : ndarray, shape (chord, 3)
        Ways [mm]; their sum is the way of the arc.
    tangents : ndarray, shape (2, 3)
        Unit vectors along the way at the start and at the end.
    radius : float
        Of curvature [mm].
    """

    chords: NDArray[np.float64]
    tangents: NDArray[np.float64]
    radius: float


def arc_of(line: Line, way: NDArray[np.float64], unit: float, tolerance: float) -> Arc:
    """The arc of a line that has G2 or G3.

    Parameters
    ----------
    line : Line
        Its words; I and J count from the start.
    way : ndarray, shape (3,)
        From the start to the end [mm]; without way in x and y the arc is a full circle.
    unit : float
        Millimetres in a unit of the program.
    tolerance : float
        Chords stay within a twentieth of it [mm].

    Raises
    ------
    InputError
        If the words name no arc.
    """
    clockwise = 2.0 in line.codes
    given = {letter: value * unit for letter in ARC_WORDS if (value := line.value(letter)) is not None}
    if "R" in given and len(given) > 1:
        raise InputError(f"line {line.number} has R beside I or J: an arc takes its radius or its centre, not both.")
    if not given:
        raise InputError(f"line {line.number} has an arc without I, J or R: say where its centre is.")
    if "R" in given:
        centre = _centre_of_radius(line, way[:2], given["R"], clockwise)
    else:
        centre = np.array([given.get("I", 0.0), given.get("J", 0.0)])
    first, last = -centre, way[:2] - centre
    start, end = float(np.hypot(*first)), float(np.hypot(*last))
    if min(start, end) == 0.0 or abs(end - start) > max(MISMATCH, RELATIVE_MISMATCH * start):
        raise InputError(
            f"line {line.number} has an arc that begins {start:.4g} mm and ends {end:.4g} mm from its centre, which no "
            "circle does: count I and J from the start of the arc, and see that the end is right."
        )
    turn = _turn(first, last, clockwise, bool(way[:2].any()))
    closest = min(tolerance / CLOSER, start)
    count = math.ceil(turn / (2.0 * math.acos(1.0 - closest / max(start, end))))
    if count > MOST_CHORDS:
        raise InputError(f"line {line.number} has an arc of {start:.4g} mm radius: too large to be told from a line.")
    part = np.linspace(0.0, 1.0, count + 1)
    angles = math.atan2(first[1], first[0]) + part * (-turn if clockwise else turn)
    radii = start + part * (end - start)  # differs by the rounding of coordinates: the ends are exact so
    places = np.stack([radii * np.cos(angles) - first[0], radii * np.sin(angles) - first[1], part * way[2]], axis=1)
    places[0], places[-1] = 0.0, way
    sense = -1.0 if clockwise else 1.0
    climb = way[2] / (turn * start)
    flat = sense * np.stack([-np.sin(angles[[0, -1]]), np.cos(angles[[0, -1]])], axis=1)
    tangents = np.column_stack([flat, np.full(2, climb)]) / math.hypot(1.0, climb)
    return Arc(np.diff(places, axis=0), tangents, start * (1.0 + climb**2))


def _centre_of_radius(line: Line, way: NDArray[np.float64], radius: float, clockwise: bool) -> NDArray[np.float64]:
    """Of the two circles the one on which the arc turns by less than half a circle, or by more where R is negative."""
    chord = float(np.hypot(*way))
    if chord == 0.0:
        raise InputError(f"line {line.number} has R and ends where it begins, which any circle does: give I and J.")
    beyond = 0.5 * chord - abs(radius)
    if beyond > max(MISMATCH, RELATIVE_MISMATCH * abs(radius)):
        raise InputError(
            f"line {line.number} has R{radius:g} mm, and its ends are {chord:.4g} mm apart: a radius of at least "
            f"{0.5 * chord:.4g} mm reaches both."
        )
    height = math.sqrt(max(radius**2 - 0.25 * chord**2, 0.0))
    left = 1.0 if clockwise == (radius < 0.0) else -1.0
    return np.asarray(0.5 * way + left * height * np.array([-way[1], way[0]]) / chord)


def _turn(first: NDArray[np.float64], last: NDArray[np.float64], clockwise: bool, apart: bool) -> float:
    """By how much the arc turns [rad], above 0 and at most a full circle."""
    between = math.atan2(float(first[0] * last[1] - first[1] * last[0]), float(first @ last))
    turn = (-between if clockwise else between) % math.tau
    return turn if apart and turn > WHOLE_TURN else math.tau
