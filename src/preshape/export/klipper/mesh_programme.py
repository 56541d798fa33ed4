"""The least vibration on a mesh of times, as a linear programme: the start from which no family has to be guessed.

For a fixed duration and centroid both of Klipper's deviations are linear in the amplitudes, and |V| is convex: the
largest of Re(exp(-i phi) V) over all phi. So what remains of the vibration is the maximum of linear functions, of which
those that are violated are added until none is (ECOSYSTEM 1.10). The optimum of the mesh is global.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.export.klipper.measure import VibrationMeasure
from preshape.export.klipper.polish import Pulses
from preshape.export.klipper.scoring import ACCELERATION, SQUARE_CORNER_VELOCITY

__all__ = ["MeshOptimum", "least_on_mesh"]

Vector = NDArray[np.float64]

MESH = 25
"""Times tried; an impulse between two is split on them, and joined again."""

ROUNDS, CLOSE_ENOUGH = 5, 0.03
"""Rounds of adding violated functions, and the relative gap at which they end."""

SECONDS = 0.5
"""HiGHS gets this long a round; a start is worth no more."""

PRESENT = 1e-5
"""Amplitudes below are zero."""


@dataclass(frozen=True, eq=False)
class MeshOptimum:
    """What the programme found.

    Parameters
    ----------
    pulses : Pulses
        Neighbours on the mesh joined to one impulse, the last one at the end of the mesh or before.
    bound : float
        No positive impulses on this mesh, with this centroid and smoothing, leave less [-], measured at its end.
    left : float
        What the impulses on the mesh leave [-].
    """

    pulses: Pulses
    bound: float
    left: float


def least_on_mesh(
    measure: VibrationMeasure, duration: float, centroid: float, smoothing: float, points: int = MESH
) -> MeshOptimum | None:
    """The least vibration at a smoothing [mm] of at most so much; None when the solver gave up.

    Parameters
    ----------
    measure : VibrationMeasure
        Of the spectra.
    duration, centroid : float
        Of the shaper [s].
    smoothing : float
        At most [mm].
    points : int
        Of the mesh.
    """
    from scipy.optimize import linprog

    times = np.linspace(0.0, duration, points)
    decayed = np.exp(np.multiply.outer(measure.rates, times - duration))
    size = points + decayed.shape[0] + 1  # amplitudes, excess of each bin, the worst sum
    fixed, right = _fixed_rows(measure, times - centroid, smoothing, size)
    equal = np.zeros((2, size))
    equal[0, :points], equal[1, :points] = 1.0, (times - centroid) / duration
    cost = np.zeros(size)
    cost[-1] = 1.0
    rows, bounds = [fixed], [right]
    best: MeshOptimum | None = None
    for _ in range(ROUNDS):
        found = linprog(
            cost,
            A_ub=np.vstack(rows),
            b_ub=np.concatenate(bounds),
            A_eq=equal,
            b_eq=[1.0, 0.0],
            method="highs-ds",
            options={"time_limit": SECONDS},
        )
        if found.status != 0 or found.x is None or found.fun is None:
            return best
        amplitudes = found.x[:points]
        phasor = decayed @ amplitudes
        over = np.abs(phasor) * measure.weights - measure.free
        left = float(np.add.reduceat(np.maximum(over, 0.0), measure.starts).max())
        if best is None or left < best.left:
            best = MeshOptimum(_joined(times, amplitudes), float(found.fun), left)
        if left <= found.fun * (1.0 + CLOSE_ENOUGH) + 1e-4:
            break
        excess = over - found.x[points:-1]
        violated = np.flatnonzero(excess > 1e-6 + 0.002 * max(float(excess.max()), 0.0))
        phase = np.conj(phasor[violated]) / np.maximum(np.abs(phasor[violated]), 1e-12)
        added = np.zeros((violated.size, size))
        added[:, :points] = np.real(phase[:, np.newaxis] * decayed[violated]) * measure.weights[violated, np.newaxis]
        added[np.arange(violated.size), points + violated] = -1.0
        rows.append(added)
        bounds.append(measure.free[violated])
    return best


def _fixed_rows(measure: VibrationMeasure, distance: Vector, smoothing: float, size: int) -> tuple[Vector, Vector]:
    """Both deviations at most the smoothing, and the excess of each quantity's bins at most the worst sum."""
    half, points = 0.5 * ACCELERATION, distance.size
    late = np.maximum(distance, 0.0)
    ends = np.append(measure.starts[1:], measure.rates.size)
    rows = np.zeros((2 + measure.starts.size, size))
    rows[0, :points] = half * distance**2 / smoothing
    rows[1, :points] = math.sqrt(2.0) * (SQUARE_CORNER_VELOCITY * late + half * late**2) / smoothing
    for row, (start, end) in enumerate(zip(measure.starts, ends, strict=True), start=2):
        rows[row, points + start : points + end] = 1.0
        rows[row, -1] = -1.0
    right = np.zeros(rows.shape[0])
    right[:2] = 1.0
    return rows, right


def _joined(times: Vector, amplitudes: Vector) -> Pulses:
    """Runs of neighbours as one impulse each, at their centre of mass."""
    present = np.flatnonzero(amplitudes > PRESENT)
    groups = np.split(present, np.flatnonzero(np.diff(present) > 1) + 1)
    mass = np.array([amplitudes[group].sum() for group in groups])
    where = np.array([amplitudes[group] @ times[group] for group in groups]) / mass
    return Pulses(where - where[0], mass / mass.sum())
