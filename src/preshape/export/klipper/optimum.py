"""The best impulses by Klipper's measures within a controller's limits: from many starts, scored independently."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from preshape.design.each_mode import recorded
from preshape.export.klipper.measure import VibrationMeasure, corner_deviations
from preshape.export.klipper.mesh_programme import least_on_mesh
from preshape.export.klipper.polish import Asked, Pulses, Room, on_grid, polished, reduced
from preshape.export.klipper.scoring import ACCELERATION, SQUARE_CORNER_VELOCITY, CornerMoments, KlipperScore, score
from preshape.export.klipper.spectra import Spectrum
from preshape.mode import Modes
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["Optimiser", "ScoredShaper", "scaled_to_smoothing"]

OPTIMUM = "spectrum optimum"
"""What the design record of such a shaper calls its family."""

ROUNDING = 1e-9
"""Relative excess over a bound that is forgiven: a shaper whose amplitudes are normalised anew still meets its own."""

STARTS = 2
"""How many of the starts are polished, the most promising first."""

FORGIVEN = 0.01
"""A start that leaves so much more vibration [-] than a small bound counts as half as promising."""


@dataclass(frozen=True)
class ScoredShaper:
    """A shaper, and Klipper's measures of it on the spectra."""

    shaper: Shaper
    score: KlipperScore


class Optimiser:
    """Searches on fixed spectra, within what a controller holds.

    Parameters
    ----------
    spectra : sequence of Spectrum
        Normalised; the worst case counts.
    room : Room
        What the controller holds.
    modes : Modes
        For the record of the shapers: where the machine is thought to vibrate.
    """

    def __init__(self, spectra: Sequence[Spectrum], room: Room, modes: Modes) -> None:
        self.spectra, self.room, self.modes = tuple(spectra), room, modes
        self.measure = VibrationMeasure.of(self.spectra)

    def best(
        self,
        asked: Asked,
        starts: Iterable[Shaper],
        *,
        mesh: tuple[float, float] | None = None,
        tail: float | None = None,
        tried: int = STARTS,
    ) -> ScoredShaper | None:
        """The best shaper that meets what is asked by Klipper's own formula; None when no search ended in one.

        Parameters
        ----------
        asked : Asked
            Bounds and aim.
        starts : iterable of Shaper
            From which to search; those that meet everything count themselves too.
        mesh : (float, float), optional
            Duration and centroid [s] for which the linear programme gives one more start.
        tail : float, optional
            Instead of the room's [s].
        tried : int
            How many of the starts are polished.
        """
        room = self.room if tail is None else replace(self.room, tail=tail)
        given = [Pulses(one.times, one.amplitudes) for one in starts]
        chosen = self._most_promising(given, asked, room)[:tried]
        if mesh is not None and math.isfinite(asked.smoothing):
            optimum = least_on_mesh(self.measure, *mesh, asked.smoothing)
            if optimum is not None and optimum.pulses.times.size > 1:
                chosen.append(reduced(optimum.pulses, room.impulses, room.smallest))
        found = [one for one in given if room.fits(one)]
        for start in chosen:
            end = self._searched(start, asked, room)
            if end is not None and (placed := on_grid(end, self.measure, asked, room)) and room.fits(placed):
                found.append(placed)
        scored = (self._scored(one, asked) for one in found)
        return min((one for one in scored if _meets(one, asked)), key=lambda one: _aim(one, asked), default=None)

    def _most_promising(self, given: Sequence[Pulses], asked: Asked, room: Room) -> list[Pulses]:
        """The starts reduced to what the controller holds, each once, the most promising first."""
        fewer = {}
        for one in given:
            start = reduced(one, room.impulses, room.smallest)
            fewer[start.times.tobytes()] = start
        return sorted(fewer.values(), key=lambda pulses: self._promise(pulses, asked))

    def _searched(self, start: Pulses, asked: Asked, room: Room) -> Pulses | None:
        """Polished; once more when the search ran out of rounds a little outside the bounds."""
        end = polished(start, self.measure, asked, room) if start.times.size > 1 else None
        if end is None or asked.vibration is None:
            return end
        left = float(self.measure.left(end.times, end.amplitudes).values.max())
        if asked.vibration < left < asked.vibration + FORGIVEN:
            return polished(end, self.measure, asked, room)
        return end

    def _promise(self, pulses: Pulses, asked: Asked) -> float:
        """Less is more promising: the aim, with what breaks the bounds added."""
        left = float(self.measure.left(pulses.times, pulses.amplitudes).values.max())
        smooths = float(corner_deviations(pulses.times, pulses.amplitudes).values.max())
        over = max(smooths / asked.smoothing - 1.0, 0.0)
        if asked.vibration is None:
            return left + over
        return smooths * (1.0 + max(left - asked.vibration, 0.0) / max(asked.vibration, FORGIVEN)) + over

    def _scored(self, pulses: Pulses, asked: Asked) -> ScoredShaper:
        aim = "least vibration" if asked.vibration is None else "highest acceleration"
        settings: dict[str, float | str] = {"aim": aim}
        if asked.vibration is not None:
            settings["vibration"] = asked.vibration
        if math.isfinite(asked.smoothing):
            settings["smoothing"] = asked.smoothing
        shaper = Shaper.normalised(pulses.times, pulses.amplitudes, Design(OPTIMUM))
        shaper = recorded(shaper, Design(OPTIMUM, self.modes, settings, "feasible"))
        return ScoredShaper(shaper, score(shaper, self.spectra))


def scaled_to_smoothing(shaper: Shaper, smoothing: float) -> Shaper:
    """The same amplitudes, sped up or slowed down until Klipper's smoothing [mm] is this.

    Examples
    --------
    >>> from preshape.export.klipper import smoothing, zv
    >>> round(smoothing(scaled_to_smoothing(zv(50.0), 0.05)), 9)
    0.05
    """
    moments = CornerMoments.of(shaper)
    return Shaper(shaper.times / _speed(moments, smoothing), shaper.amplitudes, shaper.design)


def _speed(moments: CornerMoments, smoothing: float) -> float:
    """The factor by which the shaper is to be sped up: each deviation is a quadratic in its reciprocal."""
    half = 0.5 * ACCELERATION
    linear = math.sqrt(2.0) * SQUARE_CORNER_VELOCITY * moments.late_first
    square = math.sqrt(2.0) * half * moments.late_second
    reversal = math.sqrt(half * moments.second / smoothing)
    corner = (linear + math.sqrt(linear**2 + 4.0 * smoothing * square)) / (2.0 * smoothing)
    return max(reversal, corner)


def _meets(one: ScoredShaper, asked: Asked) -> bool:
    enough = asked.vibration is None or one.score.remaining_vibration <= asked.vibration * (1.0 + ROUNDING)
    return enough and one.score.smoothing <= asked.smoothing * (1.0 + ROUNDING)


def _aim(one: ScoredShaper, asked: Asked) -> tuple[float, float]:
    """Less is better."""
    left, fast = one.score.remaining_vibration, -one.score.maximum_acceleration
    return (left, fast) if asked.vibration is None else (fast, left)
