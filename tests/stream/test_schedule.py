"""Modes by configuration: exact at the rows, straight between them, with the error that the docstring states."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Shaper, design
from preshape.engine import is_proved_shortest
from preshape.errors import InputError
from preshape.stream import Schedule, Stream
from preshape.vibration import residual_vibration

LENGTHS = [1.0, 1.5, 2.0, 3.0, 5.0]


def rope(length: float) -> float:
    """A crane's frequency [Hz]."""
    return math.sqrt(9.81 / length) / (2.0 * math.pi)


def pose(a: float, b: float) -> list[tuple[float, float]]:
    """An arm's two modes, ln f and damping linear in each of two joints."""
    return [(2.0 * math.exp(0.1 * a - 0.2 * b + 0.03 * a * b), 0.01 + 0.002 * a), (7.0 * math.exp(0.05 * b), 0.02)]


CRANE = Schedule({length: (rope(length), 0.01) for length in LENGTHS})
ARM = Schedule({(a, b): pose(a, b) for a, b in product((-1.0, 0.0, 2.0), (0.0, 1.0))}, order=0)


@pytest.mark.parametrize("length", LENGTHS)
def test_at_a_row_it_is_the_row(length: float) -> None:
    assert CRANE.modes(length)[0].frequency == pytest.approx(rope(length), rel=1e-15)
    assert CRANE.modes([length])[0].damping == 0.01


@given(st.floats(1.0, 5.0))
def test_a_crane_errs_by_no_more_than_its_curvature_says(length: float) -> None:
    """ln f = const - ln(l) / 2: a chord over h errs by at most h^2 / 8 of its second derivative, 1 / (2 l^2)."""
    k = min(int(np.searchsorted(LENGTHS, length, side="right")), len(LENGTHS) - 1)
    low, high = LENGTHS[k - 1], LENGTHS[k]
    error = math.log(CRANE.modes(length)[0].frequency / rope(length))
    assert -1e-14 <= error <= (high - low) ** 2 / (16.0 * low**2)


def test_the_bound_is_no_wider_than_need_be_and_falls_as_the_square_of_the_spacing() -> None:
    worst = []
    spacings = [0.4, 0.2, 0.1, 0.05]
    for h in spacings:
        fine = Schedule({float(length): (rope(length), 0.0) for length in np.arange(1.0, 3.0 + h / 2, h)})
        worst.append(max(abs(fine.modes(q)[0].frequency / rope(q) - 1.0) for q in np.linspace(1.0, 2.9, 401)))
    slope = np.polyfit(np.log(spacings), np.log(worst), 1)[0]
    assert slope == pytest.approx(2.0, abs=0.3)
    assert worst[-1] > 0.8 * spacings[-1] ** 2 / 16.0


def test_by_the_logarithm_of_its_length_a_crane_is_exact() -> None:
    logarithmic = Schedule({math.log(length): (rope(length), 0.0) for length in (1.0, 5.0)})
    for length in np.linspace(1.0, 5.0, 33):
        assert logarithmic.modes(math.log(length))[0].frequency == pytest.approx(rope(length), rel=1e-14)


@given(st.floats(-1.0, 2.0), st.floats(0.0, 1.0))
def test_a_pose_is_interpolated_along_each_joint(a: float, b: float) -> None:
    """What is linear in each joint on its own comes out exactly, products of joints included."""
    for found, (frequency, damping) in zip(ARM.modes((a, b)), pose(a, b), strict=True):
        assert found.frequency == pytest.approx(frequency, rel=1e-13)
        assert found.damping == pytest.approx(damping, rel=1e-12)


@given(st.floats(-1.0, 2.0), st.floats(0.0, 1.0))
def test_its_shaper_is_the_proved_one_for_the_modes_there(a: float, b: float) -> None:
    shaper = ARM.shaper([a, b])
    assert shaper.design.modes == ARM.modes([a, b]) and shaper.design.settings["order"] == 0
    assert is_proved_shortest(shaper)


