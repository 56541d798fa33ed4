"""Frequency response from the transforms of command and response, averaged over bins that are narrow at the modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.sweep_alignment import Alignment

__all__ = ["FrequencyResponse", "binned", "noise_of"]

WIDEST_BIN = 0.5
"""[Hz]"""

BINS_TO_A_POLE = 24.0
"""Bins are so many times narrower than the distance to the nearest pole: the mean over one is then 0.02 % off."""

FEWEST_LINES = 1
"""Lines of the transform in a bin, at least."""

NOISE_BIN = 0.25
"""Bins [Hz] in whose lines the noise shows as what no straight line describes."""

FEWEST_NOISE_LINES = 8
"""In such a bin, at least."""

NOISE_NEIGHBOURS = 9
"""Bins whose median is the noise in the middle one: a resonance that is sharper than a bin must not count as noise."""

_Array = NDArray[np.float64]
_Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """Response over command.

    Attributes
    ----------
    frequencies : ndarray, shape (bin,)
        [Hz], in the middle of the command's power in the bin.
    values : ndarray, shape (channel, bin)
        Measured over commanded acceleration, complex [-].
    deviation : ndarray, shape (channel, bin)
        Standard deviation of real and of imaginary part, from noise.
    """

    frequencies: _Array
    values: _Complex
    deviation: _Array


def binned(laid: Alignment, noise: _Array, natural: _Array, damping: _Array) -> FrequencyResponse:
    """Average over bins.

    Parameters
    ----------
    laid : Alignment
        Transforms.
    noise : ndarray, shape (channel, line)
        From :func:`noise_of`.
    natural, damping : ndarray, shape (mode,)
        Where bins must be narrow: natural frequencies [Hz] and damping ratios.
    """
    edges = _edges(laid.frequencies, natural, damping)
    command = np.abs(laid.command) ** 2
    power = np.add.reduceat(command, edges)
    frequencies = np.add.reduceat(command * laid.frequencies, edges) / power
    cross: _Complex = np.add.reduceat(laid.response * np.conj(laid.command), edges, axis=-1)
    spread = np.add.reduceat(noise * command, edges, axis=-1)
    return FrequencyResponse(frequencies, np.asarray(cross / power, dtype=np.complex128), np.sqrt(0.5 * spread) / power)


def _edges(frequencies: _Array, natural: _Array, damping: _Array) -> NDArray[np.intp]:
    """Index of the first line of each bin."""
    step = float(frequencies[1] - frequencies[0])
    distance = np.hypot(frequencies[:, None] - natural, damping * natural).min(axis=-1, initial=np.inf)
    width = np.clip(distance / BINS_TO_A_POLE, FEWEST_LINES * step, WIDEST_BIN)
    number = np.floor(np.cumsum(step / width)).astype(int)
    return np.concatenate([[0], np.flatnonzero(np.diff(number)) + 1]).astype(np.intp)


def noise_of(laid: Alignment) -> _Array:
    """Noise power of each line of the response, whatever the modes are, shape (channel, line).

    In a narrow bin the response over the command is a straight line; what is left of it is noise, with the lines of
    motors, harmonics and other things that the command does not explain.
    """
    step = float(laid.frequencies[1] - laid.frequencies[0])
    lines = max(round(NOISE_BIN / step), FEWEST_NOISE_LINES)
    bins = laid.frequencies.size // lines
    command = laid.command[: bins * lines].reshape(bins, lines)
    response = laid.response[:, : bins * lines].reshape(-1, bins, lines)
    ramp = np.linspace(-1.0, 1.0, lines)
    basis = np.stack([command, command * ramp], axis=-1)
    q, _ = np.linalg.qr(basis)
    left = response - np.einsum("blk,cbk->cbl", q, np.einsum("blk,cbl->cbk", np.conj(q), response))
    power = np.sum(np.abs(left) ** 2, axis=-1) / (lines - 2)
    pad = NOISE_NEIGHBOURS // 2
    padded = np.pad(power, ((0, 0), (pad, pad)), mode="edge")
    smooth = np.median(np.lib.stride_tricks.sliding_window_view(padded, NOISE_NEIGHBOURS, axis=-1), axis=-1)
    whole = np.repeat(smooth, lines, axis=-1)
    return np.pad(whole, ((0, 0), (0, laid.frequencies.size - whole.shape[-1])), mode="edge")
