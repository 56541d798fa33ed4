"""Two thousand random sets of modes: every shaper proved, nothing left, and never longer than any other way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from preshape import Mode, Modes, Shaper, design
from preshape.engine import is_proved_shortest
from preshape.engine.basis import plain_rows
from preshape.errors import InputError
from preshape.plant import ModalPlant

CHUNKS, CHUNK = 40, 50

SAME = 1e-9
"""Relative rounding of a duration."""


def random_set(random: np.random.Generator) -> tuple[Modes, tuple[int, ...]]:
    """1 to 12 modes, damping 0 to 0.2, ratios 1.001 to 50; three in ten with mixed orders, the others order 1."""
    count = int(random.integers(1, 13))
    frequencies = np.exp(random.uniform(0.0, np.log(50.0), count))
    dampings = random.uniform(0.0, 0.2, count) * (random.random(count) < 0.7)
    if count > 1 and random.random() < 0.3:
        frequencies[1] = frequencies[0] * 1.001
    mixed = random.random() < 0.3
    orders = tuple(int(q) for q in random.integers(0, 3, count)) if mixed else (1,) * count
    return Modes(list(zip(frequencies.tolist(), dampings.tolist(), strict=True))), orders


def left(shaper: Shaper, modes: Modes, orders: tuple[int, ...]) -> float:
    """Largest of the residuals and of their derivatives, each over that of one impulse at the longest lead."""
    leads, worst = shaper.duration - shaper.times, 0.0
    for mode, order in zip(modes, orders, strict=True):
        wave = np.exp(np.conj(mode.pole) * leads) * shaper.amplitudes
        worst = max(worst, *(abs((wave * (leads / shaper.duration) ** k).sum()) for k in range(order + 1)))
    return worst


@pytest.mark.slow
@pytest.mark.parametrize("chunk", range(CHUNKS))
def test_every_set_is_proved_and_leaves_nothing(chunk: int) -> None:
    random = np.random.default_rng([1991, chunk])
    for _ in range(CHUNK):
        modes, orders = random_set(random)
        shaper = design.direct(modes, orders)
        case = f"{modes!r}, {orders}"
        assert shaper.design.status == "optimal", case
        assert shaper.design.certificate is not None and shaper.design.certificate.holds, case
        assert is_proved_shortest(shaper), case
        assert (shaper.amplitudes > 0.0).all() and left(shaper, modes, orders) < 1e-9, case
        convolved = sum((order + 1) * mode.damped_period / 2.0 for mode, order in zip(modes, orders, strict=True))
        assert shaper.duration <= convolved * (1.0 + SAME), case


def clustered_set(random: np.random.Generator) -> tuple[Modes, tuple[int, ...]]:
    """1 to 12 modes, neighbours at least 1.001 apart, crowded into a range of any ratio up to 50."""
    count, gaps = int(random.integers(1, 13)), np.zeros(1)
    while gaps.min() < 1e-3:
        width = np.exp(random.uniform(np.log(0.002 * count**2), np.log(np.log(50.0))))
        logarithms = np.sort(random.uniform(0.0, width, count))
        gaps = np.diff(logarithms, append=np.inf)
    dampings = random.uniform(0.0, 0.2, count) * (random.random(count) < 0.7)
    orders = (1,) * count if random.random() < 0.8 else tuple(int(q) for q in random.integers(0, 3, count))
    return Modes(list(zip(np.exp(logarithms).tolist(), dampings.tolist(), strict=True))), orders


@pytest.mark.slow
@pytest.mark.parametrize("chunk", range(10))
def test_clusters_are_proved_too_or_what_is_open_is_said(chunk: int) -> None:
    """Ten modes within a few per cent differ by less than 1e-22: then, and only then, the shaper is not proved."""
    random, unproved = np.random.default_rng([1990, chunk]), 0
    for _ in range(CHUNK):
        modes, orders = clustered_set(random)
        shaper = design.direct(modes, orders)
        case = f"{modes!r}, {orders}"
        assert (shaper.amplitudes > 0.0).all() and left(shaper, modes, orders) < 1e-9, case
        assert ModalPlant(modes).impulse_residual(shaper.times, shaper.amplitudes).max() < 1e-12, case
        alone = [(order + 1) * mode.damped_period / 2.0 for mode, order in zip(modes, orders, strict=True)]
        assert max(alone) * (1.0 - SAME) <= shaper.duration <= sum(alone) * (1.0 + SAME), case
        if shaper.design.status == "optimal":
            assert shaper.design.certificate is not None and shaper.design.certificate.holds, case
            assert is_proved_shortest(shaper), case
        else:
            assert shaper.design.status == "feasible" and shaper.design.certificate is None, case
            assert 0.0 < shaper.design.settings["gap"] < 1.0 and not is_proved_shortest(shaper), case
            assert sum(orders) + len(orders) >= 12, case
            unproved += 1
    assert unproved <= 1


@pytest.mark.slow
def test_never_longer_than_an_antiperiod_shaper() -> None:
    random, tried = np.random.default_rng(1993), 0
    while tried < 40:
        base, count = random.uniform(0.5, 5.0), int(random.integers(2, 5))
        multiples = 2 * random.choice(12, count, replace=False) + 1
        damping = random.uniform(0.0, 0.1, count) * (tried % 2)
        pairs = zip(multiples, damping, strict=True)
        modes = Modes([Mode.from_damped_frequency(float(base * m), float(z)) for m, z in pairs])
        try:
            other = design.antiperiod(modes, impulses="exact_robust")
        except InputError:
            continue
        assert design.direct(modes).duration <= other.duration * (1.0 + SAME)
        tried += 1


@pytest.mark.slow
def test_never_longer_than_on_a_mesh() -> None:
    random = np.random.default_rng(1992)
    for _ in range(40):
        count = int(random.integers(1, 5))
        modes = Modes([(float(f), float(z)) for f, z in random.uniform([1.0, 0.0], [10.0, 0.1], (count, 2))])
        on_mesh = design.mesh(modes, 0.01)
        assert design.direct(modes).duration <= on_mesh.duration * (1.0 + SAME)


@pytest.mark.slow
def test_sequential_programming_finds_nothing_shorter() -> None:
    """SLSQP with free times and amplitudes, from the optimum disturbed and from random starts."""
    random, met = np.random.default_rng(1988), 0
    for _ in range(30):
        count = int(random.integers(1, 4))
        modes = Modes([(float(f), float(z)) for f, z in random.uniform([1.0, 0.0], [6.0, 0.1], (count, 2))])
        shaper = design.direct(modes)
        impulses = len(shaper) + 1
        for disturbed in (0.02, 0.2):
            leads = np.sort(np.append(shaper.duration - shaper.times, random.uniform(0.0, shaper.duration)))
            leads = leads * (1.0 + disturbed * random.uniform(-1.0, 1.0, impulses))
            found = sequential(modes, np.sort(leads) - leads.min(), shaper.duration)
            if found is not None:
                met += 1
                assert found >= shaper.duration * (1.0 - 1e-7)
    assert met > 20  # or this says nothing


def sequential(modes: Modes, leads: NDArray[np.float64], scale: float) -> float | None:
    """The duration that SLSQP ends at, if its shaper meets the equations."""
    from scipy.optimize import minimize

    count = leads.size
    gaps = np.zeros((count - 1, 2 * count - 1))
    gaps[:, count:] = np.eye(count - 1) - np.eye(count - 1, k=-1)
    goal = np.append(np.zeros(2 * count - 2), 1.0)
    orders = (1,) * len(modes)

    def rows(x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return plain_rows(modes, orders, np.append(0.0, x[count:]) * scale, scale)

    def equations(x: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.append(rows(x)[0] @ x[:count], x[:count].sum() - 1.0)

    def slopes(x: NDArray[np.float64]) -> NDArray[np.float64]:
        values, changes = rows(x)
        top = np.concatenate([values, (changes * x[:count] * scale)[:, 1:]], axis=1)
        return np.vstack([top, np.append(np.ones(count), np.zeros(count - 1))])

    settings: dict[str, Any] = {
        "jac": lambda x: goal,
        "method": "SLSQP",
        "bounds": [(0.0, 1.0)] * count + [(0.0, 2.0)] * (count - 1),
        "constraints": [
            {"type": "eq", "fun": equations, "jac": slopes},
            {"type": "ineq", "fun": lambda x: gaps @ x, "jac": lambda x: gaps},
        ],
        "options": {"maxiter": 300, "ftol": 1e-12},
    }
    start = np.concatenate([np.full(count, 1.0 / count), leads[1:] / scale])
    answer = minimize(lambda x: float(x[-1]), start, **settings)
    if np.abs(equations(answer.x)).max() > 1e-10 or (answer.x[:count] < -1e-12).any():
        return None
    return float(answer.x[-1]) * scale
