"""The conic programme against linear programmes that know nothing of it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from preshape import Band, Mode
from preshape.engine import ImpulsesBetween, PartialSumsBetween, VibrationAtMost, ZeroVibration
from preshape.engine.constraints import Constraint
from preshape.engine.programme import gather, solve

LEADS = np.linspace(0.0, 0.8, 41)
BAND = Band(0.9, 1.1)
RATES = tuple(2j * np.pi * f for f in np.linspace(0.9, 1.1, 9))


def least_excess(leads: np.ndarray, rates: tuple[complex, ...], tolerance: float, grow: float) -> float:
    """By a linear programme: polygons of 256 sides, in (grow = 1) or around the discs, instead of cones."""
    turns = np.exp(2j * np.pi * np.arange(256) / 256)
    sides = np.concatenate([(turn * np.exp(np.multiply.outer(-np.array(rates), leads))).real for turn in turns])
    return float(
        linprog(
            np.append(np.zeros(leads.size), 1.0),
            A_ub=np.column_stack([grow * sides, -np.ones(len(sides))]),
            b_ub=np.full(len(sides), tolerance),
            A_eq=[[1.0] * leads.size + [0.0]],
            b_eq=[1.0],
            bounds=[(0.0, None)] * leads.size + [(None, None)],
        ).fun
    )


@pytest.mark.parametrize("duration", [0.5, 0.8, 0.95])
def test_the_least_excess_lies_between_two_polygons(duration: float) -> None:
    leads = np.linspace(0.0, duration, 41)
    found = solve(gather([VibrationAtMost(BAND, 0.05, RATES), ImpulsesBetween(0.0)], leads))
    around = least_excess(leads, RATES, 0.05, 1.0)
    inside = least_excess(leads, RATES, 0.05, 1.0 / math.cos(math.pi / 256))
    assert found.solved and around - 1e-8 <= found.excess <= inside + 1e-8
    assert found.amplitudes.sum() == pytest.approx(1.0, abs=1e-9) and found.amplitudes.min() > -1e-9
    assert (found.excess < 0.0) is (duration > 0.9)


def test_the_multipliers_are_a_proof_by_themselves() -> None:
    """Weak duality, without the solver: p(u) >= excess at every lead, sum of magnitudes one."""
    asked: list[Constraint] = [VibrationAtMost(BAND, 0.05, RATES), ZeroVibration(Mode(2.5)), ImpulsesBetween(0.0)]
    programme = gather(asked, LEADS)
    found = solve(programme)
    assert np.abs(found.waves).sum() == pytest.approx(1.0, abs=1e-6)
    p = found.multipliers @ programme.equalities + np.real(found.waves.conj() @ programme.cones)
    p -= 0.05 * np.abs(found.waves).sum()
    assert p.min() == pytest.approx(found.excess, abs=1e-7) and found.excess > 0.0
    assert np.abs(programme.equalities @ found.amplitudes).max() < 1e-8


def test_linear_rows_and_bounds_against_a_linear_programme() -> None:
    asked: list[Constraint] = [ZeroVibration(Mode(1.0)), PartialSumsBetween(0.0, 1.0), ImpulsesBetween(-1.0, 1.0)]
    for last, possible in ((0.30, False), (0.40, True)):
        leads = np.linspace(0.0, last, 31)
        programme = gather(asked, leads)
        found = solve(programme)
        waves = np.exp(2j * np.pi * leads)
        sums = np.tril(np.ones((31, 31)))  # in order of time the leads fall
        answer = linprog(
            np.append(np.zeros(31), 1.0),
            A_ub=np.block([[sums[:-1], -np.ones((30, 1))], [-sums[:-1], -np.ones((30, 1))]]),
            b_ub=np.concatenate([np.ones(30), np.zeros(30)]),
            A_eq=np.column_stack([np.vstack([waves.real, waves.imag, np.ones(31)])[:, ::-1], np.zeros(3)]),
            b_eq=[0.0, 0.0, 1.0],
            bounds=[(-1.0, 1.0)] * 31 + [(None, None)],
        )
        assert answer.status == 0
        assert found.excess == pytest.approx(answer.fun, abs=1e-6) and (found.excess <= 1e-8) is possible


def test_equalities_out_of_reach_are_infeasible_not_approximated() -> None:
    found = solve(gather([ZeroVibration(Mode(1.0)), ImpulsesBetween(0.0)], np.linspace(0.0, 0.4, 30)))
    assert not found.solved
    tolerated = gather(
        [ZeroVibration(Mode(1.0)), VibrationAtMost(BAND, 0.05, RATES), ImpulsesBetween(0.0)], np.linspace(0.0, 0.4, 30)
    )
    assert solve(tolerated).excess == math.inf


def test_a_cost_chooses_among_what_is_feasible() -> None:
    programme = gather([VibrationAtMost(BAND, 0.05, RATES), ImpulsesBetween(0.0)], np.linspace(0.0, 1.2, 61))
    late, early = (solve(programme, cost=sign * programme.leads) for sign in (1.0, -1.0))
    for found in (late, early):
        assert found.solved and np.abs(programme.cones @ found.amplitudes).max() <= 0.05 + 1e-7
    assert programme.leads @ early.amplitudes > programme.leads @ late.amplitudes + 0.01
    flat = solve(programme, flatten=programme.cones.real)
    assert np.sum((programme.cones.real @ flat.amplitudes) ** 2) < np.sum((programme.cones.real @ late.amplitudes) ** 2)


def test_several_limits_are_met_together() -> None:
    bounds: list[Constraint] = [ImpulsesBetween(-1.0, 0.5), ImpulsesBetween(0.0, 2.0), ZeroVibration(Mode(1.0))]
    programme = gather(bounds, LEADS)
    assert (programme.low, programme.high) == (0.0, 0.5)
    found = solve(replace(programme, high=0.2), cost=np.zeros(LEADS.size))
    assert found.solved and -1e-9 <= found.amplitudes.min() <= found.amplitudes.max() <= 0.2 + 1e-9
