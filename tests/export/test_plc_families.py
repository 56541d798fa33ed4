"""Every shaper family through the targets st and fmu: read back exactly, and run to the same samples."""

from __future__ import annotations

import zipfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from tests.export.fmu.slaves import Slave, written
from tests.export.st.interpreter import Machine
from tests.laws import FAMILIES, Family

from preshape import Modes, Shaper
from preshape.errors import InputError
from preshape.export import fmu, render, st
from preshape.export.fmu import binary
from preshape.export.target import Exported
from preshape.stream import Stream

DT = 0.01
MODES = Modes([(1.0, 0.02), (2.7, 0.05)])
TARGETS = {"st": st.ST, "fmu": fmu.FMU}
each_family = pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)


@cache
def shaper_of(family: Family) -> Shaper:
    return family.build(MODES)


def exported(family: Family, target: str, **wishes: str) -> Exported:
    return render(shaper_of(family), target, dt=DT, name="axis", **wishes)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("precision", ["double", "single"])
@each_family
def test_it_reads_back_exactly(family: Family, precision: str, target: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(binary, "COMPILERS", ())
    for version in TARGETS[target].versions:
        export = exported(family, target, precision=precision, version=version)
        said = TARGETS[target].parse(export.files)
        np.testing.assert_array_equal(said.delays, export.placed.delays)
        np.testing.assert_array_equal(said.weights, export.placed.weights)
        assert (said.dt, said.precision) == (DT, precision)
        does = TARGETS[target].execute(export.files)
        assert does == export.placed.shaper
        assert does.amplitudes[-1] == pytest.approx(1.0 - said.weights[:-1].sum(), abs=1e-13)


def samples(export: Exported) -> tuple[np.ndarray, list[float]]:
    """A command that moves, jumps and rests, and what a stream makes of it."""
    random = np.random.default_rng(6)
    size = int(export.placed.delays[-1]) + 60
    command = 3.0 + np.concatenate([np.cumsum(random.normal(size=40)), 1e3 * random.normal(size=size)])
    stream = Stream(export.placed.shaper, DT)
    stream.reset(command[0])
    return command, stream.push_block(command).tolist()


@pytest.mark.slow
@each_family
def test_the_function_block_gives_the_samples_of_a_stream(family: Family) -> None:
    export = exported(family, "st")
    command, expected = samples(export)
    block = Machine(str(export.files["FB_Axis.st"])).instance("FB_Axis")
    assert [float(block.call(Enable=True, Command=u).Shaped) for u in command.tolist()] == expected


@pytest.mark.slow
@each_family
def test_the_fmu_gives_the_samples_of_a_stream(family: Family, tmp_path: Path) -> None:
    export = exported(family, "fmu")
    if export.notes:
        pytest.skip("there is no C compiler here")
    command, expected = samples(export)
    with zipfile.ZipFile(written(export, tmp_path)) as archive:
        archive.extractall(tmp_path)
    slave = Slave(tmp_path, dt=DT).started(initial=float(command[0]))
    assert slave.shape(command) == expected


@pytest.mark.parametrize("target", TARGETS)
def test_limits_are_errors_of_the_user(target: str) -> None:
    with pytest.raises(InputError, match="samples long"):
        render(Shaper([0.0, 1.5], [0.5, 0.5]), target, dt=1e-6)
    with pytest.raises(InputError, match="taps"):
        render(Shaper([0.0], [0.5], boxes=[(0.1, 5.1, 0.1)]), target, dt=1e-4)
