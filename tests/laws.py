"""Every shaper family, with what it promises; the laws in test_laws.py run on each line of this list."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from preshape import Modes, Shaper, design

DAMPINGS = (0.0, 0.01, 0.05, 0.1, 0.2, 0.3)


@dataclass(frozen=True)
class Family:
    """A family and its promises: `order` vanishing derivatives at the mode (-1: none), humps of height `tolerance`.

    Its impulses are positive, or of alternating sign if it is `negative`; for one mode their `partial_sums`, the shaped
    unit step, stay within these bounds.
    """

    name: str
    build: Callable[[Modes], Shaper]
    order: int
    humps: int = 0
    tolerance: float | None = None
    highest_damping: float = 0.3
    negative: bool = False
    partial_sums: tuple[float, float] = (0.0, 1.0)


def _servo_period(modes: Modes) -> float:
    """A grid that scales with the modes and does not fit them: 21 slots a period of the fastest [s]."""
    return min(mode.damped_period for mode in modes) / 21.0


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
    Family("um_zv", design.um_zv, 0, negative=True),
    Family("um_zvd", design.um_zvd, 1, negative=True),
    Family("um_ei 5 %", design.um_ei, -1, 1, 0.05, negative=True),
    Family("um_ei 1.25 %", lambda modes: design.um_ei(modes, 0.0125), -1, 1, 0.0125, negative=True),
    Family("ps_zv", design.ps_zv, 0, negative=True, partial_sums=(-1.0, 1.0)),
    Family("ps_zvd", design.ps_zvd, 1, negative=True, partial_sums=(-1.0, 1.0)),
    Family("sna_zv 0.5", lambda modes: design.sna_zv(modes, 0.5), 0, negative=True, partial_sums=(0.25, 1.0)),
    Family("sna_zv 1.5", lambda modes: design.sna_zv(modes, 1.5), 0, negative=True, partial_sums=(-0.25, 1.25)),
    Family("sd_zv 0.4", lambda modes: design.sd_zv(modes, 0.4), 0),
    Family("sd_zv 0.15", lambda modes: design.sd_zv(modes, 0.15), 0),
    Family("convolved zvd", design.convolved, 1),
    Family("direct, order 0", lambda modes: design.direct(modes, 0), 0),
    Family("direct, order 1", design.direct, 1),
    Family("direct, order 2", lambda modes: design.direct(modes, 2), 2),
    Family("mesh", lambda modes: design.mesh(modes, _servo_period(modes)), 1),
    Family("mesh, flattest", lambda modes: design.mesh(modes, _servo_period(modes), cost="second_derivative"), 1),
)
"""Adding a family is adding a line."""

ZERO_FAMILIES = tuple(family for family in FAMILIES if family.order >= 0)
HUMP_FAMILIES = tuple(family for family in FAMILIES if family.tolerance is not None)
DERIVATIVE_FAMILIES = tuple(family for family in ZERO_FAMILIES if not family.humps)
"""Those whose first `order` derivatives vanish and the next one does not."""


def damped_cases(families: tuple[Family, ...], dampings: tuple[float, ...] = DAMPINGS) -> list[tuple[Family, float]]:
    """Each family with each damping ratio at which it exists."""
    return [(family, z) for family in families for z in dampings if z <= family.highest_damping]
