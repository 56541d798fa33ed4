"""The arm linearised in a pose: links on gears, motors held by their servos; poles, and what vibrates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.plant.shuttle_arm.geometry import Links
from preshape.plant.shuttle_arm.inertia import pose_of
from preshape.plant.shuttle_arm.joints import JointHardware, Servo

__all__ = ["end_point_steps", "oscillations", "state_matrix"]

Matrix = NDArray[np.float64]

LIGHT = 0.2
"""What is damped more than this does not vibrate: the servos' own motions."""

RIGID = 1e-3
"""Poles slower than this [rad/s] are the rigid motions of free motors, and rounding."""


def state_matrix(links: Links, joints: JointHardware, servo: Servo | None, angles: Matrix) -> Matrix:
    """Of small motion about angles [rad] of shape (joint,): links, motors, and their rates, shape (24, 24).

    Gears are in touch, twists small, nothing sticks or saturates. Without a servo the motors turn freely.
    """
    mass = pose_of(links, angles[np.newaxis]).mass_matrix()[0]
    spring, damper = np.diag(joints.stiffness), np.diag(joints.relaxation * joints.stiffness)
    angle, rate = (np.zeros(6), np.zeros(6)) if servo is None else servo.gains(joints.inertia)
    motors = np.diag(1.0 / joints.inertia)
    matrix = np.zeros((24, 24))
    matrix[:12, 12:] = np.eye(12)
    matrix[12:18, :12] = np.linalg.solve(mass, np.hstack([-spring, spring]))
    matrix[12:18, 12:] = np.linalg.solve(mass, np.hstack([-damper, damper]))
    matrix[18:, :12] = motors @ np.hstack([spring, -spring - np.diag(angle)])
    matrix[18:, 12:] = motors @ np.hstack([damper, -damper - np.diag(rate + joints.viscous)])
    return matrix


def oscillations(matrix: Matrix) -> tuple[Matrix, Matrix]:
    """Natural frequencies [Hz], rising, and damping ratios [-] of what vibrates, each of shape (mode,)."""
    poles = np.linalg.eigvals(matrix).astype(complex)
    poles = poles[_light(poles)]
    return np.abs(poles) / (2.0 * np.pi), np.maximum(-poles.real / np.abs(poles), 0.0)


def end_point_steps(links: Links, joints: JointHardware, servo: Servo, angles: Matrix, rates: Matrix) -> Matrix:
    """How far the end point swings in each mode [m] right after the joints' commanded rates step by `rates` [rad/s].

    Amplitudes in the order of :func:`oscillations`, shape (mode,); shapes as of :func:`state_matrix`.
    """
    matrix = state_matrix(links, joints, servo, angles)
    values, vectors = np.linalg.eig(matrix)
    poles, shapes = values.astype(complex), vectors.astype(complex)
    kept = _light(poles)
    s = poles[kept]
    angle_gain, rate_gain = servo.gains(joints.inertia)
    # A step of rate is a ramp of the angle that the servo holds: both act on the motors, and both are integrals.
    pushed = np.zeros((24, len(s)), dtype=complex)
    pushed[18:] = (rates * rate_gain / joints.inertia)[:, np.newaxis] / s + np.outer(
        rates * angle_gain / joints.inertia, 1.0 / s**2
    )
    weights = np.sum(np.linalg.inv(shapes)[kept] * pushed.T, axis=1)
    jacobian = pose_of(links, angles[np.newaxis]).end_jacobian()[0]
    swings = 2.0 * jacobian @ shapes[:6, kept] * weights
    # The largest distance on the ellipse that Re(swing e^(i phase)) runs through.
    squared, turned = np.sum(np.abs(swings) ** 2, axis=0), np.abs(np.sum(swings**2, axis=0))
    return np.asarray(np.sqrt(0.5 * (squared + turned)))


def _light(poles: NDArray[np.complex128]) -> NDArray[np.intp]:
    """Which poles vibrate, the slowest first."""
    omegas = np.abs(poles)
    order = np.argsort(omegas)
    return order[(poles.imag[order] > RIGID) & (-poles.real[order] < LIGHT * omegas[order])]
