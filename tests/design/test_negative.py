"""Shapers with negative impulses: the published table, their equations, their ends; what all share is in test_laws.py.

That UM-ZV and PS-ZV are the shortest of their kind is asked in test_negative_shortest.py.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Modes, Shaper, design
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.vibration import residual_vibration

Build = Callable[..., Shaper]

UM, UMD, PS, PSD = (1.0, -1.0, 1.0), (1.0, -1.0, 1.0, -1.0, 1.0), (1.0, -2.0, 2.0), (1.0, -2.0, 2.0, -2.0, 2.0)

ZERO = [
    (design.um_zv, UM, 0, 0.98),
    (design.um_zvd, UMD, 1, 0.935),
    (design.ps_zv, PS, 0, 0.979),
    (design.ps_zvd, PSD, 1, 0.93),
]
"""Family, amplitudes, derivatives, the damping up to which it must be found."""


def um_ei_fine(modes: object) -> Shaper:
    return design.um_ei(modes, 0.0125)


def left_over(shaper: Shaper, frequency: float, damping: float, derivative: int = 0) -> complex:
    """exp(-z w t_N) sum a_i (w (t_i - t_N))^k exp((z + i sqrt(1 - z^2)) w t_i), one term after the other."""
    w = 2.0 * math.pi * frequency
    rate = w * complex(damping, math.sqrt(1.0 - damping**2))
    back = [t - shaper.times[-1] for t in shaper.times]
    return sum(
        (a * (w * t) ** derivative * cmath.exp(rate * t) for a, t in zip(shaper.amplitudes, back, strict=True)), 0j
    )


def width_of_the_band(shaper: Shaper, damping: float, tolerance: float) -> float:
    """Insensitivity at 1 Hz on its own: walk from the mode to where V is above the tolerance, on both sides."""
    from scipy.optimize import brentq

    grid = np.linspace(0.3, 1.8, 15001)
    outside = residual_vibration(shaper, grid, damping) > tolerance * (1.0 + 1e-6)
    below = int(np.flatnonzero(outside & (grid < 1.0))[-1])
    above = int(np.flatnonzero(outside & (grid > 1.0))[0])
    edges = [
        brentq(lambda f: float(residual_vibration(shaper, f, damping)) - tolerance, grid[k], grid[k + 1])
        for k in (below, above - 1)
    ]
    return float(edges[1] - edges[0])


@pytest.mark.parametrize(
    ("build", "damping", "times", "tolerance", "width"),
    [
        (design.um_zv, 0.0, [1 / 6, 1 / 3], 0.05, 0.0551),
        (design.um_zv, 0.1, [0.19680, 0.33572], 0.05, 0.0615),
        (design.um_zvd, 0.0, [0.089513, 0.366234, 0.642955, 0.732468], 0.05, 0.2586),
        (design.um_zvd, 0.1, [0.12031, 0.35983, 0.67456, 0.73853], 0.05, 0.2920),
        (design.um_ei, 0.0, [0.094076, 0.368366, 0.642656, 0.736732], 0.05, 0.35901),
        (design.um_ei, 0.1, [0.127508, 0.363926, 0.673999, 0.742234], 0.05, 0.40457),
        (um_ei_fine, 0.0, [0.090652, 0.366767, 0.642882, 0.733534], 0.0125, 0.18118),
        (um_ei_fine, 0.1, [0.122103, 0.360842, 0.674406, 0.739438], 0.0125, 0.20443),
        (design.ps_zv, 0.0, [math.acos(0.25) / (2 * math.pi), 0.290215], 0.05, 0.0540),
        (design.ps_zv, 0.1, [0.23315, 0.30093], 0.05, 0.0595),
        (design.ps_zvd, 0.0, [0.15241, 0.27740, 0.63131, 0.67895], 0.05, 0.2531),
        (design.ps_zvd, 0.1, [0.17744, 0.28918, 0.66772, 0.70136], 0.05, 0.2855),
    ],
)
def test_times_and_insensitivity_are_those_of_the_table(
    build: Build, damping: float, times: list[float], tolerance: float, width: float
) -> None:
    """LITERATURE 2.3, found there by another solver; the last digits printed are the accuracy."""
    shaper = build((1.0, damping))
    np.testing.assert_allclose(shaper.times[1:], times, atol=6e-6)
    found = width_of_the_band(shaper, damping, tolerance)
    assert found == pytest.approx(width, abs=1.1e-5 if round(width, 4) != width else 6e-5)


@pytest.mark.parametrize(("b", "width"), [(0.25, 0.0596), (0.5, 0.0575), (1.0, 0.0551)])
def test_undamped_specified_amplitude_is_the_closed_form(b: float, width: float) -> None:
    shaper = design.sna_zv((1.0, 0.0), b)
    angle = math.acos(b / (1.0 + b))
    np.testing.assert_allclose(2.0 * np.pi * shaper.times[1:], [angle, 2.0 * angle], atol=1e-13)
    assert width_of_the_band(shaper, 0.0, 0.05) == pytest.approx(width, abs=6e-5)


@pytest.mark.parametrize(("build", "amplitudes", "order", "highest"), ZERO)
def test_the_equations_hold_to_rounding_and_the_amplitudes_are_the_given_ones(
    build: Build, amplitudes: tuple[float, ...], order: int, highest: float
) -> None:
    @given(st.floats(0.0, highest), st.floats(0.01, 1000.0))
    def check(damping: float, frequency: float) -> None:
        shaper = build((frequency, damping))
        assert shaper.amplitudes.tolist() == list(amplitudes)
        for derivative in range(order + 1):
            assert abs(left_over(shaper, frequency, damping, derivative)) <= 1e-13

    check()


@given(st.floats(0.01, 100.0), st.floats(0.0, 0.99))
def test_any_negative_amplitude_is_kept_and_leaves_nothing_up_to_the_damping_where_it_ends(
    b: float, part: float
) -> None:
    """The end in closed form: the last two impulses merge where ZV's own K is (1 - b)/(1 + b)."""
    decay = 2.0 * math.atanh(b) / math.pi if b < 1.0 else math.inf
    end = min(decay / math.hypot(1.0, decay), 0.95) if b < 1.0 else 0.95
    shaper = design.sna_zv((1.0, part * end), b)
    assert shaper.amplitudes.tolist() == [(1.0 + b) / 2.0, -b, (1.0 + b) / 2.0]
    assert abs(left_over(shaper, 1.0, part * end)) <= 1e-13 * max(1.0, b)
    if 0.01 < end < 0.95:
        with pytest.raises(InputError, match=r"two of its impulses merge near damping"):
            design.sna_zv((1.0, 1.001 * end), b)


