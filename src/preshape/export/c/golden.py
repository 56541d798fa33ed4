"""Golden samples: a command that C and Python make alike out of whole numbers, and what comes out of the shaper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.export.target import Placed

__all__ = ["MULTIPLIER", "OFFSET", "START", "UNIT", "Golden"]

START = -1.5
"""Where the machine stands before the command begins."""

MULTIPLIER = 2654435761
"""Scatters the squares of the samples' numbers over 32 bits."""

OFFSET, UNIT = 2048, 1.0 / 1024.0
"""The noise has 12 bits and is centred; a command is a multiple of UNIT, exact in single precision up to 2**24 UNIT."""

SETTLED = 8
"""Samples beyond the shaper's duration in each part of the command."""

MOST = 256
"""Most golden samples, about; a longer command is compared at every few samples only."""


@dataclass(frozen=True)
class Golden:
    """Lengths of the command's parts, and the samples that are compared.

    Parameters
    ----------
    placed : Placed
        The shaper.
    """

    placed: Placed

    @property
    def ramp(self) -> int:
        """First sample of the ramp: a step with noise has gone through the whole ring before it."""
        return self.placed.latency_samples + SETTLED

    @property
    def hold(self) -> int:
        """Last sample that moves."""
        return 2 * self.ramp

    @property
    def total(self) -> int:
        """Samples in all."""
        return 3 * self.ramp

    @property
    def every(self) -> int:
        """Samples from one golden sample to the next."""
        return -(-self.total // MOST)

    def command(self) -> NDArray[np.float64]:
        """The command, shape (time,)."""
        n = np.minimum(np.arange(self.total, dtype=np.uint32), np.uint32(self.hold))
        noise = (n * n * np.uint32(MULTIPLIER)) >> np.uint32(20)
        ramp = np.maximum(n.astype(np.int64) - self.ramp, 0)
        return np.asarray((noise + ramp - OFFSET) * UNIT, dtype=float)

    def shaped(self) -> list[float]:
        """What comes out at samples 0, every, 2 every ..., to the last bit, in the controller's precision."""
        command = self.command()
        if self.placed.precision == "single":
            whole = _in_single(command.astype(np.float32), self.placed).astype(float)
        else:
            whole = self.placed.shaper.shape(command, self.placed.dt, initial=START)
        return [float(value) for value in whole[: self.total : self.every]]


def _in_single(command: NDArray[np.float32], placed: Placed) -> NDArray[np.float32]:
    """The kernel's operations in its order: y = r + sum of w (u - r), r the sample of the last tap."""
    last = placed.latency_samples
    padded = np.concatenate([np.full(last, START, dtype=np.float32), command])
    reference = padded[: command.size]
    total = np.zeros(command.size, dtype=np.float32)
    for delay, weight in zip(placed.delays.tolist(), placed.weights.astype(np.float32), strict=True):
        if delay < last:
            total += weight * (padded[last - delay : last - delay + command.size] - reference)
    return reference + total
