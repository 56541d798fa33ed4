"""Klipper's raw data against the commanded acceleration: modes, intervals, and what cannot be used."""

import numpy as np
import pytest
from tests.identify.simulation import clean_record, noisy, sweep_velocity

from preshape.errors import InputError
from preshape.identify import Sweep, find_modes, spectrum


def nearest(found, frequency):
    return min(found.modes, key=lambda mode: abs(mode.mode.frequency - frequency))


@pytest.mark.parametrize("slow", [None, (400.0, 1.2)])
def test_the_command_is_klippers(slow):
    """Against a loop over the pulses, as ECOSYSTEM.md 1.5 tells them."""
    times, velocities = sweep_velocity(5.0, 40.0, 60.0, 0.7, slow)
    sweep = Sweep(5.0, 40.0, 0.7, slow_period=0.0 if slow is None else slow[1])
    ours = np.interp(times, *sweep.velocity())
    np.testing.assert_allclose(ours, velocities, atol=1e-9 * np.abs(velocities).max())
    assert times[-1] == pytest.approx(sweep.duration, rel=0.01)


def test_samples_of_the_command_are_means():
    sweep = Sweep(5.0, 20.0)
    samples = sweep.sampled(1000.0, 0.25, 20_000)
    assert not samples[:250].any()
    times, velocities = sweep.velocity()
    reached = np.interp(np.arange(20_000) / 1000.0 - 0.25, times, velocities)
    np.testing.assert_allclose(np.cumsum(samples) / 1000.0, reached, atol=1e-9)
    assert samples.max() <= 60.0 * 20.0


@pytest.mark.parametrize("wrong", [{"highest": 4.0}, {"rate": 0.0}, {"rate": 1e-4}, {"lowest": float("nan")}])
def test_senseless_sweeps(wrong):
    with pytest.raises(InputError, match="highest|rate|lowest|pulses"):
        Sweep(**wrong)


def test_a_sweep_for_a_spectrum():
    series = noisy(clean_record([(48.0, 0.06)], [1.0]), np.random.default_rng(0))
    with pytest.raises(InputError, match="raw data"):
        find_modes(spectrum(series), excitation=Sweep())


@pytest.mark.parametrize("frequency", [40.0, 80.0, 120.0])
@pytest.mark.parametrize("damping", [0.005, 0.02, 0.05, 0.15])
def test_one_mode(frequency, damping):
    """Unknown start, a clock that is 20 ppm fast and wanders, steps of 4 mg."""
    found = find_modes(noisy(clean_record([(frequency, damping)], [1.0]), np.random.default_rng(1)))
    assert (found.method, found.trouble, found.clear) == ("frequency response", (), True)
    assert len(found.modes) == 1
    assert found.modes[0].mode.frequency == pytest.approx(frequency, rel=1e-3)
    assert found.modes[0].mode.damping == pytest.approx(damping, rel=0.01)


@pytest.mark.parametrize(
    ("modes", "gains"),
    [
        ([(50.0, 0.03), (52.0, 0.05)], [0.5, 0.5]),
        ([(90.0, 0.02), (91.5, 0.02)], [0.5, 0.5]),
        ([(55.0, 0.05), (57.5, 0.05)], [0.6, 0.4]),
        ([(38.0, 0.04), (70.0, 0.06)], [1.3, -0.3]),
    ],
    ids=["2 Hz apart", "1.5 Hz apart", "2.5 Hz apart", "opposite"],
)
def test_two_modes_nearer_than_a_spectrum_tells(modes, gains):
    found = find_modes(noisy(clean_record(modes, gains), np.random.default_rng(2)))
    assert found.method == "frequency response"
    assert len(found.modes) == 2
    for frequency, damping in modes:
        mode = nearest(found, frequency).mode
        assert mode.frequency == pytest.approx(frequency, rel=1e-3)
        assert mode.damping == pytest.approx(damping, rel=0.02)


@pytest.mark.parametrize(
    "settings",
    [
        {"slow": (400.0, 1.2)},
        {"speed": 2.0, "highest": 135.0},
        {"speed": 0.73, "lowest": 20.0, "highest": 100.0},
        {"start": 3.0},
    ],
    ids=["slow wave", "fast", "odd", "late"],
)
def test_the_sweep_is_found(settings):
    found = find_modes(noisy(clean_record([(48.0, 0.06)], [1.0], **settings), np.random.default_rng(3)))
    assert found.method == "frequency response"
    assert found.modes[0].mode.frequency == pytest.approx(48.0, rel=1e-3)
    assert found.modes[0].mode.damping == pytest.approx(0.06, rel=0.01)


