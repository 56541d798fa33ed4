from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.vibration import insensitivity, residual_vibration, tolerated_bands, total_insensitivity

HUMPS = {"ei": design.ei, "two-hump": design.two_hump_ei, "three-hump": design.three_hump_ei}


@pytest.mark.parametrize("tolerance", [0.01, 0.05, 0.1, 0.3])
@pytest.mark.parametrize("order", [0, 1, 2, 3, 4])
def test_undamped_zvdk_has_its_closed_form(order: int, tolerance: float) -> None:
    expected = 4.0 / math.pi * math.asin(tolerance ** (1.0 / (order + 1)))
    assert insensitivity(design.zvdk((7.0, 0.0), order), (7.0, 0.0), tolerance).value == pytest.approx(
        expected, rel=1e-10
    )


@pytest.mark.parametrize(("name", "humps"), [("ei", 1), ("two-hump", 2), ("three-hump", 3)])
@pytest.mark.parametrize("tolerance", [0.0125, 0.05, 0.1])
def test_undamped_ei_has_its_closed_form_across_touching_humps(name: str, humps: int, tolerance: float) -> None:
    n = humps + 1
    expected = 4.0 / math.pi * math.asin(1.0 / math.cosh(math.acosh(1.0 / tolerance) / n))
    found = insensitivity(HUMPS[name]((7.0, 0.0), tolerance), (7.0, 0.0), tolerance)
    assert found.value == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("family", "damping", "value"),
    [
        ("zv", 0.05, 0.0690),
        ("zv", 0.1, 0.0751),
        ("zv", 0.2, 0.0905),
        ("zvd", 0.05, 0.3117),
        ("zvd", 0.1, 0.3402),
        ("zvd", 0.2, 0.4141),
        ("zvdd", 0.1, 0.5744),
        ("zvdd", 0.2, 0.7180),
        ("mzv", 0.0, 0.1035),
        ("mzv", 0.1, 0.1341),
        ("mzv", 0.2, 0.1824),
        ("ei", 0.1, 0.472),
    ],
)
def test_damped_values_of_the_literature_digest(family: str, damping: float, value: float) -> None:
    """LITERATURE 2.1 and 2.2, computed there by another program, to its printed digits."""
    shaper = design.FAMILIES[family]((1.0, damping))
    digits = 3 if value == 0.472 else 4
    assert round(insensitivity(shaper, (1.0, damping)).value, digits) == value


def test_edges_are_roots_not_grid_points() -> None:
    shaper = design.direct([(1.0, 0.02), (2.7, 0.0)])
    for damping in (0.0, 0.02, 0.2):
        for low, high in tolerated_bands(shaper, 0.05, damping, 0.3, 6.0):
            for edge in (low, high):
                if 0.3 < edge < 6.0:
                    assert residual_vibration(shaper, edge, damping) == pytest.approx(0.05, abs=1e-12)


def test_the_bands_are_all_there_is_within_the_tolerance() -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        shaper = Shaper.normalised(np.append(0.0, np.sort(rng.random(6)) * 3.0), rng.random(7) + 0.05)
        damping = float(rng.choice([0.0, 0.03, 0.2]))
        bands = tolerated_bands(shaper, 0.15, damping, 0.0, 8.0)
        f = np.linspace(0.0, 8.0, 20_001)
        inside = np.zeros(f.size, dtype=bool)
        for low, high in bands:
            inside |= (f >= low) & (f <= high)
        v = residual_vibration(shaper, f, damping)
        clear = np.abs(v - 0.15) > 1e-9
        np.testing.assert_array_equal(inside[clear], (v <= 0.15)[clear])


def test_a_mode_outside_the_tolerance_has_no_band_and_an_open_band_is_infinite() -> None:
    assert insensitivity(design.zv((1.0, 0.0)), (1.5, 0.0)).value == 0.0
    heavy = design.ei((1.0, 0.3), 0.2)  # its last impulse is smaller than the tolerance
    assert heavy.amplitudes[-1] < 0.2
    assert insensitivity(heavy, (1.0, 0.3), 0.2).value == math.inf


def test_a_hump_a_little_too_high_breaks_the_band() -> None:
    shaper = design.ei((1.0, 0.1), 0.05)
    assert insensitivity(shaper, (1.0, 0.1), 0.05).value > 0.4
    assert insensitivity(shaper, (1.0, 0.1), 0.04999).value == 0.0
    beside = insensitivity(shaper, (0.85, 0.1), 0.04999)
    assert 0.0 < beside.value < 0.3 and beside.high < 1.0


def test_total_insensitivity_is_the_area_of_a_fine_map() -> None:
    shaper = design.zvd((10.0, 0.05))
    area = total_insensitivity(shaper, (10.0, 0.05), 0.05)
    f, z = np.linspace(5.0, 15.0, 4001), np.linspace(0.0, 0.2, 401)
    fine = np.array([residual_vibration(shaper, f, float(damping)) <= 0.05 for damping in z]).mean() * 1.0 * 0.2
    assert area == pytest.approx(fine, rel=3e-3)
    assert area < total_insensitivity(design.zvdd((10.0, 0.05)), (10.0, 0.05), 0.05)


@pytest.mark.parametrize("tolerance", [0.0, 1.0, -0.1, 5.0, math.nan])
def test_a_tolerance_is_a_fraction(tolerance: float) -> None:
    with pytest.raises(InputError, match=r"outside \(0, 1\)"):
        insensitivity(design.zv((1.0, 0.0)), (1.0, 0.0), tolerance)
    with pytest.raises(InputError, match=r"outside \(0, 1\)"):
        tolerated_bands(design.zv((1.0, 0.0)), tolerance, 0.0, 0.5, 1.5)


def test_an_empty_range_is_refused() -> None:
    with pytest.raises(InputError, match="is empty"):
        tolerated_bands(design.zv((1.0, 0.0)), 0.05, 0.0, 2.0, 1.0)


@pytest.mark.parametrize("seed", range(25))
def test_the_band_found_outwards_is_the_one_among_all_bands(seed: int) -> None:
    """`tolerated_bands` locates every extremum of V in the range; the search from the mode only those it needs."""
    rng = np.random.default_rng(seed)
    modes = [(float(f), float(rng.choice([0.0, 0.01, 0.05, 0.2]))) for f in np.cumsum(rng.uniform(1.0, 20.0, 3))]
    family = str(rng.choice(["zv", "zvd", "ei", "mzv", "two_hump_ei", "ps_zv", "um_zv"]))
    shaper, tolerance = design.FAMILIES[family](modes), float(rng.choice([0.01, 0.05, 0.1, 0.3]))
    for f, damping in modes:
        found = insensitivity(shaper, (f, damping), tolerance)
        if residual_vibration(shaper, f, damping) > tolerance:  # an EI hump of 5 % where 1 % is allowed
            assert found.value == 0.0
            continue
        bands = tolerated_bands(shaper, tolerance, damping, 0.0, 4.0 * f)
        low, high = next((a, b) for a, b in bands if a <= f * (1.0 + 1e-8) and f <= b * (1.0 + 1e-8))
        assert found.low == pytest.approx(low, abs=1e-12 * f)
        assert found.high == pytest.approx(high, abs=1e-12 * f) if high < 4.0 * f else found.high >= high
