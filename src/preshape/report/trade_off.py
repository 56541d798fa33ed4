"""What smoothing buys on measured spectra: families, the optimum, the picks, and their gain over the stock choice."""

from __future__ import annotations

from dataclasses import dataclass

from preshape.export.klipper import KlipperScore
from preshape.shaper import Shaper

__all__ = ["TradeOff", "TradePoint", "gain_sentences"]

NOTHING = 0.005
"""A gain in acceleration below this fraction is called none, and so is one in vibration below this fraction of it."""

UNSEEN = 5e-5
"""Differences of remaining vibration below this [-] are called none."""


@dataclass(frozen=True)
class TradePoint:
    """A shaper in the trade-off.

    Parameters
    ----------
    name : str
        Of the family, or of the pick.
    shaper : Shaper
        The impulses.
    score : KlipperScore
        By Klipper's own formula on all spectra, the worst case.
    left : float
        Amplitude that remains [-] with all frequencies up to 5 % off, as in :class:`preshape.report.Candidate`.
    """

    name: str
    shaper: Shaper
    score: KlipperScore
    left: float


@dataclass(frozen=True)
class TradeOff:
    """The outcome of :func:`preshape.workflow.design_within`.

    Parameters
    ----------
    stock : TradePoint
        What Klipper itself would choose.
    families : tuple of TradePoint
        Every family tuned to the spectra, Klipper's own and ours.
    optimum : tuple of TradePoint
        The least vibration found within the controller's limits at rising smoothing.
    performance : TradePoint or None
        The highest acceleration with at most ``allowed`` vibration.
    quality : TradePoint or None
        The least vibration at no more smoothing than the stock choice, then the highest acceleration.
    improved : TradePoint or None
        The highest acceleration with neither more vibration nor more smoothing than the stock choice. None, like the
        other picks, when nothing within the limits meets this.
    allowed : float
        Vibration [-] that the performance pick may leave: what was asked for, or what the stock choice leaves if that
        is more.
    impulses : int
        Most impulses of the optimum.
    """

    stock: TradePoint
    families: tuple[TradePoint, ...]
    optimum: tuple[TradePoint, ...]
    performance: TradePoint | None
    quality: TradePoint | None
    improved: TradePoint | None
    allowed: float
    impulses: int

    @property
    def picks(self) -> tuple[TradePoint, ...]:
        """Those that exist."""
        return tuple(pick for pick in (self.performance, self.quality, self.improved) if pick is not None)

    @property
    def acceleration_gain(self) -> float:
        """How much higher max_accel is with neither more vibration nor more smoothing than stock, relatively; 0: no."""
        if self.improved is None:
            return 0.0
        return self.improved.score.maximum_acceleration / self.stock.score.maximum_acceleration - 1.0

    @property
    def vibration_gain(self) -> float:
        """How much less vibration remains at no more smoothing than stock [-]; 0: no less."""
        return 0.0 if self.quality is None else _vibration(self.stock) - _vibration(self.quality)


def gain_sentences(trade: TradeOff) -> tuple[str, ...]:
    """What the picks gain over the stock choice, also when it is nothing."""
    stock = trade.stock
    sentences = [
        f"Stock is {stock.name}: {_percent(_vibration(stock))} of the vibration by Klipper's measure, smoothing "
        f"{stock.score.smoothing:.3f} mm, max_accel {stock.score.maximum_acceleration:.0f} mm/s²."
    ]
    for pick, aim in (
        (trade.performance, f"performance (highest max_accel with at most {_percent(trade.allowed)})"),
        (trade.quality, "quality (least vibration at no more smoothing than stock)"),
        (trade.improved, "improved (highest max_accel with no more of either than stock)"),
    ):
        if pick is None:
            sentences.append(f"No {aim} within {trade.impulses} impulses.")
        else:
            what = f"{_percent(_vibration(pick))}, max_accel {pick.score.maximum_acceleration:.0f} mm/s²"
            sentences.append(f"{aim[0].upper()}{aim[1:]}: {len(pick.shaper)} impulses, {what}: {_gain(pick, trade)}.")
    if trade.picks:
        off = ", ".join(f"{pick.name} {100.0 * pick.left:.0f} %" for pick in trade.picks)
        sentences.append(
            f"With all frequencies up to 5 % off, the amplitude left is: {off}, stock {100.0 * stock.left:.0f} %."
        )
    return tuple(sentences)


def _gain(pick: TradePoint, trade: TradeOff) -> str:
    """Against the stock choice, in what the pick is for."""
    faster = pick.score.maximum_acceleration / trade.stock.score.maximum_acceleration - 1.0
    before, after = _vibration(trade.stock), _vibration(pick)
    if pick is trade.quality:
        fewer = before - after
        if fewer <= max(UNSEEN, NOTHING * before):
            return "no less than stock"
        return f"{100.0 * fewer:.2g} points less than stock"
    if abs(faster) < NOTHING:
        return "nothing gained over stock"
    return f"max_accel {100.0 * faster:+.1f} % over stock"


def _vibration(point: TradePoint) -> float:
    return point.score.remaining_vibration


def _percent(fraction: float) -> str:
    return "less than 0.01 %" if fraction < 1e-4 else f"{100.0 * fraction:.3g} %"
