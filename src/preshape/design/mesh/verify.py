"""No shaper leaves this folder unless the papers' own equations hold for it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import plain_rows
from preshape.errors import InputError
from preshape.mode import Modes

__all__ = ["EXACT", "misses", "verified"]

EXACT = 1e-12
"""Residual and derivatives (times relative to the duration) up to which they count as zero [-]; rounding is 1e-16 for
each impulse, more for modes that turn many times."""

PARALLEL = (1e-7, 1e-11)
"""Rows that differ by less than this fraction are one for the last correction; neighbours on a fine grid need less."""


def verified(
    modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The amplitudes, corrected by the least that makes the equations hold to the last digit.

    Parameters
    ----------
    modes, orders
        What must vanish.
    leads, amplitudes : ndarray, shape (impulse,)
        Times before the last impulse [s] and [-], which meet it nearly.

    Raises
    ------
    InputError
        If they do not hold then, or an amplitude is not positive.
    """
    for fraction in PARALLEL:
        if misses(modes, orders, leads, amplitudes) <= EXACT:
            break
        rows = np.vstack([_rows(modes, orders, leads), np.ones(leads.size)])
        miss = rows @ amplitudes
        miss[-1] -= 1.0
        amplitudes = amplitudes - np.linalg.lstsq(rows, miss, rcond=fraction)[0]
    amplitudes = amplitudes / amplitudes.sum()
    miss_left = misses(modes, orders, leads, amplitudes)
    if miss_left > EXACT or not (amplitudes > 0.0).all():
        raise InputError(
            f"the impulses found leave {miss_left:.2g} of the vibration where zero is asked: these modes are too near "
            "each other, or the orders too high, for the arithmetic; merge near modes or lower the order."
        )
    return amplitudes


def misses(modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> float:
    """Largest of the sums that should vanish [-]."""
    return float(np.abs(_rows(modes, orders, leads) @ amplitudes).max())


def _rows(modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64]) -> NDArray[np.float64]:
    rows, _ = plain_rows(modes, orders, leads, float(leads.max()))
    return rows
