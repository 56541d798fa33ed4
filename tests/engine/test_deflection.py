"""Deflection while moving as a constraint: the closed form of the time-optimal SD-ZV shaper, and a simulation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from preshape import Mode
from preshape.engine import ImpulsesBetween, ServoGrid, ZeroVibration, deflection_at_most, minimum_duration
from preshape.errors import InputError

DT = 0.01


def closed_form_duration(mode: Mode, limit: float) -> float:
    """Impulse, box, impulse: half a damped period and the time the box holds the deflection at its limit."""
    s, phi = mode.damping / math.sqrt(1.0 - mode.damping**2), math.acos(mode.damping)
    held = (1.0 - (1.0 + mode.decay_per_half_period) * limit) / (mode.omega * limit * math.exp(-s * phi))
    return mode.damped_period / 2.0 + held


@pytest.mark.parametrize("damping", [0.0, 0.1])
@pytest.mark.parametrize("limit", [0.25, 0.3, 0.4])
def test_the_grid_optimum_is_the_time_optimal_closed_form_to_a_slot(damping: float, limit: float) -> None:
    mode = Mode(1.0, damping)
    asked = [ZeroVibration(mode), ImpulsesBetween(0.0, 1.0), deflection_at_most(mode, limit, DT), ServoGrid(DT)]
    found = minimum_duration(asked)
    assert found.status == "optimal"
    exact = closed_form_duration(mode, limit)
    assert exact - DT <= found.times[-1] <= exact + DT


def test_the_limit_holds_in_an_independent_simulation() -> None:
    """d'' + 2 z w d' + w^2 d = r'' integrated step by step for a ramp of speed one, shaped: kicks of d' by a_i."""
    mode, limit = Mode(1.0, 0.1), 0.3
    asked = [ZeroVibration(mode), ImpulsesBetween(0.0, 1.0), deflection_at_most(mode, limit, DT), ServoGrid(DT)]
    found = minimum_duration(asked)

    def free(t: float, y: np.ndarray) -> list[float]:
        return [y[1], -2.0 * mode.damping * mode.omega * y[1] - mode.omega**2 * y[0]]

    def peak(times: np.ndarray, amplitudes: np.ndarray) -> float:
        state, largest = np.zeros(2), 0.0
        ends = np.append(times[1:], times[-1] + 3.0 * mode.damped_period)
        for start, end, kick in zip(times, ends, amplitudes, strict=True):
            run = solve_ivp(free, (start, end), state + [0.0, kick], rtol=1e-9, atol=1e-12, max_step=0.01)
            largest, state = max(largest, float(np.abs(run.y[0]).max())), run.y[:, -1]
        return largest

    unshaped, shaped = peak(np.array([0.0]), np.array([1.0])), peak(found.times, found.amplitudes)
    assert shaped <= limit * unshaped * (1.0 + 2e-3)  # between two samples the deflection may bulge by (pi f dt)^2 / 2
    assert shaped > 0.98 * limit * unshaped


def test_a_limit_below_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="deflection limit is -0.1"):
        deflection_at_most(Mode(1.0), -0.1, DT)
