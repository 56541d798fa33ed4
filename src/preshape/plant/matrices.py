"""A plant from mass, damping and stiffness matrices: M x'' + C x' + K x = b u."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import whole_number
from preshape.errors import InputError
from preshape.mode import EQUAL_MODES, Mode
from preshape.plant.checks import finite_row
from preshape.plant.exact import Output
from preshape.plant.flexible_structure import FlexibleStructure
from preshape.plant.matrix_checks import symmetric_matrix
from preshape.plant.state_space import LinearPlant

__all__ = ["Place", "from_matrices"]

Place: TypeAlias = int | Sequence[float] | NDArray[np.float64]
"""A coordinate by its number, from 0, or the weights of all coordinates."""

MOST_COORDINATES = 1000
"""Eigenvalues take time as the cube."""

RIGID = 1e-14
"""Of the largest squared frequency, for each coordinate: a smaller one is rounding of a rigid body's 0."""

INDEFINITE = 1e-7
"""Of the largest squared frequency or damping: one below zero by less is rounding of matrices with seven digits."""

COUPLING = 1e-10
"""Damping between two modes, relative to the damping of both, below which there is none."""


def from_matrices(
    mass: ArrayLike,
    damping: ArrayLike | float,
    stiffness: ArrayLike,
    *,
    input: Place,
    outputs: Mapping[str, Place],
    input_name: str = "force",
    input_unit: str = "N",
    output_units: Mapping[str, str] | str = "m",
) -> FlexibleStructure | LinearPlant:
    """The plant of a structure's matrices, exact whatever its damping.

    Parameters
    ----------
    mass : array_like, shape (coordinate, coordinate)
        M, symmetric and positive definite.
    damping : array_like, shape (coordinate, coordinate), or float
        C, symmetric and positive semidefinite; or one damping ratio [-] for every mode that is not rigid.
    stiffness : array_like, shape (coordinate, coordinate)
        K, symmetric and positive semidefinite: what it does not resist is a rigid body.
    input : int or array_like, shape (coordinate,)
        Where the input acts: the number of a coordinate, from 0, or b, the force on each for a unit input. A commanded
        position behind a stiffness k acts as a force k on what that stiffness holds.
    outputs : mapping of str to int or array_like, shape (coordinate,)
        What is looked at, by name: a coordinate's number, or weights of all.
    input_name, input_unit : str
        Of the input.
    output_units : str or mapping of str to str
        One unit for all outputs, or one each by name.

    Returns
    -------
    FlexibleStructure or LinearPlant
        Modes side by side, with exact motion under a Profile, when the damping keeps them apart and lets all vibrate;
        otherwise (a damper in one place, a rigid body braked by the air) the full state-space form.

    Raises
    ------
    InputError
        If a matrix is not symmetric, does not fit the others, is indefinite, or holds NaN; or a place is not there.

    Examples
    --------
    A cart of 2 kg that floats, and 1 kg on a spring:

    >>> mass, stiffness = [[2.0, 0.0], [0.0, 1.0]], [[6.0, -6.0], [-6.0, 6.0]]
    >>> plant = from_matrices(mass, 0.01, stiffness, input=0, outputs={"cart": 0, "bend": [-1.0, 1.0]})
    >>> print(plant.modes()[0])
    0.4775 Hz, damping 0.01
    """
    m, k = symmetric_matrix("mass", mass), symmetric_matrix("stiffness", stiffness)
    count = m.shape[0]
    # As a mode's damping, a number is refused with what is wrong with it.
    ratio = Mode(1.0, damping).damping if isinstance(damping, int | float) else None
    c = np.zeros_like(m) if isinstance(damping, int | float) else symmetric_matrix("damping", damping)
    if count > MOST_COORDINATES:
        raise InputError(f"mass has {count} coordinates: give at most {MOST_COORDINATES}, reduce the model first.")
    if k.shape != m.shape or c.shape != m.shape:
        raise InputError(
            f"the matrices do not fit: mass is {m.shape}, damping {c.shape}, stiffness {k.shape}; give a row and a "
            "column of each for every coordinate."
        )
    if not outputs:
        raise InputError("the plant has no outputs: name at least one.")
    push = _row("input", input, count)
    looks = {name: _row(f"output {name!r}", at, count) for name, at in outputs.items()}
    units = {name: output_units if isinstance(output_units, str) else output_units.get(name, "") for name in outputs}
    omega, shapes = _modes(m, k)
    damped = shapes.T @ c @ shapes
    if ratio is not None:
        damped = np.diag(2.0 * ratio * omega)
    _check_damping(damped)
    modal, places = _Modal(omega, shapes, damped), _Places(push, looks, {input_name: input_unit}, units)
    return _structure(modal, places) if _apart(modal) else _state_space(modal, places)


Matrix: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Modal:
    """Undamped modes: frequencies [rad/s], 0 for rigid bodies, shapes of unit mass as columns, and their damping."""

    omega: Matrix
    shapes: Matrix
    damped: Matrix


@dataclass(frozen=True, eq=False)
class _Places:
    """What the input pushes and what each output looks at, in coordinates; their units by name."""

    push: Matrix
    looks: Mapping[str, Matrix]
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]


