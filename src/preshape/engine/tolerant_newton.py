"""Newton's method on the optimality system when vibration is tolerated in bands.

Unknown are the amplitudes a_i, the leads u_2..u_N (u_1 = 0), the multipliers c of zero vibration, size l_k and
direction e_k = exp(i phi_k) of the multiplier of each contact s_k where vibration reaches its tolerance v_k, and the
places w_k of those contacts that lie inside an edge:
  sum a_i g(u_i) = 0, sum a_i = 1;  F(s_k) = sum a_i exp(-s_k u_i) = v_k e_k;
  Re(conj(e_k) dF/dw_k) = 0 inside an edge;
  p(u_i) = 0 for all i (one is redundant), p'(u_i) = 0 for the interior ones;  |c|^2 + sum l_k^2 = 1
with p(u) = c.g(u) + sum l_k (Re(conj(e_k) exp(-s_k u)) - v_k). The system is square, and smooth where an l_k passes
through zero: of a contact that does not belong it comes out negative, like the amplitude of such an impulse.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.edges import AT_END, Edge

__all__ = ["TolerantPoint", "polish_tolerant"]

MAXIMUM_STEPS = 60

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
    sizes, phases : ndarray, shape (contact,)
        l_k [-] and phi_k [rad] of the multipliers lambda_k = l_k exp(i phi_k).
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
    sizes: NDArray[np.float64]
    phases: NDArray[np.float64]
    edges: tuple[Edge, ...]
    places: NDArray[np.float64]
    error: float = np.inf

    @property
    def waves(self) -> NDArray[np.complex128]:
        """lambda_k [-]."""
        return np.asarray(self.sizes * np.exp(1j * self.phases), dtype=complex)

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
        """sum v_k l_k [-]."""
        return float(self.tolerances @ self.sizes)


def polish_tolerant(basis: Basis | None, start: TolerantPoint, scale: float) -> TolerantPoint:
    """Solve the optimality system from a start near its solution; `scale` is about the duration [s]."""
    best, now = start, start
    for _ in range(MAXIMUM_STEPS):
        equations, jacobian, inner = _system(basis, now, scale)
        error = float(np.abs(equations).max())
        if not np.isfinite(error):
            break
        now = replace(now, error=error)
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
    n, m, k = now.leads.size, now.multipliers.size, now.sizes.size
    da, du, dc, dl, dphi, dw = np.split(step, np.cumsum([n, n - 1, m, k, k]))
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
    after = TolerantPoint(
        leads,
        now.amplitudes + shorten * da,
        now.multipliers + shorten * dc,
        now.sizes + shorten * dl,
        now.phases + shorten * dphi,
        now.edges,
        places,
    )
    size = max(float(np.abs(du).max()) / scale, float(np.abs(da).max()), float(np.abs(dw).max(initial=0.0)))
    return after, size


def _system(
    basis: Basis | None, now: TolerantPoint, scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
    """Equations, their derivatives by (a, u_2.., c, l, phi, w of inner contacts), and those contacts."""
    u, a, c, sizes, v = now.leads, now.amplitudes, now.multipliers, now.sizes, now.tolerances
    n, m, k = u.size, c.size, sizes.size
    inner = np.flatnonzero((now.places > AT_END) & (now.places < 1.0 - AT_END))
    s = now.rates
    s1, s2 = (
        np.array([complex(e.rate(np.array(w), d)) for e, w in zip(now.edges, now.places, strict=True)], dtype=complex)
        for d in (1, 2)
    )
    e = np.exp(np.multiply.outer(-s, u))
    turn = np.exp(-1j * now.phases)
    g, g1, g2 = (np.zeros((0, n)),) * 3
    if basis is not None:
        raw = basis.raw(u)
        g, g1, g2 = basis.values(raw), basis.slopes(raw, 1) * scale, basis.slopes(raw, 2) * scale**2
    # what a contact of size one adds to p, p' and p''
    wave, wave1, wave2 = (((-s * scale) ** d * turn)[:, None] * e for d in range(3))
    p = c @ g + sizes @ (wave.real - v[:, None])
    p1 = c @ g1 + sizes @ wave1.real
    p2 = c @ g2 + sizes @ wave2.real
    total, by_rate, by_rate_twice = e @ a, -(e @ (a * u)), e @ (a * u**2)
    excess = total - v * turn.conj()
    along = (turn * s1 * by_rate)[inner]
    equations = np.concatenate(
        [g @ a, [a.sum() - 1.0], p[:-1], p1[1:-1], excess.real, excess.imag, along.real, [c @ c + sizes @ sizes - 1.0]]
    )

    rows = np.cumsum([m, 1, n - 1, n - 2, k, k, inner.size])
    columns = np.cumsum([n, n - 1, m, k, k])
    jacobian = np.zeros((equations.size, columns[-1] + inner.size))
    amp, lead, mult = slice(0, n), slice(n, columns[1]), slice(columns[1], columns[2])
    size, phase, place = slice(columns[2], columns[3]), slice(columns[3], columns[4]), slice(columns[4], None)
    jacobian[:m, amp], jacobian[:m, lead] = g, (g1 * a)[:, 1:]
    jacobian[m, amp] = 1.0
    touch, flat, still = slice(rows[1], rows[2]), slice(rows[2], rows[3]), slice(rows[5], rows[6])
    moving, bending = (turn * s1)[:, None] * (-u) * e, (turn * s1)[:, None] * (s[:, None] * u - 1.0) * e * scale
    jacobian[touch, lead] = np.diag(p1)[:-1, 1:]
    jacobian[touch, mult] = g.T[:-1]
    jacobian[touch, size] = (wave.real - v[:, None]).T[:-1]
    jacobian[touch, phase] = (sizes[:, None] * wave.imag).T[:-1]
    jacobian[touch, place] = (sizes[:, None] * moving.real)[inner].T[:-1]
    jacobian[flat, lead] = np.diag(p2)[1:-1, 1:]
    jacobian[flat, mult] = g1.T[1:-1]
    jacobian[flat, size] = wave1.real.T[1:-1]
    jacobian[flat, phase] = (sizes[:, None] * wave1.imag).T[1:-1]
    jacobian[flat, place] = (sizes[:, None] * bending.real)[inner].T[1:-1]
    by_lead = -s[:, None] * a * e * scale
    for part, rows_of in ((np.real, slice(rows[3], rows[4])), (np.imag, slice(rows[4], rows[5]))):
        jacobian[rows_of, amp], jacobian[rows_of, lead] = part(e), part(by_lead)[:, 1:]
        jacobian[rows_of, phase] = -np.diag(part(1j * v * turn.conj()))
        jacobian[rows_of, place] = np.diag(part(s1 * by_rate))[:, inner]
    jacobian[still, amp] = moving.real[inner]
    jacobian[still, lead] = (a * bending.real)[inner, 1:]
    jacobian[still, phase] = np.diag((turn * s1 * by_rate).imag)[inner]
    jacobian[still, place] = np.diag((turn * (s2 * by_rate + s1**2 * by_rate_twice)).real)[np.ix_(inner, inner)]
    jacobian[-1, mult], jacobian[-1, size] = 2.0 * c, 2.0 * sizes
    return equations, jacobian, inner
