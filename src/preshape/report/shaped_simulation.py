"""What a plant does under a command, unshaped beside shaped, in numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes
from preshape.plant import Simulation
from preshape.shaper import Shaper

__all__ = ["ROUNDING", "OutputMotion", "ShapedSimulation"]

ROUNDING = 1e-12
"""A vibration below this part of the largest value of an output is rounding: a ratio of two such says nothing."""


@dataclass(frozen=True, eq=False)
class OutputMotion:
    """One output under one command.

    Attributes
    ----------
    amplitudes : ndarray, shape (mode,)
        Of the free vibration of each mode when the command ends [unit of the output], by a fit of the modes to what
        follows; NaN for a mode too fast for the samples.
    unexplained : float
        Root mean square of what the modes, and a body that coasts, do not explain of it [unit of the output].
    residual : float
        Sum of the amplitudes: what the vibration after the command cannot exceed [unit of the output].
    peak : float
        Largest \\|output\\| over the whole simulation [unit of the output].
    settling_time : float
        When the output has come within `within` of where it ends, for good [s]; infinite if it has not, within the
        time simulated.
    within : float
        The window [unit of the output], the same for both commands.
    trend : ndarray, shape (power,)
        What does not vibrate of the output after the command: factors of the powers of the time since its end
        [unit of the output / s^power].
    """

    amplitudes: NDArray[np.float64]
    unexplained: float
    residual: float
    peak: float
    settling_time: float
    within: float
    trend: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ShapedSimulation:
    """A plant under a command and the same command shaped, over the same time.

    Attributes
    ----------
    unshaped, shaped : Simulation
        Of equal length.
    command_end, shaped_end : float
        When the commands last change [s].
    shaper : Shaper
        Between the two.
    modes : Modes
        What was looked for in the vibration after the commands.
    inputs : mapping of str to str
        Units of the commands, by name.
    motions : mapping of str to (OutputMotion, OutputMotion)
        By output: unshaped, shaped.
    notes : tuple of str
        What must be known to read the numbers.
    """

    unshaped: Simulation
    shaped: Simulation
    command_end: float
    shaped_end: float
    shaper: Shaper
    modes: Modes
    inputs: Mapping[str, str]
    motions: Mapping[str, tuple[OutputMotion, OutputMotion]]
    notes: tuple[str, ...]

    @property
    def dt(self) -> float:
        """From sample to sample [s]."""
        return float(self.unshaped.times[1] - self.unshaped.times[0])

    def remaining(self, output: str) -> float:
        """The shaped residual as a part of the unshaped one [-]; NaN where that one leaves none but rounding."""
        before, after = self.motions[output]
        return after.residual / before.residual if before.residual > ROUNDING * before.peak else float("nan")
