"""The warning value of shapers with negative impulses: the largest gain of their impulses over a range."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.vibration import high_frequency_gain

IMPULSES = st.lists(
    st.tuples(st.floats(0.01, 1.0), st.floats(-3.0, 3.0).filter(lambda a: abs(a) > 0.01)), min_size=1, max_size=7
)


def shaper_of(impulses: list[tuple[float, float]]) -> Shaper:
    """Gaps and amplitudes as a shaper; the first amplitude is what makes the sum 1."""
    times = np.append(0.0, np.cumsum([gap for gap, _ in impulses]))
    rest = np.array([amplitude for _, amplitude in impulses])
    return Shaper(times, np.append(1.0 - rest.sum(), rest))


def gain_at(shaper: Shaper, frequencies: np.ndarray) -> np.ndarray:
    return np.abs(np.exp(-2j * np.pi * np.multiply.outer(frequencies, shaper.times)) @ shaper.amplitudes)


@pytest.mark.parametrize("frequency", [0.3, 10.0, 250.0])
def test_undamped_um_zv_triples_its_mode_s_third_multiple(frequency: float) -> None:
    """|F| = |2 cos(pi f / 3 f0) - 1|, at most 3, first at f = 3 f0."""
    gain = high_frequency_gain(design.um_zv((frequency, 0.0)), frequency)
    assert gain.value == pytest.approx(3.0, abs=1e-13)
    assert gain.frequency == pytest.approx(3.0 * frequency, rel=1e-9)
    assert (gain.low, gain.high, gain.bound) == (frequency, 10.0 * frequency, 3.0)


@given(IMPULSES, st.floats(0.1, 5.0))
def test_nothing_in_the_range_is_higher_and_the_value_is_reached(
    impulses: list[tuple[float, float]], above: float
) -> None:
    shaper = shaper_of(impulses)
    gain = high_frequency_gain(shaper, above)
    assert gain.low <= gain.frequency <= gain.high
    assert gain_at(shaper, np.array([gain.frequency]))[0] == pytest.approx(gain.value, rel=1e-11)
    dense = gain_at(shaper, np.linspace(above, 10.0 * above, 20011))
    assert dense.max() <= gain.value * (1.0 + 1e-12) <= gain.bound * (1.0 + 1e-11)
    assert gain.bound == pytest.approx(np.abs(shaper.amplitudes).sum())


@given(st.lists(st.tuples(st.floats(0.01, 1.0), st.floats(0.01, 1.0)), min_size=1, max_size=7), st.floats(0.1, 5.0))
def test_positive_impulses_never_amplify(impulses: list[tuple[float, float]], above: float) -> None:
    times = np.cumsum([gap for gap, _ in impulses])
    shaper = Shaper.normalised(times, [amplitude for _, amplitude in impulses])
    assert high_frequency_gain(shaper, above).value <= 1.0 + 1e-12


def test_an_unmodelled_mode_at_that_frequency_does_ring_that_much() -> None:
    shaper = design.um_ei((10.0, 0.05))
    gain = high_frequency_gain(shaper, 10.0)
    assert gain.value > 4.0
    plant = ModalPlant((gain.frequency, 0.0))
    assert plant.impulse_residual(shaper.times, shaper.amplitudes)[0] == pytest.approx(gain.value, rel=1e-9)


def test_impulses_on_a_common_grid_reach_the_bound_and_others_come_near_it_further_up() -> None:
    comb = Shaper(0.01 * np.arange(5), [1.0, -2.0, 3.0, -2.0, 1.0])
    found = high_frequency_gain(comb, 10.0)
    assert found.value == pytest.approx(found.bound, rel=1e-12) and found.bound == 9.0
    assert found.frequency == pytest.approx(50.0, rel=1e-9)

    shaper = design.um_zvd((1.0, 0.1))
    reached = [high_frequency_gain(shaper, 1.0, up_to).value for up_to in (2.0, 10.0, 100.0, 10_000.0)]
    assert reached == sorted(reached)
    assert reached[1] < 4.8 and 4.99 < reached[-1] <= 5.0


def test_the_value_at_the_start_of_the_range_counts() -> None:
    """ZV falls from its mode's double frequency on; over a range in which it only falls the start is the largest."""
    gain = high_frequency_gain(design.zv((1.0, 0.0)), 2.0, 2.5)
    assert gain.frequency == 2.0 and gain.value == pytest.approx(1.0, abs=1e-14)
    rising = high_frequency_gain(design.zv((1.0, 0.0)), 1.0, 1.5)
    assert rising.frequency == 1.5 and rising.value == pytest.approx(math.sqrt(0.5), abs=1e-14)


def test_a_single_impulse_leaves_everything_as_it_is() -> None:
    assert high_frequency_gain(Shaper([0.0], [1.0]), 5.0).value == 1.0


def test_a_range_too_long_to_search_is_cut_and_the_warning_value_is_then_the_bound() -> None:
    shaper = design.um_zv([(1e-3, 0.0), (1000.0, 0.0)])
    gain = high_frequency_gain(shaper, 1000.0)
    assert 1000.0 < gain.high < 10_000.0
    assert shaper.design.settings["high_frequency_gain"] == gain.bound == 9.0


@pytest.mark.parametrize(
    ("above", "up_to", "sentence"),
    [(0.0, None, "above 0 Hz"), (math.nan, None, "finite"), (2.0, 1.0, "is empty"), (1.0, -1.0, "above 0 Hz")],
)
def test_impossible_ranges_are_refused(above: float, up_to: float | None, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        high_frequency_gain(design.zv((1.0, 0.0)), above, up_to)
