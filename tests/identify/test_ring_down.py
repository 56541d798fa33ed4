"""Ring-downs of known modes: decaying cosines in closed form, 40 dB above white noise, many seeds."""

import numpy as np
import pytest
from tests.identify.simulation import decay

from preshape.errors import InputError, MeasurementError
from preshape.identify import TimeSeries, find_modes, ring_down

FREQUENCY_ERROR = 0.002
DAMPING_ERROR = 0.10
SEEDS = 12


def nearest(found, frequency):
    return min(found.modes, key=lambda mode: abs(mode.mode.frequency - frequency))


@pytest.mark.parametrize("damping", [0.005, 0.02, 0.05, 0.10, 0.15])
@pytest.mark.parametrize("frequency", [20.0, 40.0])
def test_one_mode(frequency, damping):
    for seed in range(SEEDS):
        series = decay([(frequency, damping)], [1.0], np.random.default_rng(seed))
        found = find_modes(series)
        assert (found.method, found.trouble, found.clear) == ("ring-down", (), True)
        assert len(found.modes) == 1
        mode = found.modes[0].mode
        assert abs(mode.frequency / frequency - 1) < FREQUENCY_ERROR
        assert abs(mode.damping / damping - 1) < DAMPING_ERROR
        assert found.modes[0].share > 0.99


@pytest.mark.parametrize("damping", [0.005, 0.02, 0.05, 0.10])
@pytest.mark.parametrize("second", [50.0, 60.0, 90.0])
def test_two_modes(second, damping):
    """At a damping ratio of 0.15 three sigma of the Cramer-Rao bound exceed 0.2 %: test_efficiency.py has that case."""
    for seed in range(SEEDS):
        found = ring_down(decay([(40.0, damping), (second, damping)], [1.0, 0.7], np.random.default_rng(seed)))
        assert len(found.modes) == 2
        for frequency in (40.0, second):
            mode = nearest(found, frequency).mode
            assert abs(mode.frequency / frequency - 1) < FREQUENCY_ERROR
            assert abs(mode.damping / damping - 1) < DAMPING_ERROR
        assert found.modes[0].share > found.modes[1].share


@pytest.mark.parametrize(
    ("modes", "channels"),
    [
        ([(40.0, 0.05)], 1),
        ([(40.0, 0.02), (60.0, 0.05)], 3),
        ([(40.0, 0.15), (60.0, 0.15)], 1),
    ],
)
def test_intervals_cover_the_truth(modes, channels):
    """95 % intervals over 40 seeds, frequency and damping of each mode: 80 or 160 of them."""
    covered = []
    for seed in range(40):
        rng = np.random.default_rng(1000 + seed)
        found = ring_down(decay(modes, [1.0, 0.7][: len(modes)], rng, channels=channels, duration=0.8))
        for frequency, damping in modes:
            mode = nearest(found, frequency)
            covered.append(mode.frequency_interval[0] <= frequency <= mode.frequency_interval[1])
            covered.append(mode.damping_interval[0] <= damping <= mode.damping_interval[1])
    assert 0.85 <= np.mean(covered) <= 0.999


def test_error_scales_with_noise():
    """The estimate is efficient: ten times the noise, ten times the error (first order in the noise)."""
    errors = []
    for noise in (0.001, 0.01):
        rng = np.random.default_rng(7)
        found = [ring_down(decay([(40.0, 0.05)], [1.0], rng, noise=noise, duration=0.5)) for _ in range(25)]
        errors.append(np.std([each.modes[0].mode.frequency for each in found]))
    assert 5.0 < errors[1] / errors[0] < 20.0


def test_without_noise_the_modes_are_exact():
    series = decay([(31.0, 0.03), (47.0, 0.08)], [1.0, 0.5], np.random.default_rng(0), noise=0.0)
    found = ring_down(series)
    for frequency, damping in ((31.0, 0.03), (47.0, 0.08)):
        mode = nearest(found, frequency).mode
        assert mode.frequency == pytest.approx(frequency, rel=1e-6)
        assert mode.damping == pytest.approx(damping, rel=1e-5)


def test_steady_line_is_not_a_mode():
    """A motor's hum does not decay, and it is not reported, though it is stronger than the mode."""
    for seed in range(6):
        rng = np.random.default_rng(seed)
        series = decay([(40.0, 0.05)], [1.0], rng, duration=0.6)
        hum = 0.6 * np.sin(2 * np.pi * 149.5 * series.times + rng.uniform(0, 6))
        found = find_modes(TimeSeries(series.sample_rate, 0.0, series.values + hum, ("x",)))
        assert [round(mode.mode.frequency) for mode in found.modes] == [40]
        assert abs(found.modes[0].mode.damping / 0.05 - 1) < DAMPING_ERROR


def test_gravity_and_a_drop_of_level_do_no_harm():
    series = decay([(40.0, 0.05)], [1.0], np.random.default_rng(4))
    shifted = find_modes(TimeSeries(series.sample_rate, 0.0, series.values + 9806.65, ("z",)))
    plain = find_modes(series)
    assert shifted.modes[0].mode.frequency == pytest.approx(plain.modes[0].mode.frequency, rel=1e-6)


@pytest.mark.parametrize("stop", [0.3, 0.61])
def test_the_free_decay_is_found_behind_a_move(stop):
    """Rough motion until `stop`, then a decay: only the decay tells the modes."""
    for seed in range(6):
        rng = np.random.default_rng(seed)
        tail = decay([(40.0, 0.05)], [1.0], rng, rate=1000.0, duration=0.6)
        move = rng.normal(0.0, 1.0, int(stop * 1000.0))
        values = np.concatenate([move, tail.values[0]])[None, :]
        mode = find_modes(TimeSeries(1000.0, 0.0, values, ("x",))).modes[0]
        assert abs(mode.mode.frequency / 40.0 - 1) < 0.01
        assert mode.mode.damping == pytest.approx(0.05, rel=0.2)


def test_fixed_damping_is_kept():
    found = ring_down(decay([(40.0, 0.05)], [1.0], np.random.default_rng(0)), damping=0.04)
    mode = nearest(found, 40.0)
    assert mode.mode.damping == 0.04
    assert mode.damping_interval == (0.04, 0.04)


def test_noise_alone_is_trouble():
    for seed in range(6):
        values = np.random.default_rng(seed).normal(size=(1, 1500))
        found = find_modes(TimeSeries(1000.0, 0.0, values, ("x",)))
        assert not found.clear
        assert found.method == "spectrum fit"
        assert any("no free decay" in sentence for sentence in found.trouble)


def test_result_can_be_drawn():
    found = ring_down(decay([(40.0, 0.05)], [1.0], np.random.default_rng(0), channels=3))
    assert found.spectrum.channels == ("sum",)
    assert found.fitted.shape == found.spectrum.frequencies.shape
    peak = found.spectrum.total.argmax()
    assert found.spectrum.frequencies[peak] == pytest.approx(40.0, abs=1.0)
    assert found.fitted[peak] == pytest.approx(found.spectrum.total[peak], rel=0.02)


@pytest.mark.parametrize("wish", [{"damping": 1.0}, {"damping": -0.1}, {"damping": float("nan")}, {"maximum": 0}])
def test_senseless_wishes(wish):
    with pytest.raises(InputError, match="outside|not a number of modes"):
        find_modes(decay([(40.0, 0.05)], [1.0], np.random.default_rng(0)), **wish)


def test_too_short():
    with pytest.raises(MeasurementError, match="too few"):
        ring_down(TimeSeries(1000.0, 0.0, np.ones((1, 20)), ("x",)))
