"""Klipper's measures against a plain sum, against simulated corners, and against the laws that they must obey."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Shaper
from preshape.errors import InputError
from preshape.export import klipper

ROUNDING = 1e-11
"""Relative, of sums of a few products; remaining vibration also subtracts the threshold."""

BINS = np.arange(5.0, 150.0, 1.25)


def peaks(*modes: tuple[float, float, float]) -> np.ndarray:
    """Power over BINS of resonances (frequency, damping, height)."""
    power = np.zeros(BINS.size)
    for frequency, damping, height in modes:
        r = BINS / frequency
        power += height * (2 * damping) ** 2 / ((1 - r**2) ** 2 + (2 * damping * r) ** 2)
    return power


@st.composite
def shapers(draw: st.DrawFn, *, positive: bool = True) -> Shaper:
    count = draw(st.integers(2, 6))
    gaps = draw(st.lists(st.floats(1e-3, 2e-2), min_size=count - 1, max_size=count - 1))
    low = 0.02 if positive else -0.3
    weights = [round(weight, 6) for weight in draw(st.lists(st.floats(low, 1.0), min_size=count, max_size=count))]
    if sum(weights) < 0.1:
        weights[0] += 1.0
    return Shaper.normalised(np.concatenate([[0.0], np.cumsum(gaps)]), weights)


spectra = st.lists(
    st.tuples(st.floats(20.0, 130.0), st.floats(0.01, 0.15), st.floats(0.1, 1.0)), min_size=1, max_size=4
).map(lambda modes: peaks(*modes))


def plain_remaining(shaper: Shaper, psd: np.ndarray, dampings: list[float]) -> float:
    """ECOSYSTEM 1.8, one scalar at a time."""
    threshold = max(psd) / 20.0
    worst = 0.0
    for z in dampings:
        left = before = 0.0
        for f, p in zip(BINS, psd, strict=True):
            w = 2 * math.pi * f
            total = 0j
            for t, a in zip(shaper.times, shaper.amplitudes, strict=True):
                decay = math.exp(-z * w * (shaper.times[-1] - t))
                total += a * decay * cmath.exp(1j * w * math.sqrt(1 - z * z) * t)
            left += max(abs(total) * p - threshold, 0.0)
            before += max(p - threshold, 0.0)
        worst = max(worst, left / before)
    return worst


@settings(max_examples=40, deadline=None)
@given(shapers(positive=False), spectra)
def test_remaining_vibration_is_the_plain_sum(shaper: Shaper, psd: np.ndarray) -> None:
    """For negative impulses too, whose V may exceed 1."""
    found = klipper.remaining_vibration(shaper, (BINS, psd))
    assert found == pytest.approx(plain_remaining(shaper, psd, [0.075, 0.1, 0.15]), rel=ROUNDING, abs=ROUNDING)


@settings(max_examples=60, deadline=None)
@given(shapers(), spectra)
def test_positive_shapers_leave_between_nothing_and_all(shaper: Shaper, psd: np.ndarray) -> None:
    left = klipper.remaining_vibration(shaper, (BINS, psd))
    assert 0.0 <= left < 1.0
    assert klipper.remaining_vibration(shaper, (BINS, 1e-7 * psd)) == pytest.approx(left, rel=ROUNDING, abs=ROUNDING)


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(["zv", "mzv", "zvd"]), st.sampled_from(list(BINS[20:])), st.floats(0.0, 0.3))
def test_nothing_is_left_of_power_at_a_zero(name: str, frequency: float, damping: float) -> None:
    psd = np.where(BINS == frequency, 3.0, 0.0)
    shaper = klipper.FAMILIES[name].pulses(frequency, damping)
    assert klipper.remaining_vibration(shaper, (BINS, psd), [damping]) == 0.0


def test_one_impulse_leaves_everything_and_smooths_nothing() -> None:
    found = klipper.score(Shaper([0.0], [1.0]), (BINS, peaks((60.0, 0.05, 1.0))))
    assert found == klipper.KlipperScore(1.0, 0.0, math.inf, 0.0)


def test_the_worst_dataset_and_the_worst_damping_count() -> None:
    shaper = klipper.mzv(60.0)
    near, far = peaks((60.0, 0.05, 1.0)), peaks((75.0, 0.05, 40.0))
    alone = [klipper.remaining_vibration(shaper, (BINS, psd)) for psd in (near, far)]
    assert klipper.remaining_vibration(shaper, (BINS, [near, far])) == max(alone) > 2 * min(alone)
    each = [klipper.remaining_vibration(shaper, (BINS, far), [z]) for z in (0.02, 0.3)]
    assert klipper.remaining_vibration(shaper, (BINS, far), iter([0.02, 0.3])) == max(each) > min(each)


def test_vibration_above_the_limit_is_not_looked_at() -> None:
    psd = peaks((60.0, 0.05, 1.0), (120.0, 0.02, 30.0))
    shaper = klipper.zv(60.0)
    keep = BINS <= 100.0
    expected = klipper.remaining_vibration(shaper, (BINS[keep], psd[keep]))
    assert klipper.remaining_vibration(shaper, (BINS, psd), maximum_frequency=100.0) == expected
    assert klipper.remaining_vibration(shaper, (BINS, psd)) != expected


STEPS = 4000
"""Time steps to the shaper's centroid in the simulated corners."""


