"""What is wrong with a record is said by name, and nothing is said of a healthy one."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.identify.simulation import decay, swept_machine

from preshape.identify import TimeSeries
from preshape.identify.motor_lines import GATE, LOWEST_LINE, without_motor_lines
from preshape.identify.sensor_checks import sensor_trouble


def series(values, rate=1600.0, unit=""):
    return TimeSeries(rate, 0.0, values, tuple("xyz"[: len(values)]), unit)


@settings(max_examples=30)
@given(st.integers(0, 10_000), st.floats(0.005, 0.15), st.floats(20.0, 120.0), st.sampled_from([0.0, 0.004, 0.03]))
def test_nothing_is_said_of_a_healthy_ring_down(seed, damping, frequency, resolution):
    """Coarse sensors too: the rounded top of a slow wave is flat for many samples, but not steep beside."""
    values = decay([(frequency, damping)], [1.0], np.random.default_rng(seed), channels=3).values
    if resolution:
        values = np.round(values / resolution) * resolution
    assert sensor_trouble(series(values, 3200.0)) == ()


def test_nothing_is_said_of_a_healthy_sweep():
    assert sensor_trouble(swept_machine([(47.0, 0.05), (79.0, 0.03)], [1.0, 0.4], np.random.default_rng(1))) == ()


@given(st.integers(0, 100), st.floats(0.3, 0.8), st.booleans())
def test_a_clipped_sensor(seed, limit, coarse):
    rng = np.random.default_rng(seed)
    values = decay([(40.0, 0.02)], [1.0], rng, channels=2).values * np.array([[1.0], [0.1]])
    clipped = np.clip(values, -limit, limit)
    if coarse:
        clipped = np.round(clipped / 0.004) * 0.004
    (sentence,) = sensor_trouble(series(clipped, 3200.0, "g"))
    assert sentence.startswith("the sensor is clipped (channel x")
    assert "channel y" not in sentence


def test_a_channel_that_is_off():
    values = decay([(40.0, 0.02)], [1.0], np.random.default_rng(0), channels=3).values.copy()
    values[1] = 3.0
    assert sensor_trouble(series(values, 3200.0)) == ("channel y never changes: that sensor is off or not connected.",)


@pytest.mark.parametrize("said", ["g", "m/s^2", "mm/s^2"])
@pytest.mark.parametrize("true", ["g", "m/s^2", "mm/s^2"])
def test_gravity_gives_a_wrong_unit_away(said, true):
    gravity = {"g": 1.0, "m/s^2": 9.80665, "mm/s^2": 9806.65}[true]
    values = gravity * (0.2 * decay([(40.0, 0.02)], [1.0], np.random.default_rng(2), channels=3).values)
    values += gravity * np.array([[0.02], [-0.03], [0.99]])
    found = sensor_trouble(series(values, 3200.0, said))
    if said == true:
        assert found == ()
    else:
        (sentence,) = found
        assert f"gravity in {true} and not in {said}" in sentence


@pytest.mark.parametrize(("frequency", "folds"), [(300.0, False), (960.0, True), (1100.0, True)])
def test_power_near_half_the_rate_is_called_aliasing(frequency, folds):
    """Sampled at 2 kHz, what vibrates at 1100 Hz appears at 900."""
    times = np.arange(4000) / 2000.0
    values = np.sin(2 * np.pi * frequency * times)[None, :] + 0.1 * np.random.default_rng(3).normal(size=(1, 4000))
    found = sensor_trouble(series(values, 2000.0))
    assert bool(found) is folds
    assert all(sentence.startswith("aliasing is likely") for sentence in found)


def capture(line, rng, *, rate=1391.0, moving=(0.1, 0.7), wobble=1.0, mode=(41.0, 0.05)):
    """A move with a motor line, and the ringing after its stop; axes x and z, in g."""
    times = np.arange(1400) / rate
    turning = (times > moving[0]) & (times < moving[1])
    phase = 2 * np.pi * np.cumsum(line + wobble * np.sin(2 * np.pi * 3.0 * times)) / rate
    hum = np.where(turning, np.sin(phase), 0.0)
    omega = 2 * np.pi * mode[0]
    after = np.maximum(times - moving[1], 0.0)
    ring = np.where(times > moving[1], np.exp(-mode[1] * omega * after) * np.sin(omega * after), 0.0)
    noise = 0.005 * rng.normal(size=(2, 1400))
    return hum, ring, np.array([0.3 * hum + ring, 0.2 * hum + 0.1 * ring]) + noise


@pytest.mark.parametrize("line", [149.5, 220.0, 400.0])
def test_a_motor_line_is_taken_out_and_the_ringing_stays(line):
    hum, ring, values = capture(line, np.random.default_rng(5))
    clean, remarks = without_motor_lines(values, 1391.0)
    named = re.match(r"motor line at (\d+) Hz taken out", remarks[0])
    assert named and abs(float(named[1]) - line) <= 1.5
    left = clean[0] - ring
    assert np.std(left) < 0.25 * np.std(0.3 * hum)  # what is left is noise and the edges of the move
    after = slice(int((0.7 + GATE) * 1391), None)
    assert np.std((clean[0] - ring)[after]) < 1.2 * 0.005  # nothing is smeared past the stop


def test_what_rings_above_the_structural_modes_is_no_motor_line():
    _, _, values = capture(149.5, np.random.default_rng(6), moving=(0.1, 0.1), mode=(190.0, 0.01))
    clean, remarks = without_motor_lines(values, 1391.0)
    assert remarks == ()
    assert clean is values


@pytest.mark.parametrize("noise", [0.0, 0.005])
@pytest.mark.parametrize("below", [0.5, 0.9, 0.94, 0.96, 0.98, 0.995])
def test_what_is_below_the_lowest_line_is_never_touched(below, noise):
    """However long it lasts, up to the limit: the side of its peak above it is no line."""
    times = np.arange(2000) / 1391.0
    hum = np.sin(2 * np.pi * below * LOWEST_LINE * times) + noise * np.random.default_rng(8).normal(size=2000)
    clean, remarks = without_motor_lines(hum[None, :], 1391.0)
    assert remarks == () and clean.tobytes() == hum.tobytes()


@pytest.mark.parametrize("line", [145.0, 150.0, 163.0, 400.0])
def test_one_line_is_one_line(line):
    """What is left where it was taken out is none of its own, however loud it was."""
    times = np.arange(2000) / 1391.0
    clean, remarks = without_motor_lines(np.sin(2 * np.pi * line * times)[None, :], 1391.0)
    (named,) = re.match(r"motor line at ([\d, ]+) Hz taken out", remarks[0])[1].split(",")
    assert abs(float(named) - line) <= 1.0
    assert np.var(clean) < 0.02 * 0.5  # the first and the last half window are not taken out altogether


def test_noise_has_no_motor_lines():
    rng = np.random.default_rng(7)
    assert all(without_motor_lines(rng.normal(size=(3, 1000)), 1391.0)[1] == () for _ in range(50))
