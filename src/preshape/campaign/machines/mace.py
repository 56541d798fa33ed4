"""The non-linear MACE: the payload's angle and weight are known, the bus's stiffness is not exactly so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.machines.machine import Factors, Instance, Values
from preshape.checks import not_negative
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant.mace import CALIBRATED, CALIBRATED_GAINS, Mace

__all__ = ["MaceMachine"]


class MaceMachine:
    """Both loops closed. The payload's commanded angle counts from where it starts."""

    def __init__(self) -> None:
        from importlib.util import find_spec

        if find_spec("exudyn") is None:
            raise InputError(
                "the non-linear MACE model needs Exudyn, which is not installed: pip install 'preshape[plants]'."
            )

    @property
    def parameters(self) -> Mapping[str, str]:
        return {"angle": "rad", "payload": "kg"}

    @property
    def scatters(self) -> Mapping[str, int]:
        return {"stiffness": 1}

    def known_modes(self, values: Values) -> Modes:
        return self._plant(values, {}).modes()

    def after(self, values: Values, name: str, command: NDArray[np.float64], dt: float) -> Values:
        turned = float(command[-1]) if name == "payload angle" else 0.0
        return {**values, "angle": values.get("angle", 0.0) + turned}

    def instance(self, values: Values, end: Values, factors: Factors) -> Instance:
        plant = self._plant(values, factors)
        return Instance(plant, plant.modes(end.get("angle", 0.0)), {"payload angle": plant.angle})

    def _plant(self, values: Values, factors: Factors) -> Mace:
        stiffness = float(factors["stiffness"][0]) if "stiffness" in factors else 1.0
        added = not_negative("payload", values.get("payload", 0.0), "kg")
        structure = replace(
            CALIBRATED,
            bending_stiffness=stiffness * CALIBRATED.bending_stiffness,
            stage_mass=CALIBRATED.stage_mass + added,
        )
        return Mace(CALIBRATED_GAINS, values.get("angle", 0.0), structure)
