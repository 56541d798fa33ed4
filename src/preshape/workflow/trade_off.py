"""The trade-off of a measured machine: the optimum at rising smoothing, and the picks within a controller's limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from preshape.export import klipper
from preshape.export.klipper import Asked, Optimiser, Room, ScoredShaper
from preshape.mode import Mode, Modes
from preshape.report import Candidate, TradeOff, TradePoint
from preshape.shaper import Shaper
from preshape.workflow.remaining import Lines, remaining_amplitude

__all__ = ["found_trade_off"]

LEVELS = 6
"""Points of the optimum's curve."""

STILL = 1e-6
"""Remaining vibration [-] below which more smoothing has nothing left to buy."""

FROM, TO, WIDEST = 0.85, 1.1, 2.5
"""The curve runs from this part of the least smoothing of Klipper's families to this part of the largest, but at most
to so many times that of the stock choice."""


def found_trade_off(
    spectra: Sequence[klipper.Spectrum],
    candidates: Sequence[Candidate],
    advice: klipper.KlipperRecommendation,
    room: Room,
    *,
    modes: Modes | None,
    lines: Sequence[Lines],
    remaining: float,
) -> TradeOff:
    """The curve and the picks.

    Parameters
    ----------
    spectra : sequence of Spectrum
        All that were measured.
    candidates : sequence of Candidate
        Families that were tuned already.
    advice : KlipperRecommendation
        Klipper's own.
    room : Room
        What the controller holds; its tail is set here to that of the stock choice.
    modes : Modes or None
        Of the machine; unless known, the frequency of Klipper's choice stands for them.
    lines : sequence of Lines
        What vibrates, for the vibration left at 5 % frequency error.
    remaining : float
        Vibration [-] that the performance pick may leave.
    """
    chosen = advice.chosen
    known = modes if modes is not None else Modes(Mode(chosen.frequency, klipper.DEFAULT_DAMPING))

    def point(name: str, shaper: Shaper, score: klipper.KlipperScore) -> TradePoint:
        return TradePoint(name, shaper, score, remaining_amplitude(shaper, lines))

    def pick(name: str, found: ScoredShaper | None) -> TradePoint | None:
        return None if found is None else point(name, found.shaper, found.score)

    search = _Search(Optimiser(spectra, _tailed(room, chosen), known), advice)
    curve = search.curve()
    allowed = max(remaining, chosen.score.remaining_vibration)
    quality = search.stillest(curve)
    known_good = [*curve, *([] if quality is None else [quality])]
    improved = search.fastest(chosen.score.remaining_vibration, chosen.score.smoothing, known_good)
    known_good += [] if improved is None else [improved]
    performance = search.fastest(allowed, math.inf, known_good)
    families = [point(f"Klipper {fit.name} {fit.frequency:.1f} Hz", fit.shaper, fit.score) for fit in advice.fits]
    families += [
        TradePoint(one.name, one.shaper, one.score, one.left)
        for one in candidates
        if not one.name.startswith("Klipper ")
    ]
    stock = next(one for one, fit in zip(families, advice.fits, strict=False) if fit.name == chosen.name)
    return TradeOff(
        stock=stock,
        families=tuple(families),
        optimum=tuple(point("optimum", one.shaper, one.score) for one in curve),
        performance=pick("performance", performance),
        quality=pick("quality", quality),
        improved=pick("improved", improved),
        allowed=allowed,
        impulses=room.impulses,
    )


def _tailed(room: Room, stock: klipper.KlipperFit) -> Room:
    """The room with the stock choice's own tail: vibration is looked at no later than with stock."""
    return replace(room, tail=stock.shaper.duration - stock.shaper.centroid)


class _Search:
    """Starts and questions for the optimiser."""

    def __init__(self, optimiser: Optimiser, advice: klipper.KlipperRecommendation) -> None:
        self.optimiser, self.stock = optimiser, advice.chosen
        self.shapes = [fit.shaper for fit in advice.fits]
        self.smoothing = [fit.score.smoothing for fit in advice.fits]

    def curve(self) -> tuple[ScoredShaper, ...]:
        """The least vibration found at rising smoothing; more smoothing never leaves more."""
        low = FROM * min(self.smoothing)
        high = max(min(TO * max(self.smoothing), WIDEST * self.stock.score.smoothing), 2.0 * low)
        found: list[ScoredShaper] = []
        for level in np.geomspace(low, high, LEVELS).tolist():
            starts = self.scaled(level) + [one.shaper for one in found[-1:]]
            best = self.optimiser.best(
                Asked(None, level), starts, mesh=self.mesh(level), tail=self.tail(level), tried=1
            )
            if best is not None and (not found or best.score.smoothing > found[-1].score.smoothing):
                found.append(best)
            if found and found[-1].score.remaining_vibration < STILL:
                break
        return tuple(found)

    def scaled(self, level: float) -> list[Shaper]:
        """Klipper's families at a smoothing [mm]."""
        return [klipper.scaled_to_smoothing(shape, level) for shape in self.shapes]

    def mesh(self, level: float) -> tuple[float, float]:
        """Duration and centroid for the linear programme: the stock choice's at this smoothing."""
        stock = klipper.scaled_to_smoothing(self.stock.shaper, level)
        return stock.duration, stock.centroid

    def tail(self, level: float) -> float:
        """The stock choice's, or what it would be at a larger smoothing."""
        room = self.optimiser.room
        return room.tail * max(1.0, math.sqrt(level / self.stock.score.smoothing))

    def fastest(self, vibration: float, smoothing: float, curve: Sequence[ScoredShaper]) -> ScoredShaper | None:
        """The highest acceleration within both."""
        starts = [self.stock.shaper, *self.shapes, *self.scaled(self.stock.score.smoothing)]
        starts += [one.shaper for one in curve]
        mesh = self.mesh(smoothing) if smoothing < math.inf else None
        return self.optimiser.best(Asked(vibration, smoothing), starts, mesh=mesh)

    def stillest(self, curve: Sequence[ScoredShaper]) -> ScoredShaper | None:
        """The least vibration at the smoothing of the stock choice, then the highest acceleration with that."""
        level = self.stock.score.smoothing
        starts = [self.stock.shaper, *self.scaled(level), *(one.shaper for one in curve)]
        least = self.optimiser.best(Asked(None, level), starts, mesh=self.mesh(level), tried=2)
        if least is None:
            return None
        bound = Asked(least.score.remaining_vibration, level)
        return self.optimiser.best(bound, [least.shaper, self.stock.shaper], tried=1) or least
