"""Modal reduction: what a structure's mass and strain say of its modes, rigid ones apart and exactly at zero.

The stiffness matrix is never formed. It is S' S, S the strain of unit coordinates times the root of the stiffness that
resists it, and the natural frequencies are the singular values of S M^(-1/2). A slow mode of a fine mesh keeps then
twice the digits that the eigenvalues of the stiffness matrix leave it: rounding is a part of the fastest frequency,
not of its square.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["StructureModes", "reduced"]


@dataclass(frozen=True, eq=False)
class StructureModes:
    """The modes of an undamped structure, with unit modal masses: shapes' M shapes = 1.

    Parameters
    ----------
    frequencies : ndarray, shape (mode,)
        Of the flexible modes, increasing [Hz].
    shapes : ndarray, shape (coordinate, mode)
        Displacements [1/sqrt(kg)] and angles [rad/(m sqrt(kg))] of each flexible mode at unit modal coordinate.
    rigid_shapes : ndarray, shape (coordinate, rigid mode)
        The same of the motions that bend nothing; none for a structure that is held.
    """

    frequencies: NDArray[np.float64]
    shapes: NDArray[np.float64]
    rigid_shapes: NDArray[np.float64]


def reduced(mass: NDArray[np.float64], strain: NDArray[np.float64], rigid: NDArray[np.float64]) -> StructureModes:
    """All modes of M x'' + S' S x = 0.

    Parameters
    ----------
    mass : ndarray, shape (coordinate, coordinate)
        M, symmetric and positive definite.
    strain : ndarray, shape (strain, coordinate)
        S.
    rigid : ndarray, shape (coordinate, rigid mode)
        What S maps to 0, all of it, independent: the flexible modes are sought across it.

    Examples
    --------
    Two masses and a spring:

    >>> found = reduced(np.diag([1.0, 1.0]), np.array([[-1.0, 1.0]]), np.ones((2, 1)))
    >>> bool(abs(2 * np.pi * found.frequencies[0] - 2**0.5) < 1e-15), found.rigid_shapes.round(6).ravel().tolist()
    (True, [0.707107, 0.707107])
    """
    from scipy.linalg import cholesky, qr, solve_triangular, svd

    root = cholesky(mass, lower=True)
    scaled = solve_triangular(root, strain.T, lower=True).T
    count = rigid.shape[1]
    basis: NDArray[np.float64] = np.eye(mass.shape[0])
    if count:
        orthogonal, triangle = qr(root.T @ rigid)
        basis = np.asarray(orthogonal, dtype=float)
        basis[:, :count] *= np.where(np.diagonal(triangle) < 0.0, -1.0, 1.0)
    _, frequencies, turned = svd(scaled @ basis[:, count:], full_matrices=True)
    orthonormal = basis[:, count:] @ turned.T[:, ::-1]
    shapes = solve_triangular(root, orthonormal, lower=True, trans="T")
    # A shape is known up to its sign: here its first coordinate is positive.
    shapes = shapes * np.where(shapes[0] < 0.0, -1.0, 1.0)
    return StructureModes(
        frequencies=frequencies[::-1] / (2.0 * np.pi),
        shapes=shapes,
        rigid_shapes=solve_triangular(root, basis[:, :count], lower=True, trans="T"),
    )
