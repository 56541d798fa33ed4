"""What comes after the last step of an input: where an output settles, and the free vibration about it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.driven_phasors import DrivenPhasors, taylor_shifted

__all__ = ["free_phasors", "rested", "trend"]

AT_REST = 1e-12
"""A slope (or higher derivative) after the last step below this fraction of its largest before is rounding of a command
that ends at rest. It must not become a drift to infinity."""


def rested(taylor: NDArray[np.float64], rounding: NDArray[np.float64] | float = 0.0) -> NDArray[np.float64]:
    """`taylor`, shape (segment, order), with the slopes after the last step at 0 where they are rounding.

    That is below a part of their largest, or below what the caller knows: `rounding`, shape (order,).
    """
    if taylor.size == 0:
        return taylor
    result = taylor.copy()
    last = result[-1]
    still = np.abs(last) <= np.maximum(AT_REST * np.abs(taylor).max(axis=0), rounding)
    still[0] = False
    last[still] = 0.0
    return result


def trend(
    phasors: DrivenPhasors, weights: NDArray[np.complex128], polynomial: NDArray[np.float64], since: float
) -> NDArray[np.float64]:
    """Derivatives of what remains of an output when the free vibration has died out, shape (order,).

    Parameters
    ----------
    phasors, weights, polynomial
        As of :class:`preshape.kernel.DrivenOutput`.
    since : float
        How long after the last step [s].
    """
    look = np.array([since])
    smooth = taylor_shifted(polynomial[-1:], look)[:, 0]
    settled = (weights @ _settled(phasors, look)).real
    result = np.zeros(max(smooth.size, settled.size))
    result[: smooth.size] += smooth
    result[: settled.size] += settled
    return result


def free_phasors(phasors: DrivenPhasors, since: float = 0.0) -> NDArray[np.complex128]:
    """The phasors' deviation from where they will settle, `since` [s] after the last step, shape (pole,)."""
    look = np.array([since])
    values, _ = phasors.look(np.array([phasors.starts.size - 1]), look, 0)
    return np.asarray(values[0][:, 0] - _settled(phasors, look)[:, 0])


def _settled(phasors: DrivenPhasors, look: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Derivatives of the polynomial that solves q' = s q + f in the last segment, shape (pole, order)."""
    forces = taylor_shifted(phasors.taylor[-1:], look)[:, 0]
    result = np.zeros((phasors.poles.size, forces.size), dtype=complex)
    higher = np.zeros(phasors.poles.size, dtype=complex)
    for order in range(forces.size - 1, -1, -1):
        higher = (higher - forces[order]) / phasors.poles
        result[:, order] = higher
    return result