def corner(shaper: Shaper, acceleration: float, velocity: float, *, reversal: bool) -> tuple[float, float]:
    """Where the axis that comes into a corner at 0 is when the delayed path is in the corner; bound of the error.

    Reversal: it comes to rest in the corner and goes back. Right angle: it arrives with `velocity` and stays.
    Simulated as a sampled path through Shaper.shape; the centroid lies on the grid, so the only error is linear
    interpolation between samples, acceleration x dt^2 / 8.
    """
    dt = shaper.centroid / STEPS
    before = math.ceil(shaper.duration / dt) + 2
    t = np.arange(-before, STEPS + 2) * dt
    path = -0.5 * acceleration * t**2
    if not reversal:
        path = np.where(t < 0.0, path + velocity * t, 0.0)
    shaped = shaper.shape(path, dt, initial=path[0])
    return -float(shaped[before + STEPS]), acceleration * dt**2 / 8


@settings(max_examples=40, deadline=None)
@given(shapers(), st.floats(500.0, 30000.0), st.floats(0.0, 30.0))
def test_smoothing_is_the_deviation_of_a_simulated_corner(shaper: Shaper, acceleration: float, velocity: float) -> None:
    reversal, error = corner(shaper, acceleration, 0.0, reversal=True)
    inward, _ = corner(shaper, acceleration, velocity, reversal=False)
    expected = max(reversal, math.sqrt(2.0) * inward)
    found = klipper.smoothing(shaper, acceleration, velocity)
    assert found == pytest.approx(expected, abs=2.0 * error + 1e-12)


def test_for_a_symmetric_shaper_it_is_the_distance_in_the_plane() -> None:
    """The axis that leaves the corner mirrors the one that arrives, so sqrt 2 is exact without damping."""
    shaper = klipper.mzv(40.0, 0.0)
    mirrored = Shaper(shaper.duration - shaper.times[::-1], shaper.amplitudes[::-1])
    arriving, error = corner(shaper, 5000.0, 50.0, reversal=False)
    leaving, _ = corner(mirrored, 5000.0, 50.0, reversal=False)
    assert klipper.smoothing(shaper, 5000.0, 50.0) == pytest.approx(math.hypot(arriving, leaving), abs=2.0 * error)


@settings(max_examples=60, deadline=None)
@given(shapers(), st.floats(0.1, 10.0))
def test_smoothing_grows_with_the_square_of_time(shaper: Shaper, factor: float) -> None:
    slower = Shaper(shaper.times * factor, shaper.amplitudes)
    once = klipper.smoothing(shaper, square_corner_velocity=0.0)
    assert klipper.smoothing(slower, square_corner_velocity=0.0) == pytest.approx(factor**2 * once, rel=ROUNDING)
    limits = [klipper.maximum_acceleration(s, square_corner_velocity=0.0) for s in (shaper, slower)]
    assert limits[1] * factor**2 == pytest.approx(limits[0], rel=ROUNDING)


