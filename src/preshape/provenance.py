"""Where a shaper comes from: its Design, and the Certificate that nothing shorter would do.

Certificate: why no positive shaper on a shorter interval can meet the same constraints.

A positive shaper mu with zero vibration of order q_j at each mode s_j satisfies  integral p dmu = 0  for every
p(t) = Re sum_jk c_jk (t/T)^k exp(s_j (t - T)),  k <= q_j.  If p >= 0 on [0, T], mu can live only where p = 0; if no
positive weights on those points before T satisfy the constraints, then mu needs the point T itself, so T is shortest.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.mode import Modes

__all__ = ["Certificate", "Design"]

MINIMUM_ALLOWED = -1e-9
"""How far below zero p may reach, relative to its maximum, before the certificate is rejected (rounding only)."""

TOUCHING = 1e-7
"""p is zero where it is below this fraction of its maximum."""

EXCLUDED_AT = 1e-6
"""Least-squares distance [-] above which the contact points before T count as unable to satisfy the constraints."""


@dataclass(frozen=True)
class Certificate:
    """A polynomial in the modes' exponentials that separates the constraints from every shorter shaper.

    Parameters
    ----------
    modes : Modes
        The modes of the constraints.
    orders : tuple of int
        Highest derivative of the residual that is zero at each mode (0: ZV, 1: ZVD).
    duration : float
        T [s].
    coefficients : tuple of complex
        c_jk, mode by mode, within a mode k = 0 ... order.
    minimum : float
        Smallest value of p on [0, T] relative to the largest magnitude of p [-], all local minima located on
        the continuum.
    contacts : tuple of float
        Times [s] at which p touches zero.
    exclusion : float
        Least-squares distance [-] at which the best positive weights on the contacts before T miss the constraints
        (rows orthonormalised on [0, T]); zero would mean that a shorter shaper exists.
    """

    modes: Modes
    orders: tuple[int, ...]
    duration: float
    coefficients: tuple[complex, ...]
    minimum: float
    contacts: tuple[float, ...]
    exclusion: float

    def __post_init__(self) -> None:
        if len(self.orders) != len(self.modes) or min(self.orders) < 0:
            raise InputError(
                f"the orders {self.orders} do not fit {len(self.modes)} modes: give one a mode, each 0 or more."
            )
        if len(self.coefficients) != sum(order + 1 for order in self.orders):
            raise InputError(f"{len(self.coefficients)} coefficients do not fit the orders {self.orders}.")

    @property
    def holds(self) -> bool:
        """Whether both parts of the argument held within rounding when it was made.

        Of a file this is only what the file says; :func:`preshape.engine.is_proved_shortest` checks it anew.
        """
        return self.minimum >= MINIMUM_ALLOWED and self.exclusion > EXCLUDED_AT

    def polynomial(self, times: ArrayLike) -> NDArray[np.float64]:
        """p at `times` [s], any shape; the values have the same shape and no unit.

        Examples
        --------
        >>> import preshape
        >>> certificate = preshape.design.direct([(1.0, 0.0)], order=0).design.certificate
        >>> bool(certificate.polynomial(0.25) > 0), certificate.holds
        (True, True)
        """
        t = np.asarray(times, dtype=float)
        value = np.zeros(t.shape)
        position = 0
        for mode, order in zip(self.modes, self.orders, strict=True):
            wave = np.exp(-mode.pole.conjugate() * (t - self.duration))
            for power in range(order + 1):
                value += np.real(self.coefficients[position] * wave) * (t / self.duration) ** power
                position += 1
        return value


@dataclass(frozen=True)
class Design:
    """Where a shaper comes from.

    Parameters
    ----------
    family : str
        "zv", "zvd", "direct", ...; "given" when the impulses were typed in.
    modes : Modes or None
        The modes it was designed for.
    settings : mapping of str to float, int, str or tuple of these
        The wishes: tolerance [-], order, humps ...
    status : str
        "exact" (closed form or Newton on it), "optimal" (shortest, certificate holds), "feasible" (meets the
        constraints, not proved shortest) or "given".
    residual : float or None
        Largest residual vibration at the design modes [-]: rounding where zero was asked for, the tolerance for EI.
    certificate : Certificate or None
        The proof of an optimal design.
    """

    family: str = "given"
    modes: Modes | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    status: str = "given"
    residual: float | None = None
    certificate: Certificate | None = None

    def __post_init__(self) -> None:
        if self.status not in ("exact", "optimal", "feasible", "given"):
            raise InputError(f"status {self.status!r} is not known: it is exact, optimal, feasible or given.")
        object.__setattr__(self, "settings", MappingProxyType(dict(self.settings)))
