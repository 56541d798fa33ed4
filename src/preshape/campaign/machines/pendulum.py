"""A payload on a rope: a pendulum below a trolley whose position is commanded."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.machines.factors import scattered_modes
from preshape.campaign.machines.machine import Factors, Instance, Values
from preshape.campaign.machines.mode_table import followers
from preshape.checks import not_negative, positive
from preshape.mode import Modes

__all__ = ["Pendulum"]

GRAVITY = 9.80665
"""[m/s^2]"""


class Pendulum:
    """sqrt(g / length) / 2 pi [Hz]: a crane.

    Parameters
    ----------
    damping : float
        Its damping ratio [-].
    length : float
        Of the rope, where no other is asked for [m].
    """

    def __init__(self, damping: float = 0.0, length: float = 1.0) -> None:
        self._damping, self._length = not_negative("damping", damping, "as a ratio"), positive("length", length, "m")

    @property
    def parameters(self) -> Mapping[str, str]:
        return {"length": "m"}

    @property
    def scatters(self) -> Mapping[str, int]:
        return {"frequency": 1, "damping": 1}

    def known_modes(self, values: Values) -> Modes:
        length = positive("length", values.get("length", self._length), "m")
        return Modes([(math.sqrt(GRAVITY / length) / (2.0 * math.pi), self._damping)])

    def after(self, values: Values, name: str, command: NDArray[np.float64], dt: float) -> Values:
        return values

    def instance(self, values: Values, end: Values, factors: Factors) -> Instance:
        modes = scattered_modes(self.known_modes(values), factors)
        return Instance(followers(modes), modes)
