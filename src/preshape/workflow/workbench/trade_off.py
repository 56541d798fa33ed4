"""What a shorter shaper costs: duration against the vibration that is left when every frequency is off."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from preshape.band import Band
from preshape.design import CLOSED_FAMILIES, needed_by
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration
from preshape.workflow.workbench.solve import solved
from preshape.workflow.workbench.state import AskedDesign, Workbench

__all__ = ["FREQUENCY_ERROR", "TradePoint", "WorkbenchTradeOff", "left_at_error", "trade_off_of"]

FREQUENCY_ERROR = 0.05
"""Every frequency may be off by this part, up or down."""

LEVELS = (0.5, 0.3, 0.2, 0.1, 0.05, 0.02)
"""Vibration left [-] for which the shortest shaper is sought, the quickest first."""

DIRECT_ORDERS = (0, 1, 2)

SAMPLES_PER_RIPPLE, FEWEST = 32, 17

PATIENCE = 10.0
"""Processor time [s] after which no further point of the optimum is begun."""


@dataclass(frozen=True)
class TradePoint:
    """A shaper of the trade-off.

    Parameters
    ----------
    name : str
        Of the family, or of the design on the workbench.
    duration : float
        What it adds to a move [s].
    left : float
        Largest residual vibration of any mode [-] when its frequency is off by up to 5 %.
    impulses : int
        How many it has.
    proved : bool
        Whether nothing shorter leaves as little: of the optimum only.
    """

    name: str
    duration: float
    left: float
    impulses: int
    proved: bool = False


@dataclass(frozen=True)
class WorkbenchTradeOff:
    """Families, designs and the optimum.

    Parameters
    ----------
    families : tuple of TradePoint
        The families that need no further wish.
    designs : tuple of TradePoint
        Those on the workbench, by their names.
    optimum : tuple of TradePoint
        The shortest positive shapers that leave at most so much, in order of duration.
    remarks : tuple of str
        What is missing, a sentence each.
    """

    families: tuple[TradePoint, ...]
    designs: tuple[TradePoint, ...]
    optimum: tuple[TradePoint, ...]
    remarks: tuple[str, ...]


def trade_off_of(
    workbench: Workbench, *, patience: float = PATIENCE, clock: Callable[[], float] = time.process_time
) -> WorkbenchTradeOff:
    """The trade-off for a workbench's modes; seconds for four of them, much more for ten.

    Parameters
    ----------
    workbench : Workbench
        Modes and designs.
    patience : float
        Processor time [s] after which no further point of the optimum is begun; `remarks` says so then.
    clock : callable
        What the time is.

    Examples
    --------
    >>> found = trade_off_of(Workbench((Mode(10.0, 0.02),)))
    >>> all(a.duration < b.duration and a.left > b.left for a, b in zip(found.optimum, found.optimum[1:]))
    True
    """
    modes, started = workbench.modes, clock()
    remarks: list[str] = []
    simple = [AskedDesign("A", family) for family in CLOSED_FAMILIES if not needed_by(family)]
    simple += [AskedDesign("A", "direct", (("order", order),)) for order in DIRECT_ORDERS]
    families = []
    for asked in simple:
        name = " ".join([asked.family, *(str(value) for _, value in asked.options)])
        outcome = solved(asked, modes)
        if outcome.shaper is not None:
            families.append(_point(name, outcome.shaper, modes))
        elif len(modes) == 1 or asked.family == "direct":
            remarks.append(f"{name} is left out: {outcome.trouble}")
    designs = []
    for asked in workbench.designs:
        outcome = solved(asked, modes)
        if outcome.shaper is not None:
            designs.append(_point(asked.name, outcome.shaper, modes))
    optimum: list[TradePoint] = []
    for level in LEVELS:
        if clock() - started > patience:
            remarks.append(f"the optimum stops above {100.0 * level:g} %: these modes take long to solve.")
            break
        asked = AskedDesign("A", "si", (("tolerance", level),), band_width=2.0 * FREQUENCY_ERROR)
        outcome = solved(asked, modes)
        if outcome.shaper is None:
            remarks.append(f"the optimum stops above {100.0 * level:g} %: {outcome.trouble}")
            break
        optimum.append(_point(f"optimum, {100.0 * level:g} %", outcome.shaper, modes))
    return WorkbenchTradeOff(tuple(families), tuple(designs), tuple(optimum), tuple(remarks))


def left_at_error(shaper: Shaper, modes: tuple[Mode, ...], error: float = FREQUENCY_ERROR) -> float:
    """The largest residual vibration of any mode [-] when its frequency is off by up to a part of itself.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    modes : tuple of Mode
        Natural frequencies [Hz] and damping ratios [-].
    error : float
        [-], 0 or more and below 1.

    Examples
    --------
    >>> import preshape
    >>> round(left_at_error(preshape.design.zv((10.0, 0.0)), (Mode(10.0, 0.0),)), 4)
    0.0785
    """
    if not 0.0 <= error < 1.0:
        raise InputError(f"error is {error:g}: give a part of the frequency from 0 to below 1.")
    return max(_largest(shaper, mode, error) for mode in modes)


def _largest(shaper: Shaper, mode: Mode, error: float) -> float:
    """The largest V in the band: sampled finer than it can ripple, the best sample refined between its neighbours."""
    from scipy.optimize import minimize_scalar

    band = Band((1.0 - error) * mode.frequency, (1.0 + error) * mode.frequency)
    ripples = SAMPLES_PER_RIPPLE * (band.high - band.low) * shaper.duration
    grid = np.linspace(band.low, band.high, math.ceil(ripples) + FEWEST)
    v = residual_vibration(shaper, grid, mode.damping)
    best = int(np.argmax(v))
    if best in (0, grid.size - 1) or error == 0.0:
        return float(v[best])
    found = minimize_scalar(
        lambda f: -float(residual_vibration(shaper, f, mode.damping)),
        bounds=(float(grid[best - 1]), float(grid[best + 1])),
        method="bounded",
        options={"xatol": 1e-9 * mode.frequency},
    )
    return max(float(v[best]), -float(found.fun))


def _point(name: str, shaper: Shaper, modes: tuple[Mode, ...]) -> TradePoint:
    proved = name.startswith("optimum") and shaper.design.status == "optimal"
    return TradePoint(name, shaper.duration, left_at_error(shaper, modes), len(shaper), proved)
