"""Klipper's pulses against what the literature says of them: zeros, humps, anchors."""

import numpy as np
import pytest

from preshape import Shaper
from preshape.errors import InputError
from preshape.export import klipper
from preshape.vibration import residual_vibration

ROUNDING = 1e-12
"""Residual at an exact zero: rounding of a few exponentials."""

ANCHOR = 5e-10
"""Half the last digit of the anchors printed in LITERATURE 2.1."""

DAMPINGS = [0.0, 0.03, 0.1, 0.2, 0.3]


def test_anchors_of_zv_and_zvd_at_ten_percent_damping() -> None:
    half = 0.5025189076
    zv, zvd = klipper.zv(1.0, 0.1), klipper.zvd(1.0, 0.1)
    np.testing.assert_allclose(zv.times, [0.0, half], atol=ANCHOR)
    np.testing.assert_allclose(zv.amplitudes, [0.57828618, 0.42171382], atol=1e1 * ANCHOR)
    np.testing.assert_allclose(zvd.times, [0.0, half, 2 * half], atol=2 * ANCHOR)
    np.testing.assert_allclose(zvd.amplitudes, [0.33441491, 0.48774255, 0.17784254], atol=1e1 * ANCHOR)


@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("name", ["zv", "mzv", "zvd"])
def test_nothing_is_left_at_the_mode(name: str, damping: float) -> None:
    shaper = klipper.FAMILIES[name].pulses(47.3, damping)
    assert residual_vibration(shaper, 47.3, damping) < ROUNDING


@pytest.mark.parametrize("damping", DAMPINGS)
def test_mzv_as_published(damping: float) -> None:
    """LITERATURE 2.1: A ~ [1 - 1/sqrt 2, (sqrt 2 - 1) K', (1 - 1/sqrt 2) K'^2] at 0, 3/8, 3/4 of a damped period."""
    root = np.sqrt(1.0 - damping**2)
    k = np.exp(-0.75 * np.pi * damping / root)
    weights = np.array([1 - 0.5**0.5, (2**0.5 - 1) * k, (1 - 0.5**0.5) * k**2])
    shaper = klipper.mzv(20.0, damping)
    np.testing.assert_allclose(shaper.amplitudes, weights / weights.sum(), rtol=1e-13)
    np.testing.assert_allclose(shaper.times, np.array([0.0, 0.375, 0.75]) / (20.0 * root), rtol=1e-13)


@pytest.mark.parametrize("damping", [0.0, 0.1])
@pytest.mark.parametrize(("impulses", "periods"), [(3, 0.6), (4, 0.9), (5, 1.1), (6, 1.0), (10, 2.0)])
def test_generalised_mzv_has_the_zeros_that_klipper_promises(impulses: int, periods: float, damping: float) -> None:
    """Zeros at 1 + i/tau damped frequencies, tau = t (n - 2) / (n - 2 t - 1), where the decay is the mode's own."""
    shaper = klipper.mzv(30.0, damping, impulses=impulses, periods=periods)
    tau = periods * (impulses - 2) / (impulses - 2 * periods - 1)
    ratio = 1.0 + np.arange(impulses - 1) / tau
    decay = damping * 30.0
    damped = ratio * 30.0 * np.sqrt(1.0 - damping**2)
    frequency = np.hypot(decay, damped)
    assert residual_vibration(shaper, frequency, decay / frequency).max() < ROUNDING * 10
    assert len(shaper) == impulses and (shaper.amplitudes > 0.0).all()


def test_ei_meets_its_tolerance_as_well_as_the_published_fit_does() -> None:
    """LITERATURE 2.2: V at the mode is .0488 to .0506 for damping up to 0.2."""
    left = [float(residual_vibration(klipper.ei(50.0, z), 50.0, z)) for z in np.linspace(0.0, 0.2, 41)]
    assert round(min(left), 4) == 0.0488
    assert round(max(left), 4) == 0.0506


def test_two_humps_stay_below_the_tolerance() -> None:
    """LITERATURE 2.2: the largest V in 0.7 to 1.3 f is .050 to .0504 for damping of 0.02 to 0.3, .0537 undamped."""
    ratio = np.linspace(0.7, 1.3, 1201)
    highest = [residual_vibration(klipper.two_hump_ei(1.0, z), ratio, z).max() for z in np.linspace(0.02, 0.3, 29)]
    assert 0.0495 < min(highest) and round(max(highest), 4) <= 0.0504
    assert round(float(residual_vibration(klipper.two_hump_ei(1.0, 0.0), ratio, 0.0).max()), 4) == 0.0537


