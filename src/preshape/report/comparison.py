"""What a comparison of commands has to show: the move, its limits, the contenders, and what could not be made."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.mode import Modes
from preshape.profile import Profile

__all__ = ["Comparison", "Contender", "Kind", "LeftOut"]

Kind = Literal["unshaped", "smooth", "filtered", "shaped", "rest-to-rest"]
"""How a command fights vibration: not at all, by a soft form, by a filter, by a shaper, or by where it switches."""


@dataclass(frozen=True, eq=False)
class Contender:
    """One command and what it does to the plant; lengths in the unit of the comparison.

    Parameters
    ----------
    name : str
        Such as "trapezoid + ZV".
    kind : str
        "unshaped", "smooth", "filtered", "shaped" or "rest-to-rest".
    acceleration : Profile
        Of the carriage [unit/s^2]. Exact where the command is a piecewise polynomial (see `exact`).
    exact : bool
        False for commands of sines or behind filters: their acceleration is interpolated by pieces of degree five to a
        part in 1e10 of its peak.
    move_time : float
        When the command ends [s]; of a filtered one, when what is left of the way is negligible.
    settling_time : float
        When the command has ended and the deflection stays within the window for good [s]; infinite if it never does.
    residual : float
        Amplitude of the vibration at `move_time` [unit].
    worst_residual : float
        The same, the worst over frequencies that are off by up to the frequency error [unit].
    peak_deflection : float
        Largest magnitude of the deflection at any time [unit], exact between samples.
    peak_acceleration : float
        Of the carriage [unit/s^2], exact likewise.
    residual_curve : ndarray, shape (ratio,)
        Amplitude at the end over ``Comparison.frequency_ratios`` [unit].
    note : str
        What must be known about it; may be empty.
    """

    name: str
    kind: Kind
    acceleration: Profile
    exact: bool
    move_time: float
    settling_time: float
    residual: float
    worst_residual: float
    peak_deflection: float
    peak_acceleration: float
    residual_curve: NDArray[np.float64]
    note: str = ""


@dataclass(frozen=True)
class LeftOut:
    """A command that cannot make this move.

    Parameters
    ----------
    name : str
        As a contender would be called.
    reason : str
        Why, in one sentence.
    """

    name: str
    reason: str


@dataclass(frozen=True, eq=False)
class Comparison:
    """The outcome of :func:`preshape.workflow.compare`.

    Parameters
    ----------
    modes : Modes
        What vibrates on the carriage.
    gains : tuple of float
        Share of each mode in the deflection [-].
    distance, maximum_acceleration : float
        The move [unit], its limit [unit/s^2].
    maximum_speed, maximum_jerk : float or None
        Further limits [unit/s, unit/s^3]; None is none.
    within : float
        Settled means that the deflection stays within this [unit].
    reference : float
        What a step to the maximum acceleration leaves, or to the maximum speed or over the way if that is less [unit].
    frequency_error : float
        By how much the frequencies may be off [-].
    frequency_ratios : ndarray, shape (ratio,)
        Actual over modelled frequency, all modes together, to twice the frequency error either way [-].
    contenders : tuple of Contender
        The first to settle first; those that never settle by what they leave.
    left_out : tuple of LeftOut
        What could not be made, with the reason.
    unit : str
        Unit of length.
    """

    modes: Modes
    gains: tuple[float, ...]
    distance: float
    maximum_acceleration: float
    maximum_speed: float | None
    maximum_jerk: float | None
    within: float
    reference: float
    frequency_error: float
    frequency_ratios: NDArray[np.float64]
    contenders: tuple[Contender, ...]
    left_out: tuple[LeftOut, ...]
    unit: str = "m"

    def __getitem__(self, name: str) -> Contender:
        """The contender of a name; KeyError with the names there are."""
        for contender in self.contenders:
            if contender.name == name:
                return contender
        raise KeyError(f"no contender {name!r}: there are {', '.join(c.name for c in self.contenders)}")

    @property
    def first_to_settle(self) -> Contender:
        """The contender that has settled first, if the modes are as modelled; InputError when there is none."""
        if not self.contenders:
            raise InputError("no command can make this move, so none settles first: see left_out for the reasons.")
        return self.contenders[0]

    def robust(self, contender: Contender) -> bool:
        """Whether it leaves no more than the window at its end, wherever the frequencies are within their error."""
        return contender.worst_residual <= self.within

    @property
    def first_robust(self) -> Contender | None:
        """The contender that ends first of those that are :meth:`robust`; None when there is none."""
        return min(filter(self.robust, self.contenders), key=lambda c: c.move_time, default=None)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain numbers and names, for JSON; a settling time that is infinite is None."""
        return {
            "schema": "preshape.comparison/1",
            "unit": self.unit,
            "modes": [{"frequency": mode.frequency, "damping": mode.damping} for mode in self.modes],
            "gains": list(self.gains),
            "distance": self.distance,
            "maximum_speed": self.maximum_speed,
            "maximum_acceleration": self.maximum_acceleration,
            "maximum_jerk": self.maximum_jerk,
            "within": self.within,
            "reference": self.reference,
            "frequency_error": self.frequency_error,
            "frequency_ratios": self.frequency_ratios.tolist(),
            "contenders": [
                {
                    "name": c.name,
                    "kind": c.kind,
                    "exact": c.exact,
                    "move_time": c.move_time,
                    "settling_time": c.settling_time if math.isfinite(c.settling_time) else None,
                    "residual": c.residual,
                    "worst_residual": c.worst_residual,
                    "peak_deflection": c.peak_deflection,
                    "peak_acceleration": c.peak_acceleration,
                    "residual_curve": c.residual_curve.tolist(),
                    "note": c.note,
                }
                for c in self.contenders
            ],
            "left_out": [{"name": one.name, "reason": one.reason} for one in self.left_out],
        }
