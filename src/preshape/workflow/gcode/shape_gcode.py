"""Shaping a G-code program for a controller that cannot shape: its moves resampled as short straight ones."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape.checks import not_negative, positive
from preshape.command.path import shaped_path
from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.shaper import Shaper
from preshape.workflow.gcode.planned import planned
from preshape.workflow.gcode.program import AXES, TOLERANCE, Passed, Run, read_program
from preshape.workflow.gcode.segments import segments
from preshape.workflow.gcode.written import DWELLS, written

__all__ = ["ShapedGcode", "shape_gcode"]

LARGEST_FILE = 100_000_000
MOST_WRITTEN = 5_000_000


@dataclass(frozen=True, eq=False)
class ShapedGcode:
    """What was written.

    Parameters
    ----------
    path : Path
        The file.
    lines_before, lines_after : int
        Of the program and of what was written.
    moves : int
        How many moves were shaped.
    unshaped_moves : int
        How many were passed on: those from a place that the program does not say, and of the extruder alone.
    duration_before, duration : float
        Of all shaped moves, planned and shaped [s].
    delay : float
        By how much all axes are late at constant speed [s].
    deviation : float
        How far the segments leave the shaped motion at most, at the same time [mm].
    shortest : float
        The shortest segment [s]; 0 if there is none.
    speed_step : float
        The largest change of velocity from one segment to the next [mm/s], as a vector: the controller must make it
        at once.
    """

    path: Path
    lines_before: int
    lines_after: int
    moves: int
    unshaped_moves: int
    duration_before: float
    duration: float
    delay: float
    deviation: float
    shortest: float
    speed_step: float


def shape_gcode(
    program: str | os.PathLike[str],
    shapers: Mapping[str, Shaper],
    out: str | os.PathLike[str],
    *,
    acceleration: float,
    corner_speed: float = 0.0,
    rapid: float | None = None,
    start: Mapping[str, float] | None = None,
    tolerance: float = TOLERANCE,
    dt: float = 0.0005,
    shortest: float = 0.002,
    dwell: str = "seconds",
) -> ShapedGcode:
    """Plan the moves of a program, shape them, and write them as straight moves of constant speed.

    All axes are delayed alike, those without a shaper too. Lines that are no move are passed on in order; the machine
    comes to rest before each. Extrusion follows the shaped way along its move, and its total is kept.

    Parameters
    ----------
    program : path
        G-code with straight moves, G0 and G1, and arcs in the XY plane, G2 and G3.
    shapers : mapping of str to Shaper
        By axis, x, y or z.
    out : path
        The file to write.
    acceleration : float
        Of the planned moves, along the way [mm/s^2]; arcs are no faster than this acceleration across the way allows.
    corner_speed : float
        By how much the velocity may jump at a corner, as a vector [mm/s]; 0 stops at every corner.
    rapid : float, optional
        Speed of G0 [mm/s]; the feed in force unless given.
    start : mapping of str to float, optional
        Where axes stand before the first line [mm].
    tolerance : float
        How far the written motion may be from the shaped one, at the same time [mm]: about that much vibration comes
        back. Arcs are planned as chords that stay within a twentieth of it.
    dt : float
        Sample time of planning and shaping [s].
    shortest : float
        The shortest segment [s]: what the controller and the line to it can take.
    dwell : {"seconds", "milliseconds"}
        What P means after G4, where the shaped motion pauses: seconds for Grbl, grblHAL, FluidNC and LinuxCNC,
        milliseconds for Marlin.

    Raises
    ------
    InputError
        If the program cannot be read, with the line; if the tolerance cannot be kept with the shortest segments; if a
        file is too large or cannot be written.
    """
    acceleration, tolerance = positive("acceleration", acceleration, "mm/s^2"), positive("tolerance", tolerance, "mm")
    dt, shortest = positive("dt", dt, "s"), positive("shortest", shortest, "s")
    corner_speed = not_negative("corner_speed", corner_speed, "mm/s")
    if dwell not in DWELLS:
        raise InputError(f"dwell is {dwell!r}: what G4 P counts is one of {', '.join(DWELLS)}.")
    if Path(out).exists() and Path(program).exists() and Path(out).samefile(program):
        raise InputError(f"{out} is the program itself: choose another name, so that nothing is lost.")
    each = _of_axes(shapers)
    text = _text(program)
    items = read_program(text, start=_places(start or {}), rapid=rapid, tolerance=tolerance)
    fewest = max(1, int(np.ceil(shortest / dt - 1e-9)))
    lines: list[str] = []
    before = after = deviation = speed_step = 0.0
    least = np.inf
    for item in items:
        if isinstance(item, Passed):
            lines.append(item.text)
            continue
        if not item.moves:
            lines += [f"; {comment}" for _, comment in item.comments]
            lines += written(item, np.zeros((4, 1)), np.zeros(1), np.zeros(0), 0.0, dwell)
            continue
        rows, begins = planned(item.moves, acceleration, corner_speed, dt)
        shaped = shaped_path(rows, [*each, *each], dt)
        motion = shaped.shaped[:3] + item.start[:, None]
        digits = 4 if item.writing.unit == 1.0 else 6
        try:
            ends, places, error = segments(motion, tolerance, fewest, digits, item.writing.unit)
        except InputError as refused:
            raise InputError(f"moves from line {item.moves[0].line}: {refused}") from None
        extruded = np.pad(shaped.shaped[3:].sum(axis=0), (0, fewest), mode="edge")[ends]
        extruded[-1] = sum(move.extruded for move in item.moves)
        delay = max(one.centroid for one in each)
        times = np.asarray(ends * dt, dtype=np.float64)
        lines += written(item, np.vstack([places, extruded]), times, begins, delay, dwell)
        if len(lines) > MOST_WRITTEN:
            raise InputError(f"more than {MOST_WRITTEN:,} lines would be written: give a larger tolerance or shortest.")
        before, after = before + (rows.shape[1] - 1) * dt, after + float(ends[-1]) * dt
        deviation, least = max(deviation, error), min(least, float(np.diff(ends).min()) * dt)
        speed_step = max(speed_step, _largest_step(places, times))
    content = "\n".join(lines) + "\n"
    if len(content) > LARGEST_FILE:
        raise InputError(f"the file would be larger than {LARGEST_FILE // 1_000_000} MB: give a larger tolerance.")
    return ShapedGcode(
        path=write_atomically(out, content),
        lines_before=len(text.splitlines()),
        lines_after=len(lines),
        moves=sum(len(item.moves) for item in items if isinstance(item, Run)),
        unshaped_moves=sum(item.moves for item in items if isinstance(item, Passed)),
        duration_before=before,
        duration=after,
        delay=max(one.centroid for one in each),
        deviation=deviation,
        shortest=0.0 if np.isinf(least) else least,
        speed_step=speed_step,
    )


def _largest_step(places: NDArray[np.float64], times: NDArray[np.float64]) -> float:
    """The largest change of velocity [mm/s], also from rest and into it."""
    velocities = np.diff(places, axis=1) / np.diff(times)
    still = np.zeros((places.shape[0], 1))
    return float(np.linalg.norm(np.diff(np.hstack([still, velocities, still]), axis=1), axis=0).max())


def _of_axes(shapers: Mapping[str, Shaper]) -> list[Shaper]:
    """One for each of x, y, z; an axis without one is only delayed."""
    by_letter = {name.upper(): shaper for name, shaper in shapers.items()}
    if not by_letter or set(by_letter) - set(AXES) or len(by_letter) < len(shapers):
        raise InputError(f"shapers are given for {', '.join(shapers) or 'no axis'}: give them for x, y or z, one each.")
    return [by_letter.get(axis, Shaper([0.0], [1.0])) for axis in AXES]


def _places(start: Mapping[str, float]) -> dict[str, float]:
    places = {name.upper(): value for name, value in start.items()}
    if set(places) - set(AXES) or not np.isfinite(list(places.values())).all():
        raise InputError(f"the start is given as {dict(start)!r}: give finite places [mm] of x, y or z.")
    return places


def _text(program: str | os.PathLike[str]) -> str:
    source = Path(program)
    try:
        if source.stat().st_size > LARGEST_FILE:
            raise InputError(f"{source} is larger than {LARGEST_FILE // 1_000_000} MB: split it.")
        return source.read_bytes().decode("utf-8")
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}.") from None
    except UnicodeDecodeError:
        raise InputError(f"{source} is no text in UTF-8: give G-code.") from None
