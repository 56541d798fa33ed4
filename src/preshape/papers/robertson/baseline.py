"""Robertson, section I and the first half of II.A: one impulse and bang-bang, what commands are measured against."""

from __future__ import annotations

import math

import numpy as np

from preshape import Mode, Shaper, design
from preshape.papers.reproduction import Row
from preshape.papers.robertson.moves import FORCE, MODE, OSCILLATOR, move
from preshape.papers.rows import ROUNDING, Because, beyond, claim, number, shown
from preshape.plant import ModalPlant
from preshape.profile import Profile
from preshape.vibration import command_insensitivity, command_vibration, insensitivity, residual_vibration

__all__ = ["rows"]

ALPHA = FORCE / OSCILLATOR.total_mass
PERIOD = 1.0 / MODE.frequency

PRINTED_PERIOD, USED_PERIOD = 4.425, 4.4425
"""[s] What is printed, and what the printed distances come from."""

PRINTED_DISTANCES = ("9.868", "39.472", "88.811")


def rows() -> list[Row]:
    """In the order of the paper."""
    return [*_one_impulse(), *_bang_bang(), *_nothing_left(), *_responses()]


def _one_impulse() -> list[Row]:
    mode = Mode(1.0, 0.1)
    off = Mode(0.87, 0.17)
    shapers = (design.zv(mode), design.zvd(mode))
    left = [_equation_1(shaper, mode) for shaper in shapers]
    gap = max(
        abs(_equation_1(s, off) - float(ModalPlant(off).impulse_residual(s.times, s.amplitudes)[0])) for s in shapers
    )
    undamped = {"ZV": design.zv((1.0, 0.0)), "ZVD": design.zvd((1.0, 0.0))}
    bands = {name: insensitivity(shaper, (1.0, 0.0)) for name, shaper in undamped.items()}
    f = np.linspace(0.75, 1.25, 101)
    curves = {name: residual_vibration(shaper, f) for name, shaper in undamped.items()}
    ramp = Profile.steps([0.0, 2.0], [1.0, -1.0], order=1)
    longer = [ramp.shaped(shaper).duration - ramp.duration for shaper in undamped.values()]
    exact = 4.0 / math.pi * math.asin(math.sqrt(0.05))
    return [
        claim(
            "(1)-(3)",
            "V of the ZV shaper is zero at the modelled mode (1 Hz, z = 0.1)",
            "0",
            f"{shown(left[0])}; elsewhere as simulated to {shown(gap)}",
            max(left) < ROUNDING and gap < ROUNDING,
        ),
        claim(
            "fig. 2",
            "the ZVD shaper leaves less over a wider range than ZV (undamped, +-25 %)",
            "lower, wider",
            f"at most {100.0 * curves['ZVD'].max():.1f} % against {100.0 * curves['ZV'].max():.1f} %",
            bool((curves["ZVD"] <= curves["ZV"] + ROUNDING).all()) and bands["ZVD"].value > bands["ZV"].value,
        ),
        number("fig. 2", "I of the ZV shaper at 5 %", "0.06", bands["ZV"].value),
        number(
            "fig. 2",
            "I of the ZVD shaper at 5 %",
            "0.28",
            bands["ZVD"].value,
            because=Because(
                "Truncated, not rounded: it is 4/pi asin(sqrt(0.05)).",
                abs(bands["ZVD"].value - exact) < 1e-9 and math.floor(100.0 * exact) == 28,
            ),
        ),
        claim(
            "1",
            "ZV takes half a period, ZVD one; a ramp gets longer by as much",
            "0.5 and 1 period",
            ", ".join(f"{value:.6g}" for value in longer),
            abs(longer[0] - 0.5) < ROUNDING and abs(longer[1] - 1.0) < ROUNDING,
        ),
    ]


def _equation_1(shaper: Shaper, mode: Mode) -> float:
    """V as (1) to (3) print it."""
    growing = shaper.amplitudes * np.exp(mode.damping * mode.omega * shaper.times)
    phase = mode.omega * math.sqrt(1.0 - mode.damping**2) * shaper.times
    c, s = float(growing @ np.cos(phase)), float(growing @ np.sin(phase))
    return math.exp(-mode.damping * mode.omega * shaper.duration) * math.hypot(c, s)


def _bang_bang() -> list[Row]:
    misses = []
    for distance in (5.0, 10.0, 15.0):
        command = move("bang-bang", distance).force
        motion, switch = OSCILLATOR.motion(command), math.sqrt(distance / ALPHA)
        misses += [
            abs(command.times[1] - switch),
            abs(float(motion("centre", command.end_time)) - distance) / distance,
            abs(float(motion("centre", command.end_time, derivative=1))),
        ]
    return [
        number("(5)", "alpha, the force-to-mass ratio, for a force of 1", "0.5", ALPHA),
        claim(
            "(5)",
            "switched at sqrt(x_d / alpha), bang-bang ends at x_d, at rest (5, 10, 15 units)",
            "moves the required distance",
            f"off by {shown(max(misses))}",
            max(misses) < 1e-11,
        ),
        number(
            "II.A",
            "the period T for m1 = m2 = k = 1",
            "4.425 s",
            PERIOD,
            "s",
            because=Because(
                f"Misprint: T = 2 pi / sqrt(2). The distances printed beside it come from {USED_PERIOD} s, which lacks "
                f"a digit; {PRINTED_PERIOD} s would give {ALPHA * PRINTED_PERIOD**2:.3f} for the first.",
                abs(PERIOD - 2.0 * math.pi / math.sqrt(2.0)) < 1e-12
                and _as_printed(USED_PERIOD)
                and not _as_printed(PRINTED_PERIOD),
            ),
        ),
    ]


