"""Machine: what a campaign varies. What its designer knows of it are parameters; what scatters, he does not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes
from preshape.plant import SimulatedPlant

__all__ = ["Factors", "Instance", "Machine", "Values"]

Values: TypeAlias = Mapping[str, float]
"""Parameters by name [their units]: a pose, a payload."""

Factors: TypeAlias = Mapping[str, NDArray[np.float64]]
"""By what scatters: the true value over the one that the designer knows [-], one for each of its kind."""


@dataclass(frozen=True, eq=False)
class Instance:
    """One machine, as it really is.

    Attributes
    ----------
    plant : SimulatedPlant
        To be simulated.
    modes : Modes
        What vibrates in it where a move ends.
    start : mapping of str to float
        Where inputs stand before the move, those that do not stand at 0 [their units].
    """

    plant: SimulatedPlant
    modes: Modes
    start: Values = field(default_factory=dict)


class Machine(Protocol):
    """One kind of machine, with all that may differ between two of them. Adding one is a file and a line in the list.

    Attributes
    ----------
    parameters : mapping of str to str
        Units of what the designer knows, by name; what is not given stays where the machine has it.
    scatters : mapping of str to int
        What may differ from what he knows, by name, and how many independent factors that has.
    """

    @property
    def parameters(self) -> Mapping[str, str]: ...

    @property
    def scatters(self) -> Mapping[str, int]: ...

    def known_modes(self, values: Values) -> Modes:
        """What the designer believes to vibrate there."""

    def after(self, values: Values, name: str, command: NDArray[np.float64], dt: float) -> Values:
        """Where a move ends that starts at `values`, under `command` [unit of the input `name`] each `dt` [s]."""

    def instance(self, values: Values, end: Values, factors: Factors) -> Instance:
        """The real one, that starts at `values` and whose move ends at `end`."""
