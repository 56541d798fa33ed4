"""Convolution of a long command with a few impulses: in C where it is installed, else the NumPy form, bit for bit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.active import compiled

__all__ = ["convolve_padded", "sparse_convolve"]

BLOCK = 8192
"""Samples a block: 64 kB of input and of output stay in the cache while every impulse passes over them."""


def sparse_convolve(
    command: NDArray[np.float64],
    delays: NDArray[np.intp],
    weights: NDArray[np.float64],
    before: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Shape a command with impulses that lie on its own sample grid.

    The order of summation is that of :func:`convolve_padded`.

    Parameters
    ----------
    command : ndarray, shape (..., time)
        The command; its last sample is held after the end.
    delays : ndarray of int, shape (tap,)
        Delays [samples], at least 0, increasing.
    weights : ndarray, shape (tap,)
        Weight of each delay [-], of sum 1.
    before : ndarray, shape (..., 1)
        The value that was commanded before the first sample.

    Returns
    -------
    ndarray, shape (..., time + max(delays))
    """
    latency = int(delays[-1])
    length = command.shape[-1] + latency
    padded = np.empty((*command.shape[:-1], latency + length))
    padded[..., :latency] = before
    padded[..., latency : latency + command.shape[-1]] = command
    padded[..., latency + command.shape[-1] :] = command[..., -1:]
    if compiled is None:
        return convolve_padded(padded, delays, weights)
    shaped = np.empty((*command.shape[:-1], length))
    rows = padded.size // padded.shape[-1]
    compiled.convolve(padded, delays.astype(np.uint32), np.ascontiguousarray(weights, dtype=float), shaped, rows)
    return shaped


def convolve_padded(
    padded: NDArray[np.float64], delays: NDArray[np.intp] | NDArray[np.uint32], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same in NumPy, for a command that begins with as many samples as the longest delay.

    With the last tap as the reference r, y = r + (((0 + w_0 (u_0 - r)) + w_1 (u_1 - r)) + ...), the taps by delay: a
    constant comes out unchanged to the last bit, and the last weight is what the others leave of 1. The kernel in C
    does the same operations in the same order.

    Parameters
    ----------
    padded : ndarray, shape (..., longest delay + time)
        The command and its past.
    delays : ndarray of int, shape (tap,)
        Delays [samples], increasing.
    weights : ndarray, shape (tap,)
        Weight of each delay [-], of sum 1.

    Returns
    -------
    ndarray, shape (..., time)

    Examples
    --------
    >>> convolve_padded(np.array([0.0, 1.0, 1.0]), np.array([0, 1]), np.array([0.25, 0.75])).tolist()
    [0.25, 1.0]
    """
    latency = int(delays[-1])
    length = padded.shape[-1] - latency
    shaped = np.zeros((*padded.shape[:-1], length))
    scratch = np.empty((*padded.shape[:-1], min(BLOCK, length)))
    for start in range(0, length, BLOCK):
        stop = min(start + BLOCK, length)
        part, product = shaped[..., start:stop], scratch[..., : stop - start]
        reference = padded[..., start:stop]
        for delay, weight in zip(delays[:-1].tolist(), weights[:-1].tolist(), strict=True):
            shift = latency - delay
            np.subtract(padded[..., start + shift : stop + shift], reference, out=product)
            product *= weight
            part += product
        part += reference
    return shaped
