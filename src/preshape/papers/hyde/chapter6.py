"""Hyde, section 6.2: "new shapers could be created as the system moves": what that gives, and what it does not."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from preshape.papers.hyde import chapter6_mace, chapter6_sweep
from preshape.papers.hyde.chapter6_mace import Follow, follow
from preshape.papers.hyde.chapter6_sweep import RATES, SPREAD, Sweep, laws, sweep
from preshape.papers.reproduction import Row
from preshape.papers.rows import beyond

__all__ = ["Adaptive", "adaptive", "rows"]

FITS = 0.1
"""A slope in log-log counts as the whole number that it is this near."""


@dataclass(frozen=True, eq=False)
class Adaptive:
    """The sweeps of one mode and of two, the laws, and the slews of MACE if it can be simulated."""

    one: Sweep
    two: Sweep
    laws: Mapping[str, tuple[float, ...]]
    mace: Follow | None


def adaptive(with_mace: bool) -> Adaptive:
    """Everything of the section, once for rows and figures."""
    return Adaptive(sweep(1), sweep(2), laws(), follow() if with_mace else None)


def rows(done: Adaptive) -> list[Row]:
    """Laws, sweeps, MACE."""
    return [*_laws(done.laws), *_sweeps(done), *([] if done.mace is None else _mace(done.mace))]


def _laws(found: Mapping[str, tuple[float, ...]]) -> list[Row]:
    slopes = {name: float(np.polyfit(np.log(RATES), np.log(left), 1)[0]) for name, left in found.items()}
    first = {name: left[0] / RATES[0] for name, left in found.items()}
    quadratic, alone = math.pi / 8.0, 1.0 / 8.0
    expected = {
        "order 0": math.hypot(quadratic, alone),
        "order 0, ahead": alone,
        "order 1": quadratic,
        "order 1, ahead": quadratic,
    }
    return [
        beyond(
            "6.2",
            "a shaper of order 0 or 1 for the frequency of its time leaves what the sweep's rate says, to first order: "
            "part left, by change of frequency in a period",
            "; ".join(f"{name} {first[name]:.3f}" for name in expected),
            all(abs(first[name] / value - 1.0) < 0.03 and abs(slopes[name] - 1.0) < FITS
                for name, value in expected.items()),
            note="Phase runs ahead as the square of time and amplitude as its root: sqrt(pi^2 + 1) / 8 for order 0, "
            "1/8 when it is made for the frequency half a shaper ahead, pi/8 for order 1 either way.",
        ),
        beyond(
            "6.2",
            "order 2 is blind to that: what is left goes with the square of the rate (now; half a shaper ahead)",
            ", ".join(f"slope {slopes[name]:.2f}" for name in ("order 2", "order 2, ahead")),
            all(abs(slopes[name] - 2.0) < FITS for name in ("order 2", "order 2, ahead")),
            note=f"At {100.0 * RATES[-1]:.0f} % a period {_percent([found['order 2'][-1]])} and "
            f"{_percent([found['order 2, ahead'][-1]])} against {_percent([found['order 1'][-1]])} of order 1.",
        ),
    ]  # fmt: skip


def _sweeps(done: Adaptive) -> list[Row]:
    one, two = done.one.left, done.two.left
    fixed = ("fixed ZV", "fixed ZVD", "fixed direct, order 2", "band +-20 %, 5 %")
    where = (
        f"frequency from {-100 * SPREAD:.0f} to +{100 * SPREAD:.0f} % during a move of {chapter6_sweep.MOVE} periods"
    )
    late = [one[name] for name in ("tracked, 0.2 s late", "tracked, 2 % off")]
    seldom = [one[name] for name in ("tracked every sample", "tracked every 0.25 s", "scheduled, 5 rows")]
    both = ("fixed ZVD", "fixed direct", "band +-20 %, 5 %", "tracked")
    ahead = "tracked, order 2, ahead"
    return [
        beyond(
            "6.2",
            f"one mode, {where}: left of the plain command's vibration by ZV, ZVD, order 2, the band of 5 %",
            _percent([one[name] for name in fixed]),
            one["fixed ZV"] > one["fixed ZVD"] > one["fixed direct, order 2"],
            note=f"{_seconds(done.one, fixed)}. The plain command leaves {_percent([done.one.plain])} of the move.",
        ),
        beyond(
            "6.2",
            "one mode, tracked: order 1; order 2; order 2 made for half a shaper ahead",
            _percent([one["tracked"], one["tracked, order 2"], one[ahead]]),
            one["tracked"] < one["band +-20 %, 5 %"] and one[ahead] < one["tracked, order 2"] < 0.5 * one["tracked"],
            note=f"{_seconds(done.one, ('tracked', 'tracked, order 2', ahead))} at most. Ahead of order 1 gains "
            f"little: {_percent([one['tracked, half a shaper ahead']])}, as the law says.",
        ),
        beyond(
            "6.2",
            "one mode, order 1: tracked every 5 ms, every 250 ms, from a table of 5 rows; 0.2 s late, 2 % off",
            f"{_percent(seldom)}; {_percent(late)}",
            max(abs(value / one["tracked"] - 1.0) for value in [*seldom, *late]) < 0.15,
            note="Its zero slope covers such errors: what counts is the sweep under the shaper.",
        ),
        beyond(
            "6.2",
            "two modes, one rising, one falling: fixed ZVD (convolved), fixed direct, band of 5 %; tracked",
            _percent([two[name] for name in both]),
            two["tracked"] < two["band +-20 %, 5 %"] < two["fixed direct"],
            note=f"{_seconds(done.two, both)}. A direct shaper that stays is the worst: between its modes it is less "
            "robust than the convolved one. The band is the shorter of the better two.",
        ),
        beyond(
            "6.2",
            "two modes, tracked: order 2; order 2 made for half a shaper ahead",
            _percent([two["tracked, order 2"], two[ahead]]),
            two[ahead] < 0.25 * two["tracked, order 2"] and two["tracked, order 2"] < two["tracked"],
            note=f"{100.0 * done.two.warm:.0f} % of the redesigns needed no search.",
        ),
    ]


def _mace(done: Follow) -> list[Row]:
    fundamental = [modes[0].frequency for modes in done.modes.values()]
    fastest = [modes[1].frequency for modes in done.modes.values()]
    left = {name: 1e6 * value for name, value in done.left.items()}
    fixed = [left[name] for name in left if name.startswith("fixed") and "order" not in name]
    band = "band of all, 2 %"
    return [
        beyond(
            "6.2",
            "MACE, closed loop: fundamental and fastest mode along the slew from 60 deg outboard to 60 deg inboard",
            f"{_listed(fundamental)}; {_listed(fastest, 1)} Hz",
            max(fundamental) / min(fundamental) > 1.15 and max(fastest) / min(fastest) > 1.2,
            note=f"Linearised every {chapter6_mace.ANGLES[1] - chapter6_mace.ANGLES[0]:.0f} deg.",
        ),
        beyond(
            "6.2",
            f"MACE, 120 deg commanded within {chapter6_mace.SLEW:g} s: left by direct shapers for outboard, vertical, "
            "inboard; by the band of all, 2 %",
            f"{_listed(fixed)}; {left[band]:.2f} µm",
            left[band] < min(fixed),
            note=f"Unshaped {left['unshaped']:.1f} µm.",
        ),
        beyond(
            "6.2",
            "the same, tracked by the payload's angle: order 1; order 2",
            f"{left['tracked']:.2f}; {left['tracked, order 2']:.2f} µm",
            left["tracked"] < 0.6 * min(fixed) and left["tracked, order 2"] < min(left[band], left["tracked"]),
            note=f"The band that stays does as well as order 1 ({left[band]:.2f} µm, {done.durations[band]:.3f} s "
            f"against {done.durations['tracked']:.3f} s): with a spread of this size tracking pays with order 2, "
            f"{done.durations['tracked, order 2']:.3f} s; fixed, that leaves "
            f"{left['fixed, vertical, order 2']:.2f} µm. Hyde's step of 120 deg is one increment: tracking cannot "
            "change its shaper.",
        ),
    ]


def _percent(values: Sequence[float]) -> str:
    return ", ".join(f"{100.0 * value:.2g}" for value in values) + " %"


def _seconds(done: Sweep, names: Sequence[str]) -> str:
    return ", ".join(f"{done.durations[name]:.2f}" for name in names) + " s"


def _listed(values: Sequence[float], digits: int = 2) -> str:
    return ", ".join(f"{value:.{digits}f}" for value in values)
