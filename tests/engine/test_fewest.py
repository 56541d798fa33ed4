"""Fewest impulses against every set of impulses tried in turn; the flattest amplitudes against an interior point."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Mode, Modes
from preshape.band import Band
from preshape.engine.basis import Basis
from preshape.engine.constraints import ImpulsesBetween, VibrationAtMost, ZeroVibration
from preshape.engine.fewest import amplitudes_at, fewest
from preshape.engine.flattest import flattest
from preshape.engine.programme import Programme, gather, solve
from preshape.engine.projection import nearest_on
from preshape.engine.windows import needed_windows
from preshape.errors import InputError

TWO = ((2.0, 0.02), (3.1, 0.02))


def positive(modes: tuple[tuple[float, float], ...], order: int, leads: np.ndarray) -> Programme:
    zero = [ZeroVibration(Mode(*mode), order) for mode in modes]
    return gather([*zero, ImpulsesBetween(0.0)], leads)


def start_of(programme: Programme) -> np.ndarray:
    start = amplitudes_at(programme, np.ones(programme.leads.size, dtype=bool))
    assert start is not None
    return start


def equations(modes: tuple[tuple[float, float], ...], order: int, leads: np.ndarray) -> np.ndarray:
    """u^k exp(-s u) and the sum, written out anew; rows of about size one."""
    rows = []
    for frequency, damping in modes:
        w = 2.0 * math.pi * frequency
        wave = np.exp(-w * (damping + 1j * math.sqrt(1.0 - damping**2)) * leads)
        for k in range(order + 1):
            rows += [((leads / leads[-1]) ** k * wave).real, ((leads / leads[-1]) ** k * wave).imag]
    return np.array([*rows, np.ones(leads.size)])


def smallest_by_brute_force(matrix: np.ndarray, up_to: int) -> int:
    """The size of the smallest set of columns that positive weights combine to (0, ..., 0, 1)."""
    from scipy.optimize import nnls

    target = np.eye(matrix.shape[0])[-1]
    for count in range(1, up_to + 1):
        for chosen in combinations(range(matrix.shape[1]), count):
            if nnls(matrix[:, chosen], target)[1] < 1e-10:
                return count
    raise AssertionError("no set is enough")


@pytest.mark.parametrize(
    ("modes", "order", "dt", "slots"),
    [
        (((1.0, 0.0),), 1, 0.125, 9),  # half a period is four slots: 1, 2, 1 lies on the grid
        (((1.0, 0.0),), 1, 0.11, 11),  # it does not
        (((1.0, 0.05),), 0, 0.1, 8),
        (((1.0, 0.0), (2.0, 0.0)), 0, 0.0625, 14),
        (((1.0, 0.0), (3.0, 0.0)), 1, 1.0 / 12.0, 14),  # an odd harmonic costs nothing: 1, 2, 1 again
        (((1.0, 0.0), (1.7, 0.1)), 0, 0.07, 13),
    ],
)
def test_every_set_of_impulses_tried_gives_the_same_number(
    modes: tuple[tuple[float, float], ...], order: int, dt: float, slots: int
) -> None:
    leads = np.arange(slots + 1) * dt
    programme = positive(modes, order, leads)
    start = start_of(programme)
    found = fewest(programme, start)
    matrix = equations(modes, order, leads)
    assert found.proved
    assert found.leads.size == smallest_by_brute_force(matrix, int(np.count_nonzero(start)))
    used = np.isin(leads, found.leads)
    np.testing.assert_allclose(matrix[:, used] @ found.amplitudes, np.eye(matrix.shape[0])[-1], atol=1e-12)
    assert (found.amplitudes > 0.0).all()


@settings(max_examples=10, deadline=None)
@given(st.floats(1.0, 3.0), st.floats(0.0, 0.1), st.integers(0, 1), st.floats(0.08, 0.13))
def test_random_modes_are_proved_and_never_need_more_than_least_squares(
    frequency: float, damping: float, order: int, dt: float
) -> None:
    modes, dt = ((frequency, damping),), dt / frequency
    leads = np.arange(math.ceil((order + 1) / 2.0 / frequency / math.sqrt(1.0 - damping**2) / dt) + 2) * dt
    programme = positive(modes, order, leads)
    start = start_of(programme)
    found = fewest(programme, start)
    assert found.proved and order + 2 <= found.leads.size <= np.count_nonzero(start) <= 2 * (order + 1) + 1


def test_a_number_that_is_too_small_is_proved_to_be() -> None:
    leads = np.arange(41) * 0.02
    programme = positive(TWO, 1, leads)
    windows = needed_windows(leads.size, lambda kept: amplitudes_at(programme, kept) is not None)
    assert len(windows) == 7  # so six impulses are too few, without any integers
    answer = fewest(programme, start_of(programme), at_most=6)
    assert answer.at_least == 7 and answer.leads.size == 9
    eight = fewest(programme, start_of(programme), at_most=8)
    assert eight.at_least == 9 and eight.proved


def test_each_window_is_needed_says_another_solver() -> None:
    """Interior-point linear programme: least L1 miss of positive impulses outside the window."""
    from scipy.optimize import linprog

    leads = np.arange(41) * 0.02
    programme = positive(TWO, 1, leads)
    windows = needed_windows(leads.size, lambda kept: amplitudes_at(programme, kept) is not None)
    assert all(a.stop <= b.start for a, b in zip(windows, windows[1:], strict=False))
    m = programme.equalities.shape[0]
    for window in windows:
        kept = np.ones(leads.size, dtype=bool)
        kept[window] = False
        rows = programme.equalities[:, kept]
        answer = linprog(
            np.concatenate([np.zeros(rows.shape[1]), np.ones(2 * m)]),
            A_eq=np.block([[rows, np.eye(m), -np.eye(m)], [np.ones((1, rows.shape[1])), np.zeros((1, 2 * m))]]),
            b_eq=np.append(np.zeros(m), 1.0),
            method="highs-ipm",
            options={"time_limit": 20.0},
        )
        assert answer.status == 0 and answer.fun > 1e-6


def test_a_tolerated_vibration_needs_fewer_impulses() -> None:
    """Discs: three places that least squares would split into five are enough when 3 % may be left."""
    from scipy.optimize import linprog

    mode, tolerance, leads = Mode(1.0, 0.05), 0.03, np.arange(13) * 0.09
    rates = tuple(-complex(Mode(mode.frequency * f, mode.damping).pole).conjugate() for f in (0.97, 1.0, 1.03))
    at_most = VibrationAtMost(Band(0.97, 1.03, 0.05), tolerance, rates)
    programme = gather([at_most, ImpulsesBetween(0.0)], leads)
    found = fewest(programme, solve(programme).amplitudes.clip(0.0))
    used = np.isin(leads, found.leads)
    assert np.abs(programme.cones[:, used] @ found.amplitudes).max() <= tolerance + 1e-7
    assert found.proved
    turns = np.exp(2j * np.pi * np.arange(48) / 48)
    for chosen in combinations(range(leads.size), found.leads.size - 1):
        columns = programme.cones[:, chosen]
        sides = np.concatenate([(turn * columns).real for turn in turns])
        least = linprog(
            np.append(np.zeros(len(chosen)), 1.0),
            A_ub=np.column_stack([sides, -np.ones(len(sides))]),
            b_ub=np.zeros(len(sides)),
            A_eq=[[1.0] * len(chosen) + [0.0]],
            b_eq=[1.0],
        )
        assert least.fun > tolerance  # the polygon is larger than the disc, so this is a proof


def test_impulses_of_both_signs() -> None:
    """A third of a period is too short for positive impulses; 1, -1, 1 fits into it, and two impulses do not."""
    leads = np.arange(9) / 24.0
    programme = gather([ZeroVibration(Mode(1.0, 0.0)), ImpulsesBetween(-1.0, 1.0)], leads)
    start = np.zeros(9)
    start[[0, 4, 8]] = 1.0, -1.0, 1.0
    found = fewest(programme, start)
    assert found.proved and found.leads.size == 3
    assert np.abs(np.exp(-2j * np.pi * found.leads) @ found.amplitudes) < 1e-7


@pytest.mark.parametrize("limits", [(-math.inf, math.inf), (-1.0, math.inf)])
def test_impulses_without_limits_are_refused(limits: tuple[float, float]) -> None:
    leads = np.arange(5) * 0.125
    programme = gather([ZeroVibration(Mode(1.0, 0.0)), ImpulsesBetween(*limits)], leads)
    with pytest.raises(InputError, match="between limits"):
        fewest(programme, np.array([0.5, 0.0, 0.0, 0.0, 0.5]))


def test_the_solver_prints_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    """A command that writes JSON to standard output relies on it."""
    programme = positive(((1.0, 0.0), (10.0, 0.0)), 1, np.arange(221) * 0.005)
    fewest(programme, start_of(programme), time_limit=3.0)
    assert capfd.readouterr().out == ""


@pytest.mark.parametrize("slots", [211, 220])
def test_the_flattest_amplitudes_equal_those_of_an_interior_point(slots: int) -> None:
    modes = Modes([(1.0, 0.0), (10.0, 0.0)])
    leads = np.arange(slots + 1) * 0.005
    basis = Basis(modes, (1, 1), float(leads[-1]))
    rows = equations(((1.0, 0.0), (10.0, 0.0)), 2, leads)[[4, 5, 10, 11]]
    found = flattest(basis(leads), rows)
    programme = positive(((1.0, 0.0), (10.0, 0.0)), 1, leads)
    other = solve(programme, flatten=rows)
    assert np.abs(basis(leads) @ found).max() < 1e-12 and found.sum() == pytest.approx(1.0, abs=1e-14)
    assert np.linalg.norm(rows @ found) == pytest.approx(np.linalg.norm(rows @ other.amplitudes), rel=1e-6)
    assert np.linalg.norm(rows @ found) <= np.linalg.norm(rows @ other.amplitudes) * (1.0 + 1e-9)
    assert np.count_nonzero(found) <= basis.size + len(rows) + 1


def test_no_other_amplitudes_are_flatter() -> None:
    """Optimality: no slot's reduced cost is negative, with multipliers from the impulses alone."""
    leads = np.arange(212) * 0.005
    basis = Basis(Modes([(1.0, 0.0), (10.0, 0.0)]), (1, 1), float(leads[-1]))
    rows = equations(((1.0, 0.0), (10.0, 0.0)), 2, leads)[[4, 5, 10, 11]]
    found = flattest(basis(leads), rows)
    used = found > 0.0
    gradient = rows.T @ (rows @ found)
    asked = np.vstack([basis(leads), np.ones(leads.size)])
    multipliers = np.linalg.lstsq(asked[:, used].T, gradient[used], rcond=None)[0]
    reduced = gradient - asked.T @ multipliers
    assert np.abs(reduced[used]).max() < 1e-10
    assert reduced.min() > -1e-10


def test_flattest_of_the_grid_is_at_least_as_flat_as_any_basic_solution() -> None:
    leads = np.arange(241) * 0.005
    basis = Basis(Modes([(1.0, 0.0), (10.0, 0.0)]), (1, 1), float(leads[-1]))
    rows = equations(((1.0, 0.0), (10.0, 0.0)), 2, leads)[[4, 5, 10, 11]]
    plain = nearest_on(basis, leads)
    size = np.linalg.norm(rows[:, np.isin(leads, plain.leads)] @ plain.amplitudes)
    assert np.linalg.norm(rows @ flattest(basis(leads), rows)) < 0.9 * size
