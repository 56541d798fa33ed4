"""A shaper that follows its modes: optimal at each change, no step, exact rest, one law for samples and blocks."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.stream.streams import ENGINES, bits, commands, run, taps_of

from preshape import Design, Modes, Shaper, design
from preshape.engine import is_proved_shortest
from preshape.errors import InputError
from preshape.kernel import EngineLike, compiled
from preshape.stream import Stream, Tracked
from preshape.stream import tracking as module
from preshape.vibration import residual_vibration

FEW = settings(max_examples=8)
DT = 0.013
MODES = Modes([(1.0, 0.02), (2.7, 0.05), (4.1, 0.0)])
FIRST = design.direct(MODES)

changes = st.lists(st.tuples(st.integers(0, 400), st.floats(-0.2, 0.2)), min_size=1, max_size=4)


def moved(by: float) -> Modes:
    """All modes `by` a part higher, the second mode a little less."""
    return Modes(
        [(mode.frequency * (1.0 + by * (0.9 if k == 1 else 1.0)), mode.damping) for k, mode in enumerate(MODES)]
    )


def streamed(stream: Stream, command: NDArray[np.float64], plan: list[tuple[int, float]]) -> NDArray[np.float64]:
    parts, at = [], 0
    for when, by in sorted(plan):
        parts.append(stream.push_block(command[at:when]))
        stream.track(moved(by))
        at = max(at, when)
    return np.concatenate([*parts, stream.push_block(command[at:])])


def test_along_a_sweep_every_shaper_is_proved_shortest_and_leaves_nothing_at_the_modes_of_its_time() -> None:
    stream = Stream(FIRST, DT)
    for k in range(1, 41):
        wanted = moved(0.2 * math.sin(0.2 * k))
        found = stream.track(wanted)
        assert found.changed and found.mismatch == 0.0 and found.shaper.design.modes == wanted
        assert found.shaper.design.status == "optimal" and is_proved_shortest(found.shaper)
        assert found.shaper.duration == pytest.approx(design.direct(wanted).duration, rel=1e-9)
        frequencies, dampings = zip(*((mode.frequency, mode.damping) for mode in wanted), strict=True)
        assert residual_vibration(found.shaper, frequencies, dampings).max() < 1e-11
        assert stream.latency == pytest.approx(found.shaper.duration, abs=DT)


@FEW
@given(plan=changes, value=st.floats(-1e9, 1e9))
def test_at_rest_a_change_moves_nothing_to_the_last_bit(plan: list[tuple[int, float]], value: float) -> None:
    stream, command = Stream(FIRST, DT), np.full(500, value)
    stream.reset(value)
    assert bits(streamed(stream, command, plan)) == bits(command)


@FEW
@given(plan=changes, value=st.floats(-1e9, 1e9), seed=st.integers(0, 99))
def test_at_the_end_the_command_comes_out_to_the_last_bit(
    plan: list[tuple[int, float]], value: float, seed: int
) -> None:
    command = np.concatenate([np.random.default_rng(seed).normal(size=400), np.full(400, value)])
    assert (streamed(Stream(FIRST, DT), command, plan)[600:] == value).all()


@FEW
@given(command=commands(), when=st.integers(0, 500), by=st.floats(-0.2, 0.2))
def test_a_change_steps_by_no_more_than_the_command_and_what_must_be_caught_up(
    command: NDArray[np.float64], when: int, by: float
) -> None:
    """The exact bound of decision 0010, from the two shapers' step responses."""
    stream = Stream(FIRST, DT)
    shaped = [stream.push_block(command[:when])]
    fresh = stream.track(moved(by)).shaper
    shaped.append(stream.push_block(command[when:]))
    size = 1 + max(int(shaper.taps(DT)[0][-1]) for shaper in (FIRST, fresh))
    old, new = (np.cumsum(np.bincount(*shaper.taps(DT), size)) for shaper in (FIRST, fresh))
    bound = max(1.0, float((1.0 - old + new).max())) * np.abs(np.diff(command, prepend=0.0)).max()
    steps = np.abs(np.diff(np.concatenate(shaped), prepend=0.0))
    assert steps.max() <= bound + 2.0 * np.spacing(np.abs(command).max())


