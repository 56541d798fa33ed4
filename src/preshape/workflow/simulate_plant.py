"""Any plant under a command, unshaped beside shaped."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import not_negative, positive, tolerance_of
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant import SimulatedPlant, Simulation, simulated
from preshape.plant.protocol import Progress
from preshape.plant.sampled_command import command_rows
from preshape.report import ROUNDING, OutputMotion, ShapedSimulation
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration
from preshape.workflow.free_vibration import final_value, output_motion

__all__ = ["simulate_plant"]

REST = 6.0
"""Periods of the slowest mode that are simulated after the shaped command, unless told otherwise."""

FEWEST_PERIODS = 2.0
"""Of the slowest mode: in less, its vibration cannot be told from a motion that ends."""

MOST_SAMPLES = 20_000_000
"""A longer simulation is a mistaken sample interval."""

ON_GRID = 1e-6
"""Part of a sample by which an impulse may miss it."""

UNNOTICED = (
    "nothing moves under the unshaped command: it is over before the plant looks at it, or too small for it to see "
    "(the joints of shuttle-arm look every 80 ms, and in steps); give a longer or larger one."
)
"""Note on a command that a plant with digital inputs does not notice."""

WORTH_SAYING = 1e-3
"""Residual vibration [-] that comes of impulses between samples, from which on it is said."""


def simulate_plant(
    plant: SimulatedPlant,
    command: ArrayLike,
    dt: float,
    shaper: Shaper,
    *,
    modes: ModesLike | None = None,
    rest: float | None = None,
    tolerance: float = 0.02,
    progress: Progress | None = None,
) -> ShapedSimulation:
    """Simulate a plant under a command and under the same command shaped, and measure what is left of both.

    Parameters
    ----------
    plant : SimulatedPlant
        Any, from rest at 0.
    command : array_like, shape (input, sample) or (sample,)
        The inputs at 0, dt, 2 dt, ... [their units]; before 0 they are 0, and after the last sample they stay.
    dt : float
        Sample interval [s]; the shaper's impulses fall on multiples of it, or are split between two.
    shaper : Shaper
        Shapes every input.
    modes : Mode, (frequency, damping) or several, optional
        What is looked for in the vibration after the commands; the plant's own unless given.
    rest : float, optional
        Time simulated after the end of the shaped command [s]; six periods of the slowest mode unless given.
    tolerance : float
        An output has settled when it stays within this part of the largest deviation of the unshaped one from where
        that ends [-].
    progress : function, optional
        Called with the part done, 0 to 1.

    Returns
    -------
    ShapedSimulation

    Raises
    ------
    InputError
        If the command does not fit the plant, the shaper lies on another grid than `dt`, the time after the command is
        too short, or the plant is unstable or does not vibrate.
    Diverged
        If a simulation runs away, with the time and what there was before.

    Examples
    --------
    >>> from preshape import design
    >>> from preshape.plant import from_matrices
    >>> plant = from_matrices([[1.0]], 0.0, [[400.0]], input=[400.0], outputs={"load": 0}, input_name="position")
    >>> result = simulate_plant(plant, [1.0], 0.001, design.zv(plant.modes()))
    >>> round(result.motions["load"][0].residual, 6), result.remaining("load") < 1e-4
    (1.0, True)
    """
    rows = command_rows(command, plant.inputs)
    dt = positive("dt", dt, "s")
    tolerance_of(tolerance)
    wanted = plant.modes() if modes is None else Modes(modes)
    slowest = 1.0 / min(mode.frequency for mode in wanted)
    after = REST * slowest if rest is None else not_negative("rest", rest, "s")
    if after < FEWEST_PERIODS * slowest:
        raise InputError(
            f"rest is {after:g} s, and the slowest mode has a period of {slowest:.4g} s: give at least "
            f"{FEWEST_PERIODS * slowest:.4g} s, so that its vibration can be told."
        )
    notes = _check_grid(shaper, dt, wanted)
    shaped = shaper.shape(rows, dt)
    length = shaped.shape[1] + int(np.ceil(after / dt))
    if length > MOST_SAMPLES:
        raise InputError(
            f"the simulation would take {length} samples of {dt:g} s: give a larger dt, or at most {MOST_SAMPLES}."
        )
    commands = [_held(part, length) for part in (rows, shaped)]
    told = [None, None] if progress is None else [_half(progress, 0.0), _half(progress, 0.5)]
    runs = [simulated(plant, part, dt, tell) for part, tell in zip(commands, told, strict=True)]
    ends = [_last_change(part) for part in commands]
    if rows.any() and all(_still(values) for values in runs[0].outputs.values()):
        notes += (UNNOTICED,)
    return ShapedSimulation(
        unshaped=runs[0],
        shaped=runs[1],
        command_end=ends[0] * dt,
        shaped_end=ends[1] * dt,
        shaper=shaper,
        modes=wanted,
        inputs=plant.inputs,
        motions=MappingProxyType(_motions(runs, ends, bool(rows[:, -1].any()), wanted, tolerance)),
        notes=notes,
    )


def _motions(
    runs: list[Simulation], ends: list[int], pushed: bool, modes: Modes, tolerance: float
) -> Mapping[str, tuple[OutputMotion, OutputMotion]]:
    found = {}
    for name, values in runs[0].outputs.items():
        final = final_value(runs[0].times, values, modes)
        deviation = float(np.abs(values - final).max())
        within = max(tolerance * deviation, ROUNDING * float(np.abs(values).max()), np.finfo(float).tiny)
        before, after = (
            output_motion(run.times, run.outputs[name], end, pushed, modes, within)
            for run, end in zip(runs, ends, strict=True)
        )
        found[name] = (before, after)
    return found


def _still(values: NDArray[np.float64]) -> bool:
    return float(np.ptp(values)) <= ROUNDING * float(np.abs(values).max())


def _check_grid(shaper: Shaper, dt: float, modes: Modes) -> tuple[str, ...]:
    """What a step that misses the shaper's impulses costs; InputError if the shaper was made for another step."""
    positions = shaper.times / dt
    misses = float(np.abs(positions - np.rint(positions)).max())
    if misses <= ON_GRID and not shaper.boxes:
        return ()
    made_for = shaper.design.settings.get("dt")
    if isinstance(made_for, float) and misses > ON_GRID:
        raise InputError(
            f"the shaper's impulses lie on a grid of {made_for:g} s, and the simulation's step of {dt:g} s does not "
            f"fit: give {made_for:g} s, or a whole part of it, as dt."
        )
    delays, weights = shaper.taps(dt)
    split = Shaper.normalised(delays * dt, weights)
    spoilt = [
        float(abs(residual_vibration(split, mode.frequency, mode.damping)))
        - float(abs(residual_vibration(shaper, mode.frequency, mode.damping)))
        for mode in modes
    ]
    if max(spoilt) < WORTH_SAYING:
        return ()
    worst = modes[int(np.argmax(spoilt))]
    return (
        f"impulses between samples are split onto both, which alone leaves {100.0 * max(spoilt):.2g} % at "
        f"{worst.frequency:.4g} Hz: take a smaller dt, or design the shaper for this one.",
    )


def _held(rows: NDArray[np.float64], length: int) -> NDArray[np.float64]:
    """The rows, their last values kept up to `length` samples."""
    return np.concatenate([rows, np.repeat(rows[:, -1:], length - rows.shape[1], axis=1)], axis=1)


def _last_change(rows: NDArray[np.float64]) -> int:
    """The sample at which a row last changes; 0, where it steps from rest, if none does later."""
    changes = np.flatnonzero(np.any(np.diff(rows, axis=1) != 0.0, axis=0))
    return int(changes[-1]) + 1 if changes.size else 0


def _half(progress: Progress, start: float) -> Progress:
    return lambda done: progress(start + 0.5 * done)
