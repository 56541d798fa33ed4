"""The edges of a band: their curves, their derivatives, and every maximum of the vibration along them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Band, Mode, Shaper
from preshape.engine import edges_of, largest_vibration
from preshape.engine.edges import Edge, vibration_peaks
from preshape.vibration import residual_vibration


@pytest.mark.parametrize(
    ("band", "count"),
    [
        (Band(1.0, 1.0), 1),
        (Band(1.0, 2.0), 1),
        (Band(1.0, 1.0, 0.1, 0.2), 2),
        (Band(1.0, 2.0, 0.1, 0.2), 4),
        (Band(1.0, 2.0, 0.1), 1),
    ],
)
def test_a_band_has_the_edges_that_have_length(band: Band, count: int) -> None:
    edges = edges_of([band, band], 0.05)
    assert len(edges) == 2 * count and all(edge.tolerance == 0.05 for edge in edges)
    corners = {edge.mode(w) for edge in edges for w in (0.0, 1.0)}
    expected = {(f, z) for f in (band.low, band.high) for z in (band.least_damping, band.highest_damping)}
    assert {(round(f, 9), round(z, 9)) for f, z in corners} == expected


@pytest.mark.parametrize("edge", [Edge(0.8, 1.3, 0.1, 0.1, 0.05), Edge(1.3, 1.3, 0.05, 0.4, 0.05)])
def test_rates_are_those_of_the_modes_and_have_these_derivatives(edge: Edge) -> None:
    places, h = np.linspace(0.05, 0.95, 7), 1e-5
    for w in places:
        assert complex(edge.rate(np.array(w))) == pytest.approx(-Mode(*edge.mode(w)).pole.conjugate(), rel=1e-12)
    for order in (1, 2):
        numeric = (edge.rate(places + h, order - 1) - edge.rate(places - h, order - 1)) / (2.0 * h)
        np.testing.assert_allclose(edge.rate(places, order), numeric, rtol=1e-8, atol=1e-8)


@settings(max_examples=60)
@given(st.integers(0, 2**31), st.integers(2, 12), st.floats(0.0, 0.3), st.booleans())
def test_every_maximum_along_an_edge_is_found(seed: int, count: int, damping: float, along_damping: bool) -> None:
    """Against a grid of ten thousand places: as many summits, as high, the ends among them."""
    random = np.random.default_rng(seed)
    leads = np.append(0.0, np.sort(random.uniform(0.01, 6.0, count - 1)))
    amplitudes = random.normal(size=count)
    low, high = damping, min(damping + 0.4, 0.9)
    edge = Edge(1.0, 1.0, low, high, 0.05) if along_damping else Edge(0.4, 2.4, damping, damping, 0.05)
    w = np.linspace(0.0, 1.0, 10_001)
    modes = np.array([edge.mode(value) for value in w[::1000]])
    s = np.exp(1j * (math.acos(edge.low_damping) * (1.0 - w) + math.acos(edge.high_damping) * w))
    v = np.abs(
        np.exp(np.multiply.outer(-2.0 * np.pi * (edge.low + (edge.high - edge.low) * w) * s, leads)) @ amplitudes
    )
    np.testing.assert_allclose(v[::1000], _vibration(leads, amplitudes, modes), rtol=1e-9)
    peaks = vibration_peaks([edge], leads, amplitudes)
    found = np.array([peak.vibration for peak in peaks])
    assert found.max() == pytest.approx(v.max(), rel=1e-5) and found.max() >= v.max() * (1.0 - 1e-12)
    rising = np.diff(np.concatenate([[-1.0], v, [-1.0]])) > 0.0
    summits = v[rising[:-1] & ~rising[1:]]
    assert found.size == summits.size
    np.testing.assert_allclose(np.sort(found), np.sort(summits), rtol=1e-4)


def _vibration(leads: np.ndarray, amplitudes: np.ndarray, modes: np.ndarray) -> np.ndarray:
    shaper = Shaper(leads[-1] - leads[::-1], amplitudes[::-1] / amplitudes.sum())
    return np.array([float(residual_vibration(shaper, f, z)) for f, z in modes]) * abs(amplitudes.sum())


@settings(max_examples=40)
@given(st.integers(0, 2**31), st.floats(0.1, 3.0), st.floats(0.0, 2.0), st.floats(0.0, 0.5), st.floats(0.0, 0.45))
def test_inside_a_rectangle_nothing_is_larger_than_on_its_edges(
    seed: int, low: float, width: float, damping: float, spread: float
) -> None:
    """The maximum modulus principle, which the engine rests on, for shapers of any sign."""
    random = np.random.default_rng(seed)
    leads = np.append(0.0, np.sort(random.uniform(0.01, 3.0, 6)))
    amplitudes = random.normal(size=7)
    band = Band(low, low + width, damping, damping + spread)
    worst = largest_vibration(edges_of([band], 0.05), leads, amplitudes)
    f = random.uniform(band.low, band.high, 2000)
    z = random.uniform(band.least_damping, band.highest_damping, 2000)
    inside = np.abs(np.exp(np.multiply.outer(-2.0 * np.pi * f * (z + 1j * np.sqrt(1.0 - z**2)), leads)) @ amplitudes)
    assert inside.max() <= worst.vibration * (1.0 + 1e-12)
    assert worst.excess == pytest.approx(worst.vibration / 0.05 - 1.0)


def test_the_worst_is_the_one_that_exceeds_its_own_tolerance_most() -> None:
    leads, amplitudes = np.array([0.0, 0.5]), np.array([0.5, 0.5])
    edges = (*edges_of([Band(0.9, 1.1)], 0.5), *edges_of([Band(1.0, 1.0, 0.1)], 0.01))
    assert largest_vibration(edges, leads, amplitudes).edge.tolerance == 0.01
