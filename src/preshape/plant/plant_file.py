"""The plant file ``preshape/plant/1``: a linear machine as JSON or TOML, read with limits, never evaluated.

The fields are documented in docs/reference/plant-file.md and stable.
"""

from __future__ import annotations

import os
import stat
import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import msgspec

from preshape.checks import not_negative, whole_number
from preshape.errors import InputError
from preshape.plant.exact import Output
from preshape.plant.flexible_structure import FlexibleStructure
from preshape.plant.mace import CALIBRATED_GAINS, Mace
from preshape.plant.mace_linear import linear_mace
from preshape.plant.matrices import Place, from_matrices
from preshape.plant.protocol import SimulatedPlant
from preshape.plant.shuttle_arm import ShuttleArm
from preshape.plant.state_space import LinearPlant

__all__ = ["BUILT_IN", "PLANT_SCHEMA", "load_plant", "plant_of", "read_plant_data"]

PLANT_SCHEMA = "preshape/plant/1"

LARGEST_FILE = 100_000_000
"""Bytes; three full matrices of a thousand coordinates, as many as are allowed, take 60 MB with all digits."""

BUILT_IN: dict[str, Callable[[], SimulatedPlant]] = {
    "mace-linear": linear_mace,
    "mace": lambda: Mace(CALIBRATED_GAINS),
    "shuttle-arm": ShuttleArm,
}
"""Plants that come along, by the name that stands in for a file."""

Matrix = list[list[float]]


class _Strict(msgspec.Struct, forbid_unknown_fields=True):
    """Fields that are not known are refused: a misspelt one would be a silent 0."""


class _Channel(_Strict):
    name: str
    unit: str = ""


class _Spot(_Strict):
    """Of a coordinate, or of several with weights."""

    name: str
    unit: str = ""
    coordinate: int | None = None
    weights: list[float] | None = None


class _Seen(_Strict):
    name: str
    weights: list[float]
    unit: str = ""
    rigid: float = 0.0


class _Shaken(_Strict):
    frequency: float
    damping: float = 0.0
    gain: float = 1.0


class _Matrices(_Strict):
    mass: Matrix
    stiffness: Matrix
    input: _Spot
    outputs: list[_Spot]
    damping: Matrix | float = 0.0


class _StateSpace(_Strict):
    A: Matrix
    B: Matrix
    C: Matrix
    inputs: list[_Channel]
    outputs: list[_Channel]
    D: Matrix | None = None
    sample_time: float | None = None


class _Modal(_Strict):
    modes: list[_Shaken]
    outputs: list[_Seen]
    input: _Channel


class _File(_Strict):
    schema: str
    matrices: _Matrices | None = None
    state_space: _StateSpace | None = None
    modal: _Modal | None = None


def load_plant(plant: str | os.PathLike[str]) -> SimulatedPlant:
    """The plant in a file, or one of those that come along.

    Parameters
    ----------
    plant : str or path
        A file that ends in .json or .toml, or a name in `BUILT_IN`.

    Raises
    ------
    InputError
        If the file cannot be read, or does not describe a plant; one sentence says where and why.

    Notes
    -----
    "mace" needs Exudyn to be simulated, and its `simulate` says so where that is missing; its modes do not.

    Examples
    --------
    >>> plant = load_plant("mace-linear")
    >>> dict(plant.inputs), len(plant.modes())
    ({'torque': 'N m'}, 12)
    """
    if (name := str(plant)) in BUILT_IN:
        return BUILT_IN[name]()
    try:
        return plant_of(read_plant_data(plant))
    except InputError as error:
        raise InputError(str(error) if str(plant) in str(error) else f"{plant}: {error}") from None


