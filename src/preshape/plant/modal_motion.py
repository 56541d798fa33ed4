"""A modal plant under a Profile: exact at any time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape.checks import positive
from preshape.mode import Modes
from preshape.plant.exact import Motion, Output, exact_motion

if TYPE_CHECKING:
    from preshape.plant.modal import ModalPlant
    from preshape.profile import Profile

__all__ = ["modal_motion", "retuned_modes"]


def modal_motion(plant: ModalPlant, command: Profile) -> Motion:
    """What :meth:`ModalPlant.motion` returns.

    Parameters
    ----------
    plant : ModalPlant
        Driven by position or acceleration.
    command : Profile
        Of position or acceleration, as the plant is driven.

    Examples
    --------
    >>> from preshape.plant import ModalPlant
    >>> from preshape.profile import Profile
    >>> motion = ModalPlant((1.0, 0.0)).motion(Profile.steps([0.0], [1.0]))
    >>> round(motion.peak("output").value, 12)
    2.0
    """
    positioned = plant.drive == "position"
    forces = [mode.omega**2 if positioned else -1.0 for mode in plant.modes]
    rows = [tuple(row) for row in np.atleast_2d(plant.gains).tolist()]
    names = ["output"] if plant.gains.ndim == 1 else [f"output {k}" for k in range(1, len(rows) + 1)]
    outputs = {name: Output(row) for name, row in zip(names, rows, strict=True)}
    return exact_motion(plant.modes, command, forces=forces, outputs=outputs)


def retuned_modes(modes: Modes, frequency_ratio: float, damping_ratio: float | None) -> Modes:
    """`modes` with every frequency scaled by a ratio, and all damping ratios replaced if one is given."""
    ratio = positive("frequency_ratio", frequency_ratio, "times the frequency")
    return Modes([(ratio * m.frequency, m.damping if damping_ratio is None else damping_ratio) for m in modes])
