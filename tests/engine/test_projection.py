"""The distance from positive impulses to the constraints, and what it proves."""

from __future__ import annotations

import numpy as np
import pytest

from preshape import Modes, design
from preshape.engine.basis import Basis
from preshape.engine.projection import Projection, nearest_on, nearest_on_mesh, project

FAR = (Modes([(1.0, 0.05), (2.3, 0.0)]), (1, 1))
NEAR = (Modes([(1.0, 0.02), (1.0005, 0.02), (1.7, 0.0)]), (1, 1, 0))
DENSE = (Modes([(1.0 + 0.1 * i, 0.01) for i in range(10)]), (1,) * 10)

CASES = [pytest.param(*FAR, id="far"), pytest.param(*NEAR, id="near"), pytest.param(*DENSE, id="dense")]

REACHED = {FAR: 1e-6, NEAR: 1e-6, DENSE: 0.02}
"""How near bound and distance come to each other: of the 1e-5 that dense modes leave, rounding takes more."""


def shortest_duration(modes: Modes, orders: tuple[int, ...]) -> float:
    shaper = design.direct(modes, orders)
    assert shaper.design.status == "optimal"
    return shaper.duration


@pytest.mark.parametrize(("modes", "orders"), CASES)
@pytest.mark.parametrize("fraction", [0.4, 0.8, 0.95])
def test_the_distance_is_bounded_by_what_a_fine_mesh_reaches(
    modes: Modes, orders: tuple[int, ...], fraction: float
) -> None:
    """Weak duality: the separating polynomial's minimum <= the true distance <= any mesh's distance."""
    whole = shortest_duration(modes, orders)
    duration, basis = fraction * whole, Basis(modes, orders, whole)
    nearest = project(basis, np.linspace(0.0, duration, 200), duration, gap=1e-9)
    fine = nearest_on(basis, np.linspace(0.0, duration, 3000))
    assert nearest.infeasible
    assert nearest.separation <= nearest.distance * (1.0 + 1e-9)
    assert nearest.separation == pytest.approx(nearest.distance, rel=REACHED[modes, orders])
    assert nearest.distance <= fine.distance * (1.0 + 1e-9)
    assert nearest.distance == pytest.approx(fine.distance, rel=0.02)


@pytest.mark.parametrize(("modes", "orders"), CASES)
def test_its_numbers_are_those_of_its_impulses(modes: Modes, orders: tuple[int, ...]) -> None:
    whole = shortest_duration(modes, orders)
    basis = Basis(modes, orders, whole)
    nearest = project(basis, np.linspace(0.0, 0.9 * whole, 60), 0.9 * whole, gap=1e-9)
    miss = basis(nearest.leads) @ nearest.amplitudes
    assert nearest.amplitudes.min() > 0.0 and nearest.amplitudes.sum() == pytest.approx(1.0, abs=1e-12)
    assert np.linalg.norm(miss) == pytest.approx(nearest.distance, rel=1e-9)
    np.testing.assert_allclose(nearest.multipliers, miss / nearest.distance, rtol=0.0, atol=1e-9)
    everywhere = nearest.multipliers @ basis(np.linspace(0.0, 0.9 * whole, 20_001))
    assert everywhere.min() >= nearest.separation * (1.0 - 1e-9)


@pytest.mark.parametrize(("modes", "orders"), CASES)
def test_no_duration_below_the_shortest_is_enough_and_a_longer_one_is(modes: Modes, orders: tuple[int, ...]) -> None:
    whole = shortest_duration(modes, orders)
    basis = Basis(modes, orders, 1.05 * whole)
    short = project(basis, np.linspace(0.0, 0.999 * whole, 200), 0.999 * whole)
    assert short.infeasible and not short.feasible
    enough = project(basis, np.linspace(0.0, 1.05 * whole, 400), 1.05 * whole)
    assert enough.feasible and not enough.infeasible and enough.distance <= basis.zero
    assert not enough.multipliers.any()
    assert np.abs(basis(enough.leads) @ enough.amplitudes).max() <= basis.zero


@pytest.mark.parametrize(("modes", "orders"), CASES)
@pytest.mark.parametrize("fraction", [0.7, 0.97, 1.04])
def test_exchange_on_a_mesh_gives_the_same_as_all_points_at_once(
    modes: Modes, orders: tuple[int, ...], fraction: float
) -> None:
    whole = shortest_duration(modes, orders)
    basis, mesh = Basis(modes, orders, 1.1 * whole), np.linspace(0.0, fraction * whole, 500)
    rows = basis(mesh)
    quick, used = nearest_on_mesh(basis, mesh, rows, np.arange(0, mesh.size, 7))
    plain = nearest_on(basis, mesh, rows)
    assert quick.feasible == plain.feasible == (fraction > 1.0)
    assert np.isin(quick.leads, mesh[used]).all() or quick.feasible
    if not quick.feasible:
        assert quick.distance == pytest.approx(plain.distance, rel=REACHED[modes, orders])
        assert (quick.multipliers @ rows).min() >= quick.distance * (1.0 - 3.0 * REACHED[modes, orders])


def test_only_what_is_proved_counts() -> None:
    """A distance that may be rounding proves nothing, nor does a polynomial that falls below zero somewhere."""
    nothing = np.zeros(2)
    assert Projection(nothing, nothing, distance=0.1, multipliers=nothing, separation=0.05).infeasible
    assert not Projection(nothing, nothing, distance=0.1, multipliers=nothing, separation=-0.05).infeasible
    assert not Projection(nothing, nothing, distance=0.1, multipliers=nothing).infeasible
    assert not Projection(nothing, nothing, 1e-13, nothing, separation=0.05, feasible=True).infeasible


def test_too_coarse_a_mesh_alone_proves_nothing() -> None:
    """On five points even a long interval looks too short; on the continuum it does not."""
    basis = Basis(*FAR, 2.0)
    coarse = nearest_on(basis, np.linspace(0.0, 2.0, 5))
    assert coarse.distance > basis.zero and not coarse.infeasible
    assert project(basis, np.linspace(0.0, 2.0, 5), 2.0).feasible
