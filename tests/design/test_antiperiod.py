"""Antiperiod shapers: against an independent plant, brute force, and the numbers of the paper."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Mode, Modes, Shaper, design
from preshape.cli.main import preshape as command_line
from preshape.design.antiperiod import paper_conditions
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.vibration import insensitivity

KINDS = ("exact", "exact_robust", "two", "three")
PER_RADIAN = 1.0 / (2.0 * math.pi)
UNDAMPED = [(2.0 * PER_RADIAN, 0.0), (14.0 * PER_RADIAN, 0.0)]


def with_decay(damped_frequency: float, rate: float) -> Mode:
    """The mode exp(-rate t) sin(2 pi damped_frequency t), as the paper writes it."""
    omega = math.hypot(rate, 2.0 * math.pi * damped_frequency)
    return Mode(omega * PER_RADIAN, rate / omega)


DAMPED = [with_decay(w * PER_RADIAN, 0.01 * w) for w in (2.0, 14.0)]
"""Equation (40): exp(-0.02 t) sin(2 t) + exp(-0.14 t) sin(14 t)."""

odd_sets = st.lists(st.integers(0, 10).map(lambda v: 2 * v + 1), min_size=1, max_size=5, unique=True)
dampings = st.lists(st.floats(0.0, 0.3), min_size=5, max_size=5)
commons = st.floats(0.1, 20.0)


def plant_residuals(modes: list[Mode], shaper: Shaper) -> np.ndarray:
    return ModalPlant(modes).impulse_residual(shaper.times, shaper.amplitudes)


@given(odd_sets, dampings, commons)
def test_the_exact_shaper_leaves_nothing_at_any_mode(integers: list[int], ratios: list[float], common: float) -> None:
    modes = [Mode.from_damped_frequency(m * common, z) for m, z in zip(integers, ratios, strict=False)]
    for impulses, factor in (("exact", 1), ("exact_robust", 2)):
        shaper = design.antiperiod(modes, impulses=impulses)
        assert plant_residuals(modes, shaper).max() <= 1e-13
        assert shaper.design.status == "exact" and (shaper.amplitudes > 0.0).all()
        assert len(shaper) <= factor * len(modes) + 1
        assert shaper.design.settings["integers"] == [m // math.gcd(*integers) for m in integers]
        assert shaper.design.settings["subsets"] == [list(range(len(modes)))]
    for mode in modes:  # the last one is the robust one
        waves = np.exp(mode.pole.conjugate() * (shaper.duration - shaper.times))
        assert abs((shaper.amplitudes * shaper.times) @ waves) <= 1e-12 * max(1.0, shaper.duration)


@given(odd_sets.filter(lambda values: len(values) > 1), commons, st.floats(0.0, 0.5))
def test_two_impulses_are_enough_when_the_decay_rates_are_equal(
    integers: list[int], common: float, per_cycle: float
) -> None:
    modes = [with_decay(m * common, per_cycle * common) for m in integers]
    shaper = design.antiperiod(modes)
    assert len(shaper) == 2 and plant_residuals(modes, shaper).max() <= 1e-13
    printed = design.antiperiod(modes, impulses="two")
    np.testing.assert_allclose(printed.amplitudes, shaper.amplitudes, atol=1e-13)


@given(odd_sets.filter(lambda values: len(values) > 1), dampings, commons)
def test_two_impulses_are_not_enough_when_they_differ(integers: list[int], ratios: list[float], common: float) -> None:
    """Impulses a, b leave |a K_i - b| at mode i, so half the difference of two K, a >= 1/2, is left somewhere."""
    modes = [Mode.from_damped_frequency(m * common, z) for m, z in zip(integers, ratios, strict=False)]
    printed = design.antiperiod(modes, impulses="two")
    decays = np.exp([-mode.damping * mode.omega * printed.duration for mode in modes])
    left = plant_residuals(modes, printed)
    np.testing.assert_allclose(left, printed.design.settings["residuals"], atol=1e-13)
    assert left.max() >= 0.25 * (decays.max() - decays.min()) - 1e-13
    exact = design.antiperiod(modes)
    assert (len(exact) == 2) == (decays.max() - decays.min() < 1e-12)


def test_the_undamped_table_of_the_paper() -> None:
    for impulses, amplitudes in (("two", [0.5, 0.5]), ("exact", [0.5, 0.5]), ("three", [0.25, 0.5, 0.25])):
        shaper = design.antiperiod(UNDAMPED, impulses=impulses)
        np.testing.assert_allclose(shaper.times, np.arange(len(amplitudes)) * math.pi / 2.0, rtol=1e-14)
        np.testing.assert_allclose(shaper.amplitudes, amplitudes, rtol=1e-14)
        assert shaper.design.status == "exact"


def test_the_damped_table_of_the_paper() -> None:
    two, three = (design.antiperiod(DAMPED, impulses=count) for count in ("two", "three"))
    np.testing.assert_allclose(two.amplitudes, [0.5484, 0.4516], atol=5e-5)
    assert two.amplitudes[0] / two.amplitudes[1] == pytest.approx(1.21448, abs=1e-5)  # printed 1.2144, cut off
    np.testing.assert_allclose(three.times, [0.0, math.pi / 2.0, math.pi], rtol=1e-14)
    # The paper prints 0.30644, 0.49482, 0.19874: its solver stopped 2e-6 s from the impulse times.
    np.testing.assert_allclose(three.amplitudes, [0.30671, 0.49477, 0.19852], atol=1e-5)
    np.testing.assert_allclose(three.amplitudes, [0.30644, 0.49482, 0.19874], atol=3e-4)


def test_the_sum_condition_holds_and_the_modes_vibrate() -> None:
    def conditions(shaper: Shaper) -> tuple[float, ...]:
        found = paper_conditions(shaper.times, shaper.amplitudes, DAMPED, 2.0 * PER_RADIAN, [1, 7])
        return found.in_phase, found.quadrature, found.quadrature_slope, found.in_phase_slope

    two, three = (design.antiperiod(DAMPED, impulses=count) for count in ("two", "three"))
    assert np.abs(conditions(two)[:2]).max() < 1e-13
    np.testing.assert_allclose(plant_residuals(DAMPED, two), [0.0799, 0.0114], atol=5e-5)
    assert np.abs(np.array(conditions(three))[[0, 1, 3]]).max() < 1e-12 and abs(conditions(three)[2]) > 0.6
    np.testing.assert_allclose(plant_residuals(DAMPED, three), [0.0071, 0.0010], atol=5e-5)
    assert two.design.status == three.design.status == "feasible"
    # The printed impulses: (35) to 1.3e-4, (36) exactly, (38) to 1.5e-3, and (37) not at all.
    printed = Shaper([0.0, math.pi / 2.0, math.pi], [0.30644, 0.49482, 0.19874])
    np.testing.assert_allclose(np.abs(conditions(printed)), [1.3e-4, 0.0, 0.63, 1.5e-3], rtol=0.03, atol=1e-12)
    exact = design.antiperiod(DAMPED)
    np.testing.assert_allclose(exact.amplitudes, [0.28173538, 0.49913994, 0.21912467], atol=5e-9)
    assert plant_residuals(DAMPED, exact).max() < 1e-15 and len(design.antiperiod(DAMPED, impulses="exact_robust")) == 5


def test_the_conditions_are_the_derivatives_that_they_claim_to_be() -> None:
    times, amplitudes, amplitude = np.array([0.0, 1.3, 3.0]), np.array([0.3, 0.5, 0.2]), [1.0, 0.4]

    def phasor(omega: float) -> np.ndarray:
        """(35) and (36) written with sin(m w t) / sin(w t), at any w with the same f(xi)."""
        left = times[-1] - times + 1e-300
        y = sum(
            a * np.exp(-mode.damping * mode.omega / 2.0 * omega * left) * np.sin(m * omega * left)
            for a, m, mode in zip(amplitude, (1, 7), DAMPED, strict=True)
        )
        envelope = y / np.sin(omega * left)
        return (
            amplitudes
            / amplitudes[-1]
            @ np.stack([np.cos(omega * left) * envelope, np.sin(omega * left) * envelope], axis=1)
        )

    found = paper_conditions(times, amplitudes, DAMPED, 2.0 * PER_RADIAN, [1, 7], amplitude)
    np.testing.assert_allclose([found.in_phase, found.quadrature], phasor(2.0), atol=1e-13)
    slope = (phasor(2.0 + 1e-5) - phasor(2.0 - 1e-5)) / 2e-5
    np.testing.assert_allclose([found.in_phase_slope, found.quadrature_slope], slope, rtol=1e-7)


def test_the_three_modes_of_the_paper_and_their_two_subsets() -> None:
    modes = [(w * PER_RADIAN, 0.0) for w in (30.0, 105.0, 385.0)]
    found = design.antiperiod_analysis(modes)
    assert found.common is not None and found.common.frequency == pytest.approx(5.0 * PER_RADIAN, rel=1e-14)
    assert found.common.integers == (6, 21, 77) and found.diophantine_divisors == (24, 12)
    assert (
        not found.exists and found.all_odd is False and found.antiperiod is None and "even multiple 6" in found.reason
    )
    pairs = {pair: design.antiperiod_analysis([modes[i] for i in pair]) for pair in [(0, 1), (0, 2), (1, 2)]}
    assert [one.common.integers for one in pairs.values() if one.common] == [(2, 7), (6, 77), (3, 11)]
    assert [one.exists for one in pairs.values()] == [False, False, True]
    assert pairs[1, 2].antiperiod == pytest.approx(math.pi / 35.0, rel=1e-14)
    shaper, one_each = design.antiperiod(modes), design.zv(modes)
    assert shaper.design.settings["subsets"] == [[0], [1, 2]] and shaper.design.status == "exact"
    assert (len(shaper), round(shaper.duration, 5)) == (4, 0.19448)
    assert (len(one_each), round(one_each.duration, 5)) == (8, 0.14280)  # more impulses, and shorter


def test_robustness_shrinks_with_the_integer() -> None:
    for impulses, width in (("two", 0.0637), ("three", 0.2871)):
        shaper = design.antiperiod(UNDAMPED, impulses=impulses)
        for mode, m in zip(UNDAMPED, (1, 7), strict=True):
            assert insensitivity(shaper, mode, 0.05).value == pytest.approx(width / m, rel=2e-3)


def test_a_deviation_leaves_what_the_documentation_says() -> None:
    modes = [Mode(1.0), Mode(7.0 * 1.0004)]
    shaper = design.antiperiod(modes)
    assert shaper.design.status == "feasible" and shaper.design.settings["integers"] == [1, 7]
    deviations = np.array(shaper.design.settings["deviations"])
    np.testing.assert_allclose(deviations, [0.0002, -0.0002], rtol=1e-2)
    np.testing.assert_allclose(plant_residuals(modes, shaper), math.pi / 2.0 * np.abs(deviations) * [1, 7], rtol=2e-3)
    assert not design.antiperiod_analysis(modes, 0.0).exists


@settings(max_examples=40)
@given(st.lists(st.integers(1, 60), min_size=2, max_size=14, unique=True), commons)
def test_the_subsets_are_as_few_as_the_powers_of_two(integers: list[int], common: float) -> None:
    """Two multiples of one frequency have an antiperiod exactly if the same power of two divides both."""
    modes = [Mode(m * common) for m in integers]
    shaper = design.antiperiod(modes, frequency_tolerance=0.0)
    powers = {m & -m for m in integers}
    assert len(shaper.design.settings["subsets"]) == len(powers)
    assert len(shaper) <= 2 ** len(powers)
    assert sorted(sum(shaper.design.settings["subsets"], [])) == list(range(len(modes)))
    assert plant_residuals(modes, shaper).max() <= 1e-12


def test_of_equally_few_subsets_the_shortest_are_taken() -> None:
    """1 and 3.01 Hz agree within 0.002, 3.01 and 9.06 Hz too, 1 and 9.06 Hz do not."""
    shaper = design.antiperiod([(1.0, 0.0), (3.01, 0.0), (9.06, 0.0)], frequency_tolerance=2e-3)
    assert shaper.design.settings["subsets"] == [[0, 1], [2]]
    assert shaper.duration < 0.56 < 0.5 + 0.5 / 3.02  # {1} and {3.01, 9.06} would take the latter


def test_forty_modes() -> None:
    modes = [(1.7 * (2 * k + 1), 0.0) for k in range(40)]
    shaper = design.antiperiod(modes)
    assert len(shaper) == 2 and shaper.design.residual is not None and shaper.design.residual < 1e-12
    scattered = [(float(f), 0.0) for f in np.random.default_rng(3).uniform(1.0, 50.0, 40)]
    assert not design.antiperiod_analysis(scattered).exists
    with pytest.raises(InputError, match="40 subsets with an antiperiod each"):
        design.antiperiod(scattered, frequency_tolerance=0.0)


@pytest.mark.parametrize("impulses", KINDS)
def test_a_mode_alone_gets_zv_or_zvd(impulses: str) -> None:
    shaper = design.antiperiod((5.0, 0.1), impulses=impulses)
    same = design.zv((5.0, 0.1)) if impulses in ("exact", "two") else design.zvd((5.0, 0.1))
    np.testing.assert_allclose(shaper.times, same.times, rtol=1e-14)
    np.testing.assert_allclose(shaper.amplitudes, same.amplitudes, rtol=1e-12)


@pytest.mark.parametrize("impulses", KINDS)
def test_a_file_gives_back_the_same_shaper_and_design(impulses: str) -> None:
    shaper = design.antiperiod([*DAMPED, (5.0, 0.02)], impulses=impulses)
    again = Shaper.from_dict(json.loads(json.dumps(shaper.to_dict())))
    assert again == shaper and again.design == shaper.design
    assert len(shaper.design.settings["residuals"]) == 3 and shaper.design.modes == Modes([*DAMPED, (5.0, 0.02)])


def test_wrong_input_is_refused() -> None:
    for arguments, sentence in (
        ({"impulses": "four"}, "give one of 'exact'"),
        ({"frequency_tolerance": 0.1}, "above 0.05"),
        ({"frequency_tolerance": -1e-3}, "give 0"),
        ({"mode_amplitudes": [1.0, 1.0]}, "leave them out"),
        ({"impulses": "two", "mode_amplitudes": [1.0]}, "give one a mode"),
        ({"impulses": "two", "mode_amplitudes": [7.0, -1.0]}, "no positive impulses"),
    ):
        with pytest.raises(InputError, match=sentence):
            design.antiperiod(DAMPED, **arguments)
    with pytest.raises(InputError, match="no positive impulses"):
        design.antiperiod([(1.0, 0.0), Mode.from_damped_frequency(7.0, 0.3)], impulses="three")


def test_the_command_line_designs_it(tmp_path: object) -> None:
    words = "design --family antiperiod --mode 15 --mode 55 --impulses three --frequency-tolerance 0.01 --json -"
    result = CliRunner().invoke(command_line, words.split(), catch_exceptions=False)
    assert result.exit_code == 0
    assert Shaper.from_dict(json.loads(result.output)) == design.antiperiod(
        [(15.0, 0.0), (55.0, 0.0)], impulses="three", frequency_tolerance=0.01
    )
    refused = CliRunner().invoke(command_line, "design --family antiperiod --mode 15 --order 1".split())
    assert "does not take --order" in str(refused.exception)