def test_one_specified_amplitude_is_the_table_s_another_unity_magnitude() -> None:
    np.testing.assert_allclose(design.sna_zv((1.0, 0.1), 0.5).times, [0.0, 0.25495, 0.39772], atol=6e-6)
    np.testing.assert_allclose(design.sna_zv((1.0, 0.3), 1.0).times, design.um_zv((1.0, 0.3)).times, atol=1e-14)


@given(st.floats(1e-6, 0.99), st.floats(0.0, 0.33))
def test_um_ei_has_the_hump_its_top_at_the_mode_and_a_zero_on_both_sides(tolerance: float, damping: float) -> None:
    """All six equations, from the impulses alone; zeros are sought as complex frequencies and turn out to be real."""
    shaper = design.um_ei((1.0, damping), tolerance)
    assert shaper.amplitudes.tolist() == list(UMD)
    value, slope = left_over(shaper, 1.0, damping), left_over(shaper, 1.0, damping, 1)
    assert abs(value) == pytest.approx(tolerance, abs=1e-13)
    rate = complex(damping, math.sqrt(1.0 - damping**2))
    assert abs((value.conjugate() * rate * slope).real) <= 1e-12 * max(tolerance, 1e-2)

    back = 2.0 * math.pi * rate * (shaper.times - shaper.duration)
    spread = math.sqrt(tolerance)
    for side in (-1.0, 1.0):
        grid = 1.0 + side * spread * np.linspace(0.0, 6.0, 2001)
        grid = grid[grid > 0.05]
        vibration = residual_vibration(shaper, np.sort(grid), damping)[:: int(side)]
        first = int(np.argmax((vibration[1:-1] < vibration[:-2]) & (vibration[1:-1] <= vibration[2:]))) + 1
        zero = complex(grid[first])
        for _ in range(8):
            wave = shaper.amplitudes * np.exp(back * zero)
            zero -= wave.sum() / (back * wave).sum()
        assert abs(zero.imag) <= 1e-12 / spread
        assert abs((shaper.amplitudes * np.exp(back * zero.real)).sum()) <= 1e-12
        assert side * (zero.real - 1.0) > 0.3 * spread


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.2, 0.4])
@pytest.mark.parametrize(("build", "amplitudes", "order", "_"), ZERO)
def test_another_solver_finds_the_same_times(
    build: Build, amplitudes: tuple[float, ...], order: int, _: float, damping: float
) -> None:
    """Robertson's C and S sums in undamped periods, growing exponents and all, and MINPACK from the undamped times."""
    from scipy.optimize import fsolve

    w, a = 2.0 * math.pi, np.array(amplitudes)

    def sums(times: np.ndarray, z: float) -> np.ndarray:
        t = np.append(0.0, times)
        rows = [a * t**k * np.exp(z * w * t) for k in range(order + 1)]
        frequency = w * math.sqrt(1.0 - z**2)
        return np.array([part for row in rows for part in (row @ np.cos(frequency * t), row @ np.sin(frequency * t))])

    times = build((1.0, 0.0)).times[1:]
    for z in np.linspace(0.0, damping, 9):
        times = fsolve(sums, times, args=(float(z),), xtol=1e-13)
    np.testing.assert_allclose(build((1.0, damping)).times[1:], times, atol=1e-9)


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.5])
def test_of_all_pairs_of_times_on_a_grid_the_best_is_next_to_um_zv(damping: float) -> None:
    step = 1.0 / 400.0
    grid = np.arange(1, 240) * step
    rate = 2.0 * math.pi * complex(damping, math.sqrt(1.0 - damping**2))
    second, third = np.meshgrid(grid, grid, indexing="ij")
    left = np.abs(1.0 - np.exp(rate * second) + np.exp(rate * third)) * np.exp(-rate.real * third)
    left[third <= second] = np.inf
    best = np.unravel_index(np.argmin(left), left.shape)
    expected = design.um_zv((1.0, damping)).times[1:]
    np.testing.assert_allclose([second[best], third[best]], expected, atol=1.5 * step)