@settings(max_examples=60, deadline=None)
@given(shapers(), st.floats(1.05, 3.0))
def test_a_longer_shaper_allows_less_acceleration(shaper: Shaper, factor: float) -> None:
    slower = Shaper(shaper.times * factor, shaper.amplitudes)
    fast, slow = klipper.maximum_acceleration(shaper), klipper.maximum_acceleration(slower)
    assert slow < fast or slow == fast == 0.0


@settings(max_examples=60, deadline=None)
@given(shapers(positive=False), st.floats(0.05, 0.5), st.floats(0.0, 10.0))
def test_maximum_acceleration_is_where_smoothing_meets_its_target(
    shaper: Shaper, target: float, velocity: float
) -> None:
    limit = klipper.maximum_acceleration(shaper, target, velocity)
    if limit == 0.0:
        assert klipper.smoothing(shaper, 0.0, velocity) > target
    elif math.isfinite(limit):
        assert klipper.smoothing(shaper, limit, velocity) == pytest.approx(target, rel=ROUNDING)
    else:
        assert klipper.smoothing(shaper, 1e9, velocity) <= target


def test_a_corner_faster_than_the_target_allows_no_acceleration() -> None:
    assert klipper.maximum_acceleration(klipper.three_hump_ei(48.0), square_corner_velocity=100.0) == 0.0


def test_the_score_gathers_the_measures() -> None:
    psd, shaper = peaks((60.0, 0.05, 1.0)), klipper.ei(62.0)
    found = klipper.score(shaper, (BINS, psd), square_corner_velocity=8.0)
    v, s = klipper.remaining_vibration(shaper, (BINS, psd)), klipper.smoothing(shaper, 5000.0, 8.0)
    assert (found.remaining_vibration, found.smoothing) == (v, s)
    assert found.maximum_acceleration == klipper.maximum_acceleration(shaper, 0.12, 8.0)
    assert found.value == pytest.approx(s * (v**1.5 + 0.2 * v + 0.01), rel=1e-14)


@pytest.mark.parametrize(
    ("frequencies", "psd", "sentence"),
    [
        ([], [], "flat lists of the same length"),
        ([1.0, 2.0], [1.0], "flat lists of the same length"),
        ([[1.0, 2.0]], [1.0, 2.0], "is not a spectrum"),
        ([2.0, 1.0], [1.0, 1.0], "must increase"),
        ([1.0, 1.0], [1.0, 1.0], "must increase"),
        ([-1.0, 1.0], [1.0, 1.0], "0 Hz or more"),
        ([1.0, 2.0], [1.0, -1.0], "negative at 2 Hz"),
        ([1.0, 2.0], [0.0, 0.0], "no vibration"),
        ([1.0, 2.0], [1.0, math.nan], "NaN or infinity"),
        ([1.0, 2.0], ["a", "b"], "must be numbers"),
        ([1.0, 2.0], [[1.0, 2.0], [1.0]], "must be numbers in rows of equal length"),
        ([1.0, 2.0], np.empty((0, 2)), "no dataset"),
        ([1.0, 250.0], [0.0, 1.0], "at or below 200 Hz"),
    ],
)
def test_unusable_spectra_are_refused(frequencies: list[float], psd: list[float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        klipper.remaining_vibration(klipper.zv(50.0), (frequencies, psd))


def test_unusable_settings_are_refused() -> None:
    shaper, psd = klipper.zv(50.0), peaks((60.0, 0.05, 1.0))
    for dampings, sentence in (([], "no damping ratio"), ([1.0], "outside \\[0, 1\\)")):
        with pytest.raises(InputError, match=sentence):
            klipper.remaining_vibration(shaper, (BINS, psd), dampings)
    with pytest.raises(InputError, match="above 0 Hz"):
        klipper.remaining_vibration(shaper, (BINS, psd), maximum_frequency=0.0)
    with pytest.raises(InputError, match="acceleration -1"):
        klipper.smoothing(shaper, -1.0)
    with pytest.raises(InputError, match="square corner velocity"):
        klipper.maximum_acceleration(shaper, square_corner_velocity=math.nan)
    with pytest.raises(InputError, match="target smoothing"):
        klipper.maximum_acceleration(shaper, 0.0)
