"""Moves as a simple planner executes them: within an acceleration, stopping at corners or rounding none, sampled."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.workflow.gcode.program import Move

__all__ = ["planned"]

STRAIGHT = 1e-3
"""Moves whose directions differ by less [rad] are one line with vertices: the rounding of their coordinates."""

MOST_SAMPLES = 5_000_000
"""Of a run: forty minutes without a stop at 0.5 ms, in a gigabyte."""


def planned(
    moves: Sequence[Move], acceleration: float, corner_speed: float, dt: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The moves, sampled.

    The speed along the way rises and falls with the acceleration; at a corner it is so low that the velocity, as a
    vector, jumps by no more than the corner speed. An arc is one move, no faster than the acceleration across the way
    allows, and has no corner where it leaves or meets a line along its tangent.

    Parameters
    ----------
    moves : sequence of Move
        At least one.
    acceleration : float
        Along the way [mm/s^2].
    corner_speed : float
        [mm/s]; 0 stops at each corner.
    dt : float
        Sample time [s].

    Returns
    -------
    rows : ndarray, shape (6, time)
        Ways of x, y, z from the start, and the extrusion in three parts: that of each move divided among the axes with
        the squares of its direction cosines, so that part k follows axis k and, shaped as that axis is, the sum
        follows the shaped way along the move.
    begins : ndarray, shape (move,)
        When each begins [s].
    """
    pieces = [move.way[None, :] if move.arc is None else move.arc.chords for move in moves]
    ways = np.concatenate(pieces)
    begin = np.cumsum([0, *(len(each) for each in pieces[:-1])])
    chords = np.linalg.norm(ways, axis=1)
    lengths = np.add.reduceat(chords, begin)
    along_way = ways / chords[:, None]
    straight = zip(moves, along_way[begin], strict=True)
    tangents = np.array([(way, way) if move.arc is None else move.arc.tangents for move, way in straight])
    turns = np.linalg.norm(tangents[1:, 0] - tangents[:-1, 1], axis=1)
    curved = [np.inf if move.arc is None else np.sqrt(acceleration * move.arc.radius) for move in moves]
    speeds = np.minimum([move.speed for move in moves], curved)
    joints = _joint_speeds(lengths, turns, speeds, acceleration, corner_speed)
    times, rates, begins = _time_law(lengths, joints, speeds, acceleration)
    if times[-1] / dt > MOST_SAMPLES:
        raise InputError(
            f"the moves from line {moves[0].line} take {times[-1]:.0f} s without a stop, more than {MOST_SAMPLES:,} "
            "samples: give a larger dt, or split the program."
        )
    t = np.asarray(np.arange(int(np.ceil(times[-1] / dt - 1e-9)) + 1) * dt, dtype=float)
    along = _travelled(t, times, rates)
    ends = np.concatenate([[0.0], np.cumsum(chords)])
    of_move = np.repeat(np.arange(len(moves)), [len(each) for each in pieces])
    share = np.array([move.extruded for move in moves])[of_move] * chords / lengths[of_move]
    extruded = share[:, None] * along_way**2
    columns = np.concatenate([ways, extruded], axis=1)
    places = np.concatenate([np.zeros((1, 6)), np.cumsum(columns, axis=0)])
    # The end of the time law and that of the way differ by rounding.
    along *= ends[-1] / max(along[-1], ends[-1] * (1.0 - 1e-9))
    return np.stack([np.interp(along, ends, place) for place in places.T]), begins


def _joint_speeds(
    lengths: NDArray[np.float64],
    turns: NDArray[np.float64],
    speeds: NDArray[np.float64],
    acceleration: float,
    corner_speed: float,
) -> NDArray[np.float64]:
    """The highest speeds at the ends of the moves, shape (move + 1,), from rest to rest; `turns` is by how much the
    unit vector along the way changes at each joint."""
    both = np.minimum(speeds[:-1], speeds[1:])
    limits = np.where(turns < STRAIGHT, both, np.minimum(both, corner_speed / np.maximum(turns, STRAIGHT)))
    joints = [0.0, *limits.tolist(), 0.0]
    gains = (2.0 * acceleration * lengths).tolist()
    for k in range(len(gains) - 1, -1, -1):
        joints[k] = min(joints[k], float(np.sqrt(joints[k + 1] ** 2 + gains[k])))
    for k, gain in enumerate(gains):
        joints[k + 1] = min(joints[k + 1], float(np.sqrt(joints[k] ** 2 + gain)))
    return np.array(joints)


def _time_law(
    lengths: NDArray[np.float64], joints: NDArray[np.float64], speeds: NDArray[np.float64], acceleration: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and speeds [mm/s] between which the speed is linear, and when each move begins [s]."""
    first, last = joints[:-1], joints[1:]
    peaks = np.minimum(speeds, np.sqrt(acceleration * lengths + 0.5 * (first**2 + last**2)))
    peaks = np.maximum(peaks, np.maximum(first, last))
    ramps = (2.0 * peaks**2 - first**2 - last**2) / (2.0 * acceleration)
    cruises = np.maximum(0.0, lengths - ramps) / peaks
    durations = np.stack([(peaks - first) / acceleration, cruises, (peaks - last) / acceleration], axis=1)
    times = np.concatenate([[0.0], np.cumsum(durations.ravel())])
    rates = np.concatenate([[0.0], np.stack([peaks, peaks, last], axis=1).ravel()])
    return times, rates, times[:-1:3]


def _travelled(t: NDArray[np.float64], times: NDArray[np.float64], rates: NDArray[np.float64]) -> NDArray[np.float64]:
    """The way at times t [s] under a speed that is linear between knots: exact."""
    steps = np.diff(times)
    ends = np.concatenate([[0.0], np.cumsum(0.5 * (rates[:-1] + rates[1:]) * steps)])
    knot = np.clip(np.searchsorted(times, t, side="right") - 1, 0, steps.size - 1)
    since = np.minimum(t - times[knot], steps[knot])
    slopes = np.diff(rates) / np.where(steps > 0.0, steps, 1.0)
    return np.asarray(ends[knot] + (rates[knot] + 0.5 * slopes[knot] * since) * since)
