"""Commands known in advance: at the limit and not beyond it, not late, and as still afterwards as the shaper promises.

Peaks are checked against sums of delayed copies on a fine grid, rest against a plant, delays against closed forms.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from tests.laws import FAMILIES, Family

from preshape import Modes, Profile, Shaper, design
from preshape.command import cycloidal, s_curve, trapezoid
from preshape.command.known import acceleration_error, advanced, fastest_within, rescaled, through_samples
from preshape.errors import InputError
from preshape.plant import ModalPlant

MODE = (4.0, 0.05)
LIMITS = {"maximum_speed": 0.5, "maximum_acceleration": 5.0, "maximum_jerk": 100.0}
ORDERS = {"speed": 1, "acceleration": 2, "jerk": 3}
BOX = design.sd_zv(MODE, 0.3, "box")
SHAPERS = {
    **{name: design.FAMILIES[name](MODE) for name in ("zv", "zvd", "um_zv", "ps_zv")},
    "box": BOX,
    "direct": design.direct([MODE, (7.0, 0.01)]),
    "held back": design.delayed(design.zvd(MODE), 0.02),
    "none": Shaper([0.0], [1.0]),
}


def move(distance: float) -> Profile:
    profile = s_curve(distance, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001).profile
    assert profile is not None
    return profile


def summed(command: Profile, shaper: Shaper, scale: float, order: int) -> NDArray[np.float64]:
    """A derivative of the shaped slowed command on a fine grid and beside each switch, by the sum over the shaper."""
    edges = [*shaper.times, *(edge for box in shaper.boxes for edge in box[:2])]
    switches = np.add.outer(scale * command.times, edges).ravel()
    grid = np.linspace(0.0, scale * command.end_time + shaper.duration, 8001)
    look = np.concatenate([grid, switches - 1e-12, switches + 1e-12])
    value = np.zeros(look.size)
    for time, amplitude in zip(shaper.times, shaper.amplitudes, strict=True):
        value += amplitude * command((look - time) / scale, order) / scale**order
    for start, end, density in shaper.boxes:
        lower, upper = ((look - edge) / scale for edge in (start, end))
        value += density * (command(lower, order - 1) - command(upper, order - 1)) / scale ** (order - 1)
    return value


def sampled_use(command: Profile, shaper: Shaper, scale: float) -> float:
    """The largest part of a limit that is used, on the grid."""
    return max(
        np.abs(summed(command, shaper, scale, order)).max() / LIMITS[f"maximum_{name}"]
        for name, order in ORDERS.items()
    )


@pytest.mark.parametrize("distance", [0.004, 0.03, 0.3])
@pytest.mark.parametrize("shaper", SHAPERS.values(), ids=SHAPERS)
def test_the_fastest_keeps_the_limits_and_nothing_faster_does(shaper: Shaper, distance: float) -> None:
    command = move(distance)
    found = fastest_within(command, shaper, **LIMITS)
    assert found.shaped.final_value == pytest.approx(distance, rel=1e-12)
    assert found.command.duration == pytest.approx(found.time_scale * command.duration, rel=1e-12)
    used = sampled_use(command, shaper, found.time_scale)
    assert used <= 1.0 + 1e-9
    assert used == pytest.approx(max(found.peaks[name] / limit for name, limit in found.limits.items()), abs=2e-3)
    generator = np.random.default_rng(5)
    for faster in np.concatenate([[1e-6], generator.uniform(1e-4, 0.7, 60)]):
        assert sampled_use(command, shaper, found.time_scale * (1.0 - faster)) > 1.0 - 1e-6


@pytest.mark.parametrize(("name", "distance"), [("direct", 0.00632), ("zvd", 0.01001), ("zv", 0.0999)])
def test_a_range_of_faster_scales_behind_one_that_exceeds_the_limits_is_found(name: str, distance: float) -> None:
    """Where copies of a pulse stop overlapping the peaks fall: slower scales exceed the limits, faster ones do not."""
    command, shaper = move(distance), SHAPERS[name]
    found = fastest_within(command, shaper, **LIMITS).time_scale
    uses = [sampled_use(command, shaper, found * scale) for scale in np.arange(0.5, 1.4, 0.005)]
    keeps = np.array(uses) <= 1.0 + 1e-9
    first = int(np.argmax(keeps))
    assert np.arange(0.5, 1.4, 0.005)[first] == pytest.approx(1.0, abs=0.006)
    assert not keeps[first:].all()  # a bisection from the slow side would stop there


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_a_trapezoid_ends_on_its_limit_and_at_rest_for_every_family(family: Family) -> None:
    shaper = family.build(Modes([MODE]))
    command = trapezoid(0.05, maximum_speed=1.0, maximum_acceleration=2.0, dt=0.001).profile
    assert command is not None
    found = fastest_within(command, shaper, maximum_speed=0.5)
    assert found.binding == "speed" and found.used == pytest.approx(1.0, abs=1e-9)
    if family.order >= 0:
        plant = ModalPlant(MODE)
        assert plant.motion(found.command).residual("output") > 1e-6
        assert plant.motion(found.shaped).residual("output") < 1e-12
    if not family.negative:
        assert found.saved >= -1e-12


def test_without_a_shaper_it_is_the_command_at_its_limits() -> None:
    for distance in (0.004, 0.3):
        found = fastest_within(move(distance), Shaper([0.0], [1.0]), **LIMITS)
        assert found.time_scale == pytest.approx(1.0, rel=1e-12) and abs(found.saved) < 1e-12
    slower = fastest_within(move(0.3), Shaper([0.0], [1.0]), maximum_acceleration=5.0 / 4.0)
    assert slower.time_scale == pytest.approx(2.0, rel=1e-12)


def test_what_is_saved_and_what_is_not() -> None:
    """Two equal pulses half a period apart, shorter than that: the peaks are halved, the time shrinks by the root."""
    pulses = Profile.steps([0.0, 0.02, 0.04], [1.0, -2.0, 1.0], order=2)
    found = fastest_within(pulses, design.zv((4.0, 0.0)), maximum_acceleration=1.0)
    assert found.time_scale == pytest.approx(math.sqrt(0.5), rel=1e-12)
    assert found.saved == pytest.approx(0.04 * (1.0 - math.sqrt(0.5)), rel=1e-12)
    # Where the shaped move cruises at the speed limit there is nothing to save, and negative impulses cost time.
    assert fastest_within(move(0.3), design.zvd(MODE), **LIMITS).saved == pytest.approx(0.0, abs=1e-12)
    assert fastest_within(move(0.03), design.um_zv(MODE), **LIMITS).saved < -0.01


def test_a_jump_of_the_peak_is_said() -> None:
    """Where copies of pulses begin to overlap, the jerk jumps over the limit: below it here, above it just beside."""
    command, shaper = move(0.05), design.um_zv(MODE)
    found = fastest_within(command, shaper, **LIMITS)
    assert found.binding == "jerk" and found.used < 0.9
    assert sampled_use(command, shaper, found.time_scale) == pytest.approx(found.used, rel=1e-9)
    assert sampled_use(command, shaper, found.time_scale * (1.0 - 1e-6)) > 1.1


def test_a_box_lets_a_trapezoid_keep_a_jerk_limit() -> None:
    command = trapezoid(0.05, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.001).profile
    assert command is not None
    smooth = Shaper([0.0], [0.0], boxes=[(0.0, 0.1, 10.0)])
    found = fastest_within(command, smooth, maximum_jerk=100.0)
    assert found.binding == "jerk" and found.used == pytest.approx(1.0, abs=1e-9)
    assert math.isinf(found.saved)  # unshaped it keeps the limit nowhere
    with pytest.raises(InputError, match="infinite jerk"):
        fastest_within(command, design.zvd(MODE), maximum_jerk=100.0)
    with pytest.raises(InputError, match="none of them binds"):
        fastest_within(command, smooth, maximum_speed=1.0)


def test_samples_of_a_smooth_move_become_its_profile() -> None:
    smooth = cycloidal(0.1, duration=0.4, dt=0.001)
    profile = through_samples(smooth.values, 0.001)
    assert profile.final_value == pytest.approx(0.1, rel=1e-12)
    assert profile.peak(1).value == pytest.approx(2.0 * 0.1 / 0.4, rel=1e-5)
    assert profile.peak(2).value == pytest.approx(2.0 * math.pi * 0.1 / 0.4**2, rel=1e-3)
    np.testing.assert_allclose(profile(smooth.times), smooth.values, atol=1e-8)
    found = fastest_within(profile, design.zvd(MODE), maximum_speed=0.4, maximum_acceleration=4.0)
    assert found.used == pytest.approx(1.0, abs=1e-9) and found.saved > 0.0
    assert ModalPlant(MODE).motion(found.shaped).residual("output") < 1e-12


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.name)
def test_rescaled_is_at_the_limit_and_as_still(family: Family) -> None:
    """Singer & Seering, 2.4, for exact commands and samples."""
    shaper = family.build(Modes([MODE]))
    force = Profile.steps([0.0, 0.07, 0.2], [5.0, -10.0, 5.0])
    found = rescaled(force, shaper, 5.0)
    assert isinstance(found.shaped, Profile)
    look = np.linspace(-0.1, 0.2 + shaper.duration, 20001)
    assert np.abs(found.shaped(look)).max() == pytest.approx(5.0, rel=1e-9)
    np.testing.assert_allclose(found.shaped(look), found.factor * shaper.shape(force)(look), atol=1e-12)
    if not family.negative:
        assert found.shaped_peak <= 5.0 * (1.0 + 1e-12) and found.gain >= 1.0 - 1e-12
    assert found.gain == pytest.approx(found.factor, rel=1e-12)  # the unshaped one was at the limit
    if family.order >= 0:
        assert ModalPlant(MODE).motion(found.shaped).residual("output") < 1e-11
    samples = rescaled(force.sample(0.001), shaper, 2.0, 0.001)
    assert np.abs(samples.shaped).max() == pytest.approx(2.0, rel=1e-12)  # type: ignore[arg-type]


@pytest.mark.parametrize("shaper", SHAPERS.values(), ids=SHAPERS)
def test_a_ramp_is_not_late_and_a_parabola_ahead_by_half_the_second_moment(shaper: Shaper) -> None:
    centre, bend = shaper.centroid, acceleration_error(shaper)
    numbers = [(t, a) for t, a in zip(shaper.times, shaper.amplitudes, strict=True)]
    grains = 100_000
    for start, end, density in shaper.boxes:
        width = (end - start) / grains
        numbers += [(start + width * (k + 0.5), density * width) for k in range(grains)]
    assert bend == pytest.approx(0.5 * math.fsum(a * (t - centre) ** 2 for t, a in numbers), rel=1e-9, abs=1e-18)
    ramp, parabola = Profile.steps([0.0], [0.7], order=1), Profile.steps([0.0], [3.0], order=2)
    late = np.linspace(shaper.duration, shaper.duration + 2.0, 37)
    followed, bent = advanced(ramp, shaper), advanced(parabola, shaper)
    assert isinstance(followed.shaped, Profile) and isinstance(bent.shaped, Profile)
    np.testing.assert_allclose(followed.shaped(late), ramp(late), atol=2e-14)
    np.testing.assert_allclose(bent.shaped(late) - parabola(late), 3.0 * bend, atol=1e-13)
    assert followed.start == pytest.approx(-centre + (shaper.times[0] if shaper.amplitudes[0] else 0.0), abs=0.021)
    assert followed.speed_error == 0.0 and followed.acceleration_error == bend
    partly = advanced(ramp, shaper, by=0.25 * centre)
    np.testing.assert_allclose(ramp(late) - partly.shaped(late), 0.7 * partly.speed_error, atol=2e-14)  # type: ignore[operator]


@pytest.mark.parametrize("dt", [0.001, 0.0037])
@pytest.mark.parametrize("shaper", SHAPERS.values(), ids=SHAPERS)
def test_samples_are_those_of_the_straight_lines_between_them(shaper: Shaper, dt: float) -> None:
    """Between samples too: the advance is no whole number of them."""
    generator = np.random.default_rng(2)
    values = np.concatenate([[0.0], np.cumsum(generator.normal(size=80))])
    slopes = np.diff(values) / dt
    joined = Profile.steps(np.arange(81) * dt, np.diff(slopes, prepend=0.0, append=0.0), order=1)
    found, exact = advanced(values, shaper, dt), advanced(joined, shaper)
    times = found.start + np.arange(found.shaped.size) * dt  # type: ignore[union-attr]
    assert found.start <= -shaper.centroid + 1e-12 and found.start > -shaper.centroid - dt
    # A box's share of each sample is exact only for edges on samples, as for Shaper.taps.
    slack = 1e-12 if not shaper.boxes else 0.05
    np.testing.assert_allclose(found.shaped, exact.shaped(times), atol=slack * np.abs(values).max())  # type: ignore[operator]
    ramp = advanced(np.arange(400) * dt, shaper, dt, initial=0.0)
    inside = slice(math.ceil(2 * shaper.duration / dt) + 2, 390)
    clock = ramp.start + np.arange(ramp.shaped.size) * dt  # type: ignore[union-attr]
    np.testing.assert_allclose(ramp.shaped[inside], clock[inside], atol=1e-13)  # type: ignore[index]


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=8), st.sampled_from(["zv", "zvd", "direct", "box"]))
def test_the_error_is_within_the_largest_acceleration_times_half_the_second_moment(
    accelerations: list[float], name: str
) -> None:
    """For positive shapers, whatever the command does: Taylor's remainder under the mean."""
    command = Profile.steps(np.arange(len(accelerations)) * 0.08, np.diff(accelerations, prepend=0.0), order=2)
    shaper = SHAPERS[name]
    found = advanced(command, shaper)
    look = np.linspace(-1.0, 2.0, 401)
    largest = max(abs(a) for a in accelerations)
    error = np.abs(found.shaped(look) - command(look)).max()  # type: ignore[operator]
    assert error <= largest * acceleration_error(shaper) * (1.0 + 1e-9) + 1e-13


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: fastest_within(move(0.1), SHAPERS["zv"]), "no limit was given"),
        (lambda: fastest_within(move(0.1), SHAPERS["zv"], maximum_speed=0.0), "above 0"),
        (lambda: fastest_within(move(0.1), SHAPERS["zv"], maximum_jerk=math.nan), "finite"),
        (lambda: fastest_within(Profile([], [], []), SHAPERS["zv"], maximum_speed=1.0), "rests or is a step"),
        (lambda: fastest_within(Profile.steps([0.0], [1.0]), BOX, maximum_speed=1.0), "rests or is a step"),
        (lambda: fastest_within(Profile.steps([0.0, 1.0], [1.0, 1.0]), SHAPERS["zv"], maximum_speed=1.0),
         "infinite speed"),
        (lambda: fastest_within(Profile.steps([0.0, 1.0], [1.0, 1.0], 1), SHAPERS["zv"], maximum_speed=1.0),
         "end it at rest"),
        (lambda: fastest_within(np.zeros(5), SHAPERS["zv"], maximum_speed=1.0), "must be a Profile"),
        (lambda: rescaled(Profile([], [], []), SHAPERS["zv"], 1.0), "rests at 0"),
        (lambda: rescaled([0.0, 0.0], SHAPERS["zv"], 1.0, 0.1), "rests at 0"),
        (lambda: rescaled([0.0, math.nan], SHAPERS["zv"], 1.0, 0.1), "NaN"),
        (lambda: rescaled([], SHAPERS["zv"], 1.0, 0.1), "no samples"),
        (lambda: rescaled([1.0], SHAPERS["zv"], 1.0), "need their dt"),
        (lambda: rescaled([1.0], SHAPERS["zv"], -1.0, 0.1), "above 0"),
        (lambda: rescaled(Profile.steps([0.0], [1.0], 1), SHAPERS["zv"], 1.0), "grows for ever"),
        (lambda: advanced([1.0], SHAPERS["zv"]), "need their dt"),
        (lambda: advanced([math.inf], SHAPERS["zv"], 0.1), "infinity"),
        (lambda: advanced([1.0], SHAPERS["zv"], 0.0), "above 0"),
        (lambda: advanced([1.0], SHAPERS["zv"], 0.1, by=-1.0), "0 s or more"),
        (lambda: through_samples([0.0, 1.0], 0.1), "at least 6"),
        (lambda: through_samples([0.0, math.nan] * 4, 0.1), "NaN"),
    ],
)  # fmt: skip
def test_wrong_input_gets_a_sentence(wrong: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        wrong()  # type: ignore[operator]
