"""Newton's method on the optimality system, and the pivots that mend a start with wrong impulses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Modes, Shaper, design
from preshape.engine.basis import Basis, plain_rows
from preshape.engine.newton import ACCEPTED, Polished, polish, settled
from preshape.engine.polynomial import Polynomial
from preshape.engine.repair import confirmed

FAR = [(1.0, 0.05), (2.3, 0.0)]
CASES = {
    "one": ([(3.0, 0.1)], 1),
    "two": (FAR, 1),
    "very near": ([(1.0, 0.02), (1.0005, 0.02), (1.7, 0.0)], 1),
    "dense": ([(1.0 + 0.1 * i, 0.01) for i in range(10)], 1),
    "odd harmonics": ([(1.0, 0.0), (3.0, 0.0), (9.0, 0.0)], 1),
    "with an impulse more": ([(1.11, 0.176), (7.41, 0.026), (2.65, 0.0)], 1),
}


def solved(modes: list[tuple[float, float]], order: int = 1) -> tuple[Basis, np.ndarray, np.ndarray, np.ndarray]:
    """Basis, leads, amplitudes and multipliers of a proved optimum."""
    shaper = design.direct(modes, order)
    proof = shaper.design.certificate
    assert proof is not None
    basis = Basis(Modes(modes), proof.orders, proof.reference, proof.groups)
    leads = shaper.duration - shaper.times[::-1]
    return basis, leads, shaper.amplitudes[::-1], basis.multipliers(np.array(proof.coefficients))


@pytest.mark.parametrize("name", CASES)
def test_from_nearby_it_goes_to_the_optimum(name: str) -> None:
    basis, leads, amplitudes, c = solved(*CASES[name])
    rng = np.random.default_rng(1)
    gap = float(np.diff(leads).min())
    start = leads + 0.005 * gap * rng.uniform(-1.0, 1.0, leads.size)
    found = polish(basis, start, amplitudes + 1e-4 * rng.normal(size=leads.size), c)
    assert found.converged and found.leads[0] == 0.0
    np.testing.assert_allclose(found.leads, leads, rtol=0.0, atol=1e-8 * leads[-1])
    np.testing.assert_allclose(found.amplitudes, amplitudes, rtol=0.0, atol=1e-7)
    assert np.linalg.norm(found.multipliers) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("order", [0, 1, 2])
def test_one_mode_ends_at_the_closed_form(damping: float, order: int) -> None:
    known = design.zvdk((3.0, damping), order)
    leads, amplitudes = known.duration - known.times[::-1], known.amplitudes[::-1]
    basis = Basis(Modes((3.0, damping)), (order,), 1.1 * known.duration)
    # p >= 0 touches at the impulses: the combination that is smallest there
    rows = np.concatenate([basis(leads).T, basis.slopes(basis.raw(leads), 1).T[1:-1]])
    c = np.linalg.svd(rows)[2][-1]
    c *= np.sign((c @ basis(np.linspace(0.0, known.duration, 50))).sum())
    rng = np.random.default_rng(order)
    found = polish(basis, leads * (1.0 + 0.01 * rng.normal(size=leads.size)), amplitudes, c)
    assert found.converged
    np.testing.assert_allclose(found.leads, leads, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(found.amplitudes, amplitudes, rtol=0.0, atol=1e-12)


def test_the_error_squares_from_step_to_step() -> None:
    basis, leads, amplitudes, c = solved(FAR)
    start = leads * (1.0 + 0.002 * np.array([0.0, 1.0, -1.0, 1.0, -0.5]))
    errors = np.array([polish(basis, start, amplitudes, c, steps).error * basis.rounding for steps in range(1, 6)])
    assert errors[-1] <= ACCEPTED * basis.rounding
    large = errors[errors > 1e-12]
    assert large.size >= 3
    assert (large[1:] < 300.0 * large[:-1] ** 2).all()


@pytest.mark.parametrize("seed", range(20))
def test_impulses_never_change_their_order(seed: int) -> None:
    """Also from starts that lead nowhere."""
    basis, leads, amplitudes, c = solved(FAR)
    rng = np.random.default_rng(seed)
    start = np.concatenate([[0.0], np.sort(rng.uniform(0.05, 1.0, leads.size - 1)) * leads[-1]])
    for steps in (1, 2, 5, 40):
        found = polish(basis, start, amplitudes, rng.normal(size=c.size), steps)
        assert (np.diff(found.leads) > 0.0).all() and found.leads[0] == 0.0


def test_only_what_is_proved_counts() -> None:
    nothing = np.zeros(2)
    assert Polished(nothing, np.array([0.5, 0.5]), nothing, error=1.0).converged
    assert not Polished(nothing, np.array([1.1, -0.1]), nothing, error=1.0).converged
    assert not Polished(nothing, np.array([0.5, 0.5]), nothing, error=1e6).converged
    assert not Polished(nothing, np.array([0.5, 0.5]), nothing, error=math.inf).converged


def test_impulses_of_no_amplitude_are_left_out() -> None:
    full = Polished(np.array([0.0, 0.3, 0.6]), np.array([0.5, 1e-14, 0.5]), np.zeros(2), error=1.0)
    kept = full.without_empty_impulses()
    assert kept.leads.tolist() == [0.0, 0.6] and kept.amplitudes.tolist() == [0.5, 0.5]
    assert kept.without_empty_impulses() is kept


@pytest.mark.parametrize("name", CASES)
def test_settling_meets_the_papers_equations_to_the_last_digits(name: str) -> None:
    """From an error of 1e-9, and with changes of that size only."""
    basis, leads, amplitudes, c = solved(*CASES[name])
    rng = np.random.default_rng(2)
    off = 1e-9 * rng.normal(size=(2, leads.size))
    off[0, 0] = 0.0
    disturbed = Polished(leads + off[0] * leads[-1], amplitudes + off[1], c, error=1.0)
    exact = settled(basis, disturbed)
    before, after = (
        np.abs(plain_rows(basis.modes, basis.orders, each.leads, leads[-1])[0] @ each.amplitudes).max()
        for each in (disturbed, exact)
    )
    assert before > 1e-10 and after < 1e-15 + 1e-5 * before
    assert exact.amplitudes.sum() == pytest.approx(1.0, abs=1e-13)
    np.testing.assert_allclose(exact.leads, disturbed.leads, rtol=0.0, atol=1e-6 * leads[-1])
    np.testing.assert_allclose(exact.amplitudes, disturbed.amplitudes, rtol=0.0, atol=1e-6)


def agrees(found: Polished | None, leads: np.ndarray, amplitudes: np.ndarray) -> bool:
    return (
        found is not None
        and found.leads.size == leads.size
        and bool(np.abs(found.leads - leads).max() < 1e-8 * leads[-1])
        and bool(np.abs(found.amplitudes - amplitudes).max() < 1e-7)
    )


@pytest.mark.parametrize("name", CASES)
def test_the_optimum_itself_is_confirmed(name: str) -> None:
    basis, leads, amplitudes, c = solved(*CASES[name])
    found = confirmed(basis, leads, amplitudes, c, pivots=0)
    assert agrees(found, leads, amplitudes)
    assert found is not None and found.minima is not None
    assert found.minima[1].min() >= -1e-9 * found.minima[2]


@pytest.mark.parametrize(
    ("modes", "missing"),
    [([(1.22, 0.0), (3.93, 0.031)], 4), *[([(1.11, 0.176), (7.41, 0.026), (2.65, 0.0)], k) for k in (1, 2, 6, 7)]],
)
def test_a_missing_impulse_is_put_where_the_polynomial_is_below_zero(
    modes: list[tuple[float, float]], missing: int
) -> None:
    basis, leads, amplitudes, c = solved(modes)
    u, a = np.delete(leads, missing), np.delete(amplitudes, missing)
    assert confirmed(basis, u, a / a.sum(), c, pivots=0) is None
    assert agrees(confirmed(basis, u, a / a.sum(), c), leads, amplitudes)


@pytest.mark.parametrize(
    ("modes", "highest"),
    [
        ([(4.51, 0.039), (1.01, 0.084)], 1.0),
        ([(15.39, 0.154), (2.03, 0.123), (1.32, 0.0), (9.13, 0.0), (10.09, 0.192)], 0.1),
    ],
)
def test_an_impulse_too_many_comes_out_negative_and_is_dropped(
    modes: list[tuple[float, float]], highest: float
) -> None:
    """An impulse where the optimum's polynomial has a minimum above zero."""
    basis, leads, amplitudes, c = solved(modes)
    minima, values, largest = Polynomial(basis, c).minima(float(leads[-1]))
    places = minima[(values > 1e-6 * largest) & (values < highest * largest)]
    assert places.size > 1
    for place in places:
        k = int(np.searchsorted(leads, place))
        u, a = np.insert(leads, k, place), np.insert(amplitudes, k, 0.03)
        assert confirmed(basis, u, a / a.sum(), c, pivots=0) is None
        assert agrees(confirmed(basis, u, a / a.sum(), c), leads, amplitudes)


