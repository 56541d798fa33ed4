"""The laws of a fixed shaper at work, for every family: samples = chunks = batch, constants, latency, saved states."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.stream.streams import ENGINES, NAMES, bits, commands, run, shaper_of, taps_of

from preshape.kernel import EngineLike
from preshape.stream import Stream

FEW = settings(max_examples=4)
EACH_FAMILY = pytest.mark.parametrize("name", NAMES)
SAMPLE_TIMES = st.sampled_from([0.002, 0.013, 0.05, 1.0])


@EACH_FAMILY
@FEW
@given(command=commands(), dt=SAMPLE_TIMES, cuts=st.lists(st.integers(0, 600), max_size=5))
def test_samples_are_chunks_are_the_batch_bit_for_bit(
    name: str, command: NDArray[np.float64], dt: float, cuts: list[int]
) -> None:
    shaper = shaper_of(name)
    batch = shaper.shape(command, dt)[: command.size]
    samples, chunks = Stream(shaper, dt), Stream(shaper, dt)
    assert bits([samples.push(u) for u in command.tolist()]) == bits(batch)
    parts = np.split(command, sorted(cut for cut in cuts if cut < command.size))
    assert bits(np.concatenate([chunks.push_block(part) for part in parts])) == bits(batch)


@EACH_FAMILY
@FEW
@given(command=commands(), dt=SAMPLE_TIMES, cut=st.integers(0, 600))
def test_both_kernels_give_the_same_bits(name: str, command: NDArray[np.float64], dt: float, cut: int) -> None:
    taps = taps_of(shaper_of(name), dt)
    outputs = []
    for parameter in ENGINES:
        if parameter.values[0] is None:
            pytest.skip("no compiler was there at the installation")
        engine: EngineLike = parameter.values[0](1, (taps,))
        outputs.append(run(engine, command[:cut]).tobytes() + run(engine, command[cut:]).tobytes())
    assert outputs[0] == outputs[1]


@EACH_FAMILY
@FEW
@given(value=st.floats(-1e12, 1e12), dt=SAMPLE_TIMES)
def test_a_constant_comes_out_to_the_last_bit(name: str, value: float, dt: float) -> None:
    stream = Stream(shaper_of(name), dt)
    stream.reset(value)
    assert (stream.push_block(np.full(50, value)) == value).all()
    stream.reset()
    stream.push_block(np.random.default_rng(0).normal(size=40))
    settled = stream.push_block(np.full(stream.latency_samples + 3, value))
    assert (settled[stream.latency_samples :] == value).all()


@EACH_FAMILY
@FEW
@given(dt=SAMPLE_TIMES)
def test_the_latency_is_the_duration_and_a_step_arrives_with_it(name: str, dt: float) -> None:
    shaper = shaper_of(name)
    stream = Stream(shaper, dt)
    periods = shaper.duration / dt
    assert stream.latency_samples == math.ceil(periods - 1e-9 * max(1.0, periods))
    step = stream.push_block(np.ones(stream.latency_samples + 2))
    assert (step[stream.latency_samples :] == 1.0).all()
    assert stream.latency_samples == 0 or step[stream.latency_samples - 1] != 1.0
    assert stream.latency == stream.latency_samples * dt


@EACH_FAMILY
@FEW
@given(command=commands(least=2), dt=SAMPLE_TIMES, cut=st.integers(0, 600))
def test_a_saved_stream_goes_on_with_the_same_bits(
    name: str, command: NDArray[np.float64], dt: float, cut: int
) -> None:
    stream = Stream(shaper_of(name), dt)
    stream.push_block(command[:cut])
    again = Stream.from_state(stream.state)
    assert again.state == stream.state
    assert bits(again.push_block(command[cut:])) == bits(stream.push_block(command[cut:]))


@EACH_FAMILY
def test_stages_in_a_row_do_what_their_convolution_does(name: str) -> None:
    """Hyde, 3.2.2: the rings in a row need the sum of the impulses, the convolution their product."""
    dt, rows = 0.01, [shaper_of(name), shaper_of("zvd")]
    on_grid = [type(one)(taps[0] * dt, taps[1] / taps[1].sum()) for one in rows for taps in [one.taps(dt)]]
    command = np.cumsum(np.random.default_rng(3).normal(size=3000)) * 0.01
    row, product = Stream(rows, dt), Stream(on_grid[0] * on_grid[1], dt)
    size = on_grid[0].magnitude * on_grid[1].magnitude * np.abs(command).max()
    difference = row.push_block(command) - product.push_block(command)
    assert np.abs(difference).max() <= 1e-14 * size
    assert row.latency_samples == product.latency_samples
    again = Stream(rows, dt)
    assert bits([again.push(u) for u in command[:500].tolist()]) == bits(Stream(rows, dt).push_block(command[:500]))


@pytest.mark.parametrize("axes", [2, 3])
def test_axes_are_shaped_alike_and_do_not_mix(axes: int) -> None:
    shaper, dt = shaper_of("direct, order 1"), 0.01
    command = np.random.default_rng(1).normal(size=(axes, 400))
    stream, expected = Stream(shaper, dt, axes), shaper.shape(command, dt)[:, :400]
    first = np.array([stream.push(column) for column in command[:, :7].T]).T
    rest = stream.push_block(command[:, 7:])
    assert bits(np.concatenate([first, rest], axis=1)) == bits(expected)


def test_large_blocks_take_another_way_to_the_same_bits() -> None:
    """From 8192 samples on a block is checked while it is shaped."""
    shaper, dt = shaper_of("zvdd"), 0.003
    command = np.cumsum(np.random.default_rng(2).normal(size=50_000))
    expected = shaper.shape(command, dt)[: command.size]
    stream = Stream(shaper, dt)
    got = [stream.push_block(part) for part in np.split(command, [9000, 9001, 30_000])]
    assert bits(np.concatenate(got)) == bits(expected)
    in_place = command.copy()
    assert Stream(shaper, dt).push_block(in_place, out=in_place) is in_place
    assert bits(in_place) == bits(expected)


def test_boxes_are_taps_on_the_grid() -> None:
    from preshape import design

    shaper = design.sd_zv((1.0, 0.02), 0.3, form="box")
    assert shaper.boxes
    command = np.random.default_rng(4).normal(size=300)
    assert bits(Stream(shaper, 0.01).push_block(command)) == bits(shaper.shape(command, 0.01)[:300])
