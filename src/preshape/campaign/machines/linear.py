"""A linear plant, of a plant file or the linear MACE: modes that scatter, and a payload on a coordinate of matrices."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.machines.factors import scattered_modes
from preshape.campaign.machines.machine import Factors, Instance, Values
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant import FlexibleStructure, LinearPlant, SimulatedPlant

__all__ = ["LinearMachine"]


class LinearMachine:
    """A linear plant as it is known, and with other modes.

    Parameters
    ----------
    loaded : function
        Gives the plant with a payload [kg] on it.
    takes_payload : bool
        Whether that can be anything but 0.
    """

    def __init__(self, loaded: Callable[[float], SimulatedPlant], takes_payload: bool) -> None:
        self._loaded, self._takes_payload = loaded, takes_payload
        self._plain = loaded(0.0)
        if isinstance(self._plain, LinearPlant) and self._plain.sample_time is not None:
            raise InputError("the plant is a sampled system, whose modes cannot be moved: give a continuous model.")

    @property
    def parameters(self) -> Mapping[str, str]:
        return {"payload": "kg"} if self._takes_payload else {}

    @property
    def scatters(self) -> Mapping[str, int]:
        count = len(self._plain.modes())
        return {"frequency": count, "damping": count}

    def known_modes(self, values: Values) -> Modes:
        return self._plant(values).modes()

    def after(self, values: Values, name: str, command: NDArray[np.float64], dt: float) -> Values:
        return values

    def instance(self, values: Values, end: Values, factors: Factors) -> Instance:
        plant = self._plant(values)
        modes = plant.modes()
        if factors:
            wanted = scattered_modes(modes, factors)
            assert isinstance(plant, FlexibleStructure | LinearPlant)
            plant, modes = plant.with_modes(wanted), wanted
        return Instance(plant, modes)

    def _plant(self, values: Values) -> SimulatedPlant:
        payload = values.get("payload", 0.0)
        if payload and not self._takes_payload:
            raise InputError("this plant takes no payload: give matrices, and machine.payload_at.")
        return self._plain if not payload else self._loaded(float(np.float64(payload)))
