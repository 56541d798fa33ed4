"""A G-code program as runs of moves, which are shaped, and lines between them, which are passed on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.workflow.gcode.arcs import ARC_WORDS, ARCS, Arc, arc_of
from preshape.workflow.gcode.words import Line, line_of

__all__ = ["AXES", "TOLERANCE", "Move", "Passed", "Run", "Writing", "read_program"]

AXES = "XYZ"
INCH = 25.4
TOLERANCE = 0.004
"""How far written motion may be from the shaped one [mm], unless told."""
MOST_LINES = 2_000_000
HARMLESS = {4.0, 90.1, 91.1, 97.0, 11.0, 17.0, 18.0, 19.0, 20.0, 21.0, 40.0, 61.0, 61.1, 64.0, 80.0, 90.0, 91.0, 94.0}
BESIDE_A_MOVE = {17.0, 18.0, 19.0, 20.0, 21.0, 40.0, 61.0, 64.0, 90.0, 91.0, 94.0}
LOSING = {27.0, 28.0, 29.0, 30.0, 49.0, 53.0, 92.1, 92.2, 92.3, 43.0, 43.1, *(54.0 + k for k in range(6))}
"""After these the program does not say where the machine stands."""
LOSING_COMMANDS = ("M0", "M1", "M6", "M60", "M98", "M125", "M206", "M428", "M600", "M701", "M702")


@dataclass(frozen=True, slots=True)
class Move:
    """A move: ways of the three axes [mm], what is extruded [mm], speed [mm/s]; its line's number; its arc, if it is no
    straight line."""

    way: NDArray[np.float64]
    extruded: float
    speed: float
    line: int
    arc: Arc | None = None


@dataclass(frozen=True, slots=True)
class Writing:
    """How coordinates are written at some place of the program: absolute ones or not, also of E; mm a unit."""

    absolute: bool
    absolute_extrusion: bool
    unit: float


@dataclass(frozen=True, slots=True)
class Passed:
    """A line that goes on as it stands, the machine at rest; whether it is a move that is not shaped."""

    text: str
    moves: bool = False


@dataclass(slots=True)
class Run:
    """Moves without another line between: where they begin [mm] (0 where only steps are written), comments with the
    number of the move they stand before, and the feed [mm/s] and kind of motion in force at the end."""

    start: NDArray[np.float64]
    start_extrusion: float
    writing: Writing
    moves: list[Move] = field(default_factory=list)
    comments: list[tuple[int, str]] = field(default_factory=list)
    feed: float | None = None
    rapid: bool = False


class _Reader:
    """The modal state of a controller, line after line."""

    def __init__(self, start: Mapping[str, float], rapid: float | None, tolerance: float) -> None:
        self.tolerance = tolerance
        self.plane, self.absolute_centres = 17.0, False
        self.rapid = None if rapid is None else positive("the rapid speed", rapid, "mm/s")
        self.place = np.array([start.get(axis, np.nan) for axis in AXES], dtype=float)
        self.extrusion = 0.0
        self.writing = Writing(True, True, 1.0)
        self.extrusion_said = True
        self.motion: float | None = None
        self.feed: float | None = None
        self.items: list[Passed | Run] = []

    def read(self, line: Line) -> None:
        if line.words is None:
            self._pass(line)
            self._command(line)
        elif not line.words:
            self._comment(line)
        else:
            self._words(line)

    def _pass(self, line: Line, moves: bool = False) -> None:
        self.items.append(Passed(line.text, moves))

    def _comment(self, line: Line) -> None:
        last = self.items[-1] if self.items else None
        if isinstance(last, Run):
            if line.comment:
                last.comments.append((len(last.moves), line.comment))
        else:
            self._pass(line)

    def _command(self, line: Line) -> None:
        """What is not read may still say how E counts, or move."""
        first = line.body.upper().split()[0]
        if first in ("M82", "M83"):
            self.writing = Writing(self.writing.absolute, first == "M82", self.writing.unit)
            self.extrusion_said = True
        letter = first[:1]
        if first in LOSING_COMMANDS or letter not in "M%":
            self.place[:] = np.nan

    def _words(self, line: Line) -> None:
        codes = line.codes
        for code in codes:
            if code in (0.0, 1.0, *ARCS):
                self.motion = code
            elif code in (90.0, 91.0, 20.0, 21.0):
                self._set(code)
            elif code not in HARMLESS | LOSING | {10.0, 92.0}:
                raise InputError(f"line {line.number} has G{code:g}, which is not read here: take it out.")
            elif code in (17.0, 18.0, 19.0):
                self.plane = code
            elif code in (90.1, 91.1):
                self.absolute_centres = code == 90.1
        feed = line.value("F")
        if feed is not None:
            if feed <= 0.0:
                raise InputError(f"line {line.number} has F{feed:g}: give a feed above 0.")
            self.feed = feed * self.writing.unit / 60.0
        if any(code in LOSING for code in codes) or (10.0 in codes and line.value("L") is not None):
            self._pass(line)
            self.place[:] = np.nan
        elif 92.0 in codes:
            self._pass(line)
            self._offset(line)
        elif 4.0 in codes:
            self._pass(line)
        elif any(name in "ABCUVWXYZE" + ARC_WORDS for name, _ in line.words or ()):
            self._move(line)
        elif any(name not in "GFN" or (name == "G" and value not in (0.0, 1.0)) for name, value in line.words or ()):
            self._pass(line)
            if any(name == "T" or f"{name}{value:g}" in LOSING_COMMANDS for name, value in line.words or ()):
                self.place[:] = np.nan
        else:  # a feed or a kind of motion alone: the moves carry it
            self._carried(line)

    def _carried(self, line: Line) -> None:
        last = self.items[-1] if self.items else None
        if isinstance(last, Run):
            last.feed, last.rapid = self.feed, self.motion == 0.0
            self._comment(line)
        else:
            self._pass(line)

    def _set(self, code: float) -> None:
        now = self.writing
        if code in (20.0, 21.0):
            self.writing = Writing(now.absolute, now.absolute_extrusion, INCH if code == 20.0 else 1.0)
            return
        # After G91 E counts from where it is; after G90 behind M83 firmwares differ.
        self.extrusion_said = code == 91.0 or now.absolute_extrusion
        self.writing = Writing(code == 90.0, code == 90.0 and now.absolute_extrusion, now.unit)

    def _offset(self, line: Line) -> None:
        given = [line.value(axis) for axis in AXES]
        e = line.value("E")
        if e is None and all(value is None for value in given):
            self.place[:], self.extrusion = 0.0, 0.0
        for k, value in enumerate(given):
            if value is not None:
                self.place[k] = value * self.writing.unit
        if e is not None:
            self.extrusion = e * self.writing.unit

    def _move(self, line: Line) -> None:
        arcs = self.motion in ARCS
        others = sorted({name for name, _ in line.words or ()} - set("GFNXYZE" + ARC_WORDS * arcs))
        if others:
            raise InputError(
                f"line {line.number} has {', '.join(others)} beside a move: only X, Y, Z, E and F are read there; put "
                "other words on a line of their own, and leave out other axes."
            )
        modes = [code for code in line.codes if code not in (0.0, 1.0, *ARCS)]
        if set(modes) - BESIDE_A_MOVE:
            raise InputError(f"line {line.number} has other G words beside a move: put them on a line before.")
        if modes:
            self.items.append(Passed(" ".join(f"G{mode:g}" for mode in modes)))
        if self.motion is None:
            raise InputError(f"line {line.number} moves without G0 or G1 before: say which.")
        way, unknown = self._way(line)
        extruded = self._extruded(line)
        arc = self._arc(line, way) if arcs and not unknown else None
        moved = arc is not None or bool(way.any())
        if unknown or (extruded and not moved):
            self._pass(line, moves=True)
            return
        speed = self.rapid if self.motion == 0.0 and self.rapid is not None else self.feed
        if speed is None:
            raise InputError(
                f"line {line.number} moves before any F says how fast: put F on it" + (", or give the rapid speed."
                if self.motion == 0.0 else ".")
            )  # fmt: skip
        last = self.items[-1] if self.items else None
        if not isinstance(last, Run):
            begin = np.nan_to_num(self.place - way) if self.writing.absolute else np.zeros(len(AXES))
            last = Run(begin, self.extrusion - extruded, self.writing)
            self.items.append(last)
        if line.comment:
            last.comments.append((len(last.moves), line.comment))
        if moved:
            last.moves.append(Move(way, extruded, speed, line.number, arc))
        last.feed, last.rapid = self.feed, self.motion == 0.0

    def _arc(self, line: Line, way: NDArray[np.float64]) -> Arc:
        if self.motion not in line.codes:
            raise InputError(f"line {line.number} goes on after an arc without G word: say G0, G1, G2 or G3.")
        if self.plane != 17.0 or self.absolute_centres:
            mode = "G90.1" if self.absolute_centres else f"G{self.plane:g}"
            raise InputError(
                f"line {line.number} has an arc under {mode}: arcs are read in the XY plane (G17) with I and J from "
                "their start (G91.1); let the program that wrote it write these as lines."
            )
        return arc_of(line, way, self.writing.unit, self.tolerance)

    def _way(self, line: Line) -> tuple[NDArray[np.float64], bool]:
        """By how much the axes move [mm], and whether one of them begins at a place that is not known."""
        way, unknown = np.zeros(len(AXES)), False
        for k, axis in enumerate(AXES):
            value = line.value(axis)
            if value is None:
                continue
            here = self.place[k]
            there = value * self.writing.unit + (0.0 if self.writing.absolute else here)
            unknown |= bool(np.isnan(here))
            way[k] = 0.0 if np.isnan(here) else there - here
            self.place[k] = there
        return way, unknown

    def _extruded(self, line: Line) -> float:
        value = line.value("E")
        if value is None:
            return 0.0
        if not self.extrusion_said:
            raise InputError(
                f"line {line.number} extrudes after G90 behind M83, where firmwares differ: say M82 or M83 after G90."
            )
        before = self.extrusion if self.writing.absolute_extrusion else 0.0
        extruded = value * self.writing.unit - before
        self.extrusion += extruded
        return extruded


def read_program(
    text: str,
    *,
    start: Mapping[str, float] | None = None,
    rapid: float | None = None,
    tolerance: float = TOLERANCE,
) -> list[Passed | Run]:
    """A program as runs of moves and lines between them, in order.

    Parameters
    ----------
    text : str
        G-code: G0 and G1 with X, Y, Z, E and F; G2 and G3 in the XY plane with I and J, or R; G90, G91, G20,
        G21, G92, M82, M83 are followed; all else that is not refused is passed on.
    start : mapping of str to float, optional
        Where the axes stand before the first line [mm], by letter. A move from a place that is not known, there or
        after homing, is passed on; its end is known.
    rapid : float, optional
        Speed of G0 [mm/s]; the feed in force unless given.
    tolerance : float
        Of the shaped motion [mm]; arcs become chords that stay within a twentieth of it.

    Raises
    ------
    InputError
        Naming the first line that cannot be read.
    """
    lines = text.splitlines()
    if len(lines) > MOST_LINES:
        raise InputError(f"the program has {len(lines):,} lines: up to {MOST_LINES:,} are read.")
    reader = _Reader(start or {}, rapid, tolerance)
    for line in _lines(lines):
        reader.read(line)
    return reader.items


def _lines(lines: Iterable[str]) -> Iterable[Line]:
    return (line_of(number, line) for number, line in enumerate(lines, 1))
