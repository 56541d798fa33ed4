"""The witness: its bound holds for every p, so tampering with p makes the bound weaker and never false."""

from dataclasses import replace

import numpy as np
import pytest
from tests.command.test_time_optimal import TWO, UNIT, problem_of

from preshape import Band
from preshape.command.rest_to_rest.shortest import Problem, polish, shortest_move
from preshape.command.rest_to_rest.shortest.adjoint import from_structure
from preshape.command.rest_to_rest.shortest.grid import Grid
from preshape.command.rest_to_rest.shortest.programme import Farthest
from preshape.command.rest_to_rest.shortest.witness import from_grid
from preshape.engine.edges import edges_of

RATES = -np.conj([mode.pole for mode in TWO.modes])
PROBLEMS = {
    "limit below the static deflection": problem_of(UNIT, 10.0, 1.0, 0.3),
    "limit above it": problem_of(UNIT, 10.0, 1.0, 0.7),
    "two modes": Problem(10.0, RATES, np.zeros((0, 2))),
    "two limited modes": Problem(10.0, RATES, np.array([[2.1, 0.0], [0.0, -1.5]])),
    "a band": Problem(20.0, RATES[:1], np.zeros((0, 1)), edges_of((Band(0.18, 0.22),), 0.1)),
}
CASES = pytest.mark.parametrize("problem", PROBLEMS.values(), ids=list(PROBLEMS))


def on_grid(problem: Problem) -> Farthest:
    grid = Grid.even(problem, 2.0 * problem.unit)
    return grid.reaching(problem.target, 2.0 * problem.unit)


def tampered(found: Farthest, random: np.random.Generator, size: float) -> Farthest:
    """Every multiplier changed by about a part of the largest of its kind."""

    def noise(values: np.ndarray) -> np.ndarray:
        scale = size * np.abs(values).max(initial=0.0)
        return values + scale * random.normal(size=values.shape)

    waves = noise(found.waves.real) + 1j * noise(found.waves.imag)
    # the masses keep to where they were: everywhere they would cost more than the bound is worth
    masses = np.where(found.masses != 0.0, found.masses * (1.0 + size * random.normal(size=found.masses.shape)), 0.0)
    return replace(found, masses=masses, waves=waves, velocity=found.velocity * (1.0 + size * random.normal()))


@CASES
def test_tampered_multipliers_on_a_grid_never_say_too_much(problem: Problem) -> None:
    best = shortest_move(problem)
    assert best is not None and best.gap < 1e-3
    found, random = on_grid(problem), np.random.default_rng(7)
    honest = from_grid(problem, found).least_duration(problem.target)
    assert 0.9 * best.duration < honest <= best.duration * (1.0 + 1e-9)
    weaker = []
    for size in (1e-6, 1e-4, 1e-2, 0.1, 1.0):
        for _ in range(12):
            bound = from_grid(problem, tampered(found, random, size)).least_duration(problem.target)
            assert bound <= best.duration * (1.0 + 1e-9)
            weaker.append(bound)
    assert min(weaker) < 0.9 * honest  # tampering is noticed


@CASES
def test_grids_for_other_durations_never_say_too_much(problem: Problem) -> None:
    best = shortest_move(problem)
    assert best is not None
    for part in (0.5, 0.9, 0.99, 1.01, 1.1, 1.5):
        duration = part * best.duration
        found = Grid.even(problem, duration).farthest(duration)
        bound = from_grid(problem, found).least_duration(problem.target)
        assert bound <= best.duration * (1.0 + 1e-9)
        if part < 1.0 and not problem.edges:
            assert bound == pytest.approx(duration, rel=1e-9)  # it is too short, and that is proved


def test_arcs_that_are_not_the_best_have_a_bound_below_the_best() -> None:
    """A structure moved or made exact for a farther target: its p is not zero where it should be, and is still a p."""
    problem = PROBLEMS["limit below the static deflection"]
    best = shortest_move(problem)
    assert best is not None and best.structure is not None
    random = np.random.default_rng(11)
    for size in (1e-8, 1e-5, 1e-3, 0.03):
        for _ in range(20):
            starts = best.structure.times * (1.0 + size * random.normal(size=best.structure.times.size))
            arcs = [replace(arc, start=float(t)) for arc, t in zip(best.structure.arcs, starts[:-1], strict=True)]
            moved = replace(best.structure, arcs=tuple(arcs), end=float(starts[-1]))
            bound = from_structure(problem, moved, best.motion, None).least_duration(problem.target)
            assert bound <= best.duration * (1.0 + 1e-9)
    for part in (0.8, 0.95, 1.05, 1.3):
        other = polish(Problem(part * problem.target, problem.rates, problem.rows), best.structure)
        assert other is not None
        bound = from_structure(problem, other.structure, best.motion, None).least_duration(problem.target)
        assert 0.5 * best.duration < bound <= best.duration * (1.0 + 1e-9)


def test_a_mass_comes_off_only_where_it_is() -> None:
    """With the masses of holds counted at the beginning, a p that is not the best would prove too much."""
    problem = PROBLEMS["limit below the static deflection"]
    best = shortest_move(problem)
    assert best is not None and best.structure is not None
    witness = from_structure(problem, best.structure, best.motion, None)
    assert witness.masses.sum() > 0.0 and witness.masses[0] == 0.0
    held = [k for k, arc in enumerate(best.structure.arcs) if arc.row is not None]
    assert np.flatnonzero(witness.masses > 1e-9 * witness.masses.sum())[0] == held[0]
