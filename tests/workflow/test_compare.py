"""Comparison of commands: each measure against an independent simulation, a closed form or a law."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.signal import lsim

from preshape import design
from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.report import Comparison, Contender
from preshape.workflow import compare

ONE = Modes([(1.2, 0.01)])
TWO = Modes([(1.2, 0.01), (3.4, 0.02)])

MOVES: dict[str, Comparison] = {
    "speed limit": compare(ONE, 0.5, maximum_speed=1.0, maximum_acceleration=5.0),
    "no speed limit": compare(ONE, 0.5, maximum_acceleration=5.0),
    "two modes": compare(TWO, -0.5, maximum_speed=1.0, maximum_acceleration=5.0, gains=[0.8, -0.5]),
    "jerk limit": compare(TWO, 0.5, maximum_speed=1.0, maximum_acceleration=5.0, maximum_jerk=50.0),
    "undamped": compare((0.4, 0.0), 3.0, maximum_acceleration=1.0),
}


def simulated(contender: Contender, modes: Modes, gains: tuple[float, ...], times: NDArray[np.float64]) -> np.ndarray:
    """The deflection by scipy.signal.lsim, driven by the carriage's speed, which has no jumps.

    With y = d' + speed:  d' = y - speed,  y' = -w^2 d - 2 z w (y - speed).
    """
    total = np.zeros(times.size)
    speed = contender.acceleration.integral()(times)
    for mode, gain in zip(modes, gains, strict=True):
        w, c = mode.omega, 2.0 * mode.damping * mode.omega
        system = ([[0.0, 1.0], [-(w**2), -c]], [[-1.0], [c]], [[1.0, 0.0]], [[0.0]])
        total += gain * np.asarray(lsim(system, speed, times)[1]).ravel()
    return total


@pytest.mark.parametrize("move", MOVES)
def test_deflection_is_that_of_an_independent_dense_simulation(move: str) -> None:
    """Straight lines between samples, and looking at samples only, cost about (w dt)^2: 1e-4 here."""
    result = MOVES[move]
    fastest = max(mode.omega for mode in result.modes)
    for one in result.contenders:
        # Two periods after its end undamped modes have shown their peak.
        end = one.acceleration.end_time + 2.0 / min(mode.frequency for mode in result.modes)
        times = np.linspace(0.0, end, math.ceil(100.0 * end * fastest) + 1)
        found = simulated(one, result.modes, result.gains, times)
        assert np.abs(found).max() == pytest.approx(one.peak_deflection, abs=1e-4 * result.reference), one.name


@pytest.mark.parametrize("move", MOVES)
def test_what_is_left_is_the_state_by_matrix_exponentials(move: str) -> None:
    """Exact for staircases of acceleration: the state is carried from step to step by expm, nothing of the library."""
    result, looked_at = MOVES[move], 0
    for one in result.contenders:
        if not one.exact or (one.acceleration.orders != 0).any():
            continue
        looked_at += 1
        amplitude = 0.0
        for mode, gain in zip(result.modes, result.gains, strict=True):
            w, z = mode.omega, mode.damping
            matrix = np.array([[0.0, 1.0, 0.0], [-(w**2), -2.0 * z * w, -1.0], [0.0, 0.0, 0.0]])
            state, before = np.zeros(3), one.acceleration.times[0]
            for time, jump in zip(one.acceleration.times, one.acceleration.jumps, strict=True):
                state = expm(matrix * (time - before)) @ state
                state[2] += jump
                before = time
            x, v = state[0], state[1]
            amplitude += abs(gain) * math.hypot(x, (v + z * w * x) / (w * math.sqrt(1.0 - z**2)))
        assert one.residual == pytest.approx(amplitude, abs=1e-12 * result.reference), one.name
    assert looked_at >= 5 or move == "jerk limit"


@pytest.mark.parametrize("ratio", [0.9, 1.0])
@pytest.mark.parametrize("move", MOVES)
def test_what_any_command_leaves_is_the_state_of_a_dense_simulation(move: str, ratio: float) -> None:
    """Sines and filters too, and with other frequencies than the command was made for."""
    result = MOVES[move]
    at = int(np.argmin(np.abs(result.frequency_ratios - ratio)))
    fastest = max(mode.omega for mode in result.modes)
    for one in result.contenders:
        end = one.acceleration.end_time
        times = np.linspace(0.0, end, math.ceil(100.0 * end * fastest) + 1)
        speed = one.acceleration.integral()(times)
        amplitude = 0.0
        for mode, gain in zip(result.modes, result.gains, strict=True):
            w, z = ratio * mode.omega, mode.damping
            system = ([[0.0, 1.0], [-(w**2), -2.0 * z * w]], [[-1.0], [2.0 * z * w]], np.eye(2), np.zeros((2, 1)))
            d, y = np.asarray(lsim(system, speed, times)[1])[-1]
            envelope = math.hypot(d, (y - speed[-1] + z * w * d) / (w * math.sqrt(1.0 - z**2)))
            amplitude += abs(gain) * envelope * math.exp(z * w * (end - one.move_time))
        assert one.residual_curve[at] == pytest.approx(amplitude, abs=1e-4 * result.reference), one.name


@pytest.mark.parametrize("move", MOVES)
def test_limits_are_kept_and_the_way_is_covered(move: str) -> None:
    result = MOVES[move]
    for one in result.contenders:
        assert one.peak_acceleration <= result.maximum_acceleration * (1.0 + 1e-9), one.name
        times = np.linspace(0.0, one.acceleration.end_time, 20001)
        a = one.acceleration(times)
        assert np.abs(a).max() <= one.peak_acceleration * (1.0 + 1e-12)
        knots = np.unique(np.concatenate([times, one.acceleration.times]))
        speed = one.acceleration.integral()
        if result.maximum_speed is not None:
            assert np.abs(speed(knots)).max() <= result.maximum_speed * (1.0 + 1e-9), one.name
        if result.maximum_jerk is not None:
            slope = np.abs(np.diff(a)) / np.diff(times)
            assert slope.max() <= result.maximum_jerk * (1.0 + 1e-5), one.name
        # Gauss's quadrature over every stretch between steps is exact for its polynomials.
        nodes, weights = np.polynomial.legendre.leggauss(4)
        starts, _ = one.acceleration.segments()
        gaps = np.diff(starts)
        inside = starts[:-1, None] + 0.5 * gaps[:, None] * (1.0 + nodes)
        covered = float((speed(inside) @ weights * 0.5 * gaps).sum())
        assert covered == pytest.approx(result.distance, rel=1e-8), one.name
        # Smooth accelerations are interpolated to a part in 1e10 of their peak, which adds up to that times the time.
        rounding = 1e-14 if one.exact else 1e-10
        assert abs(speed(starts[-1])) <= rounding * one.peak_acceleration * one.acceleration.end_time, one.name


@pytest.mark.parametrize("move", MOVES)
def test_what_must_leave_nothing_leaves_nothing(move: str) -> None:
    result = MOVES[move]
    base = "trapezoid" if result.maximum_jerk is None else "S-curve"
    exact = [f"{base} + {name}" for name in ("ZV", "ZVD", "direct", "SD-ZV")] + [f"{base}, notch"]
    exact += [name for name in ("time-optimal",) if name in {one.name for one in result.contenders}]
    for name in exact:
        assert result[name].residual < 1e-12, name
        assert result[name].settling_time == result[name].move_time or name.endswith("notch")
    for one in result.contenders:
        assert one.worst_residual >= one.residual and one.worst_residual >= one.residual_curve[100]
        assert one.settling_time >= one.move_time
        inside = np.abs(result.frequency_ratios - 1.0) <= result.frequency_error * (1.0 + 1e-12)
        assert one.worst_residual >= one.residual_curve[inside].max() * (1.0 - 1e-12)
        assert one.worst_residual <= one.residual_curve[inside].max() * 1.02 + 1e-9 * result.reference


def test_undamped_modes_are_left_at_rest_by_period_matched_on_off_and_deflection_limiting_commands() -> None:
    result = compare((0.4, 0.0), 30.0, maximum_acceleration=1.0)
    for name in ("period-matched", "S-curve", "on-off", "deflection-limiting"):
        assert result[name].residual < 1e-12, name
    static = 1.0 / (2.0 * math.pi * 0.4) ** 2
    assert result["deflection-limiting"].peak_deflection == pytest.approx(0.5 * static, rel=1e-9)
    assert result.reference == pytest.approx(static, rel=1e-12)
    assert all(math.isinf(one.settling_time) for one in result.contenders if one.residual > result.within)


def test_residuals_of_smooth_commands_are_the_closed_forms() -> None:
    """Of an undamped mode, over the distance (Singer & Seering's comparators): tests/command has them by sampling."""
    distance, mode = 0.3, Mode(1.0, 0.0)
    result = compare(mode, distance, maximum_speed=0.35, maximum_acceleration=5.0)

    def bang_bang(r: float) -> float:
        return 16.0 * math.sin(0.5 * math.pi * r) ** 2 / (2.0 * math.pi * r) ** 2

    forms = {
        "bang-bang": bang_bang,
        "cycloidal": lambda r: abs(math.sin(math.pi * r) / (math.pi * r * (1.0 - r**2))),
        "versine": lambda r: abs(math.cos(math.pi * r) / (1.0 - 4.0 * r**2)),
        "versine force": lambda r: bang_bang(r) / abs(1.0 - (r / 2.0) ** 2),
    }
    for name, form in forms.items():
        one = result[name]
        assert one.residual == pytest.approx(distance * form(one.move_time), rel=1e-8), name
        for ratio, left in zip(result.frequency_ratios[::20], one.residual_curve[::20], strict=True):
            assert left == pytest.approx(distance * form(ratio * one.move_time), rel=1e-8, abs=1e-11), name


@settings(max_examples=6)
@given(st.floats(0.3, 20.0), st.floats(0.0, 0.05), st.floats(0.5, 30.0), st.floats(0.2, 3.0))
def test_order_of_speed_and_robustness(frequency: float, damping: float, periods: float, slope: float) -> None:
    """Robust shapers are longer and bear more; a shaper lengthens its base by its own duration; bang-bang is first."""
    acceleration = 2.0
    distance = acceleration * (0.5 * periods / frequency) ** 2
    speed = slope * math.sqrt(distance * acceleration)
    result = compare((frequency, damping), distance, maximum_speed=speed, maximum_acceleration=acceleration)
    zv, zvd, direct = (result[f"trapezoid + {name}"] for name in ("ZV", "ZVD", "direct"))
    base = result["trapezoid"]
    assert base.move_time < zv.move_time < direct.move_time * (1.0 + 1e-9)
    assert direct.move_time <= zvd.move_time * (1.0 + 1e-9)
    shaper = design.zv((frequency, damping))
    assert zv.move_time - base.move_time == pytest.approx(shaper.duration, rel=1e-9)
    assert zvd.worst_residual < zv.worst_residual < base.worst_residual
    assert all(one.move_time >= base.move_time * (1.0 - 1e-9) for one in result.contenders)
    order = [one.settling_time for one in result.contenders]
    assert order == sorted(order)


def test_robust_shapers_beat_zero_vibration_at_ten_per_cent() -> None:
    result = MOVES["two modes"]
    zv = result["trapezoid + ZV"].worst_residual
    for name in ("ZVD", "EI", "direct", "SD-ZV"):
        assert result[f"trapezoid + {name}"].worst_residual < 0.4 * zv
    assert result["trapezoid + direct"].move_time < result["trapezoid + ZVD"].move_time
    peaks = {name: result[f"trapezoid + {name}"].peak_deflection for name in ("ZV", "SD-ZV")}
    assert peaks["SD-ZV"] < peaks["ZV"]


def test_nothing_is_dropped_silently() -> None:
    names = {move: {one.name for one in r.contenders} | {one.name for one in r.left_out} for move, r in MOVES.items()}
    assert len(set(map(len, names.values()))) == 1
    reasons = {one.name: one.reason for one in MOVES["jerk limit"].left_out}
    assert {"bang-bang", "trapezoid", "versine", "period-matched", "on-off"} <= reasons.keys()
    assert reasons["versine"] == "its acceleration jumps, so no jerk limit can be kept."
    assert "no acceleration limit allows" in reasons["posicast"]
    limited = {one.name: one.reason for one in MOVES["speed limit"].left_out}
    assert "knows no speed limit" in limited["time-optimal"]
    assert "time-optimal" in {one.name for one in MOVES["no speed limit"].contenders}
    assert MOVES["no speed limit"]["bang-bang"].note == "here the same as the trapezoid"


def test_own_shapers_replace_the_others_and_negative_ones_are_slowed() -> None:
    shapers = {"mine": design.zv((1.2, 0.01)), "UM-ZV": design.um_zv((1.2, 0.01))}
    result = compare(ONE, 0.1125, maximum_acceleration=5.0, shapers=shapers)
    shaped = {one.name for one in result.contenders if one.kind == "shaped"}
    assert shaped == {"trapezoid + mine", "trapezoid + UM-ZV"}
    negative = result["trapezoid + UM-ZV"]
    assert "slowed" in negative.note and negative.residual < 1e-12
    assert negative.peak_acceleration == pytest.approx(5.0, rel=1e-4)
    assert negative.peak_acceleration <= 5.0 * (1.0 + 1e-9)
    bad = compare(ONE, 0.5, maximum_acceleration=5.0, shapers={"what": "zv"})  # type: ignore[dict-item]
    assert "give a Shaper" in next(one.reason for one in bad.left_out if one.name == "trapezoid + what")


def test_units_scale_and_the_window_can_be_given() -> None:
    metres = MOVES["speed limit"]
    millimetres = compare(ONE, 500.0, maximum_speed=1e3, maximum_acceleration=5e3, unit="mm")
    for one in metres.contenders:
        other = millimetres[one.name]
        assert other.move_time == pytest.approx(one.move_time, rel=1e-5)
        assert other.worst_residual == pytest.approx(1e3 * one.worst_residual, rel=1e-3, abs=1e-9)
    wide = compare(ONE, 0.5, maximum_speed=1.0, maximum_acceleration=5.0, within=0.02)
    ei = wide["trapezoid + EI"]
    assert wide.within == 0.02 and ei.settling_time == ei.move_time and wide.robust(ei)
    assert wide.first_robust is not None and wide.first_robust.move_time <= ei.move_time


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"distance": 0.0}, "distance is 0 m"),
        ({"distance": math.nan}, "distance is nan"),
        ({"maximum_acceleration": 0.0}, "maximum_acceleration is 0 m/s"),
        ({"maximum_speed": -1.0}, "maximum_speed is -1 m/s"),
        ({"maximum_jerk": math.inf}, "maximum_jerk is inf"),
        ({"modes": (0.0, 0.0)}, "above 0 Hz"),
        ({"gains": [1.0, 2.0]}, "gains"),
        ({"gains": [0.0]}, "all gains are 0"),
        ({"tolerance": 0.0}, "outside"),
        ({"within": 0.0}, "within is 0 m"),
        ({"frequency_error": 0.5}, "below 0.5"),
        ({"frequency_error": 0.0}, "frequency_error is 0"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(change: dict[str, object], words: str) -> None:
    good: dict[str, object] = {"modes": (1.2, 0.01), "distance": 0.5, "maximum_acceleration": 5.0}
    with pytest.raises(InputError, match=words):
        compare(**(good | change))  # type: ignore[arg-type]


def test_the_window_is_a_part_of_the_least_that_a_step_leaves() -> None:
    """On an undamped mode: acceleration a / w^2, speed v / w, way d."""
    w = 2.0 * math.pi
    for distance, speed, acceleration, least in (
        (5.0, 2.0, 1.0, 1.0 / w**2),
        (5.0, 0.1, 100.0, 0.1 / w),
        (0.01, 2.0, 100.0, 0.01),
    ):
        result = compare((1.0, 0.0), distance, maximum_speed=speed, maximum_acceleration=acceleration)
        assert result.reference == pytest.approx(least, rel=1e-12)
        assert result.within == pytest.approx(0.02 * least, rel=1e-12)
        assert 0.0 < result["trapezoid"].worst_residual <= 4.0 * least


@pytest.mark.parametrize("damping", [1e-5, 1e-9, 1e-38])
def test_a_mode_that_rings_for_ages_settles_by_its_envelope(damping: float) -> None:
    result = compare((45.0, damping), 0.1, maximum_acceleration=5.0)
    base = result["trapezoid"]
    decay = damping * 2.0 * math.pi * 45.0
    expected = base.move_time + math.log(base.residual / result.within) / decay
    assert base.settling_time == pytest.approx(expected, rel=1e-3)


def test_an_unknown_contender_is_answered_with_those_there_are() -> None:
    with pytest.raises(KeyError, match="trapezoid \\+ ZV"):
        MOVES["speed limit"]["ZX"]
