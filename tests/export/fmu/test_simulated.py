"""The FMU run by fmpy: the same samples as in Python, bit for bit; states, steps and refusals."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Callable
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from tests.export.fmu.slaves import COMMAND, DT, INITIAL, PASS, RANDOM, SHAPED, SHAPERS, Slave, exported, slave, written

from preshape.stream import Stream

__all__ = ["slave"]

Make = Callable[..., Slave]


@pytest.fixture(autouse=True)
def a_compiler() -> None:
    if exported().notes:
        pytest.skip("there is no C compiler here")


@pytest.mark.parametrize("precision", ["double", "single"])
def test_fmpy_finds_nothing_wrong(precision: str, tmp_path: Path) -> None:
    """With the XML schema of FMI 3.0 and fmpy's own rules."""
    path = written(exported(precision=precision), tmp_path)
    assert validate_fmu(str(path)) == []
    description = fmpy.read_model_description(str(path))
    assert float(description.coSimulation.fixedInternalStepSize) == DT
    assert not description.coSimulation.canHandleVariableCommunicationStepSize


@pytest.mark.parametrize("name", SHAPERS)
def test_the_samples_are_those_of_a_stream(name: str, slave: Make) -> None:
    command = 20.0 + np.concatenate([np.zeros(3), np.cumsum(RANDOM), 1e9 * RANDOM[:50]])
    stream = Stream(exported(name).placed.shaper, DT)
    stream.reset(20.0)
    instance = slave(name).started(initial=20.0)
    assert instance.shaped == 20.0
    assert instance.shape(command) == stream.push_block(command).tolist()


def test_in_single_they_are_those_of_the_definition_in_float32(slave: Make) -> None:
    placed = exported("two modes", precision="single").placed
    command = RANDOM.astype(np.float32)
    delays, weights = placed.delays.astype(int), placed.weights.astype(np.float32)
    padded = np.concatenate([np.full(delays[-1], np.float32(0.7)), command])
    past = [padded[delays[-1] - delay : padded.size - delay] for delay in delays]
    total = np.zeros(command.size, dtype=np.float32)
    for weight, u in zip(weights[:-1], past[:-1], strict=True):
        total += weight * (u - past[-1])
    instance = slave("two modes", "single").started(initial=0.7)
    assert instance.shape(command.astype(float)) == (past[-1] + total).tolist()


def test_a_whole_simulation(tmp_path: Path) -> None:
    path = written(exported("negative"), tmp_path)
    times = np.arange(150) * DT
    signal = np.array(list(zip(times, RANDOM[:150], strict=True)), dtype=[("time", float), ("command", float)])
    result = fmpy.simulate_fmu(
        str(path), stop_time=149 * DT, output_interval=DT, input=signal, start_values={"initial": 2.5}
    )
    stream = Stream(exported("negative").placed.shaper, DT)
    stream.reset(2.5)
    assert result["shaped"][0] == 2.5
    # fmpy interpolates the command at the communication points, which costs a rounding
    np.testing.assert_allclose(result["shaped"][1:], stream.push_block(RANDOM[:149]), rtol=0.0, atol=1e-12)


def test_a_step_of_several_samples_holds_the_command(slave: Make) -> None:
    stream = Stream(exported().placed.shaper, DT)
    instance = slave().started()
    for samples, u in ((1, 1.0), (7, -2.0), (2, 0.5), (1000, 3.25), (10**9, -1.0), (3, 8.0)):
        expected = stream.push_block(np.full(min(samples, 1000), u))[-1]
        assert instance.step(u, samples) == expected


def test_two_instances_share_nothing(slave: Make) -> None:
    command, other = RANDOM, -3.0 * RANDOM[::-1]
    one, two = slave().started(), slave().started(initial=1.0)
    together = [(one.step(u), two.step(v)) for u, v in zip(command.tolist(), other.tolist(), strict=True)]
    assert [a for a, _ in together] == slave().started().shape(command)
    assert [b for _, b in together] == slave().started(initial=1.0).shape(other)


def test_reset_is_a_new_instance(slave: Make) -> None:
    instance = slave().started(initial=4.0, pass_not_finite=True)
    first = instance.shape(RANDOM)
    instance.fmu.reset()
    assert instance.fmu.getFloat64([COMMAND, SHAPED, INITIAL]) == [0.0, 0.0, 0.0]
    assert instance.fmu.getBoolean([PASS]) == [False]
    assert instance.started(initial=4.0, start=-7.0).shape(RANDOM) == first


def test_a_state_goes_on_where_it_was_also_as_bytes_in_another_instance(slave: Make) -> None:
    instance = slave().started(initial=1.0)
    instance.shape(RANDOM[:77])
    state = instance.fmu.getFMUState()
    saved, when = instance.fmu.serializeFMUState(state), instance.time
    on = instance.shape(RANDOM[77:])
    instance.fmu.setFMUState(state)
    instance.time = when
    assert instance.shape(RANDOM[77:]) == on
    other = slave()
    other.fmu.setFMUState(other.fmu.deserializeFMUState(saved))
    other.time = when
    assert other.shape(RANDOM[77:]) == on
    instance.fmu.freeFMUState(state)


