"""A mass under PD control with a position input: the command drags it through a spring, and a damper on the error."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from preshape.checks import not_negative, positive
from preshape.errors import InputError
from preshape.mode import Mode, ModesLike, one_mode
from preshape.plant.exact import Motion, Output, exact_motion

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = ["PositionedMass"]


@dataclass(frozen=True, slots=True)
class PositionedMass:
    """A mass that follows a position command r through a spring and a damper, both on the error d = r - x.

    m x'' = k d + c d', so  d'' + 2 z w d' + w^2 d = r'':  the deflection is that of a mass on a moving carrier.

    Parameters
    ----------
    mode : Mode or (frequency, damping)
        Natural frequency [Hz] and damping ratio [-] of the controlled mass.

    Raises
    ------
    InputError
        If it is not one mode.

    References
    ----------
    Robertson, figure 4.

    Examples
    --------
    >>> PositionedMass.from_gains(mass=2.0, stiffness=8.0, damping=0.4).mode
    Mode(frequency=0.3183098861837907, damping=0.05)
    """

    mode: Mode

    def __init__(self, mode: ModesLike) -> None:
        object.__setattr__(self, "mode", one_mode(mode))

    @classmethod
    def from_gains(cls, mass: float, stiffness: float, damping: float = 0.0) -> PositionedMass:
        """From the mass [kg], the proportional gain or stiffness [N/m] and the derivative gain or damper [N s/m].

        InputError if the mass or the stiffness is not above zero, or the damper so strong that nothing vibrates.
        """
        m, k = positive("mass", mass, "kg"), positive("stiffness", stiffness, "N/m")
        critical = 2.0 * math.sqrt(k * m)
        c = not_negative("damping", damping, "N s/m")
        if c >= critical:
            raise InputError(
                f"damping is {c:g} N s/m: from {critical:g} N s/m on this mass does not vibrate, and needs no shaper."
            )
        return cls(Mode(math.sqrt(k / m) / (2.0 * math.pi), c / critical))

    def ramp_deflection(self, speed: float) -> float:
        """The peak deflection [m] after the command's velocity steps by `speed` [m/s].

        (v / w) exp(-phi z / sqrt(1 - z^2)) with phi = acos z: what SD-ZV shapers limit to a ratio of it.
        """
        z = self.mode.damping
        return abs(speed) / self.mode.omega * math.exp(-z * math.acos(z) / math.sqrt(1.0 - z**2))

    def retuned(self, frequency_ratio: float = 1.0, damping_ratio: float | None = None) -> PositionedMass:
        """The plant as it may really be.

        Parameters
        ----------
        frequency_ratio : float
            Its natural frequency relative to this one's [-].
        damping_ratio : float, optional
            Its damping ratio [-]; this one's unless given.
        """
        ratio = positive("frequency_ratio", frequency_ratio, "times the frequency")
        z = self.mode.damping if damping_ratio is None else damping_ratio
        return PositionedMass(Mode(ratio * self.mode.frequency, z))

    def motion(self, position: Profile) -> Motion:
        """The exact motion under a position command.

        Parameters
        ----------
        position : Profile
            The command r [m]; the mass rests at 0 before it. Where it jumps, so does the deflection.

        Returns
        -------
        Motion
            With the outputs "deflection" (r - x) and "position" (x) [m].

        Examples
        --------
        >>> from preshape.profile import Profile
        >>> plant = PositionedMass((1.0, 0.1))
        >>> peak = plant.motion(Profile.steps([0.0], [2.0 / 1.5], order=1)).peak("deflection")
        >>> round(peak.value, 5), round(plant.ramp_deflection(2.0 / 1.5), 5)
        (0.18305, 0.18305)
        """
        return exact_motion(
            self.mode,
            position,
            driven_by=2,
            outputs={
                "deflection": Output((1.0,), unit="m"),
                "position": Output((-1.0,), command=1.0, unit="m"),
            },
        )
