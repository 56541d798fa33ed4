"""SimulatedPlant: what a machine must offer to be identified, shaped, compared and drawn. Put your own in this place.

Two methods and two tables of units are all:

- ``inputs``, ``outputs``: names with units, in the order of the command's rows.
- ``modes(configuration)``: what vibrates when the machine stands as `configuration` says; what a configuration is, the
  plant decides (a pose, a state, nothing), and None is where the machine starts.
- ``simulate(command, dt)``: from rest, under a sampled command, to a :class:`preshape.plant.Simulation`.

A class with these is a plant, no base class needed. Ready to take a machine of yours:

- :func:`preshape.plant.from_matrices`: mass, damping and stiffness matrices;
- :class:`preshape.plant.LinearPlant`: A, B, C, D, or a python-control system;
- :class:`preshape.plant.FunctionPlant`: x' = f(t, x, u) in Python;
- :class:`preshape.plant.SimulatorPlant`: any simulator behind a function;
- :class:`preshape.plant.SampledPlant`: any plant with exact motion;
- :func:`preshape.plant.load_plant`: a file with matrices or modes.

A ``simulate`` that takes long may take ``progress`` as well, a function that it calls with the part done, 0 to 1. One
that runs away raises :class:`preshape.plant.Diverged` with what it has.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import signature
from typing import Any, Protocol, TypeAlias, runtime_checkable

from numpy.typing import ArrayLike

from preshape.mode import Modes
from preshape.plant.simulation import Simulation

__all__ = ["Progress", "SimulatedPlant", "simulated"]

Progress: TypeAlias = Callable[[float], object]
"""Is told the part done, 0 to 1."""


@runtime_checkable
class SimulatedPlant(Protocol):
    """A machine, as everything that simulates one sees it.

    Examples
    --------
    >>> from preshape.plant import linear_mace
    >>> isinstance(linear_mace(), SimulatedPlant)
    True
    """

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of each input, by name."""

    @property
    def outputs(self) -> Mapping[str, str]:
        """Unit of each output, by name."""

    def modes(self, configuration: Any = None) -> Modes:
        """What vibrates in a configuration; InputError when that is not known, or nothing does."""

    def simulate(self, command: ArrayLike, dt: float) -> Simulation:
        """The outputs under a command of shape (input, sample) [units of the inputs], sampled every `dt` [s]."""


def simulated(plant: SimulatedPlant, command: ArrayLike, dt: float, progress: Progress | None = None) -> Simulation:
    """What the plant does, with its progress told if it knows how.

    Parameters
    ----------
    plant : SimulatedPlant
        Any.
    command : array_like, shape (input, sample)
        [Units of the inputs.]
    dt : float
        Sample interval [s].
    progress : function, optional
        Called with the part done, 0 to 1; at the end at least.

    Examples
    --------
    >>> from preshape.plant import linear_mace
    >>> parts = []
    >>> _ = simulated(linear_mace(), [1.0, 0.0], 0.001, parts.append)
    >>> parts
    [1.0]
    """
    if progress is None:
        return plant.simulate(command, dt)
    run: Callable[..., Simulation] = plant.simulate
    done = run(command, dt, progress=progress) if "progress" in signature(run).parameters else run(command, dt)
    progress(1.0)
    return done
