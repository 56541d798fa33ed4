"""Few impulses: kept on the continuum, and nothing shorter found by a search that shares nothing with it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from preshape import Band, design
from preshape.engine import AtMostImpulses, VibrationAtMost, edges_of, largest_vibration, minimum_duration
from preshape.engine.limited import shortest_limited
from preshape.errors import InputError

TWO = [(0.9, 1.1), (2.7, 3.3)]


def vibration(u: np.ndarray, a: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    return np.abs(np.exp(-2j * np.pi * np.multiply.outer(frequencies, u)) @ a)


def shortest_of_random_starts(count: int, optimum: float, starts: int) -> float:
    """Penalised Nelder-Mead and SLSQP on sampled frequencies, undamped, written anew; the last lead [s]."""
    frequencies = np.concatenate([np.linspace(low, high, 41) for low, high in TWO])
    random, best = np.random.default_rng(11), np.inf
    for _ in range(starts):
        steps, weights = random.uniform(0.2, 2.0, count - 1), random.uniform(0.1, 1.0, count)
        start = np.concatenate([steps * random.uniform(1.0, 1.8) * optimum / steps.sum(), weights / weights.sum()])
        answer = minimize(
            lambda x: x[: count - 1].sum(),
            start,
            method="SLSQP",
            bounds=[(1e-3, None)] * (count - 1) + [(0.0, 1.0)] * count,
            constraints=[
                {"type": "eq", "fun": lambda x: x[count - 1 :].sum() - 1.0},
                {
                    "type": "ineq",
                    "fun": lambda x: (
                        0.05 - vibration(np.append(0.0, np.cumsum(x[: count - 1])), x[count - 1 :], frequencies)
                    ),
                },
            ],
            options={"maxiter": 150},
        )
        if answer.success and answer.fun < best:
            u, a = np.append(0.0, np.cumsum(answer.x[: count - 1])), answer.x[count - 1 :]
            if vibration(u, a, frequencies).max() < 0.05 + 1e-6:
                best = float(answer.fun)
    return best


@pytest.mark.parametrize("count", [4, 5])
def test_random_starts_find_nothing_shorter(count: int) -> None:
    optimum = design.specified_insensitivity(TWO).duration
    found = design.specified_insensitivity(TWO, at_most=count)
    # between its samples the search may exceed the tolerance a little, and is that much shorter
    assert found.duration <= shortest_of_random_starts(count, optimum, 12) * (1.0 + 1e-4)


@pytest.mark.parametrize(
    ("bands", "tolerance", "count"),
    [
        (TWO, 0.05, 5),
        (TWO, 0.05, 4),
        ([(0.9, 1.1, 0.0, 0.1), (2.8, 3.2, 0.02)], 0.05, 4),
        ([(0.9, 1.1, 0.0, 0.1), (2.8, 3.2, 0.02)], 0.05, 3),
    ],
)
def test_the_limit_and_the_tolerance_are_kept_and_the_gap_is_to_the_proved_optimum(
    bands: list[tuple[float, ...]], tolerance: float, count: int
) -> None:
    optimum = design.specified_insensitivity(bands, tolerance)
    assert len(optimum) > count and optimum.design.status == "optimal"
    found = design.specified_insensitivity(bands, tolerance, at_most=count)
    assert len(found) <= count and (found.amplitudes > 0.0).all()
    assert found.design.status == "feasible" and found.design.certificate is None
    assert found.duration > optimum.duration
    assert found.duration * (1.0 - found.design.settings["gap"]) == pytest.approx(optimum.duration, rel=1e-9)
    edges = edges_of([Band(*band) for band in bands], tolerance)
    leads = found.duration - found.times[::-1]
    assert largest_vibration(edges, leads, found.amplitudes[::-1]).excess < 1e-6


def test_more_impulses_are_never_longer_and_the_search_is_seeded() -> None:
    shapers = [design.specified_insensitivity(TWO, at_most=count) for count in (4, 4, 6, 7)]
    assert shapers[0] == shapers[1] and shapers[2] == shapers[3]
    assert shapers[0].duration > shapers[2].duration


def test_what_no_start_leads_to_is_none_and_the_door_says_so() -> None:
    optimum = design.specified_insensitivity((0.9, 1.1))
    leads, amplitudes = optimum.duration - optimum.times[::-1], optimum.amplitudes[::-1]
    assert shortest_limited(edges_of([Band(0.9, 1.1)], 0.05), 2, leads, amplitudes) is None
    asked = [VibrationAtMost(Band(0.9, 1.1), 0.05), AtMostImpulses(2)]
    answer = minimum_duration(asked)
    assert answer.status == "infeasible" and answer.times.size == 0
    assert "no shaper with at most 2 impulses" in answer.reason
    assert f"3 impulses do it in {optimum.duration:.6g} s" in answer.reason
    with pytest.raises(InputError, match="at most 2 impulses"):
        design.specified_insensitivity((0.9, 1.1), at_most=2)
