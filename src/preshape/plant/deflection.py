"""Transient deflection: how far a plant bends during the move, and when it is not as modelled.

Residual vibration belongs to the shaper and a mode alone, and is measured in `preshape.vibration`; deflection during
the move needs the plant and the command as well, so it lives here, one floor up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.kernel import Extremum
from preshape.plant.checks import finite_row
from preshape.plant.exact import Motion, Output

if TYPE_CHECKING:
    from preshape.profile import Profile
    from preshape.shaper import Shaper

__all__ = ["DeflectionSensitivity", "Plant", "deflection_sensitivity", "transient_deflection"]


class Plant(Protocol):
    """What every plant with exact motion offers."""

    def motion(self, command: Profile, /) -> Motion:
        """The motion under a command."""

    def retuned(self, frequency_ratio: float = 1.0, damping_ratio: float | None = None) -> Plant:
        """The plant with its frequencies scaled, and its damping ratios replaced."""


@dataclass(frozen=True, eq=False)
class DeflectionSensitivity:
    """Peak deflection over errors of the model.

    Parameters
    ----------
    frequency_ratios : ndarray, shape (frequency,)
        Actual natural frequency relative to the modelled one [-].
    damping_ratios : ndarray, shape (damping,)
        Actual damping ratios [-]; NaN stands for that of the model.
    peak : ndarray, shape (damping, frequency)
        Largest \\|output\\| over all time [unit of the output].
    limit : float
        What the command was meant to keep [unit of the output].
    """

    frequency_ratios: NDArray[np.float64]
    damping_ratios: NDArray[np.float64]
    peak: NDArray[np.float64]
    limit: float

    @property
    def relative(self) -> NDArray[np.float64]:
        """Peak relative to the limit [-], shape (damping, frequency): 1.1 exceeds it by 10 %."""
        return self.peak / self.limit


def transient_deflection(
    plant: Plant, command: Profile, shaper: Shaper | None = None, *, output: str | Output = "deflection"
) -> Extremum:
    """The largest deflection during and after a move, exact.

    Parameters
    ----------
    plant : FloatingOscillator, PositionedMass, ModalPlant or alike
        What bends.
    command : Profile
        What drives it: force or position, as the plant asks.
    shaper : Shaper, optional
        Shapes the command first.
    output : str or Output
        What is looked at.

    Returns
    -------
    Extremum
        Its `value` [unit of the output], `time` [s] and `bound`.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> from preshape.profile import Profile
    >>> bang_bang = Profile.steps([0.0, 10.0**0.5, 2 * 10.0**0.5], [1.0, -2.0, 1.0])
    >>> round(transient_deflection(FloatingOscillator(1.0, 1.0, 1.0), bang_bang).value, 4)
    1.7198
    """
    return plant.motion(command if shaper is None else command.shaped(shaper)).peak(output)


def deflection_sensitivity(
    plant: Plant,
    command: Profile,
    shaper: Shaper | None = None,
    *,
    frequency_ratios: ArrayLike = 1.0,
    damping_ratios: ArrayLike | None = None,
    limit: float | None = None,
    output: str | Output = "deflection",
) -> DeflectionSensitivity:
    """The peak deflection when the plant's frequency and damping are not those the command was made for.

    Parameters
    ----------
    plant : FloatingOscillator, PositionedMass, ModalPlant or alike
        The plant as modelled.
    command : Profile
        The command, as made for it.
    shaper : Shaper, optional
        Shapes the command first.
    frequency_ratios : array_like, shape (frequency,)
        Actual natural frequency over the modelled one [-], above zero: 0.9 is a model that is 10 % too stiff or so.
    damping_ratios : array_like, shape (damping,), optional
        Actual damping ratios [-]; the model's unless given.
    limit : float, optional
        What the command was meant to keep [unit of the output]; the peak of the plant as modelled unless given.
    output : str or Output
        What is looked at.

    Returns
    -------
    DeflectionSensitivity

    Raises
    ------
    InputError
        If a ratio is out of range, or the limit is not above zero.

    References
    ----------
    Robertson, figures 12, 17 and 18.

    Examples
    --------
    >>> from preshape.plant import PositionedMass
    >>> from preshape.profile import Profile
    >>> ramp = Profile.steps([0.0], [1.0], order=1)
    >>> curve = deflection_sensitivity(PositionedMass((1.0, 0.1)), ramp, frequency_ratios=[0.8, 1.0, 1.25])
    >>> curve.relative.round(6).tolist()
    [[1.25, 1.0, 0.8]]
    """
    ratios = finite_row("frequency_ratios", frequency_ratios)
    dampings = np.array([np.nan]) if damping_ratios is None else finite_row("damping_ratios", damping_ratios)
    if ratios.size == 0 or dampings.size == 0:
        raise InputError("a list of ratios is empty: give at least one frequency ratio and one damping ratio.")
    shaped = command if shaper is None else command.shaped(shaper)
    known = plant.motion(shaped).peak(output).value if limit is None else positive("limit", limit, "units")
    if known == 0.0:
        raise InputError("the plant as modelled does not deflect at all under this command: give a limit above zero.")
    peak = [
        [
            plant.retuned(float(ratio), None if np.isnan(damping) else float(damping)).motion(shaped).peak(output).value
            for ratio in ratios
        ]
        for damping in dampings
    ]
    return DeflectionSensitivity(ratios, dampings, np.array(peak), known)
