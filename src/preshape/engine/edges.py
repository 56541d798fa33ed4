"""Where vibration in a band is largest: on the edges of its rectangle.

The sum F(s) = sum a_i exp(-s u_i) is analytic in s, so its magnitude has no maximum inside a region of the s plane but
only on the border: four curves s(w), each searched over its one parameter. Lines of constant damping are straight rays,
lines of constant frequency arcs.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.band import Band

__all__ = ["Contact", "Edge", "edges_of", "largest_vibration", "vibration_peaks"]

SAMPLES_PER_RIPPLE = 16
"""Samples per 1/duration of frequency; V^2 has no faster ripple than that."""

FEWEST_SAMPLES = 9

REFINEMENTS = 40

AT_END = 1e-9
"""A peak this near the end of its edge (parameter from 0 to 1) is at the end."""


@dataclass(frozen=True)
class Edge:
    """One side of a band: rates s(w) = 2 pi f(w) exp(i theta(w)), w from 0 to 1.

    Parameters
    ----------
    low, high : float
        Natural frequencies at w = 0 and 1 [Hz].
    low_damping, high_damping : float
        Damping ratios at w = 0 and 1 [-]; either these or the frequencies are equal.
    tolerance : float
        V allowed [-].
    """

    low: float
    high: float
    low_damping: float
    high_damping: float
    tolerance: float

    @property
    def is_point(self) -> bool:
        """Whether it has no length."""
        return self.low == self.high and self.low_damping == self.high_damping

    def rate(self, w: NDArray[np.float64], derivative: int = 0) -> NDArray[np.complex128]:
        """s or its first or second derivative by w [1/s]."""
        first, last = math.acos(self.low_damping), math.acos(self.high_damping)
        if first == last:
            direction = 2.0 * math.pi * cmath.exp(1j * first)
            frequencies = (self.low + (self.high - self.low) * w, np.full(w.shape, self.high - self.low), 0.0 * w)
            return np.asarray(direction * frequencies[derivative], dtype=complex)
        turn = 1j * (last - first)
        return np.asarray(2.0 * math.pi * self.low * turn**derivative * np.exp(1j * first + turn * w), dtype=complex)

    def mode(self, w: float) -> tuple[float, float]:
        """Natural frequency [Hz] and damping ratio [-] at w."""
        if self.low_damping == self.high_damping:
            return self.low + (self.high - self.low) * w, self.low_damping
        first, last = math.acos(self.low_damping), math.acos(self.high_damping)
        return self.low, math.cos(first + (last - first) * w)


@dataclass(frozen=True)
class Contact:
    """A place on an edge: its parameter w, and the vibration there [-]."""

    edge: Edge
    w: float
    vibration: float

    @property
    def rate(self) -> complex:
        """s [1/s]."""
        return complex(self.edge.rate(np.array(self.w)))

    @property
    def excess(self) -> float:
        """Vibration over the tolerance, minus one [-]."""
        return self.vibration / self.edge.tolerance - 1.0


def edges_of(bands: Sequence[Band], tolerance: float) -> tuple[Edge, ...]:
    """The sides of all bands; of a band without width or height only what is left of them."""
    found = []
    for band in bands:
        z, most = band.least_damping, band.highest_damping
        found.append(Edge(band.low, band.high, z, z, tolerance))
        if most > z:
            found.append(Edge(band.low, band.low, z, most, tolerance))
            if band.high > band.low:
                found += [Edge(band.low, band.high, most, most, tolerance)]
                found += [Edge(band.high, band.high, z, most, tolerance)]
    return tuple(found)


def largest_vibration(edges: Sequence[Edge], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> Contact:
    """The peak that exceeds its tolerance most."""
    return max(vibration_peaks(edges, leads, amplitudes), key=lambda peak: peak.excess)


def vibration_peaks(
    edges: Sequence[Edge], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> list[Contact]:
    """All local maxima of V along every edge, ends included, located on the continuum."""
    peaks = []
    for edge in edges:
        for w in _maxima(edge, leads, amplitudes):
            value = abs(complex(np.exp(-complex(edge.rate(np.array(w))) * leads) @ amplitudes))
            peaks.append(Contact(edge, float(w), value))
    return peaks


def _maxima(edge: Edge, leads: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Parameters of the local maxima of V along one edge."""
    if edge.is_point:
        return np.array([0.0])
    duration = float(leads.max())
    span = float(np.abs(edge.rate(np.array([1.0])) - edge.rate(np.array([0.0])))[0]) / (2.0 * math.pi)
    w = np.linspace(0.0, 1.0, math.ceil(SAMPLES_PER_RIPPLE * span * duration) + FEWEST_SAMPLES)
    slope, _ = _slopes(edge, w, leads, amplitudes)
    turns = np.flatnonzero((slope[:-1] > 0.0) & (slope[1:] <= 0.0))
    low, high = w[turns], w[turns + 1]
    guess = 0.5 * (low + high)
    for _ in range(REFINEMENTS if turns.size else 0):
        value, bend = _slopes(edge, guess, leads, amplitudes)
        low, high = np.where(value > 0.0, guess, low), np.where(value > 0.0, high, guess)
        step = guess - value / np.where(bend < 0.0, bend, -np.inf)
        following = np.where((step > low) & (step < high) & (bend < 0.0), step, 0.5 * (low + high))
        moved = float(np.abs(following - guess).max())
        guess = following
        if moved < 1e-15:
            break
    ends = ([0.0] if slope[0] <= 0.0 else []) + ([1.0] if slope[-1] > 0.0 else [])
    inner = guess[(guess > AT_END) & (guess < 1.0 - AT_END)]
    found: NDArray[np.float64] = np.unique(np.concatenate([ends, inner]))
    return found if found.size else np.array([0.0, 1.0])


def _slopes(
    edge: Edge, w: NDArray[np.float64], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """First and second derivative of V^2 / 2 along the edge."""
    s, first, second = (edge.rate(w, n) for n in range(3))
    wave = np.exp(np.multiply.outer(-s, leads))
    total = wave @ amplitudes
    by_rate, by_rate_twice = -(wave @ (amplitudes * leads)), wave @ (amplitudes * leads**2)
    change = first * by_rate
    bend = second * by_rate + first**2 * by_rate_twice
    return np.real(total.conj() * change), np.abs(change) ** 2 + np.real(total.conj() * bend)
