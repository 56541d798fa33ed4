"""What is particular to one family; what all share is in test_laws.py."""

from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Modes, design
from preshape.errors import InputError
from preshape.vibration import insensitivity, residual_vibration


def test_zvd_is_singer_and_seering_s() -> None:
    """LITERATURE 2.1, anchors at z = 0.1, 1 Hz."""
    zv, zvd = design.zv((1.0, 0.1)), design.zvd((1.0, 0.1))
    np.testing.assert_allclose(zv.amplitudes, [0.57828618, 0.42171382], atol=5e-9)
    np.testing.assert_allclose(zvd.amplitudes, [0.33441491, 0.48774255, 0.17784254], atol=5e-9)
    np.testing.assert_allclose(zvd.times, [0.0, 0.5025189076, 1.0050378152], atol=5e-11)


@pytest.mark.parametrize(
    ("damping", "amplitudes", "times"),
    [
        (0.1, [0.35471, 0.45342, 0.19187], [0.0, 0.50513, 1.00092]),
        (0.2, [0.46122, 0.40455, 0.13423], [0.0, 0.51860, 1.00911]),
    ],
)
def test_damped_ei_is_the_exact_numeric_one(damping: float, amplitudes: list[float], times: list[float]) -> None:
    """LITERATURE 2.2, found there by another solver."""
    shaper = design.ei((1.0, damping), 0.05)
    np.testing.assert_allclose(shaper.amplitudes, amplitudes, atol=6e-6)
    np.testing.assert_allclose(shaper.times, times, atol=6e-6)


@pytest.mark.parametrize("tolerance", [0.001, 0.0125, 0.05, 0.1, 0.3])
def test_undamped_ei_and_humps_are_the_classical_formulas(tolerance: float) -> None:
    """LITERATURE 2.2: EI, two-hump and three-hump in radicals, not by Chebyshev polynomials."""
    v = tolerance
    np.testing.assert_allclose(design.ei((1.0, 0.0), v).amplitudes, [(1 + v) / 4, (1 - v) / 2, (1 + v) / 4], atol=1e-12)
    x = (v**2 * (math.sqrt(1 - v**2) + 1)) ** (1 / 3)
    a = (3 * x**2 + 2 * x + 3 * v**2) / (16 * x)
    np.testing.assert_allclose(design.two_hump_ei((1.0, 0.0), v).amplitudes, [a, 0.5 - a, 0.5 - a, a], atol=1e-12)
    a, b = (1 + 3 * v + 2 * math.sqrt(2 * (v**2 + v))) / 16, (1 - v) / 4
    np.testing.assert_allclose(
        design.three_hump_ei((1.0, 0.0), v).amplitudes, [a, b, 1 - 2 * (a + b), b, a], atol=1e-12
    )


def test_published_damped_ei_fit_misses_the_tolerance_and_ours_does_not() -> None:
    """LITERATURE 2.2: the fit's hump at the mode is off by some percent of itself; ours by rounding."""
    z, v = 0.2, 0.05
    a1 = 0.24968 + 0.24961 * v + 0.80008 * z + 1.23328 * v * z + 0.49599 * z**2 + 3.17316 * v * z**2
    a3 = 0.25149 + 0.21474 * v - 0.83249 * z + 1.41498 * v * z + 0.85181 * z**2 - 4.90094 * v * z**2
    td = 1.0 / math.sqrt(1.0 - z**2)
    t2 = td * (
        0.49990 + 0.46159 * v * z + 4.26169 * v * z**2 + 1.75601 * v * z**3
        + 8.57843 * v**2 * z - 108.644 * v**2 * z**2 + 336.989 * v**2 * z**3
    )  # fmt: skip
    from preshape import Shaper

    published = Shaper([0.0, t2, td], [a1, 1.0 - a1 - a3, a3])
    assert abs(float(residual_vibration(published, 1.0, z)) / v - 1.0) > 0.005
    assert abs(float(residual_vibration(design.ei((1.0, z), v), 1.0, z)) / v - 1.0) < 1e-10


