"""The modes of any plant from what it does: shaken, left alone, and identified as a measured machine is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from preshape.checks import nonzero, positive, whole_number
from preshape.errors import InputError
from preshape.identify import Identification, TimeSeries, ring_down
from preshape.plant import SimulatedPlant, simulated
from preshape.plant.protocol import Progress

__all__ = ["identify_plant"]

EXCITED = 0.3
"""Part of the duration that noise and chirp take; the rest is free vibration."""

FEWEST_FREE = 64
"""Samples of free vibration."""

STILL = 1e-12
"""An output whose velocity changes by less than this part of its largest tells nothing."""


def identify_plant(
    plant: SimulatedPlant,
    dt: float,
    duration: float,
    *,
    excitation: Literal["pulse", "noise", "chirp"] = "pulse",
    amplitude: float = 1.0,
    width: float | None = None,
    input: str | None = None,
    outputs: Sequence[str] | None = None,
    damping: float | None = None,
    maximum: int = 4,
    seed: int = 0,
    progress: Progress | None = None,
) -> Identification:
    """Shake a plant through one input, let it ring freely, and find the modes in its outputs' velocities.

    Whatever simulates can be identified so: no model of it is looked at. What rings freely after the excitation, a body
    that coasts taken out by the derivative, is fitted with decaying sinusoids (:func:`preshape.identify.ring_down`); of
    a non-linear plant, they and their intervals belong to the amplitude that it was shaken with.

    Parameters
    ----------
    plant : SimulatedPlant
        Any.
    dt : float
        Sample interval [s]; modes are found up to 0.45 / dt.
    duration : float
        Of the whole experiment [s]; several periods of the slowest mode.
    excitation : {"pulse", "noise", "chirp"}
        A rectangle; or over the first 30 % white noise, held from sample to sample, or a sine whose frequency rises
        evenly from 0 to 0.45 / dt.
    amplitude : float
        Height of pulse or chirp, standard deviation of the noise [unit of the input].
    width : float, optional
        Of the pulse [s]: modes much faster than 1 / width are spared, one of just that frequency not shaken at all; one
        sample, which excites all frequencies alike, unless given.
    input : str, optional
        Which input is shaken; the first unless given.
    outputs : sequence of str, optional
        Which outputs are looked at, each scaled to the same size; all that move unless given.
    damping : float, optional
        Fixes all damping ratios instead of fitting them [-]; 0 for a plant without damping, which is also tried when
        nothing decays.
    maximum : int
        Largest number of modes.
    seed : int
        Of the noise.
    progress : function, optional
        Called with the part done, 0 to 1.

    Returns
    -------
    Identification
        Modes with 95 % intervals and the share of each in the velocities, the strongest first; `trouble` says what is
        wrong.

    Raises
    ------
    InputError
        If the experiment is too short, nothing moves, or a name is unknown.
    Diverged
        If the plant runs away.

    Examples
    --------
    >>> from preshape.plant import FunctionPlant
    >>> def swing(t, x, u):
    ...     return [x[1], -9.81 * np.sin(x[0]) - 0.1 * x[1] - u[0]]
    >>> crane = FunctionPlant(swing, [0.0, 0.0], {"angle": 0})
    >>> small = identify_plant(crane, 0.05, 30.0)
    >>> abs(small.modes[0].mode.frequency - crane.modes()[0].frequency) < 1e-4
    True
    """
    dt, duration = positive("dt", dt, "s"), positive("duration", duration, "s")
    amplitude = nonzero("amplitude", amplitude, "units of the input")
    names = list(plant.inputs)
    row = 0 if input is None else _known("input", input, names)
    looks = list(plant.outputs) if outputs is None else list(outputs)
    for name in looks:
        _known("output", name, list(plant.outputs))
    whole_number("maximum", maximum, 1, 100)
    count = int(round(duration / dt))
    excited = int(EXCITED * count)
    if excitation == "pulse":
        excited = 1 if width is None else max(round(positive("width", width, "s") / dt), 1)
    if count - excited < FEWEST_FREE:
        raise InputError(
            f"{duration:g} s at {dt:g} s leave {max(count - excited, 0)} samples of free vibration: give a longer "
            f"duration or a smaller dt, at least {FEWEST_FREE} samples."
        )
    command = np.zeros((len(names), count))
    command[row, :excited] = amplitude * _shape(excitation, excited, seed)
    done = simulated(plant, command, dt, progress)
    velocities = np.array([np.diff(done.outputs[name][excited:]) / dt for name in looks])
    moving = np.ptp(velocities, axis=1) > STILL * np.maximum(np.abs(velocities).max(axis=1), np.finfo(float).tiny)
    if not moving.any():
        raise InputError(
            f"nothing vibrates in {', '.join(looks)} after the {excitation} at {names[row]!r}: look at another output, "
            "or shake another input."
        )
    values = velocities[moving] / np.std(velocities[moving], axis=1, keepdims=True)
    channels = tuple(name for name, one in zip(looks, moving, strict=True) if one)
    series = TimeSeries(1.0 / dt, excited * dt, values, channels, source=f"the simulated {excitation}")
    found = ring_down(series, damping=damping, maximum=maximum)
    if found.clear or damping is not None:
        return found
    # A simulation has no lines of motors: what rings and does not decay is a mode without damping.
    undamped = ring_down(series, damping=0.0, maximum=maximum)
    if not undamped.clear:
        return found
    return replace(undamped, trouble=(*undamped.trouble, "nothing decays measurably: the modes are without damping."))


def _shape(excitation: str, count: int, seed: int) -> NDArray[np.float64]:
    if excitation == "pulse":
        return np.ones(count)
    if excitation == "noise":
        return np.random.default_rng(seed).normal(size=count)
    if excitation == "chirp":
        k = np.arange(count, dtype=float)
        return np.asarray(np.sin(np.pi * 0.45 * k**2 / count))
    raise InputError(f"excitation is {excitation!r}: give 'pulse', 'noise' or 'chirp'.")


def _known(kind: str, name: str, names: list[str]) -> int:
    if name not in names:
        raise InputError(f"{kind} is {name!r}: this plant has {', '.join(names)}.")
    return names.index(name)
