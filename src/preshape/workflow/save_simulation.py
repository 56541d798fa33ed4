"""A simulation as a table: command and outputs, unshaped beside shaped."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape.files import write_atomically
from preshape.plant import Simulation
from preshape.report import ShapedSimulation

__all__ = ["save_partial", "save_simulation"]


def save_simulation(result: ShapedSimulation, path: str | os.PathLike[str]) -> Path:
    """Write time [s], every command and every output, unshaped and shaped, with full digits.

    Parameters
    ----------
    result : ShapedSimulation
        From :func:`preshape.workflow.simulate_plant`.
    path : path
        CSV to write; an older file is replaced only when the new one is complete.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    columns: dict[str, NDArray[np.float64]] = {}
    for kind, run in (("unshaped", result.unshaped), ("shaped", result.shaped)):
        columns |= _columns(run, result.inputs, f" {kind}")
    return _written(path, result.unshaped.times, columns)


def save_partial(run: Simulation, inputs: Mapping[str, str], path: str | os.PathLike[str]) -> Path:
    """Write one simulation, or what there is of it, as :func:`save_simulation` does.

    Parameters
    ----------
    run : Simulation
        Whole, or the `partial` of one that diverged.
    inputs : mapping of str to str
        Units of its commands, by name.
    path : path
        CSV to write.
    """
    return _written(path, run.times, _columns(run, inputs, ""))


def _columns(run: Simulation, inputs: Mapping[str, str], kind: str) -> dict[str, NDArray[np.float64]]:
    found = {_title(f"{name}{kind}", inputs[name]): row for name, row in zip(inputs, run.command, strict=True)}
    return found | {_title(f"{name}{kind}", run.units[name]): values for name, values in run.outputs.items()}


def _title(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def _written(
    path: str | os.PathLike[str], times: NDArray[np.float64], columns: Mapping[str, NDArray[np.float64]]
) -> Path:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time [s]", *columns])
    rows = np.stack([times.round(12), *columns.values()], axis=1)
    writer.writerows(rows.tolist())
    return write_atomically(path, text.getvalue())
