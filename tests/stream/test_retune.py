"""A shaper that changes: no step, exact rest, no drift, and what was commanded before arrives as it would have."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.laws import FAMILIES
from tests.stream.streams import ENGINES, NAMES, bits, commands, run, shaper_of, taps_of

from preshape import Shaper, design
from preshape.kernel import EngineLike, compiled
from preshape.stream import Stream

FEW = settings(max_examples=4)
POSITIVE = [family.name for family in FAMILIES if not family.negative]
DT = 0.013

Changes = list[tuple[int, str]]
changes = st.lists(st.tuples(st.integers(0, 500), st.sampled_from(NAMES)), min_size=1, max_size=6)


def streamed(first: str, command: NDArray[np.float64], plan: Changes) -> NDArray[np.float64]:
    stream, parts, at = Stream(shaper_of(first), DT), [], 0
    for when, name in sorted(plan):
        parts.append(stream.push_block(command[at:when]))
        stream.retune(shaper_of(name))
        at = when
    return np.concatenate([*parts, stream.push_block(command[at:])])


def exactly(first: str, command: NDArray[np.float64], plan: Changes) -> list[Fraction]:
    """Each increment through the shaper of its time, in rational numbers; the last tap gets what the others leave."""
    shaped = [Fraction(0)] * command.size
    before = Fraction(0)
    for n, u in enumerate(map(Fraction, command.tolist())):
        in_force = [name for when, name in sorted(plan, key=lambda change: change[0]) if when <= n]
        delays, weights = shaper_of(in_force[-1] if in_force else first).taps(DT)
        parts = [Fraction(weight) for weight in weights[:-1].tolist()]
        for delay, weight in zip(delays.tolist(), [*parts, 1 - sum(parts)], strict=True):
            if n + delay < command.size:
                shaped[n + delay] += weight * (u - before)
        before = u
    total, sums = Fraction(0), []
    for arrival in shaped:
        total += arrival
        sums.append(total)
    return sums


def catching_up(old: str, new: str) -> float:
    """How much of an even command may arrive at once: what the old shaper still holds back, and what the new one gives.

    It is 1 when nothing arrives earlier than before. A shorter shaper catches up, and that takes larger steps.
    """
    sums = []
    size = max(Stream(shaper_of(name), DT).latency_samples for name in (old, new)) + 1
    for name in (old, new):
        delays, weights = shaper_of(name).taps(DT)
        sums.append(np.cumsum(np.bincount(delays, weights, size)))
    return max(1.0, float((1.0 - sums[0] + sums[1]).max()))


@pytest.mark.parametrize("old", POSITIVE)
@FEW
@given(command=commands(), when=st.integers(0, 500), new=st.sampled_from(POSITIVE))
def test_one_change_steps_by_no_more_than_the_command_and_what_must_be_caught_up(
    old: str, command: NDArray[np.float64], when: int, new: str
) -> None:
    shaped = streamed(old, command, [(when, new)])
    rounding = 2.0 * np.spacing(np.abs(command).max())
    largest = np.abs(np.diff(command, prepend=0.0)).max()
    assert np.abs(np.diff(shaped, prepend=0.0)).max() <= catching_up(old, new) * largest + rounding


@pytest.mark.parametrize("name", POSITIVE)
@FEW
@given(plan=changes, size=st.floats(-1e6, 1e6))
def test_of_one_increment_no_part_is_larger_than_it_whatever_changes(name: str, plan: Changes, size: float) -> None:
    plan = [(when, POSITIVE[len(other) % len(POSITIVE)]) for when, other in plan]
    command = np.where(np.arange(900) < 100, 0.0, size)
    steps = np.diff(streamed(name, command, plan), prepend=0.0) * np.sign(size)
    rounding = 2.0 * np.spacing(abs(size))
    assert (steps >= -rounding).all() and (steps <= abs(size) + rounding).all()


@pytest.mark.parametrize("name", NAMES)
@FEW
@given(plan=changes, value=st.floats(-1e9, 1e9))
def test_a_change_at_rest_changes_nothing(name: str, plan: Changes, value: float) -> None:
    command = np.full(600, value)
    stream = Stream(shaper_of(name), DT)
    stream.reset(value)
    for when, other in plan:
        assert bits(stream.push_block(command[:when])) == bits(command[:when])
        stream.retune(shaper_of(other))


@pytest.mark.parametrize("name", NAMES)
@FEW
@given(plan=changes, value=st.floats(-1e9, 1e9))
def test_at_rest_the_command_comes_out_to_the_last_bit(name: str, plan: Changes, value: float) -> None:
    command = np.concatenate([np.random.default_rng(5).normal(size=500), np.full(900, value)])
    shaped = streamed(name, command, plan)
    longest = max(Stream(shaper_of(one), DT).latency_samples for one in [name, *(one for _, one in plan)])
    assert (shaped[500 + longest :] == value).all()


@settings(max_examples=4)
@given(command=commands(least=20, most=120), plan=changes, name=st.sampled_from(NAMES))
def test_it_is_the_sum_of_the_increments_each_through_its_own_shaper(
    command: NDArray[np.float64], plan: Changes, name: str
) -> None:
    """Against rational arithmetic, to the rounding of the result and of each part."""
    plan = [(when % command.size, other) for when, other in plan]
    shaped, expected = streamed(name, command, plan), exactly(name, command, plan)
    magnitude = max(shaper_of(one).magnitude for one in [name, *(other for _, other in plan)])
    allowed = 2.0 * magnitude * np.spacing(np.abs(command).max())
    assert max(abs(float(Fraction(a) - b)) for a, b in zip(shaped.tolist(), expected, strict=True)) <= allowed


@pytest.mark.skipif(compiled is None, reason="no compiler was there at the installation")
@pytest.mark.parametrize("name", NAMES)
@FEW
@given(command=commands(), plan=changes)
def test_both_kernels_scatter_to_the_same_bits(name: str, command: NDArray[np.float64], plan: Changes) -> None:
    outputs = []
    for parameter in ENGINES:
        engine: EngineLike = parameter.values[0](1, (taps_of(shaper_of(name), DT),))
        at, parts = 0, []
        for when, other in sorted(plan):
            parts.append(run(engine, command[at:when]))
            engine.retune(0, *taps_of(shaper_of(other), DT))
            parts.append(engine.save(0, 0))
            at = max(at, when)
        outputs.append(b"".join([*(bytes(part) for part in parts), run(engine, command[at:]).tobytes()]))
    assert outputs[0] == outputs[1]


@pytest.mark.parametrize("kernel", ENGINES)
def test_a_saved_changing_stream_goes_on_with_the_same_bits(kernel: type) -> None:
    taps = [taps_of(shaper_of(name), DT) for name in ("direct, order 1", "zvdd", "mzv")]
    command = np.random.default_rng(6).normal(size=900)
    engine = kernel(1, (taps[0],))
    for part, fresh in zip(np.split(command[:600], 2), taps[1:], strict=True):
        run(engine, part)
        engine.retune(0, *fresh)
        again = kernel(1, (fresh,))
        again.load(0, 0, engine.scattering(0), engine.save(0, 0))
        assert again.save(0, 0) == engine.save(0, 0)
    assert bits(run(again, command[600:])) == bits(run(engine, command[600:]))


def test_the_shaper_in_force_is_bit_for_bit_the_batch_again_after_a_reset() -> None:
    stream = Stream(shaper_of("zvd"), DT)
    stream.push_block(np.random.default_rng(7).normal(size=50))
    stream.retune(shaper_of("direct, order 2"))
    stream.push_block(np.ones(30))
    stream.reset(2.0)
    command = np.random.default_rng(8).normal(size=400)
    expected = shaper_of("direct, order 2").shape(command, DT, initial=2.0)[:400]
    assert bits(stream.push_block(command)) == bits(expected)


def test_retuning_to_the_same_shaper_changes_rounding_only() -> None:
    stream, shaper = Stream(shaper_of("zvd"), DT), shaper_of("zvd")
    command = np.cumsum(np.random.default_rng(9).normal(size=1000))
    parts = []
    for part in np.split(command, 20):
        parts.append(stream.push_block(part))
        stream.retune(shaper)
    np.testing.assert_allclose(
        np.concatenate(parts), shaper.shape(command, DT)[:1000], atol=1e-14 * np.abs(command).max()
    )


def test_a_row_of_shapers_is_retuned_one_by_one() -> None:
    zvd, ei, mzv = shaper_of("zvd"), shaper_of("ei 5 %"), shaper_of("mzv")
    row = Stream([zvd, mzv], DT, axes=2)
    first, second = Stream(zvd, DT), Stream(mzv, DT)
    command = np.random.default_rng(10).normal(size=300)
    got = [row.push_block([command[:100], -command[:100]])]
    row.retune([ei, mzv])
    got.append(row.push_block([command[100:], -command[100:]]))
    expected = first.push_block(command[:100])
    first.retune(ei)
    expected = second.push_block(np.concatenate([expected, first.push_block(command[100:])]))
    both = np.concatenate(got, axis=1)
    assert bits(both[0]) == bits(expected)
    np.testing.assert_array_equal(both[1], -expected)


@pytest.mark.slow
@pytest.mark.skipif(compiled is None, reason="a hundred million samples need the kernel in C")
def test_nothing_drifts_in_a_hundred_million_samples() -> None:
    """A command that never rests, with a retune every million samples: at the end it comes out to the last bit."""
    stream = Stream(shaper_of("zvd"), DT)
    names = ["zvd", "direct, order 1", "ei 5 %"]
    random = np.random.default_rng(11)
    pattern = random.normal(size=1_000_000)
    out = np.empty_like(pattern)
    for turn in range(100):
        stream.retune(shaper_of(names[turn % 3]))
        stream.push_block(pattern, out=out)
    before_rest = Stream.from_state(stream.state)
    fresh = Stream(shaper_of(names[99 % 3]), DT)
    fresh.retune(shaper_of(names[99 % 3]))
    fresh.push_block(pattern)
    tail = random.normal(size=300)
    assert bits(before_rest.push_block(tail)) == bits(fresh.push_block(tail))  # what came before has left no trace
    stream.push_block(np.full(stream.latency_samples, 0.1))
    assert (stream.push_block(np.full(1000, 0.1)) == 0.1).all()


def test_a_shorter_and_a_longer_shaper_may_follow_each_other() -> None:
    short, long = Shaper([0.0], [1.0]), design.zvdd((0.05, 0.0))
    stream = Stream(short, DT)
    assert stream.push(3.0) == 3.0
    stream.retune(long)
    assert stream.push(3.0) == 3.0
    stream.push(7.0)
    stream.retune(short)
    assert stream.latency_samples == 0
    assert stream.push(8.0) < 8.0  # the step to 7 is still on its way
    assert stream.push_block(np.full(5000, 8.0))[-1] == 8.0
