"""What a stream refuses and lets through, threads, saved states that are damaged, and life without a compiler."""

from __future__ import annotations

import asyncio
import copy
import math
import pickle
import threading
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.stream.streams import ENGINES, bits, shaper_of, taps_of

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.kernel import EngineLike, compiled
from preshape.stream import Stream
from preshape.stream import parts as module

ZV = Shaper([0.0, 0.5], [0.5, 0.5])
BAD = [math.nan, math.inf, -math.inf, 1e251, -1e300]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: Stream(ZV, 0.0), "dt is 0 s"),
        (lambda: Stream(ZV, math.nan), "dt is nan"),
        (lambda: Stream(ZV, 0.1, axes=0), "axes is 0"),
        (lambda: Stream(ZV, 0.1, axes=1.5), "axes is 1.5"),
        (lambda: Stream("zv", 0.1), "is no shaper"),
        (lambda: Stream([], 0.1), "0 shapers were given"),
        (lambda: Stream([ZV, None], 0.1), "is no shaper"),
        (lambda: Stream([ZV] * 65, 0.1), "65 shapers were given"),
        (lambda: Stream([design.ps_zvd((1.0, 0.0))] * 20, 0.1), "may amplify"),
        (lambda: Stream(ZV, 1e-9), "longer than 2[*][*]26 samples"),
        (lambda: Stream(ZV, 0.1, not_finite="ignore"), "not_finite is 'ignore'"),
        (lambda: Stream(ZV, 0.1, axes=2).push(1.0), r"shape \(\): give 2 numbers"),
        (lambda: Stream(ZV, 0.1, axes=2).push([1.0, 2.0, 3.0]), r"shape \(3,\)"),
        (lambda: Stream(ZV, 0.1, axes=2).push_block([1.0]), r"give \(2, time\)"),
        (lambda: Stream(ZV, 0.1).push_block([[1.0], [2.0]]), r"give \(time,\)"),
        (lambda: Stream(ZV, 0.1).push_block("ab"), "not made of numbers"),
        (lambda: Stream(ZV, 0.1).push_block([1.0], out=np.zeros(2)), "out must be"),
        (lambda: Stream(ZV, 0.1).push_block([1.0], out=np.zeros(1, dtype=np.float32)), "out must be"),
        (lambda: Stream(ZV, 0.1).push_block([1.0, 2.0], out=np.zeros(4)[::2]), "out must be"),
        (lambda: (lambda u: Stream(ZV, 0.1).push_block(u[:4], out=u[1:]))(np.zeros(5)), "overlaps"),
        (lambda: Stream(ZV, 0.1).reset([1.0, 2.0]), "one number, or one for each of 1 axes"),
        (lambda: Stream(ZV, 0.1).reset(math.nan), "the sample is nan"),
        (lambda: Stream(ZV, 0.1).retune([ZV, ZV]), "2 shapers were given and the stream has 1"),
        (lambda: Stream(ZV, 0.1).retune(None), "is no shaper"),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(call: Callable[[], object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call()


@pytest.mark.parametrize("kernel", ENGINES)
@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("scattering", [False, True])
@pytest.mark.parametrize("size", [10, 20_000])
def test_a_bad_sample_is_refused_and_leaves_no_trace(
    kernel: Callable[..., EngineLike], bad: float, scattering: bool, size: int
) -> None:
    if size > 10 and (kernel is ENGINES[0].values[0] or scattering):
        size = 300
    taps = taps_of(shaper_of("zvd"), 0.05)
    engine, untouched = kernel(1, (taps,)), kernel(1, (taps,))
    for one in (engine, untouched):
        if scattering:
            one.retune(0, *taps)
        one.push(1.0)
    command, place = np.linspace(0.0, 1.0, size), size - 3
    command[place] = bad
    with pytest.raises(InputError, match=rf"sample {place} of axis 0 .* nothing of this block was taken"):
        engine.block(command, np.empty(size))
    with pytest.raises(InputError, match=r"the sample is .*not_finite"):
        engine.push(bad)
    assert engine.save(0, 0) == untouched.save(0, 0)


@pytest.mark.parametrize("kernel", ENGINES)
@pytest.mark.parametrize("size", [300, 9000])
def test_a_bad_sample_may_pass_and_spoils_no_other(kernel: Callable[..., EngineLike], size: int) -> None:
    """It comes out where it came in, while the last good one is held."""
    taps = taps_of(shaper_of("direct, order 1"), 0.05)
    command = np.random.default_rng(0).normal(size=size)
    held = command.copy()
    places = [0, 5, 6, 100, size - 1]
    command[places] = BAD
    held[[0, 5, 6, 100, size - 1]] = [0.0, held[4], held[4], held[99], held[size - 2]]
    passing, plain, shaped, expected = kernel(1, (taps,), True), kernel(1, (taps,)), np.empty(size), np.empty(size)
    passing.block(command, shaped)
    plain.block(held, expected)
    assert bits(shaped[places]) == bits(BAD)
    assert bits(np.delete(shaped, places)) == bits(np.delete(expected, places))
    assert passing.save(0, 0) == plain.save(0, 0)
    again = kernel(1, (taps,), True)
    assert bits([again.push(u) for u in command.tolist()]) == bits(shaped)


def test_passing_is_a_choice_of_the_stream_and_is_saved_with_it() -> None:
    stream = Stream(ZV, 0.25, axes=2, not_finite="pass")
    shaped = stream.push_block([[1.0, math.nan, 1.0], [2.0, 2.0, 2.0]])
    np.testing.assert_array_equal(shaped, [[0.5, math.nan, 1.0], [1.0, 1.0, 2.0]])
    assert math.isnan(float(np.ravel(Stream.from_state(stream.state).push([math.nan, 0.0]))[0]))


@pytest.mark.parametrize("kernel", ENGINES)
@pytest.mark.parametrize(
    ("delays", "weights"),
    [
        ([], []),
        ([0, 1], [1.0]),
        ([0, 0], [0.5, 0.5]),
        ([1, 0], [0.5, 0.5]),
        ([0, 1], [0.5, 0.6]),
        ([0, 1], [math.nan, 0.5]),
        ([0, 1], [math.inf, -math.inf]),
        ([0, 1], [2e6, 1.0 - 2e6]),
        ([0, 2**26], [0.5, 0.5]),
    ],
)
def test_taps_that_are_no_shaper_are_refused_at_configuration(
    kernel: Callable[..., EngineLike], delays: list[int], weights: list[float]
) -> None:
    taps = np.array(delays, dtype=np.uint32), np.array(weights, dtype=float)
    good = taps_of(ZV, 0.25)
    engine = kernel(1, (good,))
    for call in (lambda: kernel(1, (taps,)), lambda: engine.retune(0, *taps)):
        with pytest.raises(InputError, match=r"no shaper on the grid|one weight for each|longer than"):
            call()
    assert engine.push(1.0) == 0.5 and not engine.scattering(0)


@given(cut=st.integers(0, 400), flip=st.integers(0, 7))
def test_a_damaged_state_is_recognised(cut: int, flip: int) -> None:
    stream = Stream(ZV, 0.1, axes=2)
    stream.push_block([[1.0, 2.0], [3.0, 4.0]])
    state = bytearray(stream.state)
    state[cut % len(state)] ^= 1 << flip
    for damaged in (bytes(state), stream.state[: cut % len(stream.state)]):
        with pytest.raises(InputError, match=r"not the state|cut or damaged|version"):
            Stream.from_state(damaged)


def test_a_state_of_another_kind_is_refused() -> None:
    from preshape.stream.state import read_state, write_state

    saved = read_state(Stream(ZV, 0.1).state)
    for rings in (
        [[(False, b"\0" * 8)]],
        [[(True, b"\0" * 24)]],
        [[(True, np.array([0, 0, 0, 1e9, 0, 0.0]).tobytes())]],
    ):
        object.__setattr__(saved, "rings", rings)
        with pytest.raises(InputError, match="does not fit"):
            Stream.from_state(write_state(saved))
    with pytest.raises(InputError, match="not the state"):
        Stream.from_state("text")  # type: ignore[arg-type]


def test_copies_and_pickles_go_on_by_themselves() -> None:
    stream = Stream([ZV, shaper_of("mzv")], 0.1, axes=1)
    stream.push(2.0)
    stream.retune([shaper_of("zvd"), shaper_of("mzv")])
    stream.push(3.0)
    twin, other = pickle.loads(pickle.dumps(stream)), copy.copy(stream)
    command = np.random.default_rng(1).normal(size=100)
    assert bits(twin.push_block(command)) == bits(other.push_block(command)) == bits(stream.push_block(command))
    assert (twin.dt, twin.axes, twin.latency) == (stream.dt, stream.axes, stream.latency)


def test_streams_in_threads_do_not_disturb_each_other() -> None:
    shaper, dt = shaper_of("zvdd"), 0.01
    commands = np.random.default_rng(2).normal(size=(4, 60_000))
    results: list[np.ndarray | None] = [None] * 4

    def work(k: int) -> None:
        stream = Stream(shaper, dt)
        results[k] = np.concatenate([stream.push_block(part) for part in np.split(commands[k], 12)])

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    expected = shaper.shape(commands, dt)[:, :60_000]
    assert all(bits(results[k]) == bits(expected[k]) for k in range(4))


@pytest.mark.skipif(compiled is None, reason="the kernel in C lets other threads run")
def test_one_stream_in_two_threads_at_once_is_refused() -> None:
    stream, command = Stream(shaper_of("zvdd"), 0.001), np.zeros(5_000_000)
    out, refused, ended = np.empty_like(command), 0, threading.Event()

    def work() -> None:
        for _ in range(20):
            stream.push_block(command, out=out)
        ended.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not ended.is_set():
        try:
            stream.push(0.0)
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
            if refused >= 3:
                break
    thread.join()
    assert refused > 0


def test_a_block_may_run_beside_an_event_loop() -> None:
    async def both() -> tuple[bytes, int]:
        stream, command = Stream(ZV, 0.001), np.ones(300_000)
        block = asyncio.create_task(asyncio.to_thread(stream.push_block, command))
        turns = 0
        while not block.done():
            await asyncio.sleep(0)
            turns += 1
        return bits(await block), turns

    shaped, turns = asyncio.run(both())
    assert shaped == bits(ZV.shape(np.ones(300_000), 0.001)[:300_000]) and turns > 0


def test_without_a_compiler_there_is_one_warning_and_the_same_output(monkeypatch: pytest.MonkeyPatch) -> None:
    expected = Stream(shaper_of("ei 5 %"), 0.01).push_block(np.ones(400))
    monkeypatch.setattr(module, "compiled", None)
    with pytest.warns(RuntimeWarning, match="without a C compiler") as caught:
        stream = Stream(shaper_of("ei 5 %"), 0.01)
    assert len(caught) == 1
    assert bits(stream.push_block(np.ones(400))) == bits(expected)


def test_no_samples_are_no_samples() -> None:
    stream = Stream(ZV, 0.25)
    assert stream.push_block([]).size == 0
    assert stream.push(1.0) == 0.5
    assert "2 taps" in repr(stream)