@pytest.mark.parametrize(
    ("build", "damping"),
    [(design.um_zv, 0.9), (design.um_zvd, 0.8), (design.ps_zv, 0.9), (design.ps_zvd, 0.8)],
)
def test_heavily_damped_ones_leave_the_independent_plant_at_rest(build: Build, damping: float) -> None:
    shaper = build((25.0, damping))
    assert ModalPlant((25.0, damping)).impulse_residual(shaper.times, shaper.amplitudes)[0] < 1e-12


@pytest.mark.parametrize(
    ("build", "amplitudes", "fit", "target", "apart"),
    [
        (design.um_zv, UM, [[.16658, .29277, .075438, .21335], [.33323, .0053322, .17914, .20125]], 0.0, 6.1e-4),
        (design.um_zvd, UMD, [[.08945, .28411, .23013, .16401], [.36613, -.08833, .24048, .17001],
                              [.64277, .29103, .23262, .43784], [.73228, .00992, .49385, .38633]], 0.0, 1.8e-4),
        (design.um_ei, UMD, [[.09374, .31903, .13582, .65274], [.36798, -.05894, .13641, .63266],
                             [.64256, .28595, .26334, .24999], [.73664, .00162, .52749, .19208]], 0.05, 1.9e-3),
        (um_ei_fine, UMD, [[.09051, .29315, .20436, .29053], [.36658, -.081044, .21524, .27994],
                           [.64274, .28822, .25424, .34977], [.73339, .006322, .51595, .29764]], 0.0125, 6.5e-4),
        (design.ps_zv, PS, [[.20970, .22441, .08028, .23124], [.29013, .09557, .10346, .24624]], 0.0, 5.5e-4),
    ],
)  # fmt: skip
@pytest.mark.parametrize("damping", [0.0, 0.1, 0.2, 0.3])
def test_published_fits_are_near_and_ours_are_nearer(
    build: Build, amplitudes: tuple[float, ...], fit: list[list[float]], target: float, apart: float, damping: float
) -> None:
    """LITERATURE 2.3: cubic fits of the times in damping; V at the mode is off by up to `apart`, ours by rounding."""
    times = np.append(0.0, np.array(fit) @ damping ** np.arange(4.0))
    ours = build((1.0, damping))
    np.testing.assert_allclose(times, ours.times, atol=4e-4)
    miss = abs(float(residual_vibration(Shaper(times, amplitudes), 1.0, damping)) - target)
    assert 1e-6 < miss < apart
    assert abs(float(residual_vibration(ours, 1.0, damping)) - target) < 1e-13


