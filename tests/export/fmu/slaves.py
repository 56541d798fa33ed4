"""What the tests of FMUs share: exports, and instances of them driven through fmpy."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.fmi3 import FMU3Slave
from numpy.typing import NDArray

from preshape import Shaper, design
from preshape.export import render
from preshape.export.target import Exported

DT = 0.004
RANDOM = np.random.default_rng(3).normal(size=200)
TIME, COMMAND, SHAPED, INITIAL, PASS = range(5)
SHAPERS = {
    "zvd": design.zvd((8.7, 0.024)),
    "negative": design.um_zv((8.7, 0.024)),
    "two modes": design.direct([(3.1, 0.01), (8.7, 0.05)]),
    "nothing": Shaper([0.0], [1.0]),
    "boxes": Shaper([0.0], [0.5], boxes=[(0.01, 0.06, 10.0)]),
}


def rendered(name: str = "zvd", **wishes: str) -> Exported:
    """Written anew."""
    return render(SHAPERS[name], "fmu", dt=DT, name="axis", **wishes)


exported = cache(rendered)
"""Written once: a compiler takes most of a second."""


def written(export: Exported, folder: Path) -> Path:
    path = folder / "axis.fmu"
    path.write_bytes(bytes(export.files["axis.fmu"]))  # type: ignore[arg-type]
    return path


class Slave:
    """One instance, and the messages it logged."""

    def __init__(self, folder: Path, token: str | None = None, dt: float = DT) -> None:
        description = read_model_description(str(folder))
        self.messages: list[str] = []
        self.fmu = FMU3Slave(
            guid=token or description.instantiationToken, unzipDirectory=str(folder), modelIdentifier="axis"
        )
        self.fmu.instantiate(logMessage=lambda environment, status, category, text: self.messages.append(text.decode()))
        self.time, self.dt = 0.0, dt

    def started(self, initial: float = 0.0, pass_not_finite: bool = False, start: float = 0.0) -> Slave:
        self.fmu.setFloat64([INITIAL], [initial])
        self.fmu.setBoolean([PASS], [pass_not_finite])
        self.fmu.enterInitializationMode(startTime=start)
        self.fmu.exitInitializationMode()
        self.time = start
        return self

    def step(self, command: float, samples: int = 1) -> float:
        self.fmu.setFloat64([COMMAND], [command])
        events = self.fmu.doStep(self.time, samples * self.dt)
        self.time += samples * self.dt
        assert events == (False, False, False, self.time), "no event, no end, no early return; and where it is now"
        return self.shaped

    def shape(self, command: NDArray[np.float64]) -> list[float]:
        return [self.step(u) for u in command.tolist()]

    @property
    def shaped(self) -> float:
        (value,) = self.fmu.getFloat64([SHAPED])
        return float(value)


@pytest.fixture
def slave(tmp_path: Path) -> Callable[..., Slave]:
    """Makes instances of an export, each export extracted once."""
    folders: dict[tuple[str, str], Path] = {}

    def make(name: str = "zvd", precision: str = "double") -> Slave:
        if (name, precision) not in folders:
            folder = tmp_path / f"{name}-{precision}".replace(" ", "-")
            folder.mkdir()
            with zipfile.ZipFile(written(exported(name, precision=precision), folder)) as archive:
                archive.extractall(folder)
            folders[name, precision] = folder
        return Slave(folders[name, precision])

    return make
