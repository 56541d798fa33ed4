"""A shaper on modes, during a point-to-point move: exact, no time step."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes
from preshape.plant import ModalPlant
from preshape.profile import Profile
from preshape.report import FREQUENCY_ERROR, SimulatedMove
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["simulate_move"]

ACCELERATING, CRUISING = 0.3, 1.15
"""Parts of the move in periods of the slowest mode: short enough to excite it, and no accidental zero."""

SHOWN_PERIODS = 6.0
"""How long the vibration is shown after the move, in the same periods."""

SAMPLES = 1600


AT_REST = 1e-4
"""A mode that keeps less than this part of what one step of acceleration leaves has no ratio."""


def simulate_move(shaper: Shaper, modes: Modes, shares: Sequence[float]) -> SimulatedMove:
    """A trapezoidal velocity move of the base that carries the modes, each weighted by its share of the vibration.

    The acceleration is a staircase of four steps, shaped exactly. What is shown is the sum of the modes' vibration
    accelerations, as a sensor on the machine sees it. What each mode keeps is told twice: by the formula of the
    residual vibration, which knows the shaper only, and by the motion of the mode under the two commands.
    """
    period = max(1.0 / mode.frequency for mode in modes)
    switches = np.cumsum([0.0, ACCELERATING, CRUISING, ACCELERATING]) * period
    steps = np.array([1.0, -1.0, -1.0, 1.0])
    end = float(switches[-1])
    times = np.linspace(0.0, end + shaper.duration + SHOWN_PERIODS * period, SAMPLES)
    # A mode's own vibration acceleration is w^2 times its deflection (the base's acceleration is the command's).
    weights = np.sqrt(np.asarray(shares, dtype=float)) * np.array([mode.omega for mode in modes]) ** 2
    command = Profile.steps(switches, steps)
    commands = (command, command.shaped(shaper))
    before, after = (ModalPlant(modes, weights, drive="acceleration").motion(one) for one in commands)
    left = float(weights @ before.residual_amplitudes)
    errors = np.array([-FREQUENCY_ERROR, 0.0, FREQUENCY_ERROR])
    frequencies = np.multiply.outer([mode.frequency for mode in modes], 1.0 + errors)
    dampings = np.array([[mode.damping] for mode in modes])
    return SimulatedMove(
        times=times,
        unshaped=before("output", times) / left,
        shaped=after("output", times) / left,
        end_unshaped=end,
        end_shaped=end + shaper.duration,
        left=float(weights @ after.residual_amplitudes) / left,
        modes=modes,
        errors=errors,
        predicted=residual_vibration(shaper, frequencies, dampings),
        simulated=np.stack([_kept(commands, zip(column, dampings[:, 0], strict=True)) for column in frequencies.T], 1),
    )


def _kept(commands: Iterable[Profile], modes: Iterable[tuple[float, float]]) -> NDArray[np.float64]:
    """Amplitude after the second command over that after the first, shape (mode,)."""
    plant = ModalPlant(list(modes), drive="acceleration")
    before, after = (plant.motion(one).residual_amplitudes for one in commands)
    moved = before * np.array([mode.omega**2 for mode in plant.modes]) > AT_REST
    ratio = np.full(before.shape, np.nan)
    np.divide(after, before, out=ratio, where=moved)
    return ratio
