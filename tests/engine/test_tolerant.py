"""Tolerated vibration: edges carry the maximum, the Newton system's derivatives, zero and tolerated vibration mixed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Band, Mode, Modes
from preshape.engine import VibrationAtMost, ZeroVibration, edges_of, largest_vibration, minimum_duration
from preshape.engine.basis import Basis
from preshape.engine.edges import Edge
from preshape.engine.tolerant_newton import TolerantPoint, _system

EDGES = (
    Edge(0.8, 1.2, 0.02, 0.02, 0.05),
    Edge(0.8, 1.2, 0.02, 0.02, 0.05),
    Edge(1.2, 1.2, 0.02, 0.1, 0.05),
    Edge(0.8, 1.2, 0.1, 0.1, 0.07),
)


@settings(max_examples=30)
@given(st.integers(0, 2**31), st.floats(0.2, 2.0), st.floats(0.0, 1.5), st.floats(0.0, 0.2), st.floats(0.0, 0.3))
def test_the_largest_vibration_of_a_rectangle_is_on_its_edges(
    seed: int, low: float, width: float, damping: float, spread: float
) -> None:
    random = np.random.default_rng(seed)
    leads = np.append(0.0, np.sort(random.uniform(0.01, 3.0, 4)))
    amplitudes = random.normal(size=5)
    band = Band(low, low + width, damping, damping + spread)
    found = largest_vibration(edges_of([band], 0.05), leads, amplitudes).vibration
    f = np.linspace(band.low, band.high, 301)[:, None, None]
    z = np.linspace(damping, damping + spread, 41)[None, :, None]
    grid = np.abs((amplitudes * np.exp(-2.0 * np.pi * f * (z + 1j * np.sqrt(1.0 - z**2)) * leads)).sum(axis=2))
    assert found >= grid.max() * (1.0 - 1e-9)
    on_edges = max(grid[0].max(), grid[-1].max(), grid[:, 0].max(), grid[:, -1].max())
    assert found <= on_edges * (1.0 + 0.05) + 1e-12  # a grid may miss a peak, by little


@pytest.mark.parametrize("basis", [None, Basis(Modes([(3.0, 0.01)]), (1,), 1.3)], ids=["bands", "with zeros"])
def test_the_newton_system_has_its_own_derivatives(basis: Basis | None) -> None:
    random = np.random.default_rng(0)
    size, scale, n, k = 0 if basis is None else basis.size, 1.1, 4, 4
    point = TolerantPoint(
        leads=np.array([0.0, 0.3, 0.7, 1.1]),
        amplitudes=random.uniform(0.1, 0.4, n),
        multipliers=random.normal(size=size),
        sizes=random.uniform(0.2, 1.0, k),
        phases=random.uniform(-3.0, 3.0, k),
        edges=EDGES,
        places=np.array([0.0, 0.4, 0.6, 1.0]),
    )
    _, jacobian, inner = _system(basis, point, scale)

    def moved(step: np.ndarray) -> np.ndarray:
        da, du, dc, dl, dw = np.split(step, np.cumsum([n, n - 1, size, 2 * k]))
        leads, places = point.leads.copy(), point.places.copy()
        leads[1:] += du * scale
        places[inner] += dw
        after = TolerantPoint(
            leads,
            point.amplitudes + da,
            point.multipliers + dc,
            point.sizes + dl[:k],
            point.phases + dl[k:],
            EDGES,
            places,
        )
        return np.asarray(_system(basis, after, scale)[0])

    h = 1e-6
    numeric = np.array([(moved(h * e) - moved(-h * e)) / (2.0 * h) for e in np.eye(jacobian.shape[1])]).T
    assert jacobian.shape[0] == jacobian.shape[1]  # the system is square
    np.testing.assert_allclose(jacobian, numeric, atol=2e-6)


@pytest.mark.parametrize(
    ("zeros", "band"),
    [
        ([ZeroVibration(Mode(2.0, 0.01), 1)], Band(4.5, 5.5)),
        ([ZeroVibration(Mode(5.0, 0.02)), ZeroVibration(Mode(2.0, 0.02))], Band(0.9, 1.1, 0.0, 0.05)),
    ],
)
def test_zero_and_tolerated_vibration_together(zeros: list[ZeroVibration], band: Band) -> None:
    found = minimum_duration([*zeros, VibrationAtMost(band, 0.05)])
    assert found.status == "optimal" and found.certificate is not None and found.certificate.holds
    leads = found.times[-1] - found.times
    for one in zeros:
        for power in range(one.order + 1):
            assert abs((found.amplitudes * leads**power * np.exp(np.conj(one.mode.pole) * leads)).sum()) < 1e-10
    worst = largest_vibration(edges_of([band], 0.05), leads[::-1], found.amplitudes[::-1])
    assert worst.vibration <= 0.05 * (1.0 + 1e-6)
    for part in ([*zeros], [VibrationAtMost(band, 0.05)]):
        assert minimum_duration(part).times[-1] < found.times[-1]
    p = found.certificate.polynomial(np.linspace(0.0, found.times[-1], 5001))
    assert p.min() > -1e-8 * np.abs(p).max()


def test_a_tolerance_that_zero_vibration_keeps_by_itself_changes_nothing() -> None:
    alone = minimum_duration([ZeroVibration(Mode(2.0), 1)])
    both = minimum_duration([ZeroVibration(Mode(2.0), 1), VibrationAtMost(Band(1.99, 2.01), 0.05)])
    assert both.status == "optimal" and both.times[-1] == pytest.approx(alone.times[-1], rel=1e-12)
    assert math.isclose(alone.times[-1], 0.5, rel_tol=1e-12)
