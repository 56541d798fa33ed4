"""Outputs of many modes under a sampled command: in blocks, as matrix products, instead of a recursion a mode.

A mode's phasor obeys q_{k+1} = d q_k + a u_k + c u_{k+1}, exactly, d = exp(s dt). Within a block of samples the outputs
are the block's impulse response times its samples, a Toeplitz matrix the same for all blocks, plus what the phasors at
its start ring on; so all blocks are two matrix products, and the recursion runs only from block to block. Each power
of d is an exponential of its own, so rounding adds up over blocks, not over samples.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.phi_functions import phi_functions

__all__ = ["held_coefficients", "scanned_outputs", "twice_summed"]

BLOCK = 64
"""Samples a block: the products cost 2 (BLOCK + 4 modes) operations a sample, the recursion 1 / BLOCK of a sample's."""

Complex = NDArray[np.complex128]
Real = NDArray[np.float64]


def held_coefficients(poles: Complex, dt: float, *, linear: bool) -> tuple[Complex, Complex]:
    """What a unit command adds to a phasor q' = s q + u over one sample interval.

    Parameters
    ----------
    poles : ndarray of complex, shape (mode,)
        s [1/s].
    dt : float
        Sample interval [s].
    linear : bool
        The command between samples: the straight line, or held.

    Returns
    -------
    before, now : ndarray of complex, shape (mode,)
        Weights of the command at the start and at the end of the interval [s].
    """
    _, first, second = phi_functions(poles * dt, 2)
    if linear:
        return dt * (first - second), dt * second
    return dt * first, np.zeros_like(first)


def scanned_outputs(
    poles: Complex, weights: Complex, command: Real, dt: float, *, linear: bool = False
) -> tuple[Real, Complex]:
    """Sums of phasors at the samples of a command; every phasor is 0 before it.

    Parameters
    ----------
    poles : ndarray of complex, shape (mode,)
        s [1/s], of q' = s q + u.
    weights : ndarray of complex, shape (output, mode)
        An output is Re sum_m weights[m] q_m.
    command : ndarray, shape (sample,)
        u at 0, dt, 2 dt, ...
    dt : float
        Sample interval [s].
    linear : bool
        u between samples: the straight line, or held. It steps to its first value at 0 either way.

    Returns
    -------
    outputs : ndarray, shape (output, sample)
    last : ndarray of complex, shape (mode,)
        The phasors at the last sample.

    Examples
    --------
    >>> poles = np.array([2j * np.pi])
    >>> outputs, _ = scanned_outputs(poles, np.array([[-2j * np.pi]]), np.ones(3), 0.25)
    >>> outputs.round(12).tolist()
    [[0.0, 1.0, 2.0]]
    """
    from scipy.linalg import toeplitz
    from scipy.signal import lfilter

    before, now = held_coefficients(poles, dt, linear=linear)
    # What the past makes of a phasor, r = q - c u, obeys r_{k+1} = d r_k + (a + d c) u_k: no look ahead. Before sample
    # 0 nothing is, and a command that steps there has not acted yet: r_0 = -c u_0.
    drive = before + np.exp(poles * dt) * now
    start = -now * command[0]
    powers = np.exp(np.multiply.outer(poles * dt, np.arange(BLOCK + 1)))

    count = command.size
    blocks = -(-count // BLOCK)
    samples = command if count == blocks * BLOCK else np.concatenate([command, np.zeros(blocks * BLOCK - count)])
    samples = samples.reshape(blocks, BLOCK)
    fed = drive[:, np.newaxis] * powers[:, BLOCK - 1 :: -1]
    gathered = np.concatenate([fed.real, fed.imag]) @ samples.T
    states = np.empty((poles.size, blocks), dtype=complex)
    states[:, 0] = start
    for state, decay, real, imag in zip(states, powers[:, BLOCK], *np.split(gathered, 2), strict=True):
        state[1:] = lfilter([1.0], [1.0, -decay], (real + 1j * imag)[:-1], zi=[decay * state[0]])[0]

    rung = np.concatenate([states.real, -states.imag]).T
    outputs = np.empty((weights.shape[0], blocks * BLOCK))
    for row, weight in zip(outputs, weights, strict=True):
        ringing = weight[:, np.newaxis] * powers[:, :BLOCK]
        impulse = np.concatenate([[(weight @ now).real], ((weight * drive) @ powers[:, : BLOCK - 1]).real])
        response = np.tril(toeplitz(impulse))
        values = row.reshape(blocks, BLOCK)
        np.matmul(samples, response.T, out=values)
        values += rung @ np.concatenate([ringing.real, ringing.imag])
    used = count - (blocks - 1) * BLOCK - 1
    last = states[:, -1] * powers[:, used] + now * command[-1]
    if used:
        last += drive * (powers[:, used - 1 :: -1] @ samples[-1, :used])
    return outputs[:, :count], last


def twice_summed(command: Real, dt: float, *, linear: bool = False) -> tuple[Real, Real]:
    """The integral of a sampled command and the integral of that, at the samples, exact for the held or linear command.

    Returns
    -------
    velocity, position : ndarray, shape (sample,)
        0 at the first sample [unit s, unit s^2].
    """
    velocity, position = np.zeros((2, command.size))
    u, after = command[:-1], command[1:]
    if linear:
        np.cumsum(0.5 * dt * (u + after), out=velocity[1:])
        np.cumsum(dt * velocity[:-1] + dt**2 / 6.0 * (2.0 * u + after), out=position[1:])
    else:
        np.cumsum(dt * u, out=velocity[1:])
        np.cumsum(dt * velocity[:-1] + 0.5 * dt**2 * u, out=position[1:])
    return velocity, position
