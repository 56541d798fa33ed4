"""Where a shaper comes from: its Design, and the Certificate that nothing shorter would do.

Certificate: why no positive shaper on a shorter interval can meet the same constraints. Let u be an impulse's lead, the
time before the last one. A positive shaper mu with zero vibration of order q_j at each mode s_j, and vibration of at
most v_k at each point s_k, satisfies  integral p dmu <= 0  for every ::

    p(u) = Re sum_n c_n phi_n(u) + Re sum_k conj(lambda_k) exp(-s_k u) - sum_k v_k |lambda_k|

with phi_n spanning u^i exp(-s_j u), i <= q_j. If p >= 0 on [0, T], mu can live only where p = 0; if no positive weights
on those points but T satisfy the constraints, then mu needs the point T itself, so T is shortest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.band import Band
from preshape.errors import InputError
from preshape.kernel import DividedExponentials, chebyshev_values
from preshape.mode import Mode, Modes

__all__ = ["Certificate", "Design", "Tolerated"]

MINIMUM_ALLOWED = -1e-9
"""How far below zero p may reach, relative to its maximum, before the certificate is rejected (rounding only)."""

TOUCHING = 1e-7
"""p is zero where it is below this fraction of its maximum."""

EXCLUDED_AT = 100.0
"""How far the contacts without T must be from satisfying the constraints, in units of rounding, to count as unable."""


@dataclass(frozen=True)
class Tolerated:
    """A point at which vibration is tolerated, and its part in a certificate.

    Parameters
    ----------
    frequency, damping : float
        Natural frequency [Hz] and damping ratio [-].
    tolerance : float
        Vibration allowed there [-].
    multiplier : complex
        lambda_k [-].
    """

    frequency: float
    damping: float
    tolerance: float
    multiplier: complex

    @property
    def rate(self) -> complex:
        """s = z w + i w sqrt(1 - z^2) [1/s]."""
        return -Mode(self.frequency, self.damping).pole.conjugate()


@dataclass(frozen=True)
class Certificate:
    """A polynomial in the modes' exponentials that separates the constraints from every shorter shaper.

    Parameters
    ----------
    modes : Modes or None
        The modes at which vibration is to vanish.
    orders : tuple of int
        Highest derivative of the residual that is zero at each mode (0: ZV, 1: ZVD).
    duration : float
        T [s].
    reference : float
        The T of the functions phi_n (kernel/divided_exponentials.py) [s]; at least about the duration.
    groups : tuple of tuples of int
        Which modes share a group of divided differences, by their index; a mode far from the others is alone. Empty
        when the modes are too dense for that: then phi_n is the Chebyshev polynomial of degree n in
        x = 1 - 2 u / reference.
    coefficients : tuple of complex
        c_n, group by group, within a group mode by mode, each mode order + 1 times; or real ones by degree.
    minimum : float
        Smallest value of p on [0, T] relative to the largest magnitude of p [-], all local minima located on
        the continuum.
    contacts : tuple of float
        Times [s] at which p touches zero.
    exclusion : float
        Distance at which the best positive weights on the contacts without the first impulse miss the constraints,
        in units of rounding; near zero would mean that a shorter shaper may exist.
    points : tuple of Tolerated
        Points at which vibration is tolerated and that matter for the proof.
    bands : tuple of Band
        Where it is tolerated altogether; every point lies in one of them.
    """

    modes: Modes | None
    orders: tuple[int, ...]
    duration: float
    reference: float
    groups: tuple[tuple[int, ...], ...]
    coefficients: tuple[complex, ...]
    minimum: float
    contacts: tuple[float, ...]
    exclusion: float
    points: tuple[Tolerated, ...] = ()
    bands: tuple[Band, ...] = ()

    def __post_init__(self) -> None:
        count = 0 if self.modes is None else len(self.modes)
        if len(self.orders) != count or min(self.orders, default=0) < 0:
            raise InputError(f"the orders {self.orders} do not fit {count} modes: give one a mode, each 0 or more.")
        if self.groups:
            if len(self.coefficients) != sum(order + 1 for order in self.orders):
                raise InputError(f"{len(self.coefficients)} coefficients do not fit the orders {self.orders}.")
            if sorted(index for group in self.groups for index in group) != list(range(count)):
                raise InputError(f"the groups {self.groups} do not name each of the {count} modes once.")
        if not 0.0 < self.reference < math.inf:
            raise InputError(f"the certificate's reference is {self.reference:g} s: it must be above 0 s.")

    @property
    def holds(self) -> bool:
        """Whether both parts of the argument held within rounding when it was made.

        Of a file this is only what the file says; :func:`preshape.engine.is_proved_shortest` checks it anew.
        """
        return self.minimum >= MINIMUM_ALLOWED and self.exclusion > EXCLUDED_AT

    def polynomial(self, times: ArrayLike) -> NDArray[np.float64]:
        """p at `times` [s] from the first impulse on, any shape; the values have the same shape and no unit.

        Examples
        --------
        >>> import preshape
        >>> certificate = preshape.design.direct([(1.0, 0.0)], order=0).design.certificate
        >>> bool(certificate.polynomial(0.25) > 0), certificate.holds
        (True, True)
        """
        t = np.asarray(times, dtype=float)
        leads = self.duration - t.ravel()
        value = np.zeros(leads.shape)
        if self.modes is not None and not self.groups:
            series = chebyshev_values(leads, self.reference, len(self.coefficients))
            value += np.real(np.array(self.coefficients)) @ series
        elif self.modes is not None:
            nodes = [
                [-self.modes[i].pole.conjugate() for i in group for _ in range(self.orders[i] + 1)]
                for group in self.groups
            ]
            value += np.real(np.array(self.coefficients) @ DividedExponentials(nodes, self.reference)(leads))
        for point in self.points:
            value += np.real(np.conj(point.multiplier) * np.exp(-point.rate * leads))
            value -= point.tolerance * abs(point.multiplier)
        return value.reshape(t.shape)


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
        "exact" (closed form or Newton on it), "optimal" (proved shortest: by the certificate, or on a servo grid as
        ``settings["proved"]`` says), "feasible" (meets the constraints, not proved shortest) or "given".
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

    def __reduce__(self) -> tuple[type[Design], tuple[Any, ...]]:
        """To another process: the read-only view of the settings cannot be sent, what it shows can."""
        return Design, (self.family, self.modes, dict(self.settings), self.status, self.residual, self.certificate)
