"""ChangingModes: modes whose frequency and damping change with time, driven by a position, to fourth order.

A mass on a spring whose stiffness changes: x'' + 2 z w x' + w^2 (x - u) = 0 with w and z functions of time. A crane
that hoists while it drives is such a plant exactly, for small angles: with u the trolley's place and l(t) the length of
the rope, the load's place x obeys x'' = -(g - l'') / l * (x - u), so that w^2 = (g - l'') / l.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import not_negative, positive
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant.checks import gain_matrix
from preshape.plant.sampled_command import command_rows
from preshape.plant.simulation import Simulation

__all__ = ["ChangingModes"]

LONGEST = 0.05
"""Of an integration step, times the largest angular frequency [rad]: the local error falls as its fifth power."""

GAUSS = math.sqrt(3.0) / 6.0
"""The two nodes of a step are this part of it before and behind its middle."""

Array = NDArray[np.float64]


class ChangingModes:
    """Modes side by side, all driven by the same position, each changing with time.

    Parameters
    ----------
    modes_at : function
        From time [s] to the modes then, always as many and in the same order: natural frequencies [Hz], damping ratios
        [-].
    gains : array_like, shape (mode,), optional
        Weight of each modal coordinate in the output; equal shares that sum to 1 unless given.

    Raises
    ------
    InputError
        If the function does not give modes, or the gains do not fit them.

    Notes
    -----
    The command is held between samples; about it the motion is homogeneous, and a step of it is a Magnus expansion of
    fourth order, exact for modes that stay. The steps are kept for the next command of as many samples.

    Examples
    --------
    A spring that becomes stiffer by half within a second:

    >>> plant = ChangingModes(lambda t: (1.0 + 0.5 * min(t, 1.0), 0.0))
    >>> [plant.modes(t)[0].frequency for t in (0.0, 0.5, 3.0)]
    [1.0, 1.25, 1.5]
    >>> float(plant.simulate([1.0] * 101, dt=0.01).outputs["output"].max().round(3))
    1.904
    """

    def __init__(self, modes_at: Callable[[float], ModesLike], gains: ArrayLike | None = None) -> None:
        self._modes_at = modes_at
        self._count = len(Modes(modes_at(0.0)))
        self._gains = gain_matrix(gains, self._count)
        if self._gains.ndim != 1:
            raise InputError(f"gains have shape {self._gains.shape}: give ({self._count},), for the one output.")
        self._kept: tuple[int, float, Array] | None = None

    def __repr__(self) -> str:
        return f"<ChangingModes: {self._count} mode(s), at first {self.modes()!r}>"

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of the input, by name."""
        return MappingProxyType({"position": "m"})

    @property
    def outputs(self) -> Mapping[str, str]:
        """Unit of the output, by name."""
        return MappingProxyType({"output": "m"})

    def modes(self, configuration: float | None = None) -> Modes:
        """What vibrates at a time [s] from 0 on; at first unless given."""
        t = 0.0 if configuration is None else not_negative("configuration", configuration, "s")
        found = Modes(self._modes_at(t))
        if len(found) != self._count:
            raise InputError(f"there are {len(found)} modes at {t:g} s and {self._count} at 0 s: give as many always.")
        return found

    def simulate(self, command: ArrayLike, dt: float) -> Simulation:
        """The output under a held, sampled position, from rest at 0.

        Parameters
        ----------
        command : array_like, shape (1, sample) or (sample,)
            [m], at 0, dt, 2 dt, ...
        dt : float
            Sample interval [s].

        Returns
        -------
        Simulation

        Raises
        ------
        InputError
            If the command is not finite numbers, `dt` not above zero, or the function fails to give modes on the way.
        """
        rows = command_rows(command, self.inputs)
        dt = positive("dt", dt, "s")
        place, speed = np.zeros((2, self._count))
        places = np.zeros((rows.shape[1], self._count))
        if self._kept is None or self._kept[:2] != (rows.shape[1], dt):
            self._kept = rows.shape[1], dt, self._steps(rows.shape[1] - 1, dt)
        steps = self._kept[2]
        for n, u in enumerate(rows[0, :-1].tolist()):
            apart = place - u
            place, speed = (
                steps[n, :, 0, 0] * apart + steps[n, :, 0, 1] * speed + u,
                steps[n, :, 1, 0] * apart + steps[n, :, 1, 1] * speed,
            )
            places[n + 1] = place
        outputs = MappingProxyType({"output": places @ self._gains})
        return Simulation(dt * np.arange(rows.shape[1], dtype=float), rows, outputs, self.outputs)

    def _steps(self, samples: int, dt: float) -> Array:
        """From (x - u, x') at a sample to those at the next, shape (sample, mode, 2, 2)."""
        if samples == 0:
            return np.zeros((0, self._count, 2, 2))
        fastest = max(mode.omega for n in range(samples + 1) for mode in self.modes(n * dt))
        parts = math.ceil(fastest * dt / LONGEST)
        h = dt / parts
        middles = h * (np.arange(samples * parts, dtype=float) + 0.5)
        earlier, later = (self._matrices(middles + side * GAUSS * h) for side in (-1.0, 1.0))
        turned = later @ earlier - earlier @ later
        steps = _exponential(0.5 * h * (earlier + later) + 0.5 * GAUSS * h * h * turned)
        steps = steps.reshape(samples, parts, self._count, 2, 2)
        whole = steps[:, 0]
        for part in range(1, parts):
            whole = steps[:, part] @ whole
        return whole

    def _matrices(self, times: Array) -> Array:
        """(x - u, x') to its derivative, shape (time, mode, 2, 2)."""
        values = [[(mode.omega, mode.damping) for mode in self.modes(t)] for t in times.tolist()]
        omega, damping = np.moveaxis(np.array(values), -1, 0)
        matrices = np.zeros((*omega.shape, 2, 2))
        matrices[..., 0, 1] = 1.0
        matrices[..., 1, 0] = -(omega**2)
        matrices[..., 1, 1] = -2.0 * damping * omega
        return matrices


def _exponential(matrices: Array) -> Array:
    """Of 2x2 matrices that oscillate: exp(a + B) with B without trace, B^2 = -s^2, is exp(a) (cos s + sin(s) / s B)."""
    half = 0.5 * np.trace(matrices, axis1=-2, axis2=-1)[..., None, None]
    bare = matrices - half * np.eye(2)
    angle = np.sqrt(np.linalg.det(bare))[..., None, None]
    return np.asarray(np.exp(half) * (np.cos(angle) * np.eye(2) + np.sinc(angle / np.pi) * bare))
