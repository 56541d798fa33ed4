"""Newton's method on the optimality system when vibration is tolerated in bands.

Unknown are the amplitudes a_i, the leads u_2..u_N (u_1 = 0), the multipliers c of zero vibration and lambda_k (complex)
of the contacts s_k where vibration reaches its tolerance v_k, and the places w_k of those contacts that lie inside an
edge:
  sum a_i g(u_i) = 0, sum a_i = 1;  F(s_k) = sum a_i exp(-s_k u_i) = v_k lambda_k / |lambda_k|;
  Re(conj(lambda_k) dF/dw_k) = 0 inside an edge;
  p(u_i) = 0 for all i (one is redundant), p'(u_i) = 0 for the interior ones;  |c|^2 + sum |lambda_k|^2 = 1
with p(u) = c.g(u) + sum Re(conj(lambda_k) exp(-s_k u)) - sum v_k |lambda_k|. The system is square.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.edges import AT_END, Edge

__all__ = ["TolerantPoint", "polish_tolerant"]

MAXIMUM_STEPS = 30

LARGEST_MOVE = 0.4
"""No impulse moves by more than this fraction of the smallest gap in one step, no contact leaves its edge."""

RANK_TOLERANCE = 1e-13

STILL = 1e-13
"""A step of this relative size is rounding."""


@dataclass(frozen=True)
class TolerantPoint:
    """A point of the optimality system.

    Parameters
    ----------
    leads, amplitudes : ndarray, shape (impulse,)
        [s] and [-].
    multipliers : ndarray, shape (row,)
        c [-].
    waves : ndarray of complex, shape (contact,)
        lambda_k [-].
    edges : tuple of Edge
        The edge of each contact.
    places : ndarray, shape (contact,)
        w_k [-]; 0 and 1 are the ends, where a contact stays.
    error : float
        Largest equation error [-].
    """

    leads: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    multipliers: NDArray[np.float64]
    waves: NDArray[np.complex128]
    edges: tuple[Edge, ...]
    places: NDArray[np.float64]
    error: float = np.inf

    @property
    def rates(self) -> NDArray[np.complex128]:
        """s_k [1/s]."""
        return np.array(
            [complex(edge.rate(np.array(w))) for edge, w in zip(self.edges, self.places, strict=True)], dtype=complex
        )

    @property
    def tolerances(self) -> NDArray[np.float64]:
        """v_k [-]."""
        return np.array([edge.tolerance for edge in self.edges])

    @property
    def offset(self) -> float:
        """sum v_k |lambda_k| [-]."""
        return float(self.tolerances @ np.abs(self.waves))


def polish_tolerant(basis: Basis | None, start: TolerantPoint, scale: float) -> TolerantPoint:
    """Solve the optimality system from a start near its solution; `scale` is about the duration [s]."""
    best, now = start, start
    for _ in range(MAXIMUM_STEPS):
        equations, jacobian, inner = _system(basis, now, scale)
        error = float(np.abs(equations).max())
        if not np.isfinite(error):
            break
        now = TolerantPoint(now.leads, now.amplitudes, now.multipliers, now.waves, now.edges, now.places, error)
        if error < best.error:
            best = now
        step = np.asarray(-np.linalg.lstsq(jacobian, equations, rcond=RANK_TOLERANCE)[0], dtype=float)
        moved = _moved(now, step, inner, scale)
        if moved is None:
            break
        now, size = moved
        if size < STILL:
            break
    return best


def _moved(
    now: TolerantPoint, step: NDArray[np.float64], inner: NDArray[np.intp], scale: float
) -> tuple[TolerantPoint, float] | None:
    """The point after a step, shortened so that impulses keep their order and contacts their edges."""
    n, m, k = now.leads.size, now.multipliers.size, now.waves.size
    da, du, dc, dl, dw = np.split(step, np.cumsum([n, n - 1, m, 2 * k]))
    du = du * scale
    shorten = 1.0
    gap = float(np.diff(now.leads).min())
    if gap <= 0.0:
        return None
    if (largest := float(np.abs(du).max())) > 0.0:
        shorten = min(1.0, LARGEST_MOVE * gap / largest)
    if inner.size:
        room = np.where(dw > 0.0, 1.0 - now.places[inner], now.places[inner])
        shorten = min(
            shorten, float(np.min(np.where(np.abs(dw) > room, 0.9 * room / np.maximum(np.abs(dw), 1e-300), 1.0)))
        )
    places = now.places.copy()
    places[inner] += shorten * dw
    leads = now.leads.copy()
    leads[1:] += shorten * du
    waves = now.waves + shorten * (dl[:k] + 1j * dl[k:])
    after = TolerantPoint(
        leads, now.amplitudes + shorten * da, now.multipliers + shorten * dc, waves, now.edges, places
    )
    size = max(float(np.abs(du).max()) / scale, float(np.abs(da).max()), float(np.abs(dw).max(initial=0.0)))
    return after, size


def _system(
    basis: Basis | None, now: TolerantPoint, scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
    """Equations, their derivatives by (a, u_2.., c, Re lambda, Im lambda, w of inner contacts), and those contacts."""
    u, a, c, waves, v = now.leads, now.amplitudes, now.multipliers, now.waves, now.tolerances
    n, m, k = u.size, c.size, waves.size
    inner = np.flatnonzero((now.places > AT_END) & (now.places < 1.0 - AT_END))
    s = now.rates
    s1, s2 = (
        np.array([complex(e.rate(np.array(w), d)) for e, w in zip(now.edges, now.places, strict=True)], dtype=complex)
        for d in (1, 2)
    )
    e = np.exp(np.multiply.outer(-s, u))
    length, unit = np.abs(waves), waves / np.abs(waves)
    g, g1, g2 = (np.zeros((0, n)),) * 3
    if basis is not None:
        raw = basis.raw(u)
        g, g1, g2 = basis.values(raw), basis.slopes(raw, 1) * scale, basis.slopes(raw, 2) * scale**2
    conj = waves.conj()
    p = c @ g + np.real(conj @ e) - v @ length
    p1 = c @ g1 - np.real((conj * s) @ e) * scale
    p2 = c @ g2 + np.real((conj * s**2) @ e) * scale**2
    total, by_rate, by_rate_twice = e @ a, -(e @ (a * u)), e @ (a * u**2)
    excess = total - v * unit
    along = np.real(conj * s1 * by_rate)[inner]
    equations = np.concatenate(
        [g @ a, [a.sum() - 1.0], p[:-1], p1[1:-1], excess.real, excess.imag, along, [c @ c + length @ length - 1.0]]
    )

    rows = np.cumsum([m, 1, n - 1, n - 2, k, k, inner.size])
    columns = np.cumsum([n, n - 1, m, k, k])
    jacobian = np.zeros((equations.size, columns[-1] + inner.size))
    amp, lead, mult = slice(0, n), slice(n, columns[1]), slice(columns[1], columns[2])
    real, imag, place = slice(columns[2], columns[3]), slice(columns[3], columns[4]), slice(columns[4], None)
    jacobian[:m, amp], jacobian[:m, lead] = g, (g1 * a)[:, 1:]
    jacobian[m, amp] = 1.0
    touch = slice(rows[1], rows[2])
    jacobian[touch, lead] = np.diag(p1)[:-1, 1:]
    jacobian[touch, mult] = g.T[:-1]
    jacobian[touch, real] = (e.real - (v * unit.real)[:, None]).T[:-1]
    jacobian[touch, imag] = (e.imag - (v * unit.imag)[:, None]).T[:-1]
    moving = np.real((conj * s1)[:, None] * (-u) * e)
    jacobian[touch, place] = moving[inner].T[:-1]
    flat = slice(rows[2], rows[3])
    jacobian[flat, lead] = np.diag(p2)[1:-1, 1:]
    jacobian[flat, mult] = g1.T[1:-1]
    slope = -s[:, None] * e * scale
    jacobian[flat, real], jacobian[flat, imag] = slope.real.T[1:-1], slope.imag.T[1:-1]
    bending = np.real((conj * s1)[:, None] * (s[:, None] * u - 1.0) * e) * scale
    jacobian[flat, place] = bending[inner].T[1:-1]
    by_lead = -s[:, None] * a * e * scale
    for part, rows_of in ((np.real, slice(rows[3], rows[4])), (np.imag, slice(rows[4], rows[5]))):
        jacobian[rows_of, amp], jacobian[rows_of, lead] = part(e), part(by_lead)[:, 1:]
        jacobian[rows_of, place] = np.diag(part(s1 * by_rate))[:, inner]
    turn = v / length
    jacobian[rows[3] : rows[4], real] = -np.diag(turn * (1.0 - unit.real**2))
    jacobian[rows[3] : rows[4], imag] = np.diag(turn * unit.real * unit.imag)
    jacobian[rows[4] : rows[5], real] = np.diag(turn * unit.real * unit.imag)
    jacobian[rows[4] : rows[5], imag] = -np.diag(turn * (1.0 - unit.imag**2))
    still = slice(rows[5], rows[6])
    jacobian[still, amp] = moving[inner]
    jacobian[still, lead] = (np.real((conj * s1)[:, None] * a * (s[:, None] * u - 1.0) * e) * scale)[inner, 1:]
    jacobian[still, real] = np.diag(np.real(s1 * by_rate))[inner]
    jacobian[still, imag] = np.diag(np.imag(s1 * by_rate))[inner]
    jacobian[still, place] = np.diag(np.real(conj * (s2 * by_rate + s1**2 * by_rate_twice)))[np.ix_(inner, inner)]
    jacobian[-1, mult], jacobian[-1, real], jacobian[-1, imag] = 2.0 * c, 2.0 * waves.real, 2.0 * waves.imag
    return equations, jacobian, inner