def test_interpolated_modes_leave_less_than_interpolated_impulses() -> None:
    """Half way between two rows: the rows' shapers in equal parts leave vibration, the shaper of the modes none."""
    left, right = (design.direct(pose(a, 0.0), 0) for a in (0.0, 2.0))
    times = np.unique(np.concatenate([left.times, right.times]))
    mixed = sum(np.bincount(np.searchsorted(times, s.times), 0.5 * s.amplitudes, times.size) for s in (left, right))
    frequencies, dampings = zip(*pose(1.0, 0.0), strict=True)
    assert residual_vibration(ARM.shaper((1.0, 0.0)), frequencies, dampings).max() < 1e-12
    assert residual_vibration(Shaper(times, mixed), frequencies, dampings).max() > 0.01


def test_the_same_configuration_gives_the_same_shaper_whatever_was_asked_before() -> None:
    table = {length: (rope(length), 0.01) for length in LENGTHS}
    there, back = Schedule(table), Schedule(table)
    way = [1.2, 4.4, 2.6]
    first = [there.shaper(q) for q in way]
    assert first == [back.shaper(q) for q in reversed(way)][::-1]
    assert back.shaper(4.4).design.settings["start"] == "near"


def test_a_stream_follows_it() -> None:
    stream = Stream(CRANE.shaper(1.0), dt=0.01)
    for length in np.linspace(1.0, 5.0, 41):
        found = stream.track(CRANE.modes(length))
        assert found.start in ("near", "kept") and found.shaper.design.modes == CRANE.modes(length)


@pytest.mark.parametrize("outside", [0.5, 5.000001])
def test_outside_it_refuses_or_holds(outside: float) -> None:
    with pytest.raises(InputError, match="outside the table, 1 to 5: extend the table"):
        CRANE.modes(outside)
    held = Schedule({length: (rope(length), 0.0) for length in LENGTHS}, outside="hold")
    assert held.modes(outside)[0].frequency == pytest.approx(rope(min(max(outside, 1.0), 5.0)), rel=1e-15)
    assert held.shaper(outside).design.modes == held.modes(outside)


def test_one_row_is_a_table_too() -> None:
    single = Schedule({2.0: (1.0, 0.0)}, outside="hold")
    assert single.modes(7.0)[0].frequency == 1.0 and "1 mode(s) over 2 to 2 (1)" in repr(single)


def test_where_modes_cross_it_says_so() -> None:
    crossing = Schedule({0.0: [(1.0, 0.0), (2.0, 0.0)], 1.0: [(2.0, 0.0), (1.0, 0.0)]})
    assert len(crossing.modes(0.49)) == 2
    with pytest.raises(InputError, match="given twice"):
        crossing.modes(0.5)


ROW = [(1.0, 0.0), (2.0, 0.0)]


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Schedule({}), "no rows"),
        (lambda: Schedule([(1.0, ROW)]), "no rows"),
        (lambda: Schedule({1.0: ROW, 2.0: ROW[:1]}), "2 modes at 1 and 1 at 2: give the same modes in every row"),
        (lambda: Schedule({(0.0, 0.0): ROW, (1.0, 1.0): ROW}), "no row at 0, 1: give one for every combination"),
        (lambda: Schedule({0.0: ROW, (1.0, 1.0): ROW}), "equally many"),
        (lambda: Schedule({1.0: ROW, (1.0,): ROW}), "twice"),
        (lambda: Schedule({math.nan: ROW}), "give a finite number"),
        (lambda: Schedule({"long": ROW}), "give a finite number"),
        (lambda: Schedule({1.0: [(0.0, 0.0)]}), "not a natural frequency"),
        (lambda: Schedule({1.0: ROW}, order=9), "order is 9"),
        (lambda: Schedule({1.0: ROW}, outside="ignore"), "outside is 'ignore'"),
        (lambda: CRANE.modes((1.0, 2.0)), "has 2 numbers and the table's have 1"),
        (lambda: CRANE.modes(math.inf), "give a finite number"),
        (lambda: CRANE.shaper(None), "give a finite number"),
    ],
)
def test_a_wrong_table_or_configuration_is_refused_in_a_sentence(make, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        make()