@pytest.mark.parametrize(("damping", "highest"), [(0.1, 0.055), (0.15, 0.056)])
def test_three_humps_leave_what_the_mended_table_leaves(damping: float, highest: float) -> None:
    """ECOSYSTEM 1.1: the largest V in 0.6 to 1.5 f."""
    ratio = np.linspace(0.6, 1.5, 3601)
    left = residual_vibration(klipper.three_hump_ei(1.0, damping), ratio, damping).max()
    assert round(float(left), 3) == highest


@pytest.mark.parametrize(
    ("name", "frequency", "smoothing", "acceleration"),
    [
        ("zv", 21.0, 0.3491, 1379),
        ("zv", 86.2, 0.0270, 28957),
        ("mzv", 25.0, 0.3259, 1781),
        ("mzv", 75.0, 0.0382, 16571),
        ("ei", 29.0, 0.3918, 1452),
        ("ei", 91.6, 0.0404, 15279),
        ("2hump_ei", 40.4, 0.3469, 1608),
        ("2hump_ei", 117.6, 0.0432, 14654),
        ("3hump_ei", 48.0, 0.3924, 1387),
        ("3hump_ei", 147.8, 0.0435, 14496),
    ],
)
def test_smoothing_and_acceleration_that_klipper_prints(
    name: str, frequency: float, smoothing: float, acceleration: int
) -> None:
    """Printed by Klipper 84104bb: pins every family's impulses, wherever the real spectra are not at hand."""
    shaper = klipper.FAMILIES[name].pulses(frequency, 0.1)
    assert round(klipper.smoothing(shaper), 4) == smoothing
    assert round(klipper.maximum_acceleration(shaper)) == acceleration


@pytest.mark.parametrize("name", klipper.FAMILIES)
def test_every_family_over_its_whole_range(name: str) -> None:
    """Times go with 1/f, amplitudes do not depend on it, all are positive; above its damping limit it refuses."""
    family = klipper.FAMILIES[name]
    assert family.name == name
    for damping in np.linspace(0.0, family.maximum_damping, 9):
        slow, fast = family.pulses(1.0, damping), family.pulses(80.0, damping)
        np.testing.assert_allclose(fast.times * 80.0, slow.times, rtol=1e-14)
        np.testing.assert_allclose(fast.amplitudes, slow.amplitudes, rtol=1e-14)
        assert (slow.amplitudes > 0.0).all()
    with pytest.raises(InputError, match=f"the most that Klipper allows for {name}"):
        family.pulses(50.0, family.maximum_damping + 0.005)
    with pytest.raises(InputError, match="above 0 Hz"):
        family.pulses(0.0, 0.1)


def test_duration_in_damped_periods() -> None:
    expected = {"zv": 0.5, "mzv": 0.75, "zvd": 1.0, "ei": 1.0}
    for name, periods in expected.items():
        shaper = klipper.FAMILIES[name].pulses(10.0, 0.1)
        assert shaper.duration == pytest.approx(periods / (10.0 * np.sqrt(0.99)), rel=1e-14)


def test_the_table_is_klippers() -> None:
    assert [f.name for f in klipper.FAMILIES.values() if f.tuned] == ["zv", "mzv", "ei", "2hump_ei", "3hump_ei"]
    assert [f.minimum_frequency for f in klipper.FAMILIES.values()] == [21.0, 23.0, 29.0, 29.0, 39.0, 48.0]


def test_shapers_survive_json() -> None:
    for family in klipper.FAMILIES.values():
        shaper = family.pulses(61.2, 0.1)
        again = Shaper.from_dict(shaper.to_dict())
        assert again == shaper and again.design.family == family.name
        assert again.design.settings["executed_by"] == "Klipper"


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"impulses": 2}, "whole numbers from 3 to 10"),
        ({"impulses": 11}, "whole numbers from 3 to 10"),
        ({"impulses": 4.0}, "whole numbers from 3 to 10"),
        ({"periods": 1.0}, "n above 2 t \\+ 1"),
        ({"periods": 0.0}, "above 0"),
        ({"periods": float("nan")}, "above 0"),
        ({"impulses": 4, "periods": 0.3}, "refuses negative ones"),
    ],
)
def test_mzv_refuses_what_klipper_refuses(settings: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        klipper.mzv(50.0, 0.1, **settings)


@pytest.mark.parametrize("tolerance", [0.0, 1.0, -0.1, float("nan")])
def test_ei_refuses_a_tolerance_outside_its_range(tolerance: float) -> None:
    with pytest.raises(InputError, match="outside \\(0, 1\\)"):
        klipper.ei(50.0, tolerance=tolerance)