def test_the_damping_at_which_humps_end_is_said() -> None:
    with pytest.raises(InputError, match=r"no 3-hump EI shaper .* end near damping 0\.32"):
        design.three_hump_ei((1.0, 0.35), 0.05)
    assert design.three_hump_ei((1.0, 0.31), 0.05).design.status == "exact"


def test_mzv_lies_between_zv_and_zvd() -> None:
    for damping in (0.0, 0.1):
        bands = [insensitivity(f((1.0, damping)), (1.0, damping)).value for f in (design.zv, design.mzv, design.zvd)]
        assert bands[0] < bands[1] < bands[2]
        assert design.mzv((1.0, damping)).duration == pytest.approx(0.75 / math.sqrt(1.0 - damping**2))


def test_convolved_is_the_product_and_names_its_base() -> None:
    modes = Modes([(1.0, 0.05), (3.3, 0.02)])
    shaper = design.convolved(modes, "ei", tolerance=0.02)
    assert shaper == design.ei(modes[0], 0.02) * design.ei(modes[1], 0.02)
    assert shaper.design.settings == {"base": "ei", "humps": 1, "tolerance": 0.02}
    assert design.convolved(modes).duration == pytest.approx(sum(design.zvd(mode).duration for mode in modes))


@pytest.mark.parametrize(("low", "high"), [(9.0, 11.0), (8.0, 12.0), (5.0, 15.0), (30.0, 31.0), (2.0, 9.0)])
@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_a_band_is_covered_from_edge_to_edge_and_not_with_a_hump_too_many(
    low: float, high: float, damping: float
) -> None:
    shaper = design.ei_for_band(low, high, 0.05, damping)
    inside = residual_vibration(shaper, np.linspace(low, high, 5001), damping)
    assert inside.max() <= 0.05 * (1.0 + 1e-7)
    humps = shaper.design.settings["humps"]
    if humps > 1:
        fewer = design.k_hump_ei((1.0, damping), humps - 1, 0.05)
        band = insensitivity(fewer, (1.0, damping), 0.05)
        assert band.high / band.low < high / low


def test_on_grid_keeps_the_delay_and_reports_what_it_costs() -> None:
    exact = design.zvd((47.3, 0.05))
    coarse, fine = design.on_grid(exact, 1e-3), design.on_grid(exact, 1e-5)
    np.testing.assert_allclose(np.rint(coarse.times / 1e-3), coarse.times / 1e-3, atol=1e-9)
    assert coarse.centroid == pytest.approx(exact.centroid, rel=1e-12)
    assert coarse.design.residual == pytest.approx(float(residual_vibration(coarse, 47.3, 0.05)))
    assert fine.design.residual < 1e-3 * coarse.design.residual
    assert coarse.design.status == "feasible" and coarse.design.settings["dt"] == 1e-3
    assert design.on_grid(design.direct((10.0, 0.0)), 0.01).design.certificate is None


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: design.ei((1.0, 0.0), 0.0), r"outside \(0, 1\)"),
        (lambda: design.ei((1.0, 0.0), 1.0), r"outside \(0, 1\)"),
        (lambda: design.ei((1.0, 0.0), math.nan), r"outside \(0, 1\)"),
        (lambda: design.k_hump_ei((1.0, 0.0), 0), "from 1 to 8"),
        (lambda: design.k_hump_ei((1.0, 0.0), 2.5), "from 1 to 8"),
        (lambda: design.zvdk((1.0, 0.0), -1), "from 0 to 30"),
        (lambda: design.zv([]), "no mode"),
        (lambda: design.zv([(1.0, 0.0), (1.0, 0.0)]), "given twice"),
        (lambda: design.convolved((1.0, 0.0), "zvx"), "no family 'zvx'"),
        (lambda: design.ei_for_band(2.0, 1.0), "is empty"),
        (lambda: design.ei_for_band(0.0, 1.0), "is empty"),
        (lambda: design.ei_for_band(0.01, 100.0), "narrow the band"),
        (lambda: design.on_grid(design.zv((1.0, 0.0)), 0.0), "sample time"),
    ],
)
def test_impossible_wishes_are_refused_with_the_rule(call: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call()