def _row(name: str, place: Place, count: int) -> Matrix:
    """The weights of the coordinates at a place."""
    row = np.zeros(count)
    if isinstance(place, int | np.integer):
        row[whole_number(f"the coordinate of {name}", place, 0, count - 1)] = 1.0
        return row
    weights = finite_row(name, place)
    if weights.size != count:
        raise InputError(f"{name} has {weights.size} weight(s) for {count} coordinate(s): give one for each.")
    return weights


def _modes(m: Matrix, k: Matrix) -> tuple[Matrix, Matrix]:
    """Natural frequencies [rad/s], increasing, those of rigid bodies exactly 0, and shapes with unit modal mass."""
    from scipy.linalg import eigh, solve_triangular

    sizes = np.sqrt(np.abs(np.diagonal(m)))
    if not (np.diagonal(m) > 0.0).all():
        at = int(np.argmin(np.diagonal(m)))
        raise InputError(
            f"mass is not positive definite: coordinate {at} has the mass {m[at, at]:g}; give every coordinate a mass, "
            "or eliminate those without."
        )
    try:
        # Coordinates in their own units of mass: displacements and angles become comparable.
        root = np.linalg.cholesky(m / np.outer(sizes, sizes)) * sizes[:, np.newaxis]
    except np.linalg.LinAlgError:
        raise InputError(
            "mass is not positive definite: some motion has no mass, or a negative one; correct the matrix."
        ) from None
    half = solve_triangular(root, k, lower=True)
    squares, turned = eigh(0.5 * (half := solve_triangular(root, half.T, lower=True)) + 0.5 * half.T)
    largest = float(np.abs(squares).max())
    if squares[0] < -INDEFINITE * largest:
        raise InputError(
            f"stiffness is indefinite: in one direction it pushes away (squared frequency {squares[0]:.3g} where the "
            f"largest is {largest:.3g} rad^2/s^2); correct the matrix, or write it with more digits."
        )
    omega = np.sqrt(np.where(squares <= RIGID * m.shape[0] * largest, 0.0, squares))
    shapes = solve_triangular(root, turned, lower=True, trans="T")
    return omega, shapes * np.where(shapes[0] < 0.0, -1.0, 1.0)


def _check_damping(damped: Matrix) -> None:
    values = np.linalg.eigvalsh(damped)
    if values[0] < -INDEFINITE * max(float(np.abs(values).max()), np.finfo(float).tiny):
        raise InputError(
            f"damping is indefinite: in one direction it drives the motion (rate {values[0]:.3g} 1/s); correct the "
            "matrix, or give A, B, C, D if that is what the machine does."
        )


def _apart(modal: _Modal) -> bool:
    """Whether every mode vibrates by itself, and rigid bodies coast."""
    damped, omega = modal.damped, modal.omega
    own = np.maximum(np.diagonal(damped), 0.0)
    coupled = np.abs(damped - np.diag(np.diagonal(damped)))
    limit = COUPLING * np.sqrt(np.outer(own, own)) + len(omega) * np.finfo(float).eps * own.max(initial=0.0)
    flexible = omega > 0.0
    coasts = (own[~flexible] <= len(omega) * np.finfo(float).eps * own.max(initial=0.0)).all()
    return bool(flexible.any() and coasts and (coupled <= limit).all() and (own < 2.0 * omega)[flexible].all())


def _structure(modal: _Modal, places: _Places) -> FlexibleStructure:
    omega, shapes, push = modal.omega, modal.shapes, places.push
    rigid = shapes[:, omega == 0.0]
    modes: list[Mode] = []
    columns: list[Matrix] = []
    for w, shape, own in zip(omega, shapes.T, np.diagonal(modal.damped), strict=True):
        if w == 0.0:
            continue
        mode = Mode(w / (2.0 * np.pi), max(own, 0.0) / (2.0 * w))
        if modes and _same(modes[-1], mode):
            # Of equal modes one input excites one combination only, and that is a mode as well.
            gains = np.array([columns[-1] @ push, shape @ push])
            if (size := float(np.hypot(*gains))) > 0.0:
                columns[-1] = (gains[0] * columns[-1] + gains[1] * shape) / size
        else:
            modes.append(mode)
            columns.append(shape)
    kept = np.array(columns).T
    pushed = rigid.T @ push
    seen = {
        key: Output(tuple((row @ kept).tolist()), rigid=float((row @ rigid) @ pushed), unit=places.outputs[key])
        for key, row in places.looks.items()
    }
    ((name, unit),) = places.inputs.items()
    return FlexibleStructure(modes, kept.T @ push, seen, input=name, unit=unit)


def _same(first: Mode, second: Mode) -> bool:
    near = second.frequency - first.frequency <= 2.0 * EQUAL_MODES * second.frequency
    return near and abs(second.damping - first.damping) <= 2.0 * EQUAL_MODES


def _state_space(modal: _Modal, places: _Places) -> LinearPlant:
    """States w q and q' of the undamped modes, q and q' of rigid ones: of one size, and 0 where it must be."""
    omega, shapes = modal.omega, modal.shapes
    scale = np.where(omega > 0.0, omega, 1.0)
    zero = np.zeros((omega.size, omega.size))
    a = np.block([[zero, np.diag(scale)], [-np.diag(omega), -modal.damped]])
    b = np.concatenate([np.zeros(omega.size), shapes.T @ places.push])
    c = np.array([np.concatenate([(row @ shapes) / scale, np.zeros(omega.size)]) for row in places.looks.values()])
    return LinearPlant(a, b, c, inputs=places.inputs, outputs=places.outputs)
