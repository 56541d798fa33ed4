"""Exact motion: any modes and profile against the matrix exponential; the extremum against dense samples."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from preshape.errors import InputError
from preshape.kernel import driven_extremum
from preshape.mode import Mode
from preshape.plant import ModalPlant, Motion, Output, exact_motion
from preshape.profile import Profile

dampings = st.one_of(st.just(0.0), st.floats(1e-4, 0.9))
modes = st.lists(st.tuples(st.floats(0.2, 8.0), dampings), min_size=1, max_size=4, unique=True)
steps = st.lists(
    st.tuples(st.floats(0.0, 2.0), st.floats(-3.0, 3.0), st.integers(0, 3)), min_size=1, max_size=8
).filter(lambda steps: sum(abs(jump) for _, jump, _ in steps) > 0.1)


def profile_of(steps: list[tuple[float, float, int]]) -> Profile:
    times, jumps, orders = zip(*sorted(steps), strict=True)
    return Profile(np.array(times), np.array(jumps), np.array(orders))


def ending_at_rest(rows: list[tuple[float, float, int]]) -> Profile:
    """Staircases, each smoothed as often as its order says, so that all ends at a constant level."""
    steps = []
    for time, jump, order in rows:
        smoothed = [(time, jump, order)]
        for gap in (1.0, 0.37, 0.11)[:order]:
            slopes = [(t, j / gap, n) for t, j, n in smoothed]
            smoothed = slopes + [(t + gap, -j, n) for t, j, n in slopes]
        steps += smoothed
    return profile_of(steps)


def by_matrix_exponential(mode: Mode, profile: Profile, force: float, driven_by: int, looks: np.ndarray) -> np.ndarray:
    """(x, x', X, X') of one mode and a rigid body at `looks`, state by state; turns of at most a radian."""
    w, z, size = mode.omega, mode.damping, 8
    system = np.zeros((4 + size, 4 + size))
    system[0, 1] = system[2, 3] = 1.0
    system[1, :2] = -(w**2), -2.0 * z * w
    system[1, 4 + driven_by] = force
    system[3, 4] = 1.0
    system[4:, 4:] = np.diag(np.ones(size - 1), 1)

    def advance(state: np.ndarray, gap: float) -> np.ndarray:
        turns = max(1, math.ceil(w * gap))
        return np.asarray(np.linalg.matrix_power(expm(system * (gap / turns)), turns) @ state)

    state, now, expected, events = (
        np.zeros(4 + size),
        0.0,
        {},
        sorted(zip(profile.times, profile.jumps, profile.orders, strict=True)),
    )
    for look in sorted(looks):
        while events and events[0][0] <= look:
            time, jump, order = events.pop(0)
            state, now = advance(state, time - now), time
            state[4 + order] += jump
            if order < driven_by:  # an impulse in the driving derivative kicks the rate; a doublet, see the docstring
                kick = force * jump
                state[:2] += [0.0, kick] if driven_by - order == 1 else [kick, -2.0 * z * w * kick]
        expected[look] = advance(state, look - now)[:4]
    return np.array([expected[look] for look in looks]).T


@settings(max_examples=40)
@given(modes, steps, st.integers(0, 2))
def test_any_plant_and_profile_agree_with_the_matrix_exponential(
    given_modes: list[tuple[float, float]], rows: list[tuple[float, float, int]], driven_by: int
) -> None:
    profile = profile_of(rows)
    forces = np.linspace(1.0, -0.5, len(given_modes))
    motion = exact_motion(given_modes, profile, forces=forces, driven_by=driven_by, rigid=0.7)
    looks = np.array([0.0, 0.3, 0.77, 1.6, 2.3, 4.0])
    for k, (pair, force) in enumerate(zip(given_modes, forces, strict=True)):
        unit = [float(j == k) for j in range(len(given_modes))]
        x, v, rigid, speed = by_matrix_exponential(Mode(*pair), profile, force, driven_by, looks)
        for output, expected in [
            (Output(unit), x),
            (Output(velocity=unit), v),
            (Output(rigid=1.0), 0.7 * rigid),
            (Output(rigid_velocity=2.0), 1.4 * speed),
            (Output(unit, rigid=1.0, command=-1.0), x + 0.7 * rigid - profile(looks)),
        ]:
            np.testing.assert_allclose(
                motion(output, looks), expected, rtol=0, atol=2e-11 * (1 + np.abs(expected).max())
            )


@settings(max_examples=60)
@given(modes, steps)
def test_nothing_between_samples_is_missed(given_modes: list[tuple[float, float]], rows: list) -> None:
    motion = exact_motion(given_modes, ending_at_rest(rows), forces=[m[0] ** 2 for m in given_modes])
    output = Output(np.linspace(1.0, -2.0, len(given_modes)))
    found, high, low = motion.peak(output), motion.highest(output), motion.lowest(output)
    assert found.value == max(high.value, -low.value)
    times = np.linspace(0.0, motion.end_time + 6.0, 20001)
    values = motion(output, times)
    scale = 1e-13 * np.abs(values).max()
    assert low.value - scale <= values.min() and values.max() <= high.value + scale
    if found.value > scale:
        # Where it says it is, it is: just before a step of the command if the output jumps there.
        beside = np.abs(motion(output, found.time + np.array([0.0, -1e-12])))
        assert np.abs(beside - found.value).min() <= 1e-9 * found.value
        assert found.bound >= found.value
        if found.bound > found.value:  # a mode that rings for ever, and others: the largest is approached, not reached
            assert len(given_modes) > 1 and min(damping for _, damping in given_modes) == 0.0
    # And it is no more than samples allow: between two of them a curve rises by h^2 / 8 max|y''| at most.
    if found.time <= times[-1]:
        bend = np.abs(motion(output, times, 2)).max() * 1.05 + scale
        assert found.value <= np.abs(values).max() + (times[1] - times[0]) ** 2 / 8 * bend * 4 + scale


def test_the_extremum_does_not_depend_on_where_samples_fall() -> None:
    # Delaying the command moves all first samples; the extremum must stay the same to rounding.
    plant, out = [(0.31, 0.0), (1.7, 0.02), (6.1, 0.005)], Output((1.0, 0.9, 0.8))
    values = []
    for delay in np.linspace(0.0, 0.37, 9):
        command = Profile.steps(np.array([0.0, 0.9, 2.2, 3.3]) + delay, [1.0, -2.0, 2.0, -1.0])
        values.append(exact_motion(plant, command, forces=[4.0, 110.0, 1500.0]).peak(out).value)
    np.testing.assert_allclose(values, values[0], rtol=1e-13)


@pytest.mark.parametrize("density", [1, 3, 50])
def test_the_extremum_does_not_depend_on_how_many_samples_begin_the_search(
    density: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = Profile.steps([0.0, 0.4, 1.3, 2.9], [2.0, -5.0, 4.0, -1.0], order=1)
    motion = exact_motion([(0.5, 0.01), (2.3, 0.0), (11.0, 0.001)], command, forces=[10.0, 90.0, 900.0])
    for output in (Output((1.0, -0.7, 0.5)), Output((0.1, 0.0, 3.0)), Output(velocity=(0.1, 0.1, -0.1))):
        expected = motion.peak(output)
        with monkeypatch.context() as patch:
            patch.setattr(driven_extremum, "SAMPLES_PER_PERIOD", density)
            found = motion.peak(output)
        assert found.value == pytest.approx(expected.value, rel=1e-13)
        assert found.time == pytest.approx(expected.time, rel=1e-6)


def test_the_extremum_of_one_undamped_mode_is_in_the_closed_form() -> None:
    # A pulse of duration p on w = 2 pi f: x rings with 2 |sin(w p / 2)| after it; during it 1 - cos w t.
    for pulse, expected in [(0.1, 2 * math.sin(math.pi * 0.1)), (0.3, 2 * math.sin(0.3 * math.pi)), (0.7, 2.0)]:
        motion = ModalPlant((1.0, 0.0)).motion(Profile.steps([0.0, pulse], [1.0, -1.0]))
        found = motion.peak("output")
        assert found.value == pytest.approx(expected, rel=1e-14) and found.bound == found.value
        assert motion.residual("output") == pytest.approx(2 * abs(math.sin(math.pi * pulse)), rel=1e-13)


def test_endless_vibration_of_two_modes_is_bounded_not_guessed() -> None:
    motion = exact_motion([(1.0, 0.0), (math.sqrt(2.0), 0.0)], Profile.steps([0.0, 0.01], [1.0, -1.0]))
    output = Output((1.0, 1.0))
    found = motion.peak(output)
    assert found.value < found.bound == pytest.approx(motion.residual(output), rel=1e-12)
    assert found.value > 0.99 * found.bound  # 64 periods come as near as that
    damped = exact_motion([(1.0, 1e-3), (math.sqrt(2.0), 1e-3)], Profile.steps([0.0, 0.01], [1.0, -1.0])).peak(output)
    assert damped.value == damped.bound


def test_what_grows_for_ever_has_no_peak() -> None:
    motion = exact_motion((1.0, 0.1), Profile.steps([0.0, 1.0], [1.0, -1.0]), rigid=1.0)
    assert motion.peak(Output(rigid=1.0)).value == math.inf
    assert motion.lowest(Output((0.0,), rigid=1.0)).value == 0.0
    assert motion.highest(Output((5.0,), rigid=-1.0)).bound < math.inf
    assert motion.settling_time(Output(rigid=1.0), 0.1) == math.inf


def test_steps_of_rounding_do_not_drift_to_infinity() -> None:
    times = np.cumsum([0.0, 0.1, 0.7, 0.3, 0.3, 0.7, 0.1])
    jumps = np.array([0.1, 0.2, -0.6, 0.6, -0.6, 0.2, 0.1])
    motion = exact_motion(None, Profile.steps(times, jumps - jumps.sum() / 7), rigid=3.0)
    speed = motion(Output(rigid_velocity=1.0), [times[-1], 1e6])
    assert speed[0] == speed[1]


def test_no_command_no_motion() -> None:
    motion = exact_motion((1.0, 0.1), Profile([], [], []), outputs={"x": Output((1.0,), rigid=1.0)}, rigid=1.0)
    assert motion("x", [0.0, 3.0]).tolist() == [0.0, 0.0]
    assert motion.peak("x").value == motion.residual("x") == motion.settling_time("x", 1.0) == motion.end_time == 0.0
    assert motion.residual_amplitudes.tolist() == [0.0]


def test_a_modal_plant_moves_as_its_samples_do() -> None:
    dt, levels = 2e-3, np.random.default_rng(3).normal(size=120)
    for drive in ("position", "acceleration"):
        plant = ModalPlant([(4.0, 0.1), (9.0, 0.0)], [[1.0, 0.5], [0.0, 1.0]], drive=drive)  # type: ignore[arg-type]
        sampled = plant.response(levels, dt)
        motion = plant.motion(Profile.steps(np.arange(120) * dt, np.diff(levels, prepend=0.0)))
        for k in (0, 1):
            mine = motion(f"output {k + 1}", sampled.times)
            np.testing.assert_allclose(mine, sampled.output[k], rtol=0, atol=1e-12 * np.abs(sampled.output[k]).max())
            assert motion.residual(f"output {k + 1}") == pytest.approx(sampled.output_residual[k], rel=1e-10)
        np.testing.assert_allclose(motion.residual_amplitudes, sampled.residual_amplitudes, rtol=1e-10)


@settings(max_examples=40)
@given(modes, steps, st.floats(0.02, 0.5))
def test_settled_is_when_it_stays_within(given_modes: list[tuple[float, float]], rows: list, part: float) -> None:
    damped = [(f, max(z, 0.05)) for f, z in given_modes]
    if len(set(damped)) < len(damped):
        damped = damped[:1]
    motion = exact_motion(damped, ending_at_rest(rows), forces=[f**2 for f, _ in damped])
    output = Output(np.ones(len(damped)))
    rest = motion(output, [1e4])[0]
    within = part * motion.peak(output).value
    if within < 1e-6:
        return
    settled = motion.settling_time(output, within)
    later = settled + np.concatenate([np.geomspace(1e-9, 1.0, 200), np.linspace(1.0, 20.0, 2000)])
    assert (np.abs(motion(output, later) - rest) <= within * (1 + 1e-9)).all()
    if settled > 0.0:
        before = np.abs(motion(output, settled + np.array([0.0, -1e-9, 1e-12])) - rest)
        assert before.max() >= within * (1 - 1e-6)


def test_wrong_input_is_named() -> None:
    motion = exact_motion((1.0, 0.1), Profile.steps([0.0], [1.0]), outputs={"deflection": Output((1.0,))})
    with pytest.raises(InputError, match="'tip'.*has deflection"):
        motion.peak("tip")
    with pytest.raises(InputError, match="derivative is 4"):
        motion("deflection", 0.0, 4)
    with pytest.raises(InputError, match="finite times"):
        motion("deflection", [math.nan])
    with pytest.raises(InputError, match="displacement has 2"):
        motion.peak(Output((1.0, 2.0)))
    with pytest.raises(InputError, match="within is 0"):
        motion.settling_time("deflection", 0.0)
    with pytest.raises(InputError, match="forces has 2"):
        exact_motion((1.0, 0.1), Profile.steps([0.0], [1.0]), forces=[1.0, 2.0])
    assert isinstance(motion, Motion)


@pytest.mark.parametrize("damping", [1e-3, 1e-6, 1e-8])
def test_slow_decay_is_followed_from_its_end(damping: float) -> None:
    motion = ModalPlant((1.0, damping)).motion(Profile.steps([0.0], [1.0]))
    settled = motion.settling_time("output", 0.02)
    envelope = math.log(50.0) / (damping * 2.0 * math.pi)
    assert envelope - 1.0 < settled <= envelope * (1.0 + 1e-9)


def test_what_rings_for_ages_is_refused_not_followed() -> None:
    motion = ModalPlant((1.0, 1e-30)).motion(Profile.steps([0.0], [1.0]))
    with pytest.raises(InputError, match=r"too many periods to follow: give a wider band"):
        motion.settling_time("output", 0.02)
