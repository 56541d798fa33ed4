"""Outputs of a linear system under a sampled command: in blocks, as matrix products, instead of a step a sample.

The state obeys x_{k+1} = F x_k + a u_k + c u_{k+1}, exactly. What the past makes of it, r = x - c u, obeys
r_{k+1} = F r_k + (a + F c) u_k: no look ahead. Within a block of samples the outputs are the block's impulse response
times its samples, a Toeplitz matrix the same for all blocks, plus what the state at its start rings on; only that
state is stepped, from block to block. Nothing is diagonalised, so rigid bodies and equal modes are as good as any.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

__all__ = ["Steps", "held_steps", "scanned"]

BLOCK = 64
"""Samples that are one matrix product."""

TOGETHER = 256
"""Blocks whose products are one: about as many samples as fit into a processor's cache, and between two reports."""

Real = NDArray[np.float64]


class Steps(NamedTuple):
    """x_{k+1} = transition x_k + before u_k + now u_{k+1}."""

    transition: Real
    before: Real
    now: Real


def held_steps(a: Real, b: Real, dt: float, *, linear: bool) -> Steps:
    """The exact steps of x' = A x + B u under a command that is held, or straight, between samples.

    Parameters
    ----------
    a, b : ndarray, shape (state, state) and (state, input)
        A [1/s] and B.
    dt : float
        Sample interval [s].
    linear : bool
        The straight line from sample to sample instead of the value held.

    Examples
    --------
    A double integrator, held for two seconds:

    >>> steps = held_steps(np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]]), 2.0, linear=False)
    >>> steps.before.ravel().tolist()
    [2.0, 2.0]
    """
    from scipy.linalg import expm

    states, inputs = b.shape
    # The inputs are scaled to the size of A: the exponential is accurate relative to its largest block.
    size = max(float(np.abs(a).max(initial=0.0)), 1.0 / dt) / np.where(
        np.abs(b).max(axis=0) > 0.0, abs(b).max(axis=0), 1
    )
    chain = np.zeros((states + 2 * inputs, states + 2 * inputs))
    chain[:states, :states] = a * dt
    chain[:states, states : states + inputs] = b * size * dt
    chain[states : states + inputs, states + inputs :] = np.eye(inputs)
    found = np.asarray(expm(chain))[:states]
    held = found[:, states : states + inputs] / size
    if not linear:
        return Steps(found[:, :states], held, np.zeros_like(held))
    ramp = found[:, states + inputs :] / size
    return Steps(found[:, :states], held - ramp, ramp)


def scanned(
    steps: Steps, c: Real, d: Real, command: Real, progress: Callable[[float], object] | None = None
) -> tuple[Real, int]:
    """y = C x + D u at the samples; the state is 0 at the first.

    Parameters
    ----------
    steps : Steps
        How the state moves.
    c, d : ndarray, shape (output, state) and (output, input)
        C and D.
    command : ndarray, shape (input, sample)
        u.
    progress : function, optional
        Called with the part done, 0 to 1.

    Returns
    -------
    outputs : ndarray, shape (output, sample)
    good : int
        How many samples, from the first, are finite; none is computed long after the last of them.
    """
    inputs, count = command.shape
    blocks = -(-count // BLOCK)
    padded = np.zeros((inputs, blocks * BLOCK))
    padded[:, :count] = command
    samples = padded.reshape(inputs, blocks, BLOCK).transpose(1, 2, 0).reshape(blocks, BLOCK * inputs).T
    drive = steps.before + steps.transition @ steps.now
    block = _block(steps.transition, drive, c, c @ steps.now + d)
    state = -steps.now @ command[:, 0]
    outputs = np.empty((c.shape[0], blocks * BLOCK))
    with np.errstate(over="ignore", invalid="ignore"):
        for first in range(0, blocks, TOGETHER):
            these = samples[:, first : first + TOGETHER]
            gathered = block.fed @ these
            states = np.empty((state.size, these.shape[1]))
            for k in range(these.shape[1]):
                states[:, k] = state
                state = block.across @ state + gathered[:, k]
            found = (block.seen @ states + block.response @ these).T
            place = slice(first * BLOCK, (first + these.shape[1]) * BLOCK)
            outputs[:, place] = found.reshape(-1, c.shape[0]).T
            good = np.isfinite(outputs[:, place]).all(axis=0)
            if not good.all() or not np.isfinite(state).all():
                return outputs[:, :count], min(place.start + int(np.argmin(np.append(good, False))), count)
            if progress is not None:
                progress((first + these.shape[1]) / blocks)
    return outputs[:, :count], count


class _Block(NamedTuple):
    """What a block of samples does: rows and columns go sample by sample, inputs or outputs within."""

    seen: Real
    """Outputs of the state at the block's start, shape (BLOCK output, state)."""
    response: Real
    """Outputs of the block's own samples, shape (BLOCK output, BLOCK input)."""
    fed: Real
    """What the samples add to the state after the block, shape (state, BLOCK input)."""
    across: Real
    """The state after the block from that before, shape (state, state)."""


def _block(transition: Real, drive: Real, c: Real, through: Real) -> _Block:
    outputs, inputs = through.shape
    seen = np.empty((BLOCK, outputs, c.shape[1]))
    fed = np.empty((BLOCK, c.shape[1], inputs))
    seen[0], fed[-1] = c, drive
    with np.errstate(over="ignore", invalid="ignore"):
        for k in range(1, BLOCK):
            seen[k] = seen[k - 1] @ transition
            fed[BLOCK - 1 - k] = transition @ fed[BLOCK - k]
        markov = np.concatenate([through[np.newaxis], seen[:-1] @ drive])
        across = np.linalg.matrix_power(transition, BLOCK)
    response = np.zeros((BLOCK, outputs, BLOCK, inputs))
    for k in range(BLOCK):
        response[k:, :, k] = markov[: BLOCK - k]
    return _Block(
        seen.reshape(BLOCK * outputs, -1),
        response.reshape(BLOCK * outputs, BLOCK * inputs),
        fed.transpose(1, 0, 2).reshape(-1, BLOCK * inputs),
        across,
    )
