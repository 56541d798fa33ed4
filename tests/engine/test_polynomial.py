"""Every minimum of a combination of the constraint functions is found, also those that samples do not show."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Modes
from preshape.engine.basis import Basis
from preshape.engine.polynomial import Polynomial

FAR = Basis(Modes([(1.0, 0.05), (2.3, 0.0)]), (1, 1), 1.7)
NEAR = Basis(Modes([(1.0, 0.01), (1.0005, 0.02), (2.0, 0.0)]), (1, 1, 0), 2.0)
DENSE = Basis(Modes([(1.0 + 0.1 * i, 0.01) for i in range(10)]), (1,) * 10, 5.0)

BASES = [pytest.param(FAR, id="far"), pytest.param(NEAR, id="near"), pytest.param(DENSE, id="dense")]


@pytest.mark.parametrize("basis", BASES)
@settings(max_examples=30)
@given(seed=st.integers(0, 10**6))
def test_every_minimum_is_found(basis: Basis, seed: int) -> None:
    c = np.random.default_rng(seed).normal(size=basis.size)
    leads = np.linspace(0.0, basis.duration, 40_001)
    p = c @ basis(leads)
    lowest = p[np.flatnonzero((p[1:-1] < p[:-2]) & (p[1:-1] < p[2:])) + 1]
    polynomial = Polynomial(basis, c)
    found, values, largest = polynomial.minima(basis.duration)
    inner = np.sort(polynomial(found[1:-1]))
    assert inner.size == lowest.size
    np.testing.assert_allclose(inner, np.sort(lowest), rtol=0.0, atol=1e-4 * np.abs(p).max())
    assert found[0] == 0.0 and found[-1] == basis.duration
    assert values.min() <= p.min() + 1e-9 * np.abs(p).max()
    np.testing.assert_array_equal(values, polynomial(found))
    assert largest == pytest.approx(np.abs(p).max(), rel=0.2)


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("apart", [0.9, 0.3, 0.1, 1e-2, 1e-3])
def test_a_minimum_beside_a_maximum_is_found(basis: Basis, apart: float) -> None:
    """Both between the same two samples, which show neither; what flat certificates have, and what files may hide.

    Combinations with slope zero at both, low there; in some of them the slope's own slope has two roots, too.
    """
    samples = Polynomial(basis, np.zeros(basis.size)).samples(basis.duration)
    spacing, rng, tried = float(samples[1] - samples[0]), np.random.default_rng(1), 0
    for _ in range(200):
        middle = samples[rng.integers(2, samples.size - 3)] + spacing * rng.uniform(apart / 2.0, 1.0 - apart / 2.0)
        raw = basis.raw(middle + np.array([0.0, -0.5, 0.5]) * apart * spacing)
        low, slope = -basis.values(raw)[:, 0], basis.slopes(raw, 1)
        flat = np.array([slope[:, 1], slope[:, 2] - slope[:, 1]])
        flat /= np.linalg.norm(flat, axis=1)[:, None]
        wanted = rng.normal(size=basis.size) + 3.0 * low / np.linalg.norm(low)
        c = wanted - np.linalg.lstsq(flat, flat @ wanted, rcond=None)[0]
        curves = c @ basis.slopes(raw, 2)[:, 1:]
        if curves[0] * curves[1] < 0.0:
            minimum = middle + (-0.5 if curves[0] > 0.0 else 0.5) * apart * spacing
            found, _, _ = Polynomial(basis, c).minima(basis.duration)
            assert np.abs(found - minimum).min() < 0.05 * apart * spacing
            tried += 1
    assert tried > 100


@pytest.mark.parametrize("basis", BASES)
def test_the_slope_vanishes_to_the_last_digit_at_inner_minima(basis: Basis) -> None:
    c = np.random.default_rng(7).normal(size=basis.size)
    found, _, largest = Polynomial(basis, c).minima(basis.duration)
    raw = basis.raw(found[1:-1])
    slopes, curves = c @ basis.slopes(raw, 1), c @ basis.slopes(raw, 2)
    assert (curves > 0.0).all()
    assert np.abs(slopes / curves).max() < 1e-12 * basis.duration
    rough, values, _ = Polynomial(basis, c).minima(basis.duration, 1e-9, expected=found)
    np.testing.assert_allclose(rough, found, rtol=0.0, atol=1e-8 * basis.duration)
    np.testing.assert_allclose(values, c @ basis(found), rtol=0.0, atol=1e-12 * largest)


def test_minima_are_looked_for_up_to_any_end() -> None:
    c = np.random.default_rng(8).normal(size=FAR.size)
    whole, _, _ = Polynomial(FAR, c).minima(1.7)
    part, _, _ = Polynomial(FAR, c).minima(1.1)
    np.testing.assert_allclose(part[:-1], whole[whole < 1.1], rtol=0.0, atol=1e-12)
    assert part[-1] == 1.1


@pytest.mark.parametrize("basis", [None, FAR])
def test_tolerated_points_add_their_waves_and_take_away_the_offset(basis: Basis | None) -> None:
    """p = c.g + Re sum conj(lambda) exp(-s u) - offset, and its minima against a fine mesh."""
    rng = np.random.default_rng(9)
    rates, waves, offset = np.array([0.3 + 7.0j, 0.5 + 9.0j]), rng.normal(size=2) + 1j * rng.normal(size=2), 0.7
    c = np.zeros(0) if basis is None else rng.normal(size=basis.size)
    polynomial = Polynomial(basis, c, rates, waves, offset)
    leads = np.linspace(0.0, 1.7, 40_001)
    p = np.real(np.conj(waves) @ np.exp(-np.multiply.outer(rates, leads))) - offset
    if basis is not None:
        p += c @ basis(leads)
    np.testing.assert_allclose(polynomial(leads), p, rtol=0.0, atol=1e-12 * np.abs(p).max())
    found, values, largest = polynomial.minima(1.7)
    lowest = np.flatnonzero((p[1:-1] < p[:-2]) & (p[1:-1] < p[2:])) + 1
    np.testing.assert_allclose(found[1:-1], leads[lowest], rtol=0.0, atol=1e-4)
    np.testing.assert_allclose(values[1:-1], p[lowest], rtol=0.0, atol=1e-5 * np.abs(p).max())
    assert largest == pytest.approx(np.abs(p).max(), rel=0.2)
