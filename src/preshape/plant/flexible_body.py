"""FlexibleBody: a rigid body with modes, free to move under one force."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.checks import nonzero, positive
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant.exact import Motion, Output, exact_motion
from preshape.plant.modal_motion import retuned_modes

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = ["FlexibleBody"]


@dataclass(frozen=True)
class FlexibleBody:
    """Any modal plant with a rigid body: X'' = u / mass, and for every mode d'' + 2 z w d' + w^2 d = gain u.

    Parameters
    ----------
    mass : float
        What the force accelerates as a whole [kg].
    modes : Modes or what makes them
        Frequencies [Hz] and damping ratios [-].
    gains : float or sequence of float, one a mode
        How the force drives each mode [1/kg]: gain / w^2 is its deflection under a constant force of 1 N. Not 0: what
        is not driven cannot be stopped either, so leave it out.

    Raises
    ------
    InputError
        If a value is out of range, or there are not as many gains as modes.

    Examples
    --------
    >>> body = FlexibleBody(2.0, [(0.5, 0.01), (1.4, 0.02)], [1.0, -0.4])
    >>> body.static_deflections(1.0).round(5).tolist()
    [0.10132, -0.00517]
    """

    mass: float
    modes: Modes
    gains: tuple[float, ...]

    def __init__(self, mass: float, modes: ModesLike, gains: float | Sequence[float]) -> None:
        object.__setattr__(self, "mass", positive("mass", mass, "kg"))
        object.__setattr__(self, "modes", Modes(modes))
        given = [gains] if isinstance(gains, int | float) else list(gains)
        if len(given) != len(self.modes):
            raise InputError(f"{len(given)} gains for {len(self.modes)} modes: give one a mode [1/kg].")
        object.__setattr__(self, "gains", tuple(nonzero("gain", gain, "1/kg") for gain in given))

    def static_deflections(self, force: float) -> NDArray[np.float64]:
        """Each mode's deflection under a constant force [N]: [m], shape (mode,)."""
        return np.array([gain * force / mode.omega**2 for gain, mode in zip(self.gains, self.modes, strict=True)])

    def retuned(self, frequency_ratio: float = 1.0, damping_ratio: float | None = None) -> FlexibleBody:
        """The body as it may really be: frequencies scaled, and damping ratios replaced if one is given [-]."""
        return FlexibleBody(self.mass, retuned_modes(self.modes, frequency_ratio, damping_ratio), self.gains)

    def motion(self, force: Profile) -> Motion:
        """The exact motion under a force [N]; everything rests at 0 before it.

        Returns
        -------
        Motion
            With the outputs "centre" (the rigid body) and "deflection", or "deflection 1", "deflection 2" ... for
            several modes [m].

        Examples
        --------
        >>> from preshape.profile import Profile
        >>> motion = FlexibleBody(2.0, (1.0, 0.0), 1.0).motion(Profile.steps([0.0, 1.0, 2.0], [1.0, -2.0, 1.0]))
        >>> round(float(motion("centre", 2.0)), 12)
        0.5
        """
        count = len(self.modes)
        names = ["deflection"] if count == 1 else [f"deflection {k}" for k in range(1, count + 1)]
        rows = np.eye(count).tolist()
        outputs = {name: Output(tuple(row), unit="m") for name, row in zip(names, rows, strict=True)}
        outputs["centre"] = Output(rigid=1.0, unit="m")
        return exact_motion(self.modes, force, forces=self.gains, rigid=1.0 / self.mass, outputs=outputs)
