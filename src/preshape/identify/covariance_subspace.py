"""Poles of what is shaken by unknown white noise, from the covariances of its outputs (stochastic subspace, SSI-cov).

The covariance of outputs a lag k apart is C A^(k-1) G, as if A rang freely from the states G, so a block Hankel matrix
of covariances has the modes in its column space (H. Akaike 1974; P. Van Overschee & B. De Moor, Subspace Identification
for Linear Systems, 1996, chapter 3; B. Peeters & G. De Roeck, Mech. Syst. Signal Process. 13 (1999) 855-878).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Covariances", "Poles", "Realisation"]

_Array = NDArray[np.float64]
_Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Poles:
    """The oscillating poles of one model order, the slowest first.

    Attributes
    ----------
    natural, damping : ndarray, shape (pole,)
        Undamped natural frequencies [Hz] and damping ratios.
    shapes : ndarray, shape (pole, channel)
        Complex mode shapes, of length 1.
    power : ndarray, shape (pole,)
        Variance of the outputs that is the pole's, summed over the channels.
    """

    natural: _Array
    damping: _Array
    shapes: _Complex
    power: _Array


class Covariances:
    """Covariances of outputs with themselves at lags 0 to 2 `rows`, summed block by block of the record.

    Parameters
    ----------
    values : ndarray, shape (channel, sample)
        Outputs, mean-free.
    rows : int
        Block rows of the Hankel matrix.
    blocks : int
        Parts of the record whose sums are kept apart, so that each can be left out.
    """

    def __init__(self, values: _Array, rows: int, blocks: int) -> None:
        self.rows = rows
        lags = 2 * rows
        channels, samples = values.shape
        starts = np.linspace(0, samples - lags, blocks + 1).astype(int)
        self.sums = np.empty((blocks, lags + 1, channels, channels))
        self.counts = np.diff(starts)
        for block, (begin, end) in enumerate(zip(starts[:-1], starts[1:], strict=True)):
            past = values[:, begin:end].T
            ahead = np.lib.stride_tricks.sliding_window_view(values[:, begin : end + lags], end - begin, axis=-1)
            self.sums[block] = np.matmul(ahead.transpose(1, 0, 2), past)

    def mean(self, left_out: int | None = None) -> _Array:
        """Covariances, shape (lag, channel, channel), without a block if one is named."""
        keep = np.arange(len(self.counts)) != (-1 if left_out is None else left_out)
        return np.asarray(self.sums[keep].sum(axis=0) / self.counts[keep].sum())


class Realisation:
    """State-space models of every order behind covariances.

    Parameters
    ----------
    covariances : ndarray, shape (lag, channel, channel)
        From lag 0 on.
    rows : int
        Block rows of the Hankel matrix.
    rate : float
        Samples per second [Hz].
    highest : int
        Highest order that will be asked for.
    """

    def __init__(self, covariances: _Array, rows: int, rate: float, highest: int) -> None:
        channels = covariances.shape[-1]
        lag = 1 + np.arange(rows)[:, None] + np.arange(rows)
        hankel = covariances[lag].transpose(0, 2, 1, 3).reshape(rows * channels, rows * channels)
        u, s, v = np.linalg.svd(hankel)
        root = np.sqrt(s[:highest])
        self._observe = u[:, :highest] * root
        self._control = root[:, None] * v[:highest]
        self._channels = channels
        self._rate = rate
        # Nested least squares: one factorisation serves every order.
        self._q, self._r = np.linalg.qr(self._observe[:-channels])
        self._shifted = self._q.T @ self._observe[channels:]

    def matrices(self, order: int) -> tuple[_Array, _Array, _Array]:
        """State matrix A, output matrix C and next-state covariance G of an order."""
        a = np.linalg.solve(self._r[:order, :order], self._shifted[:order, :order])
        return a, self._observe[: self._channels, :order], self._control[:order, : self._channels]

    def poles(self, order: int) -> Poles:
        """The oscillating poles of an order, growing ones too."""
        a, c, g = self.matrices(order)
        discrete, vectors = np.linalg.eig(a)
        upper = np.flatnonzero((discrete.imag > 1e-9) & (np.abs(discrete) > 1e-6))
        modal = np.linalg.solve(vectors, g.astype(complex))
        continuous = self._rate * np.log(discrete[upper])
        natural = np.abs(continuous) / (2.0 * np.pi)
        order_of = np.argsort(natural)
        upper, continuous, natural = upper[order_of], continuous[order_of], natural[order_of]
        shapes = (c @ vectors[:, upper]).T
        # Lag 0 of C A^(k-1) G, mode by mode, on the diagonal.
        power = 2.0 * np.real(np.einsum("pc,pc->p", shapes, modal[upper]) / discrete[upper])
        shapes = shapes / np.linalg.norm(shapes, axis=-1, keepdims=True)
        return Poles(natural, -continuous.real / np.abs(continuous), shapes, power)

    def density(self, order: int, zero: _Array, weights: _Array, frequencies: _Array) -> _Array:
        """One-sided power spectral density of the model, summed over the channels, shape (frequency,).

        Parameters
        ----------
        order : int
        zero : ndarray, shape (channel, channel)
            Covariance at lag 0.
        weights : ndarray, shape (channel,)
            With which the channels are summed.
        frequencies : ndarray, shape (frequency,)
            [Hz], below half the sample rate.
        """
        a, c, g = self.matrices(order)
        discrete, vectors = np.linalg.eig(a)
        parts = np.einsum("c,cp,pc->p", weights, c @ vectors, np.linalg.solve(vectors, g.astype(complex)))
        z = np.exp(2j * np.pi * frequencies / self._rate)
        half = np.sum(parts[:, None] / (z - discrete[:, None]), axis=0)
        return np.asarray(np.maximum((float(weights @ np.diag(zero)) + 2.0 * half.real) * 2.0 / self._rate, 0.0))
