"""The parts of the engine, each against something simpler."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Modes, design
from preshape.engine.basis import Basis
from preshape.engine.newton import Polished
from preshape.engine.projection import Projection, nearest_on, project

MODES = Modes([(1.0, 0.05), (2.3, 0.0)])


def test_rows_are_orthonormal_on_the_interval() -> None:
    basis = Basis(MODES, (1, 1), 0.9)
    samples = basis.samples_needed(0.9)
    rows = basis(np.linspace(0.0, 0.9, samples))
    np.testing.assert_allclose(rows @ rows.T / samples, np.eye(8), atol=1e-10)


def test_near_equal_modes_stay_orthonormal_where_scaled_rows_are_parallel() -> None:
    near = Modes([(14.25, 0.01), (15.25, 0.01)])
    basis = Basis(near, (1, 1), 0.2)
    times = np.linspace(0.0, 0.2, basis.samples_needed(0.2))
    rows = basis(times)
    assert np.linalg.cond(rows) == pytest.approx(1.0, abs=1e-6)
    raw = basis.raw(times)
    assert np.linalg.cond(raw / np.linalg.norm(raw, axis=1)[:, None]) > 1e3


@pytest.mark.parametrize("order", [1, 2])
def test_derivatives_are_those_of_the_rows(order: int) -> None:
    basis = Basis(MODES, (2, 1), 1.3)
    times, h = np.linspace(0.1, 1.2, 7), 1e-5
    numeric = (basis(times + h, order - 1) - basis(times - h, order - 1)) / (2.0 * h)
    np.testing.assert_allclose(basis(times, order), numeric, rtol=1e-6, atol=1e-5 * np.abs(numeric).max())


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6))
def test_every_minimum_is_found(seed: int) -> None:
    rng = np.random.default_rng(seed)
    basis = Basis(MODES, (1, 1), 1.7)
    c = rng.normal(size=8)
    times = np.linspace(0.0, 1.7, 40_001)
    p = c @ basis(times)
    lowest = p[np.flatnonzero((p[1:-1] < p[:-2]) & (p[1:-1] < p[2:])) + 1]
    found = basis.minima(c, 1.7)
    inner = np.sort(c @ basis(found[1:-1]))
    assert inner.size == lowest.size
    np.testing.assert_allclose(inner, np.sort(lowest), atol=1e-5 * np.abs(p).max())
    assert found[0] == 0.0 and found[-1] == 1.7


@pytest.mark.parametrize("duration", [0.5, 0.9, 1.1])
def test_the_distance_is_bounded_by_what_a_fine_mesh_reaches(duration: float) -> None:
    """Weak duality: the separating polynomial's minimum <= the true distance <= any mesh's distance."""
    basis = Basis(MODES, (1, 1), duration)
    nearest = project(basis, np.linspace(0.0, duration, 30), gap=1e-9)
    fine = nearest_on(basis, np.linspace(0.0, duration, 3000))
    assert nearest.infeasible
    assert nearest.separation <= nearest.distance * (1.0 + 1e-9)
    assert nearest.separation == pytest.approx(nearest.distance, rel=1e-6)
    assert nearest.distance <= fine.distance * (1.0 + 1e-9)
    assert nearest.distance == pytest.approx(fine.distance, rel=1e-3)


def test_a_long_enough_interval_is_not_called_infeasible() -> None:
    basis = Basis(MODES, (1, 1), 2.0)
    nearest = project(basis, np.linspace(0.0, 2.0, 100))
    assert nearest.distance < 1e-10 and not nearest.infeasible
    assert np.abs(basis(nearest.times) @ nearest.amplitudes).max() < 1e-10


def test_certificate_coefficients_are_the_combination_in_plain_exponentials() -> None:
    basis = Basis(MODES, (1, 0), 1.1)
    c, duration = np.random.default_rng(2).normal(size=basis.size), 1.07
    coefficients = basis.coefficients(c, duration)
    times = np.linspace(0.0, duration, 50)
    plain, position = np.zeros(50), 0
    for mode, order in zip(MODES, (1, 0), strict=True):
        for k in range(order + 1):
            wave = (times / duration) ** k * np.exp(-np.conj(mode.pole) * (times - duration))
            plain += np.real(coefficients[position] * wave)
            position += 1
    np.testing.assert_allclose(plain, c @ basis(times), atol=1e-12)


def test_only_what_is_proved_counts() -> None:
    """Each link of the chain refuses what it must refuse."""
    nothing = np.zeros(2)
    assert Projection(nothing, nothing, distance=0.1, multipliers=nothing, separation=0.05).infeasible
    assert not Projection(nothing, nothing, distance=0.1, multipliers=nothing, separation=-0.05).infeasible
    assert not Projection(nothing, nothing, distance=1e-12, multipliers=nothing, separation=0.05).infeasible
    assert Polished(nothing, np.array([0.5, 0.5]), nothing, error=1.0).converged
    assert not Polished(nothing, np.array([1.1, -0.1]), nothing, error=1.0).converged
    assert not Polished(nothing, np.array([0.5, 0.5]), nothing, error=1e6).converged
    proof = design.direct([(1.0, 0.0), (2.3, 0.0)]).design.certificate
    assert proof is not None and proof.holds
    assert not replace(proof, minimum=-1e-6).holds
    assert not replace(proof, exclusion=0.0).holds


def test_contacts_that_could_do_it_earlier_are_found_out() -> None:
    """On an interval longer than needed the impulses before its end meet the constraints: no exclusion there."""
    shaper = design.direct([(1.0, 0.05), (2.3, 0.0)])
    longer = Basis(MODES, (1, 1), 1.2 * shaper.duration)
    assert nearest_on(longer, shaper.times).distance < 1e-10
    exact = Basis(MODES, (1, 1), shaper.duration)
    assert nearest_on(exact, shaper.times[:-1]).distance > 1e-3
