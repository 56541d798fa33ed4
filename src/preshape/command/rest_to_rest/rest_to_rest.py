"""RestToRest: the result of every command of this folder, a force of constant levels with what it does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import not_negative, positive
from preshape.command.checks import sample_count
from preshape.command.command import Command
from preshape.command.rest_to_rest.shortest import Motion, Problem
from preshape.plant import FlexibleBody
from preshape.profile import Profile

__all__ = ["RestToRest", "result_of"]

SHOWN = 60
"""More switches than this are not shown in full."""


@dataclass(frozen=True, eq=False)
class RestToRest:
    """A force that moves a flexible body from rest to rest.

    Parameters
    ----------
    method : str
        "bang-bang", "on-off", "deflection-limiting" or "time-optimal".
    body : FlexibleBody
        What it was made for.
    distance : float
        How far it moves [m]; negative is backwards.
    maximum_force : float
        What the actuator can do, both ways [N].
    switch_times : ndarray, shape (switch,)
        When the force steps [s], increasing from 0 to the end of the move.
    levels : ndarray, shape (switch - 1,)
        The force between them [N]; it is 0 before the first and after the last.
    peak_deflections : ndarray, shape (output,)
        Exact maximum of each output's magnitude at any time [m], also after the move. An output is a mode's deflection,
        unless others were given.
    residuals : ndarray, shape (mode,)
        Vibration left in each mode, relative to what one step of the maximum force would leave [-].
    status : str
        "exact" (closed form), "optimal" (proved shortest: `gap` is below 1e-9) or "feasible" (keeps everything, and
        `gap` says how much of its duration a shorter command could save at most).
    lower_bound : float or None
        No command that keeps the same limits is shorter than this [s]; None where that was not asked.
    settings : mapping
        What was asked besides.
    """

    method: str
    body: FlexibleBody
    distance: float
    maximum_force: float
    switch_times: NDArray[np.float64]
    levels: NDArray[np.float64]
    peak_deflections: NDArray[np.float64]
    residuals: NDArray[np.float64]
    status: str
    lower_bound: float | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "settings", MappingProxyType(dict(self.settings)))
        for name in ("switch_times", "levels", "peak_deflections", "residuals"):
            getattr(self, name).setflags(write=False)

    @property
    def duration(self) -> float:
        """How long the move takes [s]."""
        return float(self.switch_times[-1])

    @property
    def gap(self) -> float | None:
        """Part of the duration by which a command that keeps the same limits could be shorter at most [-]."""
        return None if self.lower_bound is None else max(0.0, 1.0 - self.lower_bound / self.duration)

    @property
    def force(self) -> Profile:
        """The force [N] as its steps of level."""
        return Profile.steps(self.switch_times, np.diff(self.levels, prepend=0.0, append=0.0))

    def sample(self, dt: float, rest: float = 0.0) -> Command:
        """The force on a grid: each sample is its mean over the interval before.

        Means keep the area, so the body still stops. Held from one sample to the next the force is late by `dt`, and
        switches between samples are blurred: of a mode of w rad/s about (w dt)^2 / 24 of a step is left for each.

        Parameters
        ----------
        dt : float
            Sample interval [s].
        rest : float
            How long at least the 0 after the move is kept in the samples [s]; the last sample is 0 in any case.
        """
        dt = positive("dt", dt, "s")
        # one sample more: held to the next, the last mean of the move must be followed by the 0
        count = sample_count(self.duration + not_negative("rest", rest, "s"), dt) + 2
        times = np.arange(count) * dt
        means = np.diff(self.force.integral()(times)) / dt
        values = np.append(0.0, np.clip(means, -self.maximum_force, self.maximum_force))
        return Command(dt=dt, values=values, quantity="force [N]", duration=self.duration)

    def __str__(self) -> str:
        gap = "" if self.gap is None else f", at most {100.0 * self.gap:.2g} % too long"
        lines = [f"{self.method}: {self.distance:g} m in {self.duration:.6g} s, {self.status}{gap}", ""]
        lines += ["  from [s]      force [N]"]
        rows = [f"  {t:<12.9g}  {u:+.9g}" for t, u in zip(self.switch_times, [*self.levels, 0.0], strict=True)]
        if len(rows) > SHOWN:  # a staircase, which nobody reads
            rows = [*rows[: SHOWN // 2], f"  ... {len(rows) - SHOWN} more ...", *rows[-SHOWN // 2 :]]
        lines += rows
        peaks = ", ".join(f"{peak:.6g}" for peak in self.peak_deflections)
        return "\n".join([*lines, "", f"  deflection at most {peaks} m"])


def result_of(
    method: str,
    body: FlexibleBody,
    distance: float,
    maximum_force: float,
    times: ArrayLike,
    levels: ArrayLike,
    *,
    outputs: ArrayLike | None = None,
    status: str = "exact",
    lower_bound: float | None = None,
    settings: Mapping[str, Any] | None = None,
) -> RestToRest:
    """The result for switch times [s] and levels in units of the maximum force in the direction of the move.

    Arcs without a length are left out, and so are switches at which nothing changes; peaks and residuals are those of
    the exact motion.
    """
    switches, forces = _without_empty(np.asarray(times, dtype=float), np.asarray(levels, dtype=float))
    weights = np.eye(len(body.modes)) if outputs is None else np.asarray(outputs, dtype=float)
    rates = -np.conj([mode.pole for mode in body.modes])
    # a target is of no interest here; the limits of the outputs are 1 m
    problem = Problem(1.0, rates, weights * body.static_deflections(maximum_force))
    motion = Motion(problem, switches, forces)
    return RestToRest(
        method=method,
        body=body,
        distance=distance,
        maximum_force=maximum_force,
        switch_times=switches,
        levels=np.copysign(maximum_force, distance) * forces,
        peak_deflections=motion.largest(),
        residuals=motion.residuals,
        status=status,
        lower_bound=lower_bound,
        settings=settings or {},
    )


def _without_empty(
    times: NDArray[np.float64], levels: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Without arcs that take no time, and without switches at which the level stays."""
    lasting = np.diff(times) > 4.0 * np.finfo(float).eps * times[-1]
    starts, kept = times[:-1][lasting], levels[lasting]
    changes = np.append(True, np.diff(kept) != 0.0)
    return np.append(starts[changes], times[-1]), kept[changes]
