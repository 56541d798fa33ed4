"""Profile: a command as an exact sum of delayed powers, steps of its level, slope, acceleration or jerk.

Most commands that machines are given are piecewise polynomials. Kept as their steps, they can be shaped,
differentiated, integrated and simulated exactly: no sample grid, no rounding of a switch to a sample.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import nonzero, not_negative, positive, whole_number
from preshape.errors import InputError
from preshape.kernel import Extremum, polynomial_extremum
from preshape.profile_steps import HIGHEST_ORDER, checked_orders, checked_vector, merged_steps, segments_of
from preshape.ruckig_steps import ruckig_steps
from preshape.shaper import Shaper

__all__ = ["Profile"]

MOST_SAMPLES = 20_000_000
"""A longer sampled command is a mistaken sample interval: 20 million samples are 160 MB."""


@dataclass(frozen=True, eq=False)
class Profile:
    """A command, at rest at 0 before its first step:  value(t) = sum_k jumps[k] max(t - times[k], 0)^n_k / n_k!

    with n_k = orders[k]: 0 is a step of level, 1 of slope, 2 of acceleration, 3 of jerk. After the last step the
    polynomial goes on for ever; most commands end at a constant level.

    Parameters
    ----------
    times : array_like, shape (step,)
        When each step happens [s], in any order; they are sorted, and steps of one order at one time added up.
    jumps : array_like, shape (step,)
        By how much [unit/s^order].
    orders : array_like of int, shape (step,)
        Which derivative steps, 0 to 6.

    Raises
    ------
    InputError
        If the three do not fit together, or a value is not finite.

    Examples
    --------
    >>> ramp_to_one = Profile([0.0, 2.0], [0.5, -0.5], [1, 1])
    >>> ramp_to_one([0.0, 1.0, 2.0, 50.0]).tolist()
    [0.0, 0.5, 1.0, 1.0]
    """

    times: NDArray[np.float64]
    jumps: NDArray[np.float64]
    orders: NDArray[np.intp]

    def __init__(self, times: ArrayLike, jumps: ArrayLike, orders: ArrayLike) -> None:
        t, c, n = checked_vector("times", times), checked_vector("jumps", jumps), checked_orders(orders)
        if not t.size == n.size == c.size:
            raise InputError(
                f"{t.size} times, {c.size} jumps and {n.size} orders: a profile needs one of each for every step."
            )
        for name, column in zip(("times", "jumps", "orders"), merged_steps(t, c, n), strict=True):
            column.setflags(write=False)
            object.__setattr__(self, name, column)

    @classmethod
    def steps(cls, times: ArrayLike, jumps: ArrayLike, order: int = 0) -> Profile:
        """A profile whose steps are all of one order.

        Parameters
        ----------
        times, jumps : array_like, shape (step,)
            As for Profile.
        order : int
            Which derivative steps: 0 level, 1 slope, 2 acceleration, 3 jerk.

        Examples
        --------
        >>> bang_bang = Profile.steps([0.0, 1.0, 2.0], [1.0, -2.0, 1.0], order=2)
        >>> bang_bang.final_value
        1.0
        """
        t = checked_vector("times", times)
        return cls(t, jumps, np.full(t.size, whole_number("order", order, 0, HIGHEST_ORDER)))

    @classmethod
    def from_ruckig(cls, trajectory: Any, axis: int = 0) -> Profile:
        """One axis of a trajectory of `ruckig`, relative to its start: its exact steps of jerk, no samples.

        Parameters
        ----------
        trajectory : ruckig.Trajectory
            Calculated, from rest to rest or any other end; ``pip install preshape[motion]`` brings ruckig.
        axis : int
            Which degree of freedom, from 0.

        Raises
        ------
        InputError
            If it is no such trajectory, has no such axis, or starts while moving: what a shaper has to remember of the
            time before is then unknown.
        """
        return cls(*ruckig_steps(trajectory, axis))

    @property
    def start_time(self) -> float:
        """When the first step happens [s]; 0 if there is none."""
        return float(self.times[0]) if self.times.size else 0.0

    @property
    def end_time(self) -> float:
        """When the last step happens [s]; 0 if there is none."""
        return float(self.times[-1]) if self.times.size else 0.0

    @property
    def duration(self) -> float:
        """From the first step to the last [s]."""
        return self.end_time - self.start_time

    @property
    def ends_at_rest(self) -> bool:
        """Whether the command is constant after its last step."""
        _, taylor = self._pieces
        return not taylor[-1:, 1:].any()

    @property
    def final_value(self) -> float:
        """The level after the last step [unit]; InputError if the command does not end at rest."""
        if not self.ends_at_rest:
            raise InputError("the command still changes after its last step, so it has no final value: end it at rest.")
        return float(self._pieces[1][-1, 0]) if self.times.size else 0.0

    def segments(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The polynomial between the steps, for exact evaluation and simulation.

        Returns
        -------
        starts : ndarray, shape (segment,)
            Where each begins [s], increasing; the last one goes on for ever, before the first the command is 0.
        taylor : ndarray, shape (segment, highest order + 1)
            The command's derivatives of order 0, 1, ... right after the step there [unit/s^order].

        Examples
        --------
        >>> starts, taylor = Profile([0.0, 2.0], [0.5, -0.5], [1, 1]).segments()
        >>> starts.tolist(), taylor.tolist()
        ([0.0, 2.0], [[0.0, 0.5], [1.0, 0.0]])
        """
        return self._pieces

    def __call__(self, t: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """The command, or a derivative of it, at any times.

        Parameters
        ----------
        t : array_like
            Times [s], of any shape. Where the value steps, it is the one after the step; the impulse that a step leaves
            in its derivative is left out.
        derivative : int
            Order of the derivative, 0 to 6.

        Returns
        -------
        ndarray
            Of the shape of `t` [unit/s^derivative].
        """
        order = whole_number("derivative", derivative, 0, HIGHEST_ORDER)
        when = np.asarray(t, dtype=float)
        if not np.isfinite(when).all():
            raise InputError("a time is NaN or infinite: give finite times in seconds.")
        starts, taylor = self._pieces
        if starts.size == 0 or order >= taylor.shape[1]:
            return np.zeros(when.shape)
        segment = np.searchsorted(starts, when, side="right") - 1
        since = np.where(segment >= 0, when - starts[segment], 0.0)
        rows = taylor[segment]
        value = rows[..., -1]
        for k in range(taylor.shape[1] - 1, order, -1):
            value = rows[..., k - 1] + value * since / (k - order)
        return np.asarray(np.where(segment >= 0, value, 0.0))

    def peak(self, derivative: int = 0) -> Extremum:
        """The largest magnitude over all time of the command, or of a derivative of it: exact, not the largest sample.

        Infinite where a step leaves an impulse in the derivative, and when it grows for ever.

        Examples
        --------
        >>> move = Profile.steps([0.0, 1.0, 2.0], [1.0, -2.0, 1.0], order=2)
        >>> move.peak(1).value, move.peak(1).time, move.peak(3).value
        (1.0, 1.0, inf)
        """
        order = whole_number("derivative", derivative, 0, HIGHEST_ORDER)
        if (self.orders < order).any():
            return Extremum(np.inf, float(self.times[int(np.argmax(self.orders < order))]), np.inf)
        starts, taylor = self._pieces
        return polynomial_extremum(starts, taylor[:, order:])

    def derivative(self) -> Profile:
        """The derivative [unit/s]; InputError if the command itself steps, for then it holds impulses."""
        if (self.orders == 0).any():
            first = self.times[int(np.argmax(self.orders == 0))]
            raise InputError(f"the command steps at {first:g} s, so its derivative is no function: smooth it first.")
        return Profile(self.times, self.jumps, self.orders - 1)

    def integral(self) -> Profile:
        """The integral over time [unit s], 0 before the first step."""
        return Profile(self.times, self.jumps, self.orders + 1)

    def delayed(self, time: float) -> Profile:
        """The same command, `time` [s] later."""
        return Profile(self.times + not_negative("time", time, "s"), self.jumps, self.orders)

    def scaled(self, factor: float) -> Profile:
        """The command times `factor`, which is not 0."""
        return Profile(self.times, self.jumps * nonzero("factor", factor, "times the command"), self.orders)

    def __add__(self, other: Profile) -> Profile:
        """Both commands at once."""
        if not isinstance(other, Profile):
            return NotImplemented
        return Profile(*(np.concatenate(pair) for pair in zip(self._columns(), other._columns(), strict=True)))

    def shaped(self, shaper: Shaper) -> Profile:
        """The command convolved with a shaper, exactly: each step delayed and scaled, coincident ones merged.

        Parameters
        ----------
        shaper : Shaper
            A part of constant density turns a step into two of the next order.

        Raises
        ------
        InputError
            If a part of constant density meets a step of order 6.

        Examples
        --------
        >>> step = Profile.steps([0.0], [1.0])
        >>> step.shaped(Shaper([0.0, 0.5], [0.5, 0.5])).jumps.tolist()
        [0.5, 0.5]
        """
        times = [np.add.outer(self.times, shaper.times).ravel()]
        orders = [np.repeat(self.orders, shaper.times.size)]
        jumps = [np.multiply.outer(self.jumps, shaper.amplitudes).ravel()]
        for start, end, density in shaper.boxes:
            times += [self.times + start, self.times + end]
            orders += [self.orders + 1] * 2
            jumps += [self.jumps * density, -self.jumps * density]
        return Profile(np.concatenate(times), np.concatenate(jumps), np.concatenate(orders))

    def sample(self, dt: float, rest: float = 0.0) -> NDArray[np.float64]:
        """The command at 0, dt, 2 dt, ... to its last step, and `rest` longer.

        Parameters
        ----------
        dt : float
            Sample interval [s].
        rest : float
            How long at least to go on after the last step [s].

        Returns
        -------
        ndarray, shape (sample,)

        Raises
        ------
        InputError
            If dt is not above zero, or a step is before time 0.
        """
        dt, rest = positive("dt", dt, "s"), not_negative("rest", rest, "s")
        if self.start_time < 0.0:
            raise InputError(f"the first step is at {self.start_time:g} s, before the samples: delay the command.")
        count = (self.end_time + rest) / dt
        if count > MOST_SAMPLES:
            raise InputError(f"{count:.3g} samples are more than {MOST_SAMPLES:,}: give a larger dt.")
        return self(np.arange(int(np.ceil(count - 1e-9)) + 1) * dt)

    def __len__(self) -> int:
        return self.times.size

    def __repr__(self) -> str:
        kinds = ", ".join(str(n) for n in np.unique(self.orders))
        return f"<Profile: {len(self)} steps of order {kinds} from {self.start_time:g} s to {self.end_time:g} s>"

    def _columns(self) -> tuple[NDArray[Any], ...]:
        return self.times, self.jumps, self.orders

    @cached_property
    def _pieces(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return segments_of(self.times, self.jumps, self.orders)