def test_damaged_and_foreign_states_are_refused(slave: Make) -> None:
    instance = slave().started()
    instance.shape(RANDOM[:10])
    saved = instance.fmu.serializeFMUState(instance.fmu.getFMUState())
    stranger = slave("negative").started()
    foreign = stranger.fmu.serializeFMUState(stranger.fmu.getFMUState())
    ring = saved[:-8] + np.array([np.nan]).tobytes()
    for state in (b"", saved[:-1], saved + b"\0", foreign, ring):
        with pytest.raises(FMICallException, match="error"):
            instance.fmu.deserializeFMUState(state)
    assert len(instance.messages) == 5 and "damaged" in instance.messages[-1]


@pytest.mark.parametrize("step", [0.5 * DT, 1.5 * DT, 0.0, -DT, 1.001 * DT, math.nan, math.inf, 1e-300])
def test_a_step_off_the_grid_is_refused_and_changes_nothing(step: float, slave: Make) -> None:
    instance = slave().started()
    first = instance.shape(RANDOM[:50])
    with pytest.raises(FMICallException, match="discard"):
        instance.fmu.doStep(instance.time, step)
    assert "whole multiple of the sample time 0.004" in instance.messages[-1]
    assert first + instance.shape(RANDOM[50:]) == slave().started().shape(RANDOM)


def test_rounding_of_long_times_is_no_step_off_the_grid(slave: Make) -> None:
    instance = slave().started(start=1e6)
    for index in range(5):
        now, later = 1e6 + index * DT, 1e6 + (index + 1) * DT
        instance.fmu.doStep(now, later - now)
    with pytest.raises(FMICallException, match="error"):
        instance.fmu.doStep(1e6, DT)
    assert "this instance is at" in instance.messages[-1]


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, "large"])
def test_what_is_not_finite_is_refused_and_poisons_nothing(bad: float | str, precision: str, slave: Make) -> None:
    value = (1.1e250 if precision == "double" else 1.1e18) if bad == "large" else float(bad)
    instance = slave("zvd", precision).started()
    first = instance.shape(RANDOM[:50])
    with pytest.raises(FMICallException, match="discard"):
        instance.step(value)
    assert "pass_not_finite" in instance.messages[-1] and instance.shaped == first[-1]
    assert first + instance.shape(RANDOM[50:]) == slave("zvd", precision).started().shape(RANDOM)
    with pytest.raises(FMICallException, match="discard"):
        slave("zvd", precision).fmu.setFloat64([INITIAL], [value])


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1.1e250])
def test_or_it_is_passed_by_choice_like_in_a_stream(bad: float, slave: Make) -> None:
    command = RANDOM.copy()
    command[[0, 40, 41, 90]] = bad
    stream = Stream(exported().placed.shaper, DT, not_finite="pass")
    stream.reset(0.5)
    shaped = slave().started(initial=0.5, pass_not_finite=True).shape(command)
    np.testing.assert_array_equal(shaped, stream.push_block(command))


def test_calls_out_of_order_and_unknown_variables_are_errors(slave: Make) -> None:
    fresh = slave()
    calls: list[Callable[[], object]] = [
        lambda: fresh.fmu.doStep(0.0, DT),
        fresh.fmu.exitInitializationMode,
        fresh.fmu.terminate,
        lambda: fresh.fmu.setFloat64([SHAPED], [1.0]),
        lambda: fresh.fmu.getFloat64([99]),
        lambda: fresh.fmu.getFloat64([COMMAND], 2),
        lambda: fresh.fmu.setBoolean([COMMAND], [True]),
        lambda: fresh.fmu.getInt32([COMMAND]),
        lambda: fresh.fmu.setString([COMMAND], ["one"]),
        fresh.fmu.enterEventMode,
        lambda: fresh.fmu.getDirectionalDerivative([SHAPED], [COMMAND], [1.0]),
        lambda: fresh.started().fmu.setFloat64([INITIAL], [1.0]),
        lambda: fresh.fmu.setBoolean([PASS], [True]),
        fresh.fmu.enterInitializationMode,
    ]
    for number, call in enumerate(calls):
        with pytest.raises(FMICallException, match="error"):
            call()
        assert len(fresh.messages) == number + 1
    fresh.fmu.terminate()
    with pytest.raises(FMICallException):
        fresh.step(1.0)


def test_the_binary_of_another_export_does_not_start(tmp_path: Path) -> None:
    with zipfile.ZipFile(written(exported(), tmp_path)) as archive:
        archive.extractall(tmp_path)
    with pytest.raises(Exception, match="Failed to instantiate"):
        Slave(tmp_path, token="{another}")
