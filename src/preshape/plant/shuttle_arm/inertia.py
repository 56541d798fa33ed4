"""What six links do to motion in a pose: mass matrix, centripetal torques, end point. Any number of poses at once.

All vectors are in the base's frame. Masses and principal moments enter as weighted rows A of the links' Jacobians, so
that the mass matrix, A' A, is symmetric and positive definite by construction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.plant.shuttle_arm.geometry import Links

__all__ = ["Pose", "end_points", "pose_of"]

Matrix = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pose:
    """Where the links are. Shapes begin with (run, ...).

    Attributes
    ----------
    links : Links
    turns : ndarray, shape (run, link, 3, 3)
        The links' frames.
    axes : ndarray, shape (run, joint, 3)
    joints : ndarray, shape (run, joint, 3)
        [m]
    rows : ndarray, shape (run, 36, joint)
        For each link the weighted Jacobian of its centre [m sqrt(kg)], then of its turn [sqrt(kg m^2)].
    """

    links: Links
    turns: Matrix
    axes: Matrix
    joints: Matrix
    rows: Matrix

    def mass_matrix(self) -> Matrix:
        """Shape (run, joint, joint) [kg m^2]."""
        return np.swapaxes(self.rows, 1, 2) @ self.rows

    def end_jacobian(self) -> Matrix:
        """Of the end point, shape (run, 3, joint) [m]."""
        end = self.joints[:, 5] + self.turns[:, 5] @ self.links.end
        return np.swapaxes(_cross(self.axes, end[:, np.newaxis] - self.joints), 1, 2)

    def centripetal(self, rates: Matrix) -> Matrix:
        """The torques that keep the joints' rates [rad/s] as they are, shape (run, joint) [N m]; no gravity."""
        own = self.axes * rates[:, :, np.newaxis]
        spin = np.cumsum(own, axis=1)
        # A joint's axis turns with the link before it.
        turning = np.cumsum(_cross(spin - own, own), axis=1)
        arms = np.diff(self.joints, axis=1)
        of_joints = _cross(turning[:, :-1], arms) + _cross(spin[:, :-1], _cross(spin[:, :-1], arms))
        accelerations = np.concatenate([np.zeros_like(arms[:, :1]), np.cumsum(of_joints, axis=1)], axis=1)
        out = (self.turns @ self.links.centres[:, :, np.newaxis])[..., 0]
        accelerations = accelerations + _cross(turning, out) + _cross(spin, _cross(spin, out))
        # Euler's equations along the links' own axes.
        moments = self.links.moments
        inside = np.swapaxes(self.turns, 2, 3)
        turning, spin = (inside @ turning[..., np.newaxis])[..., 0], (inside @ spin[..., np.newaxis])[..., 0]
        torques = moments * turning + _cross(spin, moments * spin)
        weighted = np.concatenate(
            [np.sqrt(self.links.masses)[:, np.newaxis] * accelerations, torques / np.sqrt(moments)], axis=2
        )
        return np.asarray((np.swapaxes(self.rows, 1, 2) @ weighted.reshape(len(rates), 36, 1))[..., 0])


def pose_of(links: Links, angles: Matrix) -> Pose:
    """The links at these angles, shape (run, joint) [rad].

    Examples
    --------
    >>> import numpy as np
    >>> from preshape.plant.shuttle_arm.geometry import SHUTTLE_LINKS
    >>> stretched = pose_of(SHUTTLE_LINKS, np.zeros((1, 6)))
    >>> stretched.end_jacobian()[0, 1, 0].round(3)
    np.float64(15.316)
    """
    turns, joints = _frames(links, angles)
    # The axis of a joint stands still in its own frame.
    axes = (turns @ links.axes[:, :, np.newaxis])[..., 0]
    centres = joints + (turns @ links.centres[:, :, np.newaxis])[..., 0]
    runs = len(angles)
    rows = np.empty((runs, 6, 6, 6))
    moved = np.tri(6)[:, np.newaxis, :]
    ways = _cross(axes[:, np.newaxis], centres[:, :, np.newaxis] - joints[:, np.newaxis])
    rows[:, :, :3] = np.swapaxes(ways, 2, 3) * moved * np.sqrt(links.masses)[:, np.newaxis, np.newaxis]
    turned = np.swapaxes(turns, 2, 3) @ np.swapaxes(axes, 1, 2)[:, np.newaxis]
    rows[:, :, 3:] = turned * moved * np.sqrt(links.moments)[:, :, np.newaxis]
    return Pose(links, turns, axes, joints, rows.reshape(runs, 36, 6))


def end_points(links: Links, angles: Matrix) -> Matrix:
    """Of the arm, shape (run, 3) [m], for angles of shape (run, joint) [rad].

    Examples
    --------
    >>> import numpy as np
    >>> from preshape.plant.shuttle_arm.geometry import SHUTTLE_LINKS
    >>> end_points(SHUTTLE_LINKS, np.zeros((1, 6))).round(3).tolist()
    [[15.316, 0.0, 0.305]]
    """
    turns, joints = _frames(links, angles)
    return np.asarray(joints[:, 5] + turns[:, 5] @ links.end)


def _frames(links: Links, angles: Matrix) -> tuple[Matrix, Matrix]:
    """Turns and joints of the links, as :class:`Pose` has them."""
    own = _turns(links.axes, angles)
    turns = np.empty_like(own)
    joints = np.empty((len(angles), 6, 3))
    turns[:, 0], joints[:, 0] = own[:, 0], links.offsets[0]
    for i in range(1, 6):
        joints[:, i] = joints[:, i - 1] + turns[:, i - 1] @ links.offsets[i]
        turns[:, i] = turns[:, i - 1] @ own[:, i]
    return turns, joints


def _turns(axes: Matrix, angles: Matrix) -> Matrix:
    """Rotation matrices about unit axes (Rodrigues), shape (run, joint, 3, 3)."""
    x, y, z = axes.T
    zero = np.zeros(6)
    cross = np.stack([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    sine, cosine = np.sin(angles)[..., np.newaxis, np.newaxis], np.cos(angles)[..., np.newaxis, np.newaxis]
    return np.asarray(np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross))


def _cross(a: Matrix, b: Matrix) -> Matrix:
    """a x b over the last axis; what numpy.cross does, in a third of its time."""
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        product[..., i] = a[..., j] * b[..., k] - a[..., k] * b[..., j]
    return product