def _as_printed(period: float) -> bool:
    """Whether (7) with this period gives the printed distances."""
    return tuple(f"{ALPHA * (n * period) ** 2:.3f}" for n in (1, 2, 3)) == PRINTED_DISTANCES


def _nothing_left() -> list[Row]:
    found = []
    for n, (word, printed) in enumerate(zip(("first", "second", "third"), PRINTED_DISTANCES, strict=True), start=1):
        distance = ALPHA * (n * PERIOD) ** 2
        left = OSCILLATOR.motion(move("bang-bang", distance).force).residual("deflection")
        found.append(
            number(
                "(7)",
                f"{word} distance at which bang-bang leaves nothing",
                printed,
                distance,
                because=Because(
                    f"alpha (n T)^2 = (n pi)^2; the printed value comes from T = {USED_PERIOD} s. Ours leaves "
                    f"{shown(left)}, simulated.",
                    left < ROUNDING and abs(distance - (n * math.pi) ** 2) < 1e-9 and _as_printed(USED_PERIOD),
                ),
            )
        )
    zeros = [
        OSCILLATOR.motion(move("bang-bang", ALPHA * (n * PERIOD) ** 2).force).residual("deflection") for n in (1, 4)
    ]
    states = [_against_bang_bang(distance) for distance in (math.pi**2, 9.868)]
    near = float(command_vibration(move("bang-bang", 9.868).force, MODE.frequency))
    found.append(
        claim(
            "(6)", "bang-bang leaves nothing when t_2 = n T (n = 1, 4)", "0", shown(max(zeros)), max(zeros) < ROUNDING
        )
    )
    found.append(
        claim(
            "II.A",
            "relative to bang-bang the vibration has no value at these distances (on-off, first distance)",
            "undefined",
            states[0],
            states[0] == "undefined",
        )
    )
    found.append(
        beyond(
            "II.A",
            "at the printed 9.868 it has one: bang-bang leaves of what one impulse does",
            f"{100.0 * near:.5f} %",
            states[1] == "measured" and 0.0 < near < 1e-6,
            note="Only the exact distance is singular.",
        )
    )
    return found


def _against_bang_bang(distance: float) -> str:
    return command_insensitivity(move("on-off", distance).force, MODE, relative_to="bang-bang").status


def _responses() -> list[Row]:
    motions = {distance: OSCILLATOR.motion(move("bang-bang", distance).force) for distance in (5.0, 10.0, 15.0)}
    left = {distance: motion.residual("second_position") for distance, motion in motions.items()}
    peak = {distance: motion.peak("deflection").value for distance, motion in motions.items()}
    on_off = [OSCILLATOR.motion(move("on-off", d).force).peak("deflection").value for d in (5.0, 10.0, 15.0, 20.0)]
    limited = OSCILLATOR.motion(move("limited", 10.0).force)
    return [
        claim(
            "fig. 6",
            "bang-bang leaves considerable vibration after 5 and 15 units, very little after 10 (of the second mass)",
            "considerable; very little",
            f"{left[5.0]:.3f}, {left[15.0]:.3f}; {left[10.0]:.5f}",
            min(left[5.0], left[15.0]) > 0.4 and left[10.0] < 1e-3,
        ),
        claim(
            "fig. 7",
            "even then, 10 units, there is a large transient deflection",
            "large",
            f"{peak[10.0]:.4f}; {peak[5.0]:.4f} for 5, {peak[15.0]:.4f} for 15",
            peak[10.0] > 1.9 * OSCILLATOR.static_deflection(FORCE),
            note="Twice the static one.",
        ),
        number("II.A", "deflection of the Analytic On-Off command, 10 units", "0.5", on_off[1]),
        beyond(
            "II.A",
            "and for 5, 15, 20 units",
            ", ".join(f"{on_off[i]:.6g}" for i in (0, 2, 3)),
            max(abs(value - OSCILLATOR.static_deflection(FORCE)) for value in on_off) < 1e-12,
            note="The static deflection, for every distance.",
        ),
        number(
            "II.A",
            "a limit of 0.3 is that part of the on-off command's",
            "60 %",
            100.0 * limited.peak("deflection").value / on_off[1],
            "%",
            note="From the simulated peaks.",
        ),
        claim(
            "II.A",
            "both commands are vibration-free, here the limited one for 10 units: left in the deflection",
            "vibration-free",
            shown(limited.residual("deflection")),
            limited.residual("deflection") < ROUNDING,
        ),
    ]
