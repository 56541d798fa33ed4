"""What oscillates in x' = A x: poles and their vectors, with what stands still (rigid bodies, integrators) set apart.

A rigid body is a pair of poles at 0 with one vector, and such a pair is what eigenvalues are worst at: rounding of
1e-16 moves it by 1e-8. So the zeros are taken out first, by orthogonal transformations that split off what A maps to 0,
as often as there is any; eigenvalues are those of the rest, which has none at 0.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.mode import EQUAL_MODES, Mode, Modes

__all__ = [
    "Oscillation",
    "check_stable",
    "distinct_modes",
    "mode_of",
    "moved_poles",
    "oscillation",
    "sampled_oscillation",
    "upper_poles",
]

REAL_POLE = 1e-6
"""A pole whose imaginary part is below this part of it is critically damped within the accuracy of a double pole."""

MARGIN = 1e-9
"""A pole to the right of the axis by less than this part of it is on the axis: rounding of an undamped mode."""

FORGOTTEN = 1e-3
"""A sampled system forgets a pole below this within a sample: a delay, whose zeros rounding scatters up to there."""

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Oscillation:
    """The poles of x' = A x that are not 0.

    Attributes
    ----------
    poles : ndarray of complex, shape (pole,)
        Eigenvalues [1/s]; of a pair, both.
    right, left : ndarray of complex, shape (state, pole)
        A right = right poles, left' A = poles left', and left' right = 1 for each.
    zeros : int
        How many poles are 0.
    """

    poles: Complex
    right: Complex
    left: Complex
    zeros: int


def oscillation(a: Real, accuracy: float) -> Oscillation:
    """The non-zero poles of A and their vectors.

    Parameters
    ----------
    a : ndarray, shape (state, state)
        A, balanced.
    accuracy : float
        How accurate its entries are, relative to its size: what is nearer to 0 is 0.

    Examples
    --------
    Two masses of 1 kg and a spring of 2 N/m, floating:

    >>> stiff = 2.0 * np.array([[-1.0, 1.0], [1.0, -1.0]])
    >>> found = oscillation(np.block([[np.zeros((2, 2)), np.eye(2)], [stiff, np.zeros((2, 2))]]), 1e-14)
    >>> found.zeros, found.poles.imag.round(12).tolist()
    (2, [2.0, -2.0])
    """
    from scipy.linalg import eig, solve_triangular, svd

    states = a.shape[0]
    turned, basis = a.copy(), np.eye(states)
    limit = accuracy * (float(np.linalg.norm(a, 2)) if states else 0.0)
    zeros = 0
    while zeros < states:
        _, values, across = svd(turned[zeros:, zeros:])
        none = int(np.count_nonzero(values <= limit))
        if none == 0:
            break
        turn = np.concatenate([across[-none:], across[:-none]]).T
        turned[:, zeros:] = turned[:, zeros:] @ turn
        turned[zeros:] = turn.T @ turned[zeros:]
        turned[zeros:, zeros : zeros + none] = 0.0
        basis[:, zeros:] = basis[:, zeros:] @ turn
        zeros += none
    if zeros == states:
        nothing = np.zeros((states, 0), dtype=complex)
        return Oscillation(np.zeros(0, dtype=complex), nothing, nothing, zeros)
    # scipy-stubs has two arrays for left and right asked together, and real vectors too; SciPy returns these three.
    found: tuple[Complex, Complex, Complex] = eig(turned[zeros:, zeros:], left=True, right=True)  # type: ignore[assignment]
    poles, left, right = found
    # A right vector of the whole has a part among the zeros, (pole - nilpotent)^-1 of the coupling; a left one not.
    above = np.zeros((zeros, poles.size), dtype=complex)
    coupled = turned[:zeros, zeros:] @ right
    for k, pole in enumerate(poles if zeros else ()):
        above[:, k] = solve_triangular(pole * np.eye(zeros) - np.triu(turned[:zeros, :zeros], 1), coupled[:, k])
    products = np.einsum("ij,ij->j", left.conj(), right)
    whole_left = basis[:, zeros:] @ (left / np.where(products == 0.0, 1.0, products).conj())
    return Oscillation(np.asarray(poles), basis @ np.concatenate([above, right]), whole_left, zeros)


def sampled_oscillation(transition: Real, accuracy: float, dt: float) -> Oscillation:
    """The same of x_{k+1} = F x_k, as poles of the continuous motion through the samples.

    Delays, and poles that alternate from sample to sample, which no such motion has, are left out.

    Parameters
    ----------
    transition : ndarray, shape (state, state)
        F, balanced.
    accuracy : float
        As of :func:`oscillation`; poles at 1 are the zeros here.
    dt : float
        From sample to sample [s].
    """
    found = oscillation(transition - np.eye(transition.shape[0]), accuracy)
    poles: Complex = found.poles + 1.0
    alternating = (poles.real < 0.0) & (np.abs(poles.imag) <= REAL_POLE * np.abs(poles))
    kept = (np.abs(poles) > FORGOTTEN) & ~alternating
    continuous = np.asarray(np.log(poles[kept]) / dt, dtype=complex)
    return Oscillation(continuous, found.right[:, kept], found.left[:, kept], found.zeros)


def moved_poles(a: Real, found: Oscillation, old: Modes, new: Modes) -> Real:
    """A with the oscillating pairs elsewhere and all vectors where they are: their shapes, and the zeros, stay.

    Parameters
    ----------
    a : ndarray, shape (state, state)
        A.
    found : Oscillation
        Of it.
    old, new : Modes
        What oscillates in it, and what is to oscillate instead, in the same order.
    """
    moved = a.astype(complex)
    for k in upper_poles(found.poles):
        pole = found.poles[k]
        nearest = int(np.argmin([abs(mode.pole - pole) for mode in old]))
        change = (new[nearest].pole - pole) * np.outer(found.right[:, k], found.left[:, k].conj())
        moved += change + change.conj()
    return np.asarray(moved.real)


def upper_poles(poles: Complex) -> NDArray[np.intp]:
    """Which poles are the upper of an oscillating pair, by increasing \\|pole\\|."""
    found = np.flatnonzero(poles.imag > REAL_POLE * np.abs(poles))
    return found[np.argsort(np.abs(poles[found]), kind="stable")]


def mode_of(pole: complex) -> Mode:
    """The mode of a stable pole [1/s]."""
    size = abs(pole)
    return Mode(size / (2.0 * np.pi), min(max(-pole.real / size, 0.0), 1.0 - EQUAL_MODES))


def check_stable(poles: Complex, slack: float) -> None:
    """InputError naming the pole [1/s] that grows fastest, beyond rounding (`slack` [1/s]), if one does."""
    growing = poles.real > np.maximum(MARGIN * np.abs(poles), slack)
    if growing.any():
        worst = poles[growing][np.argmax(poles[growing].real)]
        what = f"at {abs(worst.imag) / (2.0 * np.pi):.4g} Hz " if worst.imag else ""
        raise InputError(
            f"the plant is unstable: a motion {what}grows as exp({worst.real:.4g} t): "
            "check signs and gains; only what decays, or rings on, can be shaped."
        )


def distinct_modes(modes: Iterable[Mode]) -> Modes:
    """The modes with equal ones given once, by frequency; InputError if there is none."""
    kept: list[Mode] = []
    for mode in sorted(modes, key=lambda one: one.frequency):
        near = (m for m in reversed(kept) if mode.frequency - m.frequency <= 2.0 * EQUAL_MODES * mode.frequency)
        if not any(abs(mode.damping - other.damping) <= 2.0 * EQUAL_MODES for other in near):
            kept.append(mode)
    if not kept:
        raise InputError("nothing vibrates in this plant: no pole is complex, so there is nothing to shape.")
    return Modes(kept)
