"""The families of each Klipper, and of Kalico: the names stay while the pulses change.

Three things happened: in 2025-09 the EI shapers became the published fits for damped modes (Klipper pull request 7048);
until 2026-03 a comma was missing in the table of 3hump_ei, so that its polynomials in the damping ratio ended with the
square; in 2026-03 mzv and ei took parameters (pull request 7231). Kalico's main branch has the old EI shapers, its
bleeding-edge-v2 those of 2025-09 with the slip.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import numpy as np
from numpy.polynomial.polynomial import polyval

from preshape.export.damped_humps import THREE_HUMP_AMPLITUDES, THREE_HUMP_TIMES
from preshape.export.family import Family, evenly_spaced, executed, undamped_humps
from preshape.export.klipper import families
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["VERSIONS"]

MISSING_COMMA = (0.11275, 0.76632, 3.29160 - 1.44380)
"""The first row of amplitudes without it; its length was taken for that of all."""

TRIED_IMPULSES = range(3, 11)
TRIED_PERIODS = [tenths / 10.0 for tenths in range(6, 31)]
TRIED_TOLERANCES = (0.05, 0.01, 0.02, 0.03, 0.1, 0.15, 0.2)
"""What the search for the nearest setting tries of the generalised mzv and ei, where they exist."""


def _old_ei(name: str, humps: int) -> Family:
    """An EI family as it was before 2025-09."""

    def pulses(frequency: float, damping: float) -> Shaper:
        return evenly_spaced("Klipper", name, Mode(frequency, damping), undamped_humps(humps, 0.05))

    return Family(name, pulses)


def _slipped_three_hump_ei(frequency: float, damping: float) -> Shaper:
    """`3hump_ei` from 2025-09 to 2026-03."""
    mode, used = Mode(frequency, damping), len(MISSING_COMMA)
    rows = [MISSING_COMMA, *(row[:used] for row in THREE_HUMP_AMPLITUDES[1:])]
    periods = [0.0, *(float(polyval(mode.damping, row[:used])) for row in THREE_HUMP_TIMES)]
    weights = [float(polyval(mode.damping, row)) for row in rows]
    return executed("Klipper", "3hump_ei", mode, np.array(periods) / mode.frequency, weights)


def _mzv(frequency: float, damping: float, n: int = 3, t: float = 0.75) -> Shaper:
    return families.mzv(frequency, damping, impulses=n, periods=t)


def _mzv_parameters() -> Iterator[dict[str, float]]:
    yield {}
    for n in TRIED_IMPULSES:
        yield from ({"n": n, "t": t} for t in TRIED_PERIODS if n > 2.0 * t + 1.0)


def _ei(frequency: float, damping: float, v_tol: float = 0.05) -> Shaper:
    return families.ei(frequency, damping, tolerance=v_tol)


def _ei_parameters() -> Iterator[dict[str, float]]:
    yield {}
    yield from ({"v_tol": v} for v in TRIED_TOLERANCES)


def _stock(name: str) -> Family:
    known = families.FAMILIES[name]
    return Family(name, known.pulses, known.maximum_damping)


def _named(*entries: Family) -> Mapping[str, Family]:
    return MappingProxyType({family.name: family for family in entries})


VERSIONS: Mapping[str, Mapping[str, Family]] = MappingProxyType(
    {
        "2026-03": _named(
            _stock("zv"),
            Family("mzv", _mzv, 0.99, _mzv_parameters),
            _stock("zvd"),
            Family("ei", _ei, 0.4, _ei_parameters),
            _stock("2hump_ei"),
            _stock("3hump_ei"),
        ),
        "2025-09": _named(
            *(_stock(name) for name in ("zv", "mzv", "zvd", "ei", "2hump_ei")),
            Family("3hump_ei", _slipped_three_hump_ei, 0.2),
        ),
        "old": _named(
            *(_stock(name) for name in ("zv", "mzv", "zvd")),
            _old_ei("ei", 1),
            _old_ei("2hump_ei", 2),
            _old_ei("3hump_ei", 3),
        ),
    }
)
"""By the month since which Klipper has them."""
