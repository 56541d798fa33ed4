"""Filtered commands: what a notch or a low-pass filter makes of a command, the usual remedy that shaping replaces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive, whole_number
from preshape.command.checks import sample_count
from preshape.command.command import Command
from preshape.errors import InputError
from preshape.mode import ModesLike, one_mode

__all__ = ["low_pass_filtered", "notch_filtered"]

LEFT = 1e-4
"""The filter has settled when what it still has to move is below this fraction of the command's largest value."""


def notch_filtered(command: Command, mode: ModesLike, pole_damping: float = 0.7) -> Command:
    """The command through (s^2 + 2 z w s + w^2) / (s^2 + 2 z_p w s + w^2), which replaces the mode's damping by z_p.

    Parameters
    ----------
    command : Command
        Any command; it is followed by its last value.
    mode : Mode or (frequency [Hz], damping)
        What is notched out.
    pole_damping : float
        z_p [-], 0.5 to 1.

    Examples
    --------
    >>> from preshape.command import step
    >>> smooth = notch_filtered(step(1.0, dt=0.01), (1.0, 0.05))
    >>> bool(abs(smooth.values[-1] - 1.0) < 1e-3)
    True
    """
    target = one_mode(mode)
    z = positive("pole_damping", pole_damping, "(a ratio)")
    if not 0.5 <= z <= 1.0:
        raise InputError(f"pole_damping is {z:g}: give 0.5 to 1, or the filter rings itself.")
    w = target.omega
    return _filtered(command, ([1.0, 2.0 * target.damping * w, w**2], [1.0, 2.0 * z * w, w**2]), z * w)


def low_pass_filtered(command: Command, cutoff: float, order: int = 2) -> Command:
    """The command through a Butterworth low-pass filter.

    Parameters
    ----------
    command : Command
        Any command; it is followed by its last value.
    cutoff : float
        -3 dB frequency [Hz].
    order : int
        1 to 8.

    Examples
    --------
    >>> from preshape.command import step
    >>> smooth = low_pass_filtered(step(1.0, dt=0.01), 0.5)
    >>> bool(abs(smooth.values[-1] - 1.0) < 1e-3)
    True
    """
    from scipy.signal import butter

    frequency = 2.0 * math.pi * positive("cutoff", cutoff, "Hz")
    count = whole_number("order", order, 1, 8)
    numerator, denominator = butter(count, frequency, analog=True)
    slowest = float(np.abs(np.roots(denominator).real).min())
    return _filtered(command, (numerator, denominator), slowest)


def _filtered(command: Command, system: Any, slowest: float) -> Command:
    """The response of a filter to the held command, until it has settled; exact for a command held between samples."""
    from scipy.signal import cont2discrete, lfilter

    tail = sample_count(-math.log(LEFT) / slowest + command.dt, command.dt)
    values = np.concatenate([command.values, np.full(tail, command.values[-1])])
    numerator, denominator, *_ = cont2discrete(system, command.dt, method="zoh")
    # cont2discrete delays by nothing: the sample of a step is that of the response right after it
    shaped: NDArray[np.float64] = np.asarray(lfilter(np.ravel(numerator), denominator, values), dtype=float)
    return Command(
        dt=command.dt, values=shaped, quantity=command.quantity, duration=command.duration + tail * command.dt
    )
