"""The chosen shaper on the identified modes, during a point-to-point move: exact, no time step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape.identify import IdentifiedMode
from preshape.mode import Modes
from preshape.plant import ModalPlant
from preshape.profile import Profile
from preshape.report import SimulatedMove
from preshape.shaper import Shaper

__all__ = ["simulate_move"]

ACCELERATING, CRUISING = 0.3, 1.15
"""Parts of the move in periods of the slowest mode: short enough to excite it, and no accidental zero."""

SHOWN_PERIODS = 6.0
"""How long the vibration is shown after the move, in the same periods."""

SAMPLES = 1600


def simulate_move(shaper: Shaper, modes: Sequence[IdentifiedMode]) -> SimulatedMove:
    """A trapezoidal velocity move of the base that carries the modes, each weighted by its measured share.

    The acceleration is a staircase of four steps, shaped exactly. What is shown is the sum of the modes' vibration
    accelerations, as a sensor on the machine sees it.
    """
    wanted = Modes([mode.mode for mode in modes])
    period = max(1.0 / mode.frequency for mode in wanted)
    switches = np.cumsum([0.0, ACCELERATING, CRUISING, ACCELERATING]) * period
    steps = np.array([1.0, -1.0, -1.0, 1.0])
    end = float(switches[-1])
    times = np.linspace(0.0, end + shaper.duration + SHOWN_PERIODS * period, SAMPLES)
    # A mode's own vibration acceleration is w^2 times its deflection (the base's acceleration is the command's).
    weights = np.array([np.sqrt(mode.share) * mode.mode.omega**2 for mode in modes])
    plant = ModalPlant(wanted, weights, drive="acceleration")
    command = Profile.steps(switches, steps)

    def vibration(acceleration: Profile) -> tuple[np.ndarray, float]:
        motion = plant.motion(acceleration)
        return motion("output", times), float(weights @ motion.residual_amplitudes)

    unshaped, left_unshaped = vibration(command)
    shaped, left_shaped = vibration(command.shaped(shaper))
    return SimulatedMove(
        times=times,
        unshaped=unshaped / left_unshaped,
        shaped=shaped / left_unshaped,
        end_unshaped=end,
        end_shaped=end + shaper.duration,
        left=left_shaped / left_unshaped,
    )
