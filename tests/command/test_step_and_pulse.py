"""Step, pulse, and Command itself."""

import math

import numpy as np
import pytest

from preshape.command import Command, pulse, step
from preshape.errors import InputError


def test_step_starts_at_rest_and_steps_when_told() -> None:
    command = step(3.0, dt=0.1, start=0.3, rest=0.2)
    np.testing.assert_array_equal(command.values, [0, 0, 0, 3, 3, 3])
    assert command.duration == pytest.approx(0.3, rel=1e-15)
    np.testing.assert_allclose(command.times, [0, 0.1, 0.2, 0.3, 0.4, 0.5], rtol=1e-15)


@pytest.mark.parametrize("dt", [0.1, 1e-3, 1 / 3200, 7e-5])
def test_pulse_has_its_area_under_a_held_output(dt: float) -> None:
    width = 7 * dt
    command = pulse(-2.0, width=width, dt=dt, rest=5 * dt, quantity="force [N]")
    assert command.values.sum() * dt == pytest.approx(-2.0 * width, rel=1e-14)
    assert command.values[0] == 0.0 and command.values[-1] == 0.0
    assert command.duration == pytest.approx(8 * dt, rel=1e-14)
    assert command.quantity == "force [N]"


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: step(0.0, dt=0.1), "height is 0"),
        (lambda: step(math.nan, dt=0.1), "height is nan"),
        (lambda: step(dt=0.0), "dt is 0 s"),
        (lambda: step(dt=0.1, start=0.0), "start is 0 s: give a value above 0"),
        (lambda: step(dt=0.1, start=0.25), "not a whole number of samples of 0.1 s: give 0.2 s or 0.3 s"),
        (lambda: step(dt=0.1, start=0.05), "give 0.1 s, or another dt"),
        (lambda: step(dt=0.1, rest=-1.0), "rest is -1 s"),
        (lambda: pulse(1.0, width=0.0333, dt=1e-3), "width is 0.0333 s, not a whole number"),
        (lambda: pulse(1.0, width=-0.1, dt=1e-3), "width is -0.1 s"),
        (lambda: pulse(1.0, width=1e9, dt=1e-3), "more than the 20,000,000"),
        (lambda: Command(0.1, np.array([1.0, 2.0]), "position [m]", 0.1), "the first value is 1"),
        (lambda: Command(0.1, np.array([]), "position [m]", 0.1), "at least one sample"),
        (lambda: Command(0.1, np.zeros((2, 2)), "position [m]", 0.1), r"shape \(2, 2\)"),
        (lambda: Command(0.1, np.array([0.0, math.inf]), "position [m]", 0.1), "infinity at sample 1"),
        (lambda: Command(0.1, np.zeros(3), "position [m]", 0.1, np.zeros(2)), "velocity has 2 samples"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()


def test_a_command_cannot_be_changed_behind_its_back() -> None:
    given = np.array([0.0, 1.0])
    command = Command(0.1, given, "position [m]", 0.1)
    given[1] = 5.0
    assert command.values[1] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        command.values[1] = 2.0
