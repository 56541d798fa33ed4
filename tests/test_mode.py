from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Mode, Modes
from preshape.errors import InputError
from preshape.mode import one_mode


@given(st.floats(1e-3, 1e4), st.floats(0.0, 0.99))
def test_the_pole_has_the_mode_s_frequency_and_damping(frequency: float, damping: float) -> None:
    pole = Mode(frequency, damping).pole
    assert abs(pole) == pytest.approx(2.0 * math.pi * frequency, rel=1e-12)
    assert -pole.real / abs(pole) == pytest.approx(damping, abs=1e-12)


@given(st.floats(1e-3, 1e4), st.floats(0.0, 0.99))
def test_a_damped_frequency_is_converted_at_the_border(damped: float, damping: float) -> None:
    assert Mode.from_damped_frequency(damped, damping).omega_d == pytest.approx(2.0 * math.pi * damped, rel=1e-12)


def test_decay_over_half_a_damped_period_is_that_of_the_free_vibration() -> None:
    mode = Mode(3.0, 0.07)
    assert mode.decay_per_half_period == pytest.approx(math.exp(mode.pole.real * mode.damped_period / 2.0), rel=1e-14)


@pytest.mark.parametrize("given", [(1.0, 0.1), Mode(1.0, 0.1), [Mode(1.0, 0.1)], [(1.0, 0.1)], [[1.0, 0.1]]])
def test_everything_that_reads_as_a_mode_is_one(given: object) -> None:
    assert one_mode(given) == Mode(1.0, 0.1)


@pytest.mark.parametrize(
    ("modes", "sentence"),
    [
        ([], "no mode was given"),
        ([(0.0, 0.1)], "above 0 Hz"),
        ([(-3.0, 0.1)], "above 0 Hz"),
        ([(math.nan, 0.1)], "finite value"),
        ([(math.inf, 0.1)], "finite value"),
        ([(1.0, 1.0)], r"outside \[0, 1\)"),
        ([(1.0, -0.1)], r"outside \[0, 1\)"),
        ([(1.0, math.nan)], r"outside \[0, 1\)"),
        ([("1", 0.1)], "must be a number"),
        ([(True, 0.1)], "must be a number"),
        ([(1.0, 0.1), (2.0, 0.1), (1.0, 0.1)], "given twice"),
        ([(1.0, 0.1, 3.0)], "is not a mode"),
        ("1:0.1", "is not a mode"),
        (5.0, "is not a mode"),
        ([1.0, 0.1], "is not a mode"),  # a flat list might as well be two frequencies
    ],
)
def test_what_is_no_mode_is_refused_with_the_rule(modes: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Modes(modes)


def test_modes_are_an_immutable_sequence() -> None:
    modes = Modes([(2.0, 0.1), (1.0, 0.0)])
    assert [mode.frequency for mode in modes] == [2.0, 1.0]
    assert modes[1:] == Modes((1.0, 0.0))
    assert hash(modes) == hash(Modes([Mode(2.0, 0.1), Mode(1.0)]))
    with pytest.raises(TypeError):
        modes[0] = Mode(1.0)
