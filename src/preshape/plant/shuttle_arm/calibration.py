"""The gears' stiffnesses, from the four frequencies that Hyde gives for the arm with a 7,000 lb satellite.

Hyde names neither pose nor satellite ("depending on orientation, can be estimated at about"). Stated here: the wrist
points down into the payload bay, and the satellite is a cylinder 3 m across and 2 m long. Four numbers, four unknowns:
both shoulder joints are alike, and so are the wrist's pitch and yaw. What the booms give is in the joints' stiffnesses.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.plant.shuttle_arm.geometry import SHUTTLE_LINKS, Links, Payload
from preshape.plant.shuttle_arm.joints import JointHardware, Servo
from preshape.plant.shuttle_arm.linear import oscillations, state_matrix

__all__ = [
    "CALIBRATED_JOINTS",
    "CALIBRATION_POSE",
    "HYDE_FREQUENCIES",
    "STIFFNESSES",
    "FitRow",
    "calibrate",
    "calibration_table",
]

Matrix = NDArray[np.float64]

HYDE_FREQUENCIES = (0.20, 0.26, 0.45, 0.59)
"""Hyde, section 3.2.3 [Hz]."""

CALIBRATION_POSE = tuple(np.radians([0.0, 60.0, -90.0, -40.0, 0.0, 0.0]).tolist())
"""The stated pose [rad]: 60 deg up, folded back by 90 deg, the wrist 40 deg further down."""

STIFFNESSES = (2163829.0, 1944287.0, 321229.0, 54269.0)
"""Of shoulder, elbow, wrist pitch and yaw, wrist roll [N m/rad]: what :func:`calibrate` finds."""

STARTS = tuple((2e6, 2e6, wrist, roll) for roll in (5e4, 1e5, 2.5e4) for wrist in (3e5, 1.5e5, 6e5))
"""Where the fit starts [N m/rad], one after the other: modes in and across the arm's plane may pass each other on the
way, and the fit stays where they meet."""

FITTED = 1e-6
"""Relative: a frequency that is reached."""


@dataclass(frozen=True)
class FitRow:
    """One frequency of the fit.

    Attributes
    ----------
    printed, fitted : float
        [Hz]
    damping : float
        Of the fitted model [-].
    """

    printed: float
    fitted: float
    damping: float

    @property
    def residual(self) -> float:
        """Relative difference [-]."""
        return self.fitted / self.printed - 1.0


def calibrate(
    frequencies: tuple[float, ...] = HYDE_FREQUENCIES,
    *,
    pose: tuple[float, ...] = CALIBRATION_POSE,
    payload: Payload | None = None,
    servo: Servo | None = None,
    links: Links = SHUTTLE_LINKS,
) -> tuple[float, ...]:
    """The stiffnesses with which the arm has these first four frequencies.

    Parameters
    ----------
    frequencies : tuple of float
        [Hz], rising.
    pose : tuple of float
        [rad]
    payload : Payload, optional
        7,000 lb unless given.
    servo : Servo, optional
        What holds the motors; the usual one unless given.
    links : Links
        Geometry and masses, without the payload.

    Returns
    -------
    tuple of float
        Of shoulder, elbow, wrist pitch and yaw, wrist roll [N m/rad].

    Raises
    ------
    InputError
        If no stiffnesses give them.

    Examples
    --------
    >>> bool(np.allclose(calibrate(), STIFFNESSES, rtol=1e-4))
    True
    """
    from scipy.optimize import least_squares

    heavy = links.carrying(Payload() if payload is None else payload)
    held = Servo() if servo is None else servo
    wanted = np.array(frequencies, dtype=float)
    if wanted.shape != (4,) or not (np.isfinite(wanted).all() and (wanted > 0.0).all()):
        raise InputError(f"the frequencies are {frequencies!r}: give four above 0 Hz, rising.")

    def off(logarithms: Matrix) -> Matrix:
        joints = JointHardware(_six(tuple(np.exp(logarithms).tolist())))
        found, _ = oscillations(state_matrix(heavy, joints, held, np.array(pose)))
        return np.asarray(np.log(found[:4] / wanted))

    best = None
    for start in STARTS:
        fit = least_squares(off, np.log(start), xtol=1e-12, ftol=1e-14, gtol=1e-14)
        best = fit if best is None or fit.cost < best.cost else best
        if np.abs(best.fun).max() < FITTED:
            break
    assert best is not None
    if np.abs(best.fun).max() > FITTED:
        missed = ", ".join(f"{100.0 * one:+.1f} %" for one in best.fun)
        raise InputError(
            f"no joint stiffnesses give {wanted.tolist()} Hz in this pose (nearest: {missed}): "
            "give another pose or payload."
        )
    return tuple(np.exp(best.x).tolist())


def calibration_table() -> list[FitRow]:
    """Every frequency of the fit with the constants of this file, and its residual.

    Examples
    --------
    >>> max(abs(row.residual) for row in calibration_table()) < 1e-4
    True
    """
    heavy = SHUTTLE_LINKS.carrying(Payload())
    found, dampings = oscillations(state_matrix(heavy, CALIBRATED_JOINTS, Servo(), np.array(CALIBRATION_POSE)))
    return [
        FitRow(printed, float(fitted), float(damping))
        for printed, fitted, damping in zip(HYDE_FREQUENCIES, found, dampings, strict=False)
    ]


def _six(four: tuple[float, ...]) -> Matrix:
    """For the six joints, of the four that differ."""
    shoulder, elbow, wrist, roll = four
    return np.array([shoulder, shoulder, elbow, wrist, wrist, roll])


CALIBRATED_JOINTS = JointHardware(_six(STIFFNESSES))
"""With all imperfections on."""