def test_what_is_recorded_for_several_modes_is_what_the_shaped_step_does() -> None:
    modes = Modes([(1.0, 0.02), (2.7, 0.05), (4.1, 0.0)])
    shaper = design.um_zv(modes)
    assert shaper == design.um_zv(modes[0]) * design.um_zv(modes[1]) * design.um_zv(modes[2])
    step = [shaper.amplitudes[shaper.times <= t].sum() for t in np.linspace(0.0, shaper.duration, 20001)]
    assert shaper.design.settings["lowest_partial_sum"] == pytest.approx(min(step), abs=1e-13)
    assert shaper.design.settings["highest_partial_sum"] == pytest.approx(max(step), abs=1e-13)
    assert max(step) > 1.5  # convolved, it is no unity-magnitude shaper any more
    response = np.abs(np.exp(-2j * np.pi * np.outer(np.linspace(4.1, 41.0, 40001), shaper.times)) @ shaper.amplitudes)
    assert shaper.design.settings["high_frequency_gain"] == pytest.approx(response.max(), rel=1e-5)


def test_the_hump_of_a_convolved_um_ei_is_amplified_by_the_other_mode_s_shaper_and_the_residual_says_so() -> None:
    modes = Modes([(10.0, 0.1), (30.0, 0.02)])
    alone = [design.um_ei(mode) for mode in modes]
    expected = [
        0.05 * float(residual_vibration(other, mode.frequency, mode.damping))
        for mode, other in zip(modes, alone[::-1], strict=True)
    ]
    assert design.um_ei(modes).design.residual == pytest.approx(max(expected), rel=1e-9)
    assert max(expected) > 0.07


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: design.um_zv((1.0, 0.985)), r"no UM-ZV shaper .* merge near damping 0\.981"),
        (lambda: design.um_zvd((1.0, 0.95)), r"no UM-ZVD shaper .* merge near damping 0\.935"),
        (lambda: design.ps_zv((1.0, 0.985)), r"no PS-ZV shaper .* merge near damping 0\.979"),
        (lambda: design.ps_zvd((1.0, 0.94)), r"no PS-ZVD shaper .* merge near damping 0\.930"),
        (lambda: design.um_ei((1.0, 0.8)), r"tolerance 0\.05 .* longer than a damped period near damping 0\.7666"),
        (lambda: um_ei_fine((1.0, 0.9)), r"longer than a damped period near damping 0\.851"),
        (lambda: design.um_ei((1.0, 0.5), 0.5), r"longer than a damped period near damping 0\.478"),
        (lambda: design.sna_zv((1.0, 0.2), 0.25), r"near damping 0\.1605; use zv, or a negative amplitude above 0\.31"),
        (lambda: design.um_ei((1.0, 0.0), 1.0), r"outside \(0, 1\)"),
        (lambda: design.um_ei((1.0, 0.0), 1e-7), "use um_zvd"),
        (lambda: design.sna_zv((1.0, 0.0), 0.0), "above 0 and up to 100"),
        (lambda: design.sna_zv((1.0, 0.0), math.nan), "above 0 and up to 100"),
        (lambda: design.sna_zv((1.0, 0.0), True), "above 0 and up to 100"),
        (lambda: design.um_zv([]), "no mode"),
    ],
)
def test_where_a_family_ends_and_what_is_impossible_is_said(call: Callable[[], Shaper], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call()


def test_the_remedy_for_too_small_a_negative_amplitude_works() -> None:
    with pytest.raises(InputError) as refused:
        design.sna_zv((1.0, 0.2), 0.25)
    above = float(str(refused.value).split("above ")[1].rstrip("."))
    assert design.sna_zv((1.0, 0.2), above + 1e-3).design.residual < 1e-13