@FEW
@given(command=commands(least=20), plan=changes, chunk=st.integers(1, 50))
def test_samples_blocks_and_a_stream_that_was_saved_between_give_the_same_bits(
    command: NDArray[np.float64], plan: list[tuple[int, float]], chunk: int
) -> None:
    plan = [(when % command.size, by) for when, by in plan]
    whole = streamed(Stream(FIRST, DT), command, plan)
    singly, saved = Stream(FIRST, DT), Stream(FIRST, DT)
    samples = []
    for n, u in enumerate(command.tolist()):
        for by in (by for when, by in sorted(plan) if when == n):
            singly.track(moved(by))
        samples.append(singly.push(u))
    assert bits(samples) == bits(whole)
    again = []
    for start in range(0, command.size, chunk):
        end = min(start + chunk, command.size)
        saved = Stream.from_state(saved.state)
        inside = [(when - start, by) for when, by in plan if start <= when < end]
        again.append(streamed(saved, command[start:end], inside))
    assert bits(np.concatenate(again)) == bits(whole)


@pytest.mark.skipif(compiled is None, reason="no compiler was there at the installation")
@FEW
@given(command=commands(), plan=changes)
def test_both_kernels_follow_with_the_same_bits(command: NDArray[np.float64], plan: list[tuple[int, float]]) -> None:
    outputs = []
    for parameter in ENGINES:
        engine: EngineLike = parameter.values[0](1, (taps_of(FIRST, DT),))
        shaper, at, parts = FIRST, 0, []
        for when, by in sorted(plan):
            parts.append(run(engine, command[at:when]))
            done = module.tracked((shaper,), moved(by), 0.0, True)
            if done.changed:  # what is kept is not touched
                shaper = done.shaper
                engine.retune(0, *taps_of(shaper, DT))
            at = max(at, when)
        outputs.append(np.concatenate([*parts, run(engine, command[at:])]))
    assert bits(outputs[0]) == bits(outputs[1]) == bits(streamed(Stream(FIRST, DT), command, plan))


def test_of_a_step_that_was_commanded_tracking_changes_nothing() -> None:
    """It is one increment, and goes through the shaper of its time."""
    stream, fixed, step = Stream(FIRST, DT), Stream(FIRST, DT), np.full(400, 0.7)
    shaped = [stream.push_block(step[:1])]
    for k in range(1, 400):
        stream.track(moved(0.0005 * min(k, 40)))
        shaped.append(stream.push_block(step[k : k + 1]))
    np.testing.assert_allclose(np.concatenate(shaped), fixed.push_block(step), rtol=0, atol=1e-15)


def test_modes_that_stay_are_a_fixed_stream_bit_for_bit() -> None:
    command = np.random.default_rng(3).normal(size=400)
    tracking, fixed = Stream(FIRST, DT), Stream(FIRST, DT)
    shaped = []
    for u in command.tolist():
        assert tracking.track(MODES) == Tracked(FIRST, "kept", 0.0)
        shaped.append(tracking.push(u))
    assert bits(shaped) == bits(fixed.push_block(command))
    assert tracking.state == fixed.state


@pytest.mark.parametrize("order", [0, 2, [1, 0, 2]])
def test_orders_and_the_preference_stay(order: int | list[int]) -> None:
    stream = Stream(design.direct(MODES, order, prefer="fewest"), DT)
    for by in (0.01, 0.02):
        made = stream.track(moved(by)).shaper.design
        assert made.settings["order"] == order and made.settings["prefer"] == "fewest"
        assert made.certificate is not None


def test_within_the_tolerance_the_shaper_stays_and_slow_drift_still_counts() -> None:
    stream = Stream(FIRST, DT)
    random = np.random.default_rng(1)
    for by in random.uniform(-0.004, 0.004, 20):
        found = stream.track(moved(by), tolerance=0.005)
        assert found.start == "kept" and found.shaper is FIRST
        assert found.mismatch == pytest.approx(abs(by), rel=1e-6)
    starts = [stream.track(moved(0.001 * k), tolerance=0.005).start for k in range(1, 12)]
    assert starts == ["kept"] * 5 + ["near"] + ["kept"] * 5


