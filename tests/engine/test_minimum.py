"""The door of the engine: every kind of constraint, what is infeasible and why, and what is preferred."""

from __future__ import annotations

import numpy as np
import pytest

from preshape import Band, Mode, design
from preshape.engine import (
    AtMostImpulses,
    ImpulsesBetween,
    ResponseBetween,
    ServoGrid,
    VibrationAtMost,
    ZeroVibration,
    minimum_duration,
)
from preshape.errors import InputError

TWO = [ZeroVibration(Mode(1.0), 1), ZeroVibration(Mode(2.3), 1)]


def left(times: np.ndarray, amplitudes: np.ndarray, frequency: float) -> float:
    return float(abs((amplitudes * np.exp(2j * np.pi * frequency * times)).sum()))


def test_zero_vibration_is_what_direct_gives() -> None:
    found = minimum_duration(TWO)
    assert found.status == "optimal" and found.certificate is not None and found.gap == 0.0
    assert found.times[-1] == pytest.approx(design.direct([(1.0, 0.0), (2.3, 0.0)]).duration, rel=1e-12)


def test_bounded_impulses_on_a_grid() -> None:
    """No impulse above a quarter: longer than without the bound, and the bound is kept."""
    grid = ServoGrid(0.01)
    free = minimum_duration([ZeroVibration(Mode(1.0)), ImpulsesBetween(0.0, 1.0), grid])
    bounded = minimum_duration([ZeroVibration(Mode(1.0)), ImpulsesBetween(0.0, 0.2), grid])
    assert free.times[-1] == pytest.approx(0.5, abs=1e-9) and free.status == bounded.status == "optimal"
    assert bounded.amplitudes.max() <= 0.2 + 1e-7 and bounded.amplitudes.min() >= -1e-9
    assert bounded.times[-1] > free.times[-1] and left(bounded.times, bounded.amplitudes, 1.0) < 1e-7


def test_an_actuator_level_is_a_bounded_response() -> None:
    """The shaped command of a unit pulse of 0.1 s stays below 0.4 at all times: impulses that overlap are spread."""
    dt = 0.02
    pulse = ResponseBetween(lambda t: np.where(t < 0.1 - 1e-9, 1.0, 0.0), 0.0, 0.4, dt, until=0.2)
    found = minimum_duration([ZeroVibration(Mode(1.0)), ImpulsesBetween(0.0, 1.0), pulse, ServoGrid(dt)])
    assert found.status == "optimal"
    times = np.arange(0.0, found.times[-1] + 0.2, dt)
    level = np.array(
        [found.amplitudes[(t - found.times >= -1e-9) & (t - found.times < 0.1 - 1e-9)].sum() for t in times]
    )
    assert level.max() <= 0.4 + 1e-6 and left(found.times, found.amplitudes, 1.0) < 1e-7


def test_few_impulses_on_a_grid() -> None:
    found = minimum_duration([ZeroVibration(Mode(1.0)), ServoGrid(0.05), AtMostImpulses(2)])
    assert found.times.size == 2 and found.times[-1] == pytest.approx(0.5) and left(*_both(found), 1.0) < 1e-9


def _both(found: object) -> tuple[np.ndarray, np.ndarray]:
    return found.times, found.amplitudes  # type: ignore[attr-defined]


@pytest.mark.parametrize("longest", [0.5, 0.9, 1.2])
def test_a_duration_that_is_too_short_names_the_shortest(longest: float) -> None:
    ways = [
        [VibrationAtMost(Band(0.9, 1.1), 0.05)],
        [VibrationAtMost(Band(0.9, 1.1), 0.05), ServoGrid(0.1)],
        [VibrationAtMost(Band(0.9, 1.1), 0.05), VibrationAtMost(Band(2.7, 3.3), 0.05), AtMostImpulses(5)],
    ]
    for asked in ways:
        free = minimum_duration(asked)
        found = minimum_duration(asked, longest=longest)
        if free.times[-1] <= longest:
            assert found.status == free.status and found.times[-1] == free.times[-1]
        else:
            assert found.status == "infeasible" and f"takes {free.times[-1]:.9g} s" in found.reason
            assert "nan" not in found.reason