def plant_of(data: Any, added_mass: Mapping[int, float] | None = None) -> SimulatedPlant:
    """The plant that a plant file's data describe.

    Parameters
    ----------
    data : mapping
        As :func:`read_plant_data` gives them.
    added_mass : mapping of int to float, optional
        What is put on coordinates of matrices [kg], by their numbers from 0: a payload.

    Raises
    ------
    InputError
        If they do not describe a plant, or mass is added where there are no matrices.

    Examples
    --------
    >>> data = read_plant_data("examples/data/machine.toml")
    >>> [round(plant_of(data, {2: added}).modes()[0].frequency, 2) for added in (0.0, 0.5)]
    [8.68, 8.12]
    """
    try:
        given = msgspec.convert(data, _File)
    except msgspec.ValidationError as error:
        raise InputError(f"not a {PLANT_SCHEMA} file: {error}.") from None
    if given.schema != PLANT_SCHEMA:
        raise InputError(f"its schema is {given.schema!r}: write {PLANT_SCHEMA!r}, the one this version reads.")
    for coordinate, mass in (added_mass or {}).items():
        if given.matrices is None:
            raise InputError("it has no matrices, so no mass can be put on a coordinate: give matrices.")
        at = whole_number("the payload's coordinate", coordinate, 0, len(given.matrices.mass) - 1)
        if len(given.matrices.mass[at]) > at:  # a row that is too short is refused below
            given.matrices.mass[at][at] += not_negative("the payload", mass, "kg")
    return _plant(given)


def _plant(given: _File) -> SimulatedPlant:
    parts = [part for part in (given.matrices, given.state_space, given.modal) if part is not None]
    if len(parts) != 1:
        raise InputError(f"it describes {len(parts)} plants: give one of matrices, state_space and modal.")
    if given.matrices is not None:
        matrices = given.matrices
        _apart("output", [one.name for one in matrices.outputs])
        return from_matrices(
            matrices.mass,
            matrices.damping,
            matrices.stiffness,
            input=_place(matrices.input),
            outputs={one.name: _place(one) for one in matrices.outputs},
            input_name=matrices.input.name,
            input_unit=matrices.input.unit,
            output_units={one.name: one.unit for one in matrices.outputs},
        )
    if given.state_space is not None:
        system = given.state_space
        _apart("input", [one.name for one in system.inputs])
        _apart("output", [one.name for one in system.outputs])
        return LinearPlant(
            system.A,
            system.B,
            system.C,
            system.D,
            inputs={one.name: one.unit for one in system.inputs},
            outputs={one.name: one.unit for one in system.outputs},
            sample_time=system.sample_time,
        )
    assert given.modal is not None
    modal = given.modal
    _apart("output", [one.name for one in modal.outputs])
    return FlexibleStructure(
        [(one.frequency, one.damping) for one in modal.modes],
        [one.gain for one in modal.modes],
        {one.name: Output(one.weights, rigid=one.rigid, unit=one.unit) for one in modal.outputs},
        input=modal.input.name,
        unit=modal.input.unit,
    )


def _place(spot: _Spot) -> Place:
    if (spot.coordinate is None) == (spot.weights is None):
        raise InputError(f"{spot.name!r} needs a place: give one of coordinate (a number, from 0) and weights.")
    return spot.weights if spot.weights is not None else spot.coordinate or 0


def _apart(kind: str, names: list[str]) -> None:
    double = [name for name in names if names.count(name) > 1]
    if double:
        raise InputError(f"two {kind}s are named {double[0]!r}: give each a name of its own.")


def read_plant_data(plant: str | os.PathLike[str]) -> Any:
    """What a plant file, JSON or TOML of limited size, holds; InputError when it cannot be read."""
    source = Path(plant)
    try:
        status = source.stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError(f"{source} is not a regular file: give a plant file, .json or .toml.")
        if status.st_size > LARGEST_FILE:
            raise InputError(
                f"{source} has {status.st_size / 1e6:.0f} MB and a plant file at most {LARGEST_FILE / 1e6:.0f} MB: "
                "reduce the model to its modes first."
            )
        text = source.read_bytes()
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "strerror", None) or error
        raise InputError(
            f"cannot read {source}: {reason}; give a plant file, or one of {', '.join(BUILT_IN)}."
        ) from None
    if not text.strip():
        raise InputError(f"{source} is empty: write the plant into it, see the reference of the plant file.")
    try:
        if source.suffix.lower() == ".toml":
            return tomllib.loads(text.decode())
        if source.suffix.lower() == ".json":
            return msgspec.json.decode(text)
    except (tomllib.TOMLDecodeError, msgspec.DecodeError, UnicodeDecodeError, RecursionError, OverflowError) as error:
        kind = source.suffix[1:].upper()
        raise InputError(f"{source} is not {kind} ({error}): it is truncated or misspelt; correct it.") from None
    raise InputError(f"{source} names no kind of file: end it in .json or .toml.")
