"""Direct shapers where searches fail: near-equal modes, harmonics, modes far apart, mixed orders, twenty modes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Modes, Shaper, design
from preshape.engine import is_proved_shortest, shortest_positive
from preshape.plant import ModalPlant


def random_twenty() -> list[tuple[float, float]]:
    """Twenty modes anywhere from 1 to 20 Hz; some are within 1 % of each other."""
    rng = np.random.default_rng(5)
    rng.uniform(1.0, 20.0, 10)
    return [(float(f), 0.01) for f in np.sort(rng.uniform(1.0, 20.0, 20))]


HARD: dict[str, tuple[list[tuple[float, float]], list[int]]] = {
    "mixed orders": ([(1.0, 0.02), (2.7, 0.01), (4.1, 0.0), (6.0, 0.1)], [0, 2, 1, 3]),
    "near, 1.0005": ([(1.0, 0.01), (1.0005, 0.01), (2.0, 0.0)], [1, 1, 1]),
    "two near pairs": ([(1.0, 0.01), (1.0005, 0.02), (1.7, 0.0), (1.7 * 1.0005, 0.0)], [1, 1, 2, 0]),
    "near, one in 1e8": ([(1.0, 0.05), (1.0 + 1e-8, 0.05), (2.3, 0.0)], [1, 1, 1]),
    "five within a thousandth": ([(1.0 + 2e-4 * i, 0.0) for i in range(5)], [1] * 5),
    "harmonics 1 2 3": ([(1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], [1, 1, 1]),
    "harmonics 1 2 3, damped": ([(1.0, 0.02), (2.0, 0.02), (3.0, 0.02)], [1, 1, 1]),
    "harmonics 1 3 9": ([(1.0, 0.0), (3.0, 0.0), (9.0, 0.0)], [1, 1, 1]),
    "harmonics 1 3 9, damped": ([(1.0, 0.01), (3.0, 0.01), (9.0, 0.01)], [1, 1, 1]),
    "harmonics 1 to 5": ([(float(i), 0.0) for i in range(1, 6)], [1] * 5),
    "far, 1 to 100": ([(1.0, 0.0), (100.0, 0.0)], [1, 1]),
    "far, damped": ([(1.0, 0.05), (100.0, 0.01)], [1, 1]),
    "dampings 0 to 0.3": ([(1.0, 0.0), (1.6, 0.3), (2.2, 0.1), (3.7, 0.2), (5.0, 0.01)], [1] * 5),
    "equal frequencies": ([(1.0, 0.0), (1.0, 0.1), (1.0, 0.3)], [1, 0, 1]),
    "ten in an octave": ([(1.0 + 0.1 * i, 0.01) for i in range(10)], [1] * 10),
    "twenty, even": ([(float(f), 0.01) for f in range(1, 21)], [1] * 20),
    "twenty, random": (random_twenty(), [1] * 20),
}

MADE: dict[str, Shaper] = {}


def made(name: str) -> Shaper:
    if name not in MADE:
        MADE[name] = design.direct(*HARD[name])
    return MADE[name]


def left(shaper: Shaper, modes: list[tuple[float, float]], orders: list[int]) -> float:
    """Largest |sum a (|s| u)^k / k! exp(-s u)|: the residual and its derivatives in ln f, written out anew."""
    leads, worst = shaper.duration - shaper.times, 0.0
    for (frequency, damping), order in zip(modes, orders, strict=True):
        w = 2.0 * math.pi * frequency
        waves = shaper.amplitudes * np.exp(-w * (damping + 1j * math.sqrt(1.0 - damping**2)) * leads)
        for k in range(order + 1):
            worst = max(worst, abs((waves * (w * leads) ** k).sum()) / math.factorial(k))
    return worst


@pytest.mark.parametrize("name", HARD)
def test_it_is_proved_shortest(name: str) -> None:
    shaper = made(name)
    assert shaper.design.status == "optimal"
    assert shaper.design.certificate is not None and shaper.design.certificate.holds
    assert is_proved_shortest(shaper)


@pytest.mark.parametrize("name", HARD)
def test_nothing_is_left_of_vibration_and_its_slopes(name: str) -> None:
    shaper, (modes, orders) = made(name), HARD[name]
    assert (shaper.amplitudes > 0.0).all() and shaper.amplitudes.sum() == pytest.approx(1.0, abs=1e-14)
    assert left(shaper, modes, orders) < 1e-9
    assert ModalPlant(modes).impulse_residual(shaper.times, shaper.amplitudes).max() < 1e-12


@pytest.mark.parametrize("name", HARD)
def test_it_is_no_longer_than_convolved_and_no_shorter_than_its_longest_mode(name: str) -> None:
    shaper, (modes, orders) = made(name), HARD[name]
    alone = [
        (order + 1) * 0.5 / (frequency * math.sqrt(1.0 - damping**2))
        for (frequency, damping), order in zip(modes, orders, strict=True)
    ]
    assert max(alone) * (1.0 - 1e-9) <= shaper.duration <= sum(alone) * (1.0 + 1e-9)


@pytest.mark.parametrize(
    "name", ["mixed orders", "near, 1.0005", "harmonics 1 2 3, damped", "far, damped", "dampings 0 to 0.3"]
)
def test_an_independent_solver_finds_nothing_one_per_cent_shorter(name: str) -> None:
    """Interior-point linear programme on a fine mesh, rows orthonormalised: least L1 miss of positive impulses."""
    from scipy.optimize import linprog

    shaper, (modes, orders) = made(name), HARD[name]
    misses = []
    for factor in (0.99, 1.01):
        duration = factor * shaper.duration
        leads = np.linspace(0.0, duration, int(30 * max(f for f, _ in modes) * duration) + 300)
        rows = []
        for (frequency, damping), order in zip(modes, orders, strict=True):
            w = 2.0 * math.pi * frequency
            waves = np.exp(-w * (damping + 1j * math.sqrt(1.0 - damping**2)) * leads)
            for k in range(order + 1):
                rows += [(waves * (leads / duration) ** k).real, (waves * (leads / duration) ** k).imag]
        matrix = np.linalg.qr(np.array(rows).T)[0].T * math.sqrt(leads.size)
        m, n = matrix.shape
        answer = linprog(
            np.concatenate([np.zeros(n), np.ones(2 * m)]),
            A_eq=np.block([[matrix, np.eye(m), -np.eye(m)], [np.ones((1, n)), np.zeros((1, 2 * m))]]),
            b_eq=np.append(np.zeros(m), 1.0),
            method="highs-ipm",
            options={"time_limit": 20.0},
        )
        assert answer.status == 0
        misses.append(answer.fun)
    assert misses[0] > 1e-4 and misses[1] < 1e-8


@pytest.mark.parametrize("orders", [[0, 1, 2], [2, 1, 0], [1, 0, 1], [0, 0, 3]])
def test_a_mixed_order_lies_between_the_equal_ones(orders: list[int]) -> None:
    modes = [(1.0, 0.02), (2.7, 0.01), (3.3, 0.0)]
    low, mixed, high = (design.direct(modes, each).duration for each in (min(orders), orders, max(orders)))
    assert low < mixed < high


def test_the_order_in_which_modes_are_given_does_not_matter() -> None:
    modes, orders = HARD["mixed orders"]
    turned = design.direct(modes[::-1], orders[::-1])
    np.testing.assert_allclose(turned.times, made("mixed orders").times, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(turned.amplitudes, made("mixed orders").amplitudes, rtol=0.0, atol=1e-10)


@pytest.mark.parametrize("damping", [0.0, 0.01, 0.1, 0.3, 0.7])
@pytest.mark.parametrize("order", [0, 1, 2, 4])
def test_the_search_finds_every_closed_form_of_one_mode(damping: float, order: int) -> None:
    """The engine's search, which does not know them, and the front door, which takes them as a start."""
    known = [design.zv, design.zvd, design.zvdd][order] if order < 3 else lambda mode: design.zvdk(mode, order)
    closed = known((3.0, damping))
    searched = shortest_positive(Modes((3.0, damping)), (order,))
    assert searched.certificate is not None and searched.certificate.holds
    for found in (searched, design.direct((3.0, damping), order)):
        np.testing.assert_allclose(found.times, closed.times, rtol=0.0, atol=1e-8 * closed.duration)
        np.testing.assert_allclose(found.amplitudes, closed.amplitudes, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("ratio", [1.0005, 1.05, 1.5, 2.0, 2.9, 2.999, 3.0])
@pytest.mark.parametrize("order", [0, 1])
def test_the_search_finds_the_closed_form_of_two_modes(ratio: float, order: int) -> None:
    closed = design.symmetric_two_modes([(2.0, 0.0), (2.0 * ratio, 0.0)], order)
    searched = shortest_positive(Modes([(2.0, 0.0), (2.0 * ratio, 0.0)]), (order, order))
    assert searched.certificate is not None and searched.certificate.holds
    assert searched.times[-1] == pytest.approx(closed.duration, rel=1e-8)
    if ratio < 2.99:  # beside 3 two of the impulses vanish
        np.testing.assert_allclose(searched.times, closed.times, rtol=0.0, atol=1e-8 * closed.duration)
        np.testing.assert_allclose(searched.amplitudes, closed.amplitudes, rtol=0.0, atol=1e-8)
