"""Every shaper family, with what it promises; the laws in test_laws.py run on each line of this list."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from preshape import Modes, Shaper, design

DAMPINGS = (0.0, 0.01, 0.05, 0.1, 0.2, 0.3)


@dataclass(frozen=True)
class Family:
    """A family and its promises: `order` vanishing derivatives at the mode (-1: none), humps of height `tolerance`."""

    name: str
    build: Callable[[Modes], Shaper]
    order: int
    humps: int = 0
    tolerance: float | None = None
    highest_damping: float = 0.3


FAMILIES = (
    Family("zv", design.zv, 0),
    Family("zvd", design.zvd, 1),
    Family("zvdd", design.zvdd, 2),
    Family("zvd^3", lambda modes: design.zvdk(modes, 3), 3),
    Family("mzv", design.mzv, 0),
    Family("ei 5 %", design.ei, -1, 1, 0.05),
    Family("ei 1.25 %", lambda modes: design.ei(modes, 0.0125), -1, 1, 0.0125),
    Family("ei 20 %", lambda modes: design.ei(modes, 0.2), -1, 1, 0.2),
    Family("two-hump ei 5 %", design.two_hump_ei, 0, 2, 0.05),
    Family("two-hump ei 1 %", lambda modes: design.two_hump_ei(modes, 0.01), 0, 2, 0.01),
    Family("three-hump ei 5 %", design.three_hump_ei, -1, 3, 0.05),
    Family("four-hump ei 1 %", lambda modes: design.k_hump_ei(modes, 4, 0.01), 0, 4, 0.01),
    Family("convolved zvd", design.convolved, 1),
    Family("direct, order 0", lambda modes: design.direct(modes, 0), 0),
    Family("direct, order 1", design.direct, 1),
    Family("direct, order 2", lambda modes: design.direct(modes, 2), 2),
)
"""Adding a family is adding a line."""

ZERO_FAMILIES = tuple(family for family in FAMILIES if family.order >= 0)
HUMP_FAMILIES = tuple(family for family in FAMILIES if family.tolerance is not None)
DERIVATIVE_FAMILIES = tuple(family for family in ZERO_FAMILIES if not family.humps)
"""Those whose first `order` derivatives vanish and the next one does not."""


def damped_cases(families: tuple[Family, ...], dampings: tuple[float, ...] = DAMPINGS) -> list[tuple[Family, float]]:
    """Each family with each damping ratio at which it exists."""
    return [(family, z) for family in families for z in dampings if z <= family.highest_damping]
