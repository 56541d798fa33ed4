"""Modes of a python-control system: of its matrices, or of the denominators of its transfer functions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant.oscillation import check_stable, distinct_modes, mode_of, upper_poles
from preshape.plant.state_space import LinearPlant

__all__ = ["modes_of"]

AT_REST = 1e-7
"""A pole nearer to 0 than this part of the largest is a rigid body's: a double root is found to half the digits."""

FORGOTTEN, INTEGRATOR = 1e-3, 1e-5
"""A sampled pole this near to 0 is a delay, this near to 1 an integrator: the rounding of a polynomial's
coefficients scatters double roots that far. Matrices are more accurate."""

ALTERNATING = 1e-6
"""A sampled pole on the negative axis, within this part of it, alternates from sample to sample: no motion has it."""


def modes_of(system: Any) -> Modes:
    """What vibrates in a python-control system, to design shapers for.

    Parameters
    ----------
    system : control.StateSpace, control.TransferFunction
        Or anything with A, B, C, D and dt, or with poles() and dt; ``dt`` is 0 or None for a continuous system, the
        step [s] of a sampled one, whose poles z stand for log(z)/dt.

    Returns
    -------
    Modes
        Undamped natural frequencies [Hz] and damping ratios of the oscillating pairs, the slowest first; equal ones
        are one. Rigid bodies and poles on the real axis do not oscillate and are left out. What `control.damp` gives
        in rad/s for the same poles. Of a sampled transfer function with integrators those slower than 1e-5 rad a sample
        are taken for the integrators' rounding; matrices are more accurate.

    Raises
    ------
    InputError
        If the system is unstable, nothing vibrates in it, it is sampled and does not say how fast, or is no system.

    Examples
    --------
    >>> class Likewise:
    ...     A, B, C, D, dt = [[0.0, 1.0], [-400.0, -2.0]], [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]], 0
    >>> round(modes_of(Likewise())[0].omega, 9), round(modes_of(Likewise())[0].damping, 9)
    (20.0, 0.05)
    """
    if all(hasattr(system, name) for name in "ABCD"):
        return LinearPlant.from_control(system).modes()
    if not callable(getattr(system, "poles", None)):
        raise InputError(
            f"{type(system).__name__} has neither matrices A, B, C, D nor poles(): give a StateSpace or a "
            "TransferFunction of python-control."
        )
    step = getattr(system, "dt", None)
    if step is True:
        raise InputError("the system is sampled with an unspecified step (dt is True): give it its dt [s] first.")
    found = np.asarray(system.poles(), dtype=complex)
    if step:
        moving = _continuous(found, float(step))
    else:
        moving = found[np.abs(found) > AT_REST * np.abs(found).max(initial=0.0)]
    check_stable(moving, AT_REST * float(np.abs(moving).max(initial=0.0)))
    if step:
        moving = moving[np.abs(moving.imag) * float(step) < np.pi * (1.0 - ALTERNATING)]
    return distinct_modes(mode_of(complex(pole)) for pole in moving[upper_poles(moving)])


def _continuous(poles: NDArray[np.complex128], step: float) -> NDArray[np.complex128]:
    """log(z)/dt, without delays, at 0, and integrators, at 1."""
    kept = poles[(np.abs(poles) > FORGOTTEN) & (np.abs(poles - 1.0) > INTEGRATOR)]
    return np.asarray(np.log(kept) / step, dtype=complex)
