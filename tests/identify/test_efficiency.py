"""How good an estimate from a ring-down can be at all: the Cramer-Rao bound, and how near to it we are."""

import numpy as np
import pytest
from tests.identify.simulation import decay

from preshape.identify import ring_down

SEEDS = 60
NOISE = 0.01


def bound(modes, amplitudes, phases, *, rate, duration):
    """Standard deviations of frequencies and damping ratios no unbiased estimate can beat; shape (mode, 2)."""
    times = np.arange(int(duration * rate)) / rate

    def model(parameters):
        total = np.zeros(times.size)
        for amplitude, phase, frequency, damping in parameters.reshape(-1, 4):
            omega = 2.0 * np.pi * frequency
            total += (
                amplitude * np.exp(-damping * omega * times) * np.cos(omega * np.sqrt(1.0 - damping**2) * times + phase)
            )
        return total

    truth = np.array([[a, p, f, z] for a, p, (f, z) in zip(amplitudes, phases, modes, strict=True)]).ravel()
    columns = []
    for index, value in enumerate(truth):
        step = 1e-6 * max(abs(value), 0.1)
        ahead, behind = truth.copy(), truth.copy()
        ahead[index] += step
        behind[index] -= step
        columns.append((model(ahead) - model(behind)) / (2.0 * step))
    jacobian = np.array(columns).T
    covariance = NOISE**2 * np.linalg.inv(jacobian.T @ jacobian)
    return np.sqrt(np.diag(covariance)).reshape(-1, 4)[:, 2:]


@pytest.mark.parametrize(
    ("modes", "rate"),
    [
        ([(40.0, 0.005)], 3200.0),
        ([(40.0, 0.05)], 3200.0),
        ([(40.0, 0.15)], 3200.0),
        ([(120.0, 0.15)], 3200.0),
        ([(40.0, 0.15)], 1000.0),
        ([(40.0, 0.05), (60.0, 0.05)], 3200.0),
        ([(40.0, 0.15), (90.0, 0.15)], 3200.0),
        ([(40.0, 0.15), (50.0, 0.15)], 3200.0),
    ],
)
def test_errors_are_those_of_the_best_possible_estimate(modes, rate):
    """RMS errors within 25 % of the bound. At a damping ratio of 0.15 three sigma of it reach 0.2 % to 0.9 %."""
    amplitudes, duration = [1.0, 0.7][: len(modes)], 1.0
    squares = np.zeros((len(modes), 2))
    for seed in range(SEEDS):
        series = decay(modes, amplitudes, np.random.default_rng(seed), rate=rate, duration=duration)
        phases = _phases(seed, len(modes))
        limit = bound(modes, amplitudes, phases, rate=rate, duration=duration)
        found = ring_down(series)
        assert len(found.modes) == len(modes)
        for row, (frequency, damping) in enumerate(modes):
            mode = min(found.modes, key=lambda one: abs(one.mode.frequency - frequency)).mode
            squares[row] += ((np.array([mode.frequency, mode.damping]) - (frequency, damping)) / limit[row]) ** 2
    ratio = np.sqrt(squares / SEEDS)
    assert (ratio < 1.25).all()


def _phases(seed, count):
    """The phases that `decay` draws first."""
    rng = np.random.default_rng(seed)
    return [rng.uniform(0, 2 * np.pi) for _ in range(count)]