def test_a_sweep_that_is_named_gives_the_same():
    series = noisy(clean_record([(48.0, 0.06)], [1.0]), np.random.default_rng(4))
    free, named = find_modes(series), find_modes(series, excitation=Sweep(5.0, 133.3, 1.0, 75.0))
    assert named.method == "frequency response"
    assert named.modes[0].mode.damping == pytest.approx(free.modes[0].mode.damping, rel=1e-3)


@pytest.mark.parametrize(
    ("modes", "gains"), [([(60.0, 0.05)], [1.0]), ([(50.0, 0.03), (52.0, 0.05)], [0.5, 0.5])], ids=["one", "two"]
)
def test_intervals_cover_the_truth_and_are_no_wider_than_they_need_be(modes, gains):
    clean = clean_record(modes, gains)
    covered, errors, widths = [], [], []
    for seed in range(24):
        found = find_modes(noisy(clean, np.random.default_rng(seed), noise_density=30_000.0))
        for frequency, damping in modes:
            mode = nearest(found, frequency)
            pairs = ((mode.frequency_interval, frequency), (mode.damping_interval, damping))
            covered.append([low <= truth <= high for (low, high), truth in pairs])
            widths.append([0.5 * (high - low) for (low, high), _ in pairs])
            errors.append([mode.mode.frequency - frequency, mode.mode.damping - damping])
    assert np.mean(covered) >= 0.9
    assert (np.median(widths, axis=0) < 6.0 * np.sqrt(np.mean(np.square(errors), axis=0))).all()


def test_fixed_damping_is_kept():
    found = find_modes(noisy(clean_record([(48.0, 0.06)], [1.0]), np.random.default_rng(5)), damping=0.08)
    assert found.modes[0].mode.damping == 0.08
    assert found.modes[0].damping_interval == (0.08, 0.08)
    assert found.modes[0].mode.frequency == pytest.approx(48.0, rel=0.02)


def test_harmonics_and_a_fan_do_no_harm():
    """What is not in step with the command averages out: a quadratic distortion, a steady line stronger than noise."""
    clean = clean_record([(48.0, 0.06)], [1.0])
    times = np.arange(clean.shape[-1]) / 3200.0
    clean[0] += 0.3 * clean[0] ** 2 / np.abs(clean[0]).max() + 2000.0 * np.sin(2 * np.pi * 61.3 * times)
    found = find_modes(noisy(clean, np.random.default_rng(6)))
    assert found.method == "frequency response"
    mode = found.modes[0]
    assert mode.mode.damping == pytest.approx(0.06, rel=0.03)
    assert mode.damping_interval[0] <= 0.06 <= mode.damping_interval[1]


def test_lost_samples_leave_the_spectrum():
    clean = np.delete(clean_record([(48.0, 0.06)], [1.0]), np.s_[224_000:224_040], axis=1)
    remark = "samples are missing: the time stamps have 1 gaps."
    found = find_modes(noisy(clean, np.random.default_rng(7), remarks=(remark,)))
    assert found.method == "spectrum fit"
    assert any("command and response drift apart" in sentence for sentence in found.trouble)
    assert found.modes[0].damping_interval[0] <= 0.06 <= found.modes[0].damping_interval[1]


def test_a_machine_that_is_not_linear_is_told():
    clean = clean_record([(48.0, 0.06)], [1.0])
    clean[0] = 1.2e4 * np.tanh(clean[0] / 1.2e4)
    found = find_modes(noisy(clean, np.random.default_rng(8)))
    assert any(sentence.startswith("the modes explain the response to the sweep only to") for sentence in found.trouble)


@pytest.mark.parametrize("sweep", [Sweep(1000.0, 1100.0), Sweep(5.0, 11.0), Sweep(40.0, 60.0, 0.3)])
def test_a_sweep_that_is_not_in_the_record_is_told(sweep):
    found = find_modes(noisy(clean_record([(48.0, 0.06)], [1.0]), np.random.default_rng(0)), excitation=sweep)
    assert found.method == "spectrum fit"
    assert "the modes come from the spectrum alone" in found.trouble[-1]
    assert found.modes[0].mode.frequency == pytest.approx(48.0, rel=0.01)


def test_no_sweep_is_told():
    values = np.random.default_rng(9).normal(size=(3, 200_000)) * 1000.0
    found = find_modes(noisy(values, np.random.default_rng(9)))
    assert found.method == "spectrum fit"
    assert any("no evenly rising sweep" in sentence or "no clear peak" in sentence for sentence in found.trouble)


def test_the_fitted_curve_is_the_measured_spectrum():
    found = find_modes(noisy(clean_record([(48.0, 0.06)], [1.0]), np.random.default_rng(10)))
    inside = np.isfinite(found.fitted) & (found.spectrum.frequencies > 12.0) & (found.spectrum.frequencies < 126.0)
    np.testing.assert_allclose(found.fitted[inside], found.spectrum.total[inside], rtol=0.05)