@pytest.mark.parametrize("k", [2, 3])
def test_an_impulse_given_as_two_beside_each_other_becomes_one(k: int) -> None:
    basis, leads, amplitudes, c = solved(FAR)
    apart = 0.05 * float(np.diff(leads).min())
    u = np.sort(np.concatenate([np.delete(leads, k), leads[k] + np.array([-apart, apart])]))
    a = np.insert(amplitudes, k, amplitudes[k] / 2.0)
    a[k + 1] = a[k]
    assert confirmed(basis, u, a, c, pivots=0) is None
    assert agrees(confirmed(basis, u, a, c), leads, amplitudes)


def test_a_start_that_leads_nowhere_is_not_confirmed() -> None:
    """Never something else as if it were the optimum: what is confirmed meets the constraints, and p is its proof."""
    basis, leads, _, _ = solved(FAR)
    rng, confirmed_ones = np.random.default_rng(3), 0
    for _ in range(60):
        count = int(rng.integers(2, 9))
        u = np.concatenate([[0.0], np.sort(rng.uniform(0.05, 1.3, count - 1)) * leads[-1]])
        found = confirmed(basis, u, rng.dirichlet(np.ones(count)), rng.normal(size=basis.size))
        if found is not None:
            confirmed_ones += 1
            assert found.leads[-1] == pytest.approx(leads[-1], rel=1e-8)
    assert confirmed_ones < 60


def test_a_confirmed_start_makes_a_shaper() -> None:
    basis, leads, amplitudes, c = solved(FAR)
    found = confirmed(basis, leads, amplitudes, c)
    assert found is not None
    shaper = Shaper.normalised(found.leads[-1] - found.leads[::-1], found.amplitudes[::-1])
    assert shaper.duration == pytest.approx(design.direct(FAR).duration, rel=1e-12)
