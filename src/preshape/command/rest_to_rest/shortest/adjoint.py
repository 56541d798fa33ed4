"""The witness of a structure: the p that is zero where the force switches, and where it holds an output on its limit.

Built from the end backwards, linear in what is unknown (c, each mode's final phasor, the wave of every tolerance, and
the masses where outputs reach their limits). Masses where holds end, and densities during them, follow: on an arc that
holds mode j, e_j is what makes p zero. p = 0 at every other switch then is a linear system for the unknowns.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.motion import Motion
from preshape.command.rest_to_rest.shortest.polish import ActiveTolerance
from preshape.command.rest_to_rest.shortest.problem import Problem, kappa
from preshape.command.rest_to_rest.shortest.programme import Farthest
from preshape.command.rest_to_rest.shortest.structure import Arc, Structure
from preshape.command.rest_to_rest.shortest.witness import Witness

__all__ = ["from_structure"]

RANK = 1e-12

NEIGHBOURS = 4
"""Samples of the grid on each side of a contact whose masses count as its."""

SAME_PEAK = 1.0
"""Points this near, in units of 1/duration [rad], stand for one peak of vibration."""

NODES = 12
"""Gauss nodes an interval for the total of a density."""

INTERVALS_PER_PERIOD = 16

ONE_SIGN = 1e-15
"""A sum that falls short of that of the magnitudes by this part has terms of both signs."""

Rows = NDArray[np.float64]


def from_structure(
    problem: Problem,
    structure: Structure,
    motion: Motion,
    found: Farthest | None,
    tolerances: Sequence[ActiveTolerance] = (),
) -> Witness:
    """The p that is zero where a structure switches and holds; if there are several, the one nearest to the grid's.

    Parameters
    ----------
    problem : Problem
        What is asked.
    structure : Structure
        Arcs with their exact times.
    motion : Motion
        Under them.
    found : Farthest or None
        The solution on a grid that they come from, if any.
    tolerances : sequence of ActiveTolerance
        Where the vibration is as large as allowed.
    """
    return _Backwards(problem, structure, motion, tolerances).witness(found)


class _Backwards:
    """Rows of coefficients for 1, c, the two parts of every mode's final phasor, the waves, and the masses."""

    def __init__(
        self, problem: Problem, structure: Structure, motion: Motion, tolerances: Sequence[ActiveTolerance]
    ) -> None:
        self.problem, self.structure, self.tolerances = problem, structure, tolerances
        modes = problem.rates.size
        self.rates = np.concatenate([problem.rates, [one.rate for one in tolerances]])
        self.first_wave = 2 + 2 * modes
        self.first_mass = self.first_wave + len(tolerances)
        self.size = self.first_mass + len(structure.contacts)
        self.phasors = np.zeros((self.rates.size, self.size), dtype=complex)
        self.phasors[np.arange(modes), 2 + 2 * np.arange(modes)] = 1.0
        self.phasors[np.arange(modes), 3 + 2 * np.arange(modes)] = 1.0j
        for k, one in enumerate(tolerances):
            left = motion.left(one.rate)
            self.phasors[modes + k, self.first_wave + k] = np.conj(left) / abs(left) * one.rate

    def witness(self, found: Farthest | None) -> Witness:
        """p and its price."""
        structure, times = self.structure, self.structure.times
        events = np.unique(np.concatenate([times, [touch.time for touch in structure.touches]]))
        ends, kept, zero = [], [], []
        equations: list[Rows] = []
        exits: list[tuple[float, int, Rows, Rows]] = []
        held: list[tuple[float, float, int, Rows]] = []
        for early, late in zip(events[-2::-1], events[:0:-1], strict=True):
            k = int(np.searchsorted(times, early, side="right")) - 1
            arc = structure.arcs[k]
            mode = None if arc.row is None else self.problem.held_mode(arc.row)
            if late == times[k + 1] and late != structure.end and structure.arcs[k + 1].row is None:
                equations.append(self._rest(late))
            if mode is not None and late == times[k + 1]:
                exits.append((late, mode, self._exit_mass(arc, mode, late), self._rest(late)))
            if mode is not None:
                held.append((early, late, mode, self.phasors.copy()))
            ends.append(early)
            kept.append(self.phasors.copy())
            zero.append(mode is not None)
            self.phasors = self.phasors * np.exp(-self.rates * (late - early))[:, None]
            if mode is not None and early == times[k]:
                self._enter(arc, mode, early)
            self._touch(early)
        unknown = self._solved(equations, self._guess(found))
        masses, price = np.zeros(len(ends)), 0.0
        for (time, _, _), mass in zip(structure.contacts, unknown[self.first_mass :], strict=True):
            masses[_piece_from(events, time)] += abs(float(mass))
        for time, mode, mass, left in exits:
            masses[_piece_from(events, time)] += abs(float(mass @ unknown))
            price += abs(float(left @ unknown)) * self._jump_price(mode)
        for early, late, mode, phasors in held:
            masses[_piece_from(events, early)] += self._density(early, late, mode, phasors, unknown)
        waves = np.abs(unknown[self.first_wave : self.first_mass])
        price += float(waves @ np.array([one.tolerance for one in self.tolerances]))
        return Witness(
            times=events,
            phasors=np.array([rows @ unknown for rows in kept[::-1]]),
            rates=self.rates,
            constant=float(unknown[1]),
            zero=np.array(zero[::-1]),
            masses=masses,
            price=price,
        )

    def _rest(self, time: float, but: int | None = None, derivative: int = 0) -> Rows:
        """p where the phasors are now, or a derivative of it, without one mode's part if asked."""
        keep = np.arange(self.rates.size) != (-1 if but is None else but)
        row = np.real(self.phasors[keep] * self.rates[keep, None] ** derivative).sum(axis=0)
        if derivative == 0:
            row[0] += self.structure.end - time
            row[1] -= 1.0
        elif derivative == 1:
            row[0] -= 1.0
        return np.asarray(row)

    def _exit_mass(self, arc: Arc, mode: int, time: float) -> Rows:
        """The mass where a hold ends: what the slope of e_j jumps by there."""
        outside = np.real(self.phasors[mode] * self.rates[mode])
        inside = -self._rest(time, mode, 1)
        return np.asarray((inside - outside) / (abs(self.rates[mode]) ** 2 * self._weight(arc, mode)))

    def _jump_price(self, mode: int) -> float:
        """How much p is worth for each unit by which e_j jumps where a hold of its mode ends [s].

        It should not jump: p = 0 is one of the equations there. What rounding leaves, or a structure that cannot meet
        all of them, counts with the largest that the mode's deflection and speed can be. A mode that is kept within A,
        and must stop before it gets farther than 2 A, is never faster than s with s^2 = 8 A z w s + 4 A (1 + A) w^2.
        """
        rate = self.problem.rates[mode]
        omega, most = float(abs(rate)), 1.0 / float(np.abs(self.problem.rows[:, mode]).max())
        z = float(rate.real) / omega
        fastest = omega * (4.0 * most * z + math.sqrt(16.0 * (most * z) ** 2 + 4.0 * most * (1.0 + most)))
        return fastest / omega**2 + 2.0 * z * most / omega

    def _enter(self, arc: Arc, mode: int, time: float) -> None:
        """Before a hold e_j is what it was inside, and its slope that of inside plus the mass."""
        rate, real, slope = self.rates[mode], -self._rest(time, mode), -self._rest(time, mode, 1)
        slope[self._mass_at(time, arc.row)] += self._weight(arc, mode) * abs(rate) ** 2
        self.phasors[mode] = real + 1j * (rate.real * real - slope) / rate.imag

    def _touch(self, time: float) -> None:
        """Before a touch the phasors of all modes in the output differ by the mass."""
        taken = kappa(self.problem.rates) * self.problem.rates
        for touch in self.structure.touches:
            if touch.time == time:
                column = self._mass_at(time, touch.row)
                self.phasors[: taken.size, column] -= self.problem.rows[touch.row] * taken

    def _weight(self, arc: Arc, mode: int) -> float:
        return 0.0 if arc.row is None else float(self.problem.rows[arc.row, mode])

    def _mass_at(self, time: float, row: int | None) -> int:
        """Where the unknown mass of a contact is."""
        which = [(when, output) for when, output, _ in self.structure.contacts].index(
            (time, -1 if row is None else row)
        )
        return self.first_mass + which

    def _guess(self, found: Farthest | None) -> Rows:
        """What the multipliers on the grid say of the unknowns."""
        guess = np.zeros(self.size)
        guess[0] = 1.0
        if found is None:
            return guess
        modes = self.problem.rates.size
        final = np.conj(found.waves[:modes]) * self.problem.rates
        guess[1] = found.velocity
        guess[2 : self.first_wave : 2], guess[3 : self.first_wave : 2] = final.real, final.imag
        for k, one in enumerate(self.tolerances):
            near = np.abs(found.points - one.rate) < SAME_PEAK / found.times[-1]
            guess[self.first_wave + k] = np.abs(found.waves[modes:][near]).sum()
        for k, (time, row, _) in enumerate(self.structure.contacts):
            at = int(np.searchsorted(found.sample_times, time))
            guess[self.first_mass + k] = found.masses[row, max(0, at - NEIGHBOURS) : at + NEIGHBOURS].sum()
        return guess

    def _solved(self, equations: Sequence[Rows], guess: Rows) -> Rows:
        """What is unknown: of all solutions the nearest to the guess."""
        system = np.array(equations).reshape(-1, self.size)
        step = np.linalg.lstsq(system[:, 1:], -system @ guess, rcond=RANK)[0]
        return np.concatenate([[1.0], guess[1:] + step])

    def _density(self, early: float, late: float, mode: int, phasors: Rows, unknown: Rows) -> float:
        """The total of a density's magnitude over an arc that holds a mode."""
        rate = self.rates[mode]
        waves = phasors @ unknown
        waves[mode] = 0.0
        periods = (late - early) * float(np.abs(self.rates).max()) / (2.0 * math.pi)
        edges = np.linspace(early, late, 2 + math.ceil(INTERVALS_PER_PERIOD * periods))
        nodes, weights = np.polynomial.legendre.leggauss(NODES)
        half = 0.5 * np.diff(edges)[:, None]
        t = 0.5 * (edges[:-1] + edges[1:])[:, None] + half * nodes
        each = waves * np.exp(-np.multiply.outer(late - t, self.rates))
        rest, slope, bend = (np.real(each * self.rates**n).sum(axis=-1) for n in range(3))
        rest, slope = rest + self.structure.end - t - unknown[1], slope - 1.0
        density = (bend - 2.0 * rate.real * slope) / abs(rate) ** 2 + rest
        arc = self.structure.arcs[int(np.searchsorted(self.structure.times, early, side="right")) - 1]
        totals = (np.abs(density) * half * weights).sum(axis=1)
        # where it changes its sign no quadrature is exact, but that of its square is, and by Schwarz that is enough
        mixed = np.abs(density.sum(axis=1)) < np.abs(density).sum(axis=1) * (1.0 - ONE_SIGN)
        squares = (density**2 * half * weights).sum(axis=1)
        totals[mixed] = np.sqrt(2.0 * half[mixed, 0] * squares[mixed])
        return float(totals.sum() / abs(self._weight(arc, mode)))


def _piece_from(events: NDArray[np.float64], time: float) -> int:
    """The piece that begins at a time; the last one for the end."""
    return min(int(np.searchsorted(events, time)), events.size - 2)