def test_fewer_impulses_without_vibration_exist_although_the_shortest_shaper_has_more() -> None:
    """1 and 10 Hz: four impulses in .5370 s, three in .5455 s. So three are not called too few; a grid finds them."""
    zeros = [ZeroVibration(Mode(1.0)), ZeroVibration(Mode(10.0))]
    four = minimum_duration(zeros)
    assert four.times.size == 4 and four.times[-1] == pytest.approx(0.5370434719639722, rel=1e-9)
    with pytest.raises(InputError, match="the shortest shaper .* has 4 impulses, more than 3: .* servo grid"):
        minimum_duration([*zeros, AtMostImpulses(3)])
    three = minimum_duration([*zeros, AtMostImpulses(3), ServoGrid(6.0 / 11.0 / 24.0)])
    assert three.status == "optimal" and three.times.size == 3
    assert three.times[-1] == pytest.approx(6.0 / 11.0, rel=1e-9)
    assert max(left(three.times, three.amplitudes, f) for f in (1.0, 10.0)) < 1e-9


def test_what_is_infeasible_says_why_and_what_would_do() -> None:
    short = minimum_duration([ZeroVibration(Mode(1.0), 1)], longest=0.8)
    assert short.status == "infeasible" and short.times.size == 0
    assert "0.8 s is too short" in short.reason and "takes 1 s" in short.reason
    coarse = minimum_duration([*TWO, ServoGrid(0.3)])
    assert coarse.status == "infeasible" and "coarser than half a period of 2.3 Hz" in coarse.reason
    few = minimum_duration([VibrationAtMost(Band(0.9, 1.1), 0.05), AtMostImpulses(1)])
    assert few.status == "infeasible" and "3 impulses do it" in few.reason
    with pytest.raises(InputError, match="with zero vibration here has 5 impulses, more than 3"):
        minimum_duration([*TWO, AtMostImpulses(3)])
    with pytest.raises(InputError, match="give a mode or a band"):
        minimum_duration([ImpulsesBetween(0.0)])
    with pytest.raises(InputError, match="need a servo grid"):
        minimum_duration([*TWO, ImpulsesBetween(-1.0, 1.0)])
    with pytest.raises(InputError, match="prefer chooses among equally short shapers of zero vibration"):
        minimum_duration([*TWO, ServoGrid(0.01)], prefer="fewest")
    fine = minimum_duration([VibrationAtMost(Band(0.9, 1.1), 0.05), ServoGrid(1e-5)])
    assert fine.status == "infeasible" and "give a coarser grid" in fine.reason
    for grid in ([], [ServoGrid(0.02)]):
        none = minimum_duration([*TWO, *grid, AtMostImpulses(2)])
        assert none.status == "infeasible" and "zero vibration of order 1 takes at least 3" in none.reason
    with pytest.raises(InputError, match="prefer is 'nicest'"):
        minimum_duration(TWO, prefer="nicest")


@pytest.mark.parametrize("prefer", ["flattest", "fewest"])
@pytest.mark.parametrize("frequencies", [(1.0, 2.3), (1.0, 2.0, 3.0), (1.0, 3.0, 9.0)])
def test_a_preference_keeps_the_duration_and_the_constraints(prefer: str, frequencies: tuple[float, ...]) -> None:
    asked = [ZeroVibration(Mode(f), 1) for f in frequencies]
    plain, chosen = minimum_duration(asked), minimum_duration(asked, prefer=prefer)
    assert chosen.status == "optimal" and chosen.times[-1] == pytest.approx(plain.times[-1], rel=1e-9)
    assert max(left(chosen.times, chosen.amplitudes, f) for f in frequencies) < 1e-9
    assert prefer != "fewest" or chosen.times.size <= plain.times.size
