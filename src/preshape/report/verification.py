"""What a machine did with a shaper and without: the result of a verification."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.identify import IdentifiedMode

__all__ = ["AS_PREDICTED", "DOUBTFUL", "LESS", "MORE", "NOISE", "Estimate", "ModeVerdict", "Ringing", "Verification"]

AS_PREDICTED = "as predicted"
"""The intervals of the measured and of the predicted ratio overlap."""
LESS = "less than predicted"
"""The shaper takes away less than predicted: the measured ratio lies above the predicted one."""
MORE = "more than predicted"
"""It takes away more: the measured ratio lies below."""
NOISE = "not distinguishable from noise"
"""The mode rings too little in a recording for a ratio."""
DOUBTFUL = "stop in doubt"
"""When the move ended is not clear enough for a ratio."""


@dataclass(frozen=True)
class Estimate:
    """A measured number and the ends of its 95 % interval.

    Parameters
    ----------
    value, low, high : float
        In the unit of what is measured; `high` is infinite where a divisor cannot be told from noise.
    """

    value: float
    low: float
    high: float

    def to_dict(self) -> dict[str, float | None]:
        """The three numbers; null where one is not finite."""
        numbers = {"value": self.value, "low": self.low, "high": self.high}
        return {name: number if math.isfinite(number) else None for name, number in numbers.items()}


@dataclass(frozen=True)
class ModeVerdict:
    """One mode, without and with the shaper.

    Parameters
    ----------
    mode : IdentifiedMode
        With its intervals.
    before, after : Estimate
        Amplitude at the stop of the move, over all axes, in the unit of the recordings.
    ratio : Estimate
        After over before [-]: what residual vibration is.
    predicted : tuple of float or None
        Lowest, middle and highest residual vibration [-] of the shaper within the intervals of frequency and damping.
    verdict : str
        With a shaper "as predicted", "less than predicted" (it takes less away) or "more than predicted"; without one
        "reduced", "increased" or "no sure change"; "not distinguishable from noise"; "stop in doubt" where the shaped
        recordings are not what the shaper makes of the unshaped ones, and the stop was not given.
    new : bool
        True when the shaped recordings show it, and more of it than the unshaped ones.
    """

    mode: IdentifiedMode
    before: Estimate
    after: Estimate
    ratio: Estimate
    predicted: tuple[float, float, float] | None
    verdict: str
    new: bool = False


@dataclass(frozen=True, eq=False)
class Ringing:
    """A recording after the stop, for the figure.

    Parameters
    ----------
    name : str
        Of the file.
    stop, stop_spread : float
        When the move stopped in the recording, and the standard deviation of that [s]; 0 when it was given.
    times : ndarray, shape (sample,)
        Since the stop [s].
    values, fitted : ndarray, shape (axis, sample)
        Measured and fitted, without the constant part.
    frequencies, amplitude : ndarray, shape (frequency,)
        Spectrum of the measured values, over all axes: frequencies [Hz] and amplitude density [unit s].
    """

    name: str
    stop: float
    stop_spread: float
    times: NDArray[np.float64]
    values: NDArray[np.float64]
    fitted: NDArray[np.float64]
    frequencies: NDArray[np.float64]
    amplitude: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Verification:
    """Recordings of one move without and with a shaper, compared.

    Parameters
    ----------
    modes : tuple of ModeVerdict
        Of the unshaped recordings, the strongest first; then what only the shaped ones show.
    axes : tuple of str
        Names of the axes; the last row of the residuals, "total", is over all of them.
    before, after, ratio : tuple of Estimate
        Root mean square after the stop for each axis and in total, in `unit`, and its ratio [-].
    wait, window, below : float
        Time after the stop from which on, time over which [s], and frequency up to which [Hz] the root mean square is
        taken.
    floor : float or None
        Root mean square of the noise before the move, over all axes; None where it is not recorded.
    unit : str
        Of the recordings.
    unshaped, shaped : tuple of Ringing
        The recordings after the stop.
    trouble : tuple of str
        What is wrong with the recordings, or their comparison, as sentences.
    """

    modes: tuple[ModeVerdict, ...]
    axes: tuple[str, ...]
    before: tuple[Estimate, ...]
    after: tuple[Estimate, ...]
    ratio: tuple[Estimate, ...]
    wait: float
    window: float
    below: float
    floor: float | None
    unit: str
    unshaped: tuple[Ringing, ...]
    shaped: tuple[Ringing, ...]
    trouble: tuple[str, ...]

    @property
    def new_modes(self) -> tuple[ModeVerdict, ...]:
        """Modes that ring with the shaper, and not, or less, without it."""
        return tuple(one for one in self.modes if one.new)

    @property
    def sentence(self) -> str:
        """The verdict in a sentence."""
        total = self.ratio[-1]
        doubtful = any(one.verdict == DOUBTFUL for one in self.modes)
        text = "Not to be trusted before the stop is given. " if doubtful else ""
        text += (
            f"With the shaper {percent(total)} of the vibration after the stop is left "
            f"(root mean square over {self.stretch}, all axes)"
        )
        known = [one for one in self.modes if not one.new]
        for verdict in dict.fromkeys(one.verdict for one in known):
            named = ", ".join(f"{one.mode.mode.frequency:.3g} Hz" for one in known if one.verdict == verdict)
            text += f"; {verdict}: {named}"
        if self.new_modes:
            named = ", ".join(f"{one.mode.mode.frequency:.3g} Hz" for one in self.new_modes)
            text += f"; new with the shaper: {named}"
        return text + "."

    @property
    def stretch(self) -> str:
        """The window in words."""
        return f"{1e3 * self.window:.3g} ms" + (f" from {1e3 * self.wait:.2g} ms on" if self.wait > 0.0 else "")

    def to_dict(self) -> dict[str, Any]:
        """All numbers, for JSON; the samples themselves are left out."""
        rows = zip((*self.axes, "total"), self.before, self.after, self.ratio, strict=True)
        return {
            "sentence": self.sentence,
            "unit": self.unit,
            "wait": self.wait,
            "window": self.window,
            "below": self.below,
            "floor": self.floor,
            "residual": [
                {"axis": axis, "before": b.to_dict(), "after": a.to_dict(), "ratio": r.to_dict()}
                for axis, b, a, r in rows
            ],
            "modes": [
                {
                    "frequency": one.mode.mode.frequency,
                    "frequency_interval": list(one.mode.frequency_interval),
                    "damping": one.mode.mode.damping,
                    "damping_interval": list(one.mode.damping_interval),
                    "before": one.before.to_dict(),
                    "after": one.after.to_dict(),
                    "ratio": one.ratio.to_dict(),
                    "predicted": None
                    if one.predicted is None
                    else dict(zip(("low", "value", "high"), one.predicted, strict=True)),
                    "verdict": one.verdict,
                    "new": one.new,
                }
                for one in self.modes
            ],
            "stops": [
                {"file": one.name, "stop": one.stop, "standard_deviation": one.stop_spread}
                for one in (*self.unshaped, *self.shaped)
            ],
            "trouble": list(self.trouble),
        }


def percent(ratio: Estimate) -> str:
    """A ratio with its interval in words of percent."""
    if not math.isfinite(ratio.value):
        return "an unknown part"
    high = f"{100.0 * ratio.high:.3g}" if math.isfinite(ratio.high) else "unknown"
    return f"{100.0 * ratio.value:.3g} % ({100.0 * ratio.low:.3g} to {high})"
