"""What smoothing buys on measured spectra: families, the optimum, the picks, and their gain over the stock choice."""

from __future__ import annotations

from dataclasses import dataclass

from preshape.export.klipper import KlipperScore
from preshape.shaper import Shaper

__all__ = ["FREQUENCY_ERROR", "TradeOff", "TradePoint", "gain_sentences", "robustness_sentence"]

FREQUENCY_ERROR = 0.05
"""Relative error of the frequencies that a shaper must bear: modes move by some percent with position, load and
temperature, so a shaper that is right for the measurement alone is not one to trust."""

NOTHING = 0.005
"""A gain in acceleration below this fraction is called none, and so is one in vibration below this fraction of it."""

CLEARLY = 0.1
"""Amplitudes left that differ by less than this fraction are called alike."""

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
    def fragile(self) -> tuple[TradePoint, ...]:
        """Picks that leave clearly more than stock when the frequencies are off."""
        return tuple(pick for pick in self.picks if pick.left > (1.0 + CLEARLY) * self.stock.left)

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
    """What each pick is, and what it gains over the stock choice, also when that is nothing."""
    stock = trade.stock
    sentences = [
        f"Stock is {stock.name}: {_percent(_vibration(stock))} of the vibration by Klipper's measure, smoothing "
        f"{stock.score.smoothing:.3f} mm, max_accel {stock.score.maximum_acceleration:.0f} mm/s²."
    ]
    for pick, name, aim in (
        (
            trade.performance,
            "performance",
            f"the highest max_accel that leaves at most {_percent(trade.allowed)} of the vibration",
        ),
        (trade.quality, "quality", "the least vibration at no more smoothing than stock"),
        (trade.improved, "improved", "the highest max_accel with no more vibration and no more smoothing than stock"),
    ):
        if pick is None:
            sentences.append(f"No {name} pick ({aim}) within {trade.impulses} impulses.")
        else:
            sentences.append(f"{name.capitalize()}, {aim}: {_gain(pick, trade)}.")
    return tuple(sentences)


def robustness_sentence(trade: TradeOff) -> str:
    """What the picks leave when the machine is not quite as measured, which Klipper's measure does not ask; empty
    without picks."""
    if not trade.picks:
        return ""
    off = f"With all frequencies up to {100.0 * FREQUENCY_ERROR:.0f} % off"
    if not trade.fragile:
        return f"{off}, no pick leaves more of the amplitude than stock, {_whole(trade.stock)}."
    left = ", ".join(f"{pick.name} {_whole(pick)}" for pick in trade.fragile)
    return (
        f"{off}, more of the amplitude is left than the {_whole(trade.stock)} of stock: {left}. Klipper's measure does "
        "not see this; take such a pick only where the frequencies stay as they were measured."
    )


def _gain(pick: TradePoint, trade: TradeOff) -> str:
    """Against the stock choice: max_accel, and for the quality pick the vibration first."""
    faster = pick.score.maximum_acceleration / trade.stock.score.maximum_acceleration - 1.0
    speed = f"max_accel {100.0 * faster:+.1f} % over stock" if abs(faster) >= NOTHING else ""
    if pick is not trade.quality:
        return speed or "nothing gained over stock"
    before = _vibration(trade.stock)
    fewer = before - _vibration(pick)
    if before <= UNSEEN:
        still = "stock leaves none to take away"
    elif fewer <= max(UNSEEN, NOTHING * before):
        still = "nothing gained over stock"
    else:
        still = f"{100.0 * fewer:.2g} % of the vibration less than stock"
    return "; ".join(part for part in (still, speed) if part)


def _whole(point: TradePoint) -> str:
    return f"{100.0 * point.left:.0f} %"


def _vibration(point: TradePoint) -> float:
    return point.score.remaining_vibration


def _percent(fraction: float) -> str:
    return "less than 0.01 %" if fraction < 1e-4 else f"{100.0 * fraction:.3g} %"
