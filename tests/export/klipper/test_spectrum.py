"""Klipper's spectrum against a plain sum of sines, against scipy's convention, and against known signals."""

import math

import numpy as np
import pytest
from scipy.signal import welch

from preshape.errors import InputError, MeasurementError
from preshape.export import klipper

FLOAT_SUM = 1e-10
"""Relative difference of two ways to sum some hundred products."""


def record(samples: int, rate: float, seed: int = 1, jitter: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Times and three axes of coloured noise with an offset (gravity)."""
    random = np.random.default_rng(seed)
    t = (np.arange(samples) + jitter * random.uniform(-0.5, 0.5, samples)) / rate
    a = np.cumsum(random.normal(size=(3, samples)), axis=1) * 0.2 + random.normal(size=(3, samples))
    return t, a + np.array([[0.0], [3.0], [9806.65]])


def naive_psd(t: np.ndarray, x: np.ndarray) -> tuple[list[float], list[float]]:
    """The recipe of ECOSYSTEM 1.6 word by word, with a discrete Fourier sum and no library."""
    n = len(x)
    rate = n / (t[-1] - t[0])
    size = 1
    while size < math.floor(rate * 0.5):
        size *= 2
    centre = (size - 1) / 2
    window = [float(np.i0(6.0 * math.sqrt(1 - ((k - centre) / centre) ** 2)) / np.i0(6.0)) for k in range(size)]
    scale = sum(w * w for w in window) * rate
    total, count, start = np.zeros(size // 2 + 1), 0, 0
    while start + size <= n:
        piece = x[start : start + size]
        piece = (piece - sum(piece) / size) * window
        angle = 2 * math.pi * np.outer(np.arange(size // 2 + 1), np.arange(size)) / size
        power = (np.cos(angle) @ piece) ** 2 + (np.sin(angle) @ piece) ** 2
        power[1:-1] *= 2
        total += power / scale
        count, start = count + 1, start + size // 2
    return [k * rate / size for k in range(size // 2 + 1)], list(total / count)


@pytest.mark.parametrize(("samples", "rate"), [(700, 400.0), (1000, 513.0), (515, 511.9), (300, 250.0)])
def test_the_spectrum_is_the_recipe(samples: int, rate: float) -> None:
    t, a = record(samples, rate, jitter=0.3)
    spectrum = klipper.power_spectral_density(t, a)
    for axis in range(3):
        frequencies, psd = naive_psd(t, a[axis])
        np.testing.assert_allclose(spectrum.frequencies, frequencies, rtol=1e-14)
        np.testing.assert_allclose(spectrum.psd[axis], psd, rtol=1e-8, atol=FLOAT_SUM * max(psd))
    np.testing.assert_array_equal(spectrum.total, spectrum.psd[0] + spectrum.psd[1] + spectrum.psd[2])


def test_the_difference_from_welch_is_the_sample_rate_alone() -> None:
    """Klipper's rate is N / (last - first), the true one N - 1: all its frequencies are N / (N - 1) times too high."""
    rate, n = 400.0, 1001
    t, a = record(n, rate)
    spectrum = klipper.power_spectral_density(t, a)
    frequencies, psd = welch(a, rate, window=np.kaiser(256, 6.0), noverlap=128, detrend="constant")
    np.testing.assert_allclose(spectrum.frequencies, frequencies * n / (n - 1), rtol=1e-12)
    np.testing.assert_allclose(spectrum.psd, psd * (n - 1) / n, rtol=1e-9)


def test_the_power_of_a_sine_is_half_its_squared_amplitude() -> None:
    rate, n = 3200.0, 20000
    t = np.arange(n) / rate
    spectrum = klipper.power_spectral_density(t, 7.0 * np.sin(2 * np.pi * 75.0 * t))
    assert spectrum.frequencies[1] == pytest.approx(3200.0 * n / (n - 1) / 2048, rel=1e-12)
    assert abs(spectrum.frequencies[spectrum.total.argmax()] - 75.0) < spectrum.frequencies[1]
    power = spectrum.total.sum() * spectrum.frequencies[1]
    # Leakage into the removed mean and past the ends is what a Kaiser window of beta 6 leaves, below 1e-4 in power.
    assert power == pytest.approx(24.5, rel=1e-4)


@pytest.mark.parametrize(("rate", "size"), [(3200.0, 2048), (4096.0, 2048), (4100.0, 4096), (1600.0, 1024)])
def test_the_window_is_half_a_second_rounded_up(rate: float, size: int) -> None:
    t = np.arange(9000) / rate
    spectrum = klipper.power_spectral_density(t, np.sin(t))
    assert spectrum.frequencies.size == size // 2 + 1


def test_a_record_no_longer_than_one_window_is_refused() -> None:
    t, a = record(257, 400.0)
    klipper.power_spectral_density(t, a)
    with pytest.raises(MeasurementError, match="measure for longer"):
        klipper.power_spectral_density(t[:256], a[:, :256])


@pytest.mark.parametrize(
    ("times", "acceleration", "sentence"),
    [
        ([0.0], [1.0], "at least two times"),
        ([0.0, 0.1, 0.2], [1.0, 2.0], "at least two times"),
        ([0.0, 0.1, 0.1], [1.0, 2.0, 3.0], "do not increase"),
        ([0.0, 0.1, 0.2], [1.0, float("nan"), 3.0], "NaN"),
        ([0.0, float("inf"), 0.2], [1.0, 2.0, 3.0], "NaN or infinity"),
    ],
)
def test_unusable_records_are_refused(times: list[float], acceleration: list[float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        klipper.power_spectral_density(times, acceleration)


def test_normalisation_divides_by_frequency_and_fades_low_ones() -> None:
    f = [0.0, 4.9, 9.9, 9.99, 10.0, 50.0]
    expected = [
        math.exp(1 - 100.0**2) / 0.1,
        math.exp(-3.0) / 5.0,
        math.exp(0.0) / 10.0,
        math.exp(1 - (10 / 10.09) ** 2) / 10.09,
        1 / 10.1,
        1 / 50.1,
    ]
    np.testing.assert_allclose(klipper.normalise_to_frequencies(f, np.ones(6)), expected, rtol=1e-12)
    both = klipper.normalise_to_frequencies(f, np.ones((2, 6)) * [[1.0], [3.0]])
    np.testing.assert_allclose(both, [expected, np.multiply(3.0, expected)], rtol=1e-12)


def test_normalisation_refuses_other_shapes_and_negative_frequencies() -> None:
    with pytest.raises(InputError, match="last axis"):
        klipper.normalise_to_frequencies([1.0, 2.0], [1.0])
    with pytest.raises(InputError, match="0 or more"):
        klipper.normalise_to_frequencies([-1.0, 2.0], [1.0, 1.0])
