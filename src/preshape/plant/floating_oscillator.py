"""Two masses and a spring, free to move, a force on the first: a flexible spacecraft in its simplest form."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from preshape.checks import not_negative, positive
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant.exact import Motion, Output, exact_motion
from preshape.plant.flexible_body import FlexibleBody

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = ["FloatingOscillator"]


@dataclass(frozen=True, slots=True)
class FloatingOscillator:
    """Masses m1 and m2 joined by a spring and a damper, the force u on m1.

    The mass centre obeys X'' = u / (m1 + m2), the deflection d = x1 - x2 obeys d'' + 2 z w d' + w^2 d = u / m1 with
    w^2 = k (1/m1 + 1/m2).

    Parameters
    ----------
    first_mass, second_mass : float
        m1, which the force acts on, and m2 [kg].
    stiffness : float
        k [N/m].
    damping : float
        Coefficient c of the damper beside the spring [N s/m], 0 or more, below what would stop the vibration.

    Raises
    ------
    InputError
        If a mass or the stiffness is not above zero, or the damper so strong that nothing vibrates.

    References
    ----------
    Robertson, figure 3 (m1 = m2 = k = 1).

    Examples
    --------
    >>> plant = FloatingOscillator(1.0, 1.0, 1.0)
    >>> round(plant.mode.omega**2, 12), plant.static_deflection(1.0)
    (2.0, 0.5)
    """

    first_mass: float
    second_mass: float
    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("first_mass", "kg"), ("second_mass", "kg"), ("stiffness", "N/m")):
            object.__setattr__(self, name, positive(name, getattr(self, name), unit))
        object.__setattr__(self, "damping", not_negative("damping", self.damping, "N s/m"))
        if self.damping >= self.critical_damping:
            raise InputError(
                f"damping is {self.damping:g} N s/m: from {self.critical_damping:g} N s/m on this oscillator does not "
                "vibrate; give less."
            )

    @classmethod
    def from_mode(cls, first_mass: float, second_mass: float, mode: Mode) -> FloatingOscillator:
        """The oscillator with these masses [kg] whose deflection vibrates as `mode`."""
        reduced = 1.0 / (
            1.0 / positive("first_mass", first_mass, "kg") + 1.0 / positive("second_mass", second_mass, "kg")
        )
        return cls(first_mass, second_mass, reduced * mode.omega**2, 2.0 * mode.damping * mode.omega * reduced)

    @property
    def critical_damping(self) -> float:
        """The damper from which on nothing vibrates [N s/m]."""
        return 2.0 * math.sqrt(self.stiffness / self._inverse_mass)

    @property
    def total_mass(self) -> float:
        """m1 + m2 [kg]."""
        return self.first_mass + self.second_mass

    @property
    def mode(self) -> Mode:
        """The vibration of the deflection."""
        w = math.sqrt(self.stiffness * self._inverse_mass)
        return Mode(w / (2.0 * math.pi), self.damping / self.critical_damping)

    @property
    def flexible_body(self) -> FlexibleBody:
        """The same as a rigid body with one mode, the deflection x1 - x2."""
        return FlexibleBody(self.total_mass, self.mode, 1.0 / self.first_mass)

    def static_deflection(self, force: float) -> float:
        """The deflection [m] that a steady `force` [N] holds while it accelerates the whole: u / (m1 w^2)."""
        return force * self.second_mass / (self.total_mass * self.stiffness)

    def retuned(self, frequency_ratio: float = 1.0, damping_ratio: float | None = None) -> FloatingOscillator:
        """The oscillator as it may really be: other stiffness and damper, the same masses.

        Parameters
        ----------
        frequency_ratio : float
            Its natural frequency relative to this one's [-].
        damping_ratio : float, optional
            Its damping ratio [-]; this one's unless given.
        """
        mode = self.mode
        ratio = positive("frequency_ratio", frequency_ratio, "times the frequency")
        z = mode.damping if damping_ratio is None else damping_ratio
        return FloatingOscillator.from_mode(self.first_mass, self.second_mass, Mode(ratio * mode.frequency, z))

    def motion(self, force: Profile) -> Motion:
        """The exact motion under a force [N].

        Parameters
        ----------
        force : Profile
            The force on the first mass [N]; both masses rest at 0 before it.

        Returns
        -------
        Motion
            With the outputs "deflection" (x1 - x2), "first_position", "second_position" and "centre" [m].

        Examples
        --------
        >>> from preshape.profile import Profile
        >>> motion = FloatingOscillator(1.0, 1.0, 1.0).motion(Profile.steps([0.0], [1.0]))
        >>> round(motion.peak("deflection").value, 12)
        1.0
        """
        m1, m2, total = self.first_mass, self.second_mass, self.total_mass
        return exact_motion(
            self.mode,
            force,
            forces=[1.0 / m1],
            rigid=1.0 / total,
            outputs={
                "deflection": Output((1.0,), unit="m"),
                "first_position": Output((m2 / total,), rigid=1.0, unit="m"),
                "second_position": Output((-m1 / total,), rigid=1.0, unit="m"),
                "centre": Output(rigid=1.0, unit="m"),
            },
        )

    @property
    def _inverse_mass(self) -> float:
        """1/m1 + 1/m2 [1/kg]."""
        return 1.0 / self.first_mass + 1.0 / self.second_mass