@pytest.mark.parametrize("by", [1e-9, 1e-6, 1e-4])
def test_without_a_tolerance_the_smallest_change_is_followed(by: float) -> None:
    found = Stream(FIRST, DT).track(moved(by))
    assert found.start == "near" and found.shaper.design.modes == moved(by)


def test_a_damping_ratio_counts_like_a_frequency() -> None:
    found = Stream(FIRST, DT).track([(1.0, 0.03), (2.7, 0.05), (4.1, 0.0)], tolerance=0.02)
    assert found.start == "kept" and found.mismatch == pytest.approx(0.01, rel=1e-3)


FAR = Modes([(1.0, 0.02), (5.4, 0.05), (13.0, 0.0)])


def test_where_newton_does_not_lead_a_search_does_or_the_old_shaper_stays_and_says_so() -> None:
    assert design.direct_near(FIRST, FAR) is None
    command = np.random.default_rng(2).normal(size=300)
    bounded, fixed = Stream(FIRST, DT), Stream(FIRST, DT)
    found = bounded.track(FAR, search=False)
    assert found.start == "missed" and found.shaper is FIRST and not found.changed
    assert found.mismatch == pytest.approx(13.0 / 4.1 - 1.0)
    assert bits(bounded.push_block(command)) == bits(fixed.push_block(command))
    found = bounded.track(FAR)
    assert found.start == "full" and found.shaper.design.modes == FAR and is_proved_shortest(found.shaper)
    assert bounded.track(FAR, search=False).start == "kept"


def test_after_a_search_in_another_thread_tracking_goes_on_from_what_was_found() -> None:
    stream = Stream(FIRST, DT)
    assert stream.track(FAR, search=False).start == "missed"
    stream.retune(design.direct(FAR))
    near = [(mode.frequency * 1.001, mode.damping) for mode in FAR]
    assert stream.track(near, search=False).start == "near"


def test_a_shaper_without_proof_is_followed_by_searching() -> None:
    """Where the search itself finds no proof, the loop goes on: it searches again, or keeps what it has."""
    unproved = Shaper(FIRST.times, FIRST.amplitudes, Design("direct", MODES, {"order": 1, "gap": 0.1}, "feasible"))
    stream = Stream(unproved, DT)
    assert stream.track(moved(0.01), search=False).start == "missed"
    assert stream.track(moved(0.01)).start == "full"
    assert stream.track(moved(0.02)).start == "near"


@pytest.mark.parametrize(
    ("make", "modes", "sentence"),
    [
        (lambda: design.zvd(MODES), MODES, "make it with a shaper of design.direct"),
        (lambda: design.on_grid(FIRST, DT, "exact"), MODES, "not moved to a grid"),
        (lambda: [FIRST, FIRST], MODES, "2 shapers in a row"),
        (lambda: FIRST, [(1.0, 0.0)], "1 modes are to be tracked, the shaper in force is for 3"),
        (lambda: FIRST, [(math.nan, 0.0), (2.0, 0.0), (3.0, 0.0)], "not a natural frequency"),
        (lambda: FIRST, "modes", "is not a mode"),
        (lambda: FIRST, [], "no mode was given"),
    ],
)
def test_what_cannot_be_followed_is_refused_and_the_stream_goes_on(make, modes, sentence: str) -> None:
    stream, fixed = Stream(make(), DT), Stream(make(), DT)
    with pytest.raises(InputError, match=sentence):
        stream.track(modes)
    with pytest.raises(InputError):
        stream.track(modes, tolerance=math.nan)
    command = np.random.default_rng(4).normal(size=100)
    assert bits(stream.push_block(command)) == bits(fixed.push_block(command))


def test_a_saved_stream_that_cannot_track_says_so_until_it_is_retuned() -> None:
    stream = Stream.from_state(Stream(design.zvd(MODES), DT).state)
    with pytest.raises(InputError, match="the saved stream had no shaper that can be tracked"):
        stream.track(MODES)
    stream.retune(FIRST)
    assert stream.track(MODES).start == "kept"


def test_a_state_whose_shaper_is_not_the_one_that_shapes_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = Stream(FIRST, DT)
    monkeypatch.setattr(stream, "_shapers", (design.direct(moved(0.1)),))
    with pytest.raises(InputError, match="another shaper than it shapes with"):
        Stream.from_state(stream.state)
