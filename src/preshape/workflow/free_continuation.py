"""Free vibration at the end of a record, continued backwards sample by sample until the record disagrees.

The unknowns are the amplitudes of all channels, their constants, and small changes of the poles that the channels
share. Each earlier sample that agrees is used to know them better (recursive least squares), so that what the next one
should be, and how surely, is known without assumptions about how good the poles are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.decaying_sinusoids import DecayFit, Subspace, fit_decay, left_over

__all__ = ["Break", "continued", "decay_components", "left_at_start"]

COMPONENTS = 6
"""Decaying sinusoids, at most."""

WIDTHS = (1, 2, 4, 8, 16, 32)
"""Samples over which it is asked whether they agree."""

UNLIKELY = 5.5
"""Their mean is off by so many standard deviations where the vibration is not free."""

MARGIN = 24
"""Samples after those that disagree, from which on the vibration is surely free."""

STRONGEST_DAMPING = 0.35
"""A component that dies away faster is the end of the move."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Break:
    """Where a record stops agreeing with the free vibration after it.

    Parameters
    ----------
    first : int
        First sample of the arrays.
    off : ndarray, shape (channel, sample)
        How far the samples are off the vibration that the later ones show.
    noise : ndarray, shape (channel, sample)
        Standard deviation of `off`, were it still free.
    """

    first: int
    off: _Array
    noise: _Array


def decay_components(values: _Array, rate: float) -> DecayFit | None:
    """Decaying sinusoids that explain a free decay, their number by the information criterion; None when none do."""
    values = values - values.mean(axis=-1, keepdims=True)
    subspace = Subspace(values, rate)
    best, least = None, np.inf
    for count in range(1, COMPONENTS + 1):
        natural, damping = subspace.poles(2 * count + 1)
        kept = damping < STRONGEST_DAMPING
        natural, damping = natural[kept], damping[kept]
        if not natural.size or 4 * natural.size + 2 >= values.shape[-1]:
            continue
        squares, freedoms = left_over(values, rate, natural, damping)
        if freedoms <= 0:
            continue
        unknowns = 2 * natural.size * (values.shape[0] + 1)
        criterion = values.size * np.log(max(squares, np.finfo(float).tiny)) + unknowns * np.log(values.size)
        if criterion < least:
            best, least = (natural, damping), criterion
    return None if best is None else fit_decay(values, rate, *best)


class _Model:
    """Values and slopes of the vibration over all samples, about amplitudes that are fitted from one on."""

    def __init__(self, values: _Array, rate: float, fit: DecayFit, first: int) -> None:
        channels, samples = values.shape
        natural, damping = fit.natural, np.minimum(fit.damping, 0.99)
        root = np.sqrt(1.0 - damping**2)
        poles = 2.0 * np.pi * natural * (-damping + 1j * root)
        times = (np.arange(samples) - first) / rate
        waves = np.exp(np.clip(np.outer(times, poles.real), -500.0, 500.0) + 1j * np.outer(times, poles.imag))
        linear = np.concatenate([waves.real, waves.imag, np.ones((samples, 1))], axis=1)
        found, *_ = np.linalg.lstsq(linear[first:], values[:, first:].T, rcond=None)
        left = values.T - linear @ found
        freedom = max(samples - first - found.shape[0], 1)
        self.variance = np.sum(left[first:] ** 2, axis=0) / freedom + np.finfo(float).tiny
        count, width = natural.size, linear.shape[1]
        amplitudes = found[:count] - 1j * found[count : 2 * count]  # (mode, channel)
        slopes = np.stack(
            [2.0 * np.pi * (-damping + 1j * root), 2.0 * np.pi * natural * (-1.0 - 1j * damping / root)], axis=-1
        )
        moved = times[:, None] * waves
        self.jacobian = np.zeros((samples, channels, channels * width + 2 * count))
        for channel in range(channels):
            self.jacobian[:, channel, channel * width : (channel + 1) * width] = linear
            for kind in range(2):
                at = channels * width + kind * count
                self.jacobian[:, channel, at : at + count] = (moved * slopes[:, kind] * amplitudes[:, channel]).real
        self.left = left  # (sample, channel)


