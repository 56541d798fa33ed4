"""Convolution of a long command with a few impulses: the NumPy form, and the reference for any faster one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["sparse_convolve"]

BLOCK = 8192
"""Samples a block: 64 kB of input and of output stay in the cache while every impulse passes over them."""


def sparse_convolve(
    command: NDArray[np.float64],
    delays: NDArray[np.intp],
    weights: NDArray[np.float64],
    before: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Shape a command with impulses that lie on its own sample grid.

    Parameters
    ----------
    command : ndarray, shape (..., time)
        The command; its last sample is held after the end.
    delays : ndarray of int, shape (tap,)
        Delays [samples], at least 0, each once.
    weights : ndarray, shape (tap,)
        Weight of each delay [-].
    before : ndarray, shape (..., 1)
        The value that was commanded before the first sample.

    Returns
    -------
    ndarray, shape (..., time + max(delays))
    """
    latency = int(delays.max(initial=0))
    length = command.shape[-1] + latency
    padded = np.empty((*command.shape[:-1], latency + length))
    padded[..., :latency] = before
    padded[..., latency : latency + command.shape[-1]] = command
    padded[..., latency + command.shape[-1] :] = command[..., -1:]
    shaped = np.zeros((*command.shape[:-1], length))
    scratch = np.empty((*command.shape[:-1], min(BLOCK, length)))
    for start in range(0, length, BLOCK):
        stop = min(start + BLOCK, length)
        part, product = shaped[..., start:stop], scratch[..., : stop - start]
        for delay, weight in zip(delays.tolist(), weights.tolist(), strict=True):
            shift = latency - delay
            np.multiply(padded[..., start + shift : stop + shift], weight, out=product)
            part += product
    return shaped