def continued(values: _Array, rate: float, fit: DecayFit, first: int, earliest: int) -> Break | None:
    """Continue what `values` shows from `first` on backwards to `earliest`; None when everything agrees.

    Parameters
    ----------
    values : ndarray, shape (channel, sample)
        A record that ends with a free decay.
    rate : float
        Samples per second [Hz].
    fit : DecayFit
        Of the samples from `first` on.
    first, earliest : int
        Samples.
    """
    model = _Model(values, rate, fit, first)
    weighted = model.jacobian[first:] / np.sqrt(model.variance)[:, None]
    rows = weighted.reshape(-1, weighted.shape[-1])
    scale = 1.0 / np.maximum(np.sqrt(np.sum(rows**2, axis=0)), 1e-150)
    covariance = scale[:, None] * np.linalg.pinv((rows * scale).T @ (rows * scale), rcond=1e-10, hermitian=True) * scale
    unknowns = covariance @ (rows.T @ (model.left[first:] / np.sqrt(model.variance)).ravel())
    ordinary = _ordinary(model.left[first:] / np.sqrt(model.variance))
    noise = np.diag(model.variance)
    history = [(first, unknowns, covariance)]
    seen: list[_Array] = []
    for at in range(first - 1, earliest - 1, -1):
        row = model.jacobian[at]
        gained = covariance @ row.T
        total = row @ gained + noise
        ahead = model.left[at] - row @ unknowns
        seen.append(ahead / np.sqrt(np.diag(total)))
        width = _disagrees(np.array(seen[-WIDTHS[-1] :]), ordinary)
        if width:
            return _break(model, history, at, min(at + 2 * width + MARGIN, first))
        gain = np.linalg.solve(total, gained.T).T
        unknowns = unknowns + gain @ ahead
        covariance = covariance - gain @ gained.T
        history.append((at, unknowns, covariance))
    return None


def left_at_start(values: _Array, rate: float, fit: DecayFit, first: int, head: int) -> float:
    """Mean square of what the fit leaves of the `head` samples from `first` on, over that of the rest."""
    model = _Model(values, rate, fit, first)
    left = model.left[first:]
    rest = np.mean(left[head:] ** 2, axis=0) + np.finfo(float).tiny
    return float(np.max(np.mean(left[:head] ** 2, axis=0) / rest))


def _ordinary(left: _Array) -> dict[int, float]:
    """Standard deviation of means over each width, in the free part, times the width's root: 1 for white noise."""
    sums = np.concatenate([np.zeros((1, left.shape[1])), np.cumsum(left, axis=0)])
    spread = {}
    for width in WIDTHS:
        moving = (sums[width:] - sums[:-width]) / np.sqrt(width) if left.shape[0] > 4 * width else np.zeros((1, 1))
        spread[width] = max(1.0, float(np.sqrt(np.mean(moving**2, axis=0)).max()))
    return spread


def _disagrees(seen: _Array, ordinary: dict[int, float]) -> int:
    """The number of last samples that cannot be free vibration, 0 when all can."""
    for width in WIDTHS:
        if width > seen.shape[0]:
            break
        last = seen[-width:]
        if np.abs(last.sum(axis=0)).max() > UNLIKELY * ordinary[width] * np.sqrt(width):
            return width
        if np.sum(last**2) - last.size > UNLIKELY * ordinary[width] ** 2 * np.sqrt(2.0 * last.size) + UNLIKELY**2:
            return width
    return 0


def _break(model: _Model, history: list[tuple[int, _Array, _Array]], at: int, later: int) -> Break:
    _, unknowns, covariance = history[min(history[0][0] - later, len(history) - 1)]
    first = max(at - MARGIN // 3, 0)
    rows = model.jacobian[first:later]
    off = (model.left[first:later] - rows @ unknowns).T
    variance = np.einsum("sci,ij,scj->cs", rows, covariance, rows, optimize=True) + model.variance[:, None]
    return Break(first, off, np.sqrt(variance))
