"""Hyde, chapter 2: one mode, two and three impulses; the system of section 2.4, 1 Hz and z = 0.1, throughout."""

from __future__ import annotations

import numpy as np

from preshape import Mode, Shaper, design
from preshape.papers.misprint import constraint, printed_zero, reversed_shapers
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, beyond, claim, difference, number, shown
from preshape.plant import ModalPlant
from preshape.vibration import insensitivity, residual_vibration

__all__ = ["LATE", "MODE", "late_copy", "late_pair", "rows"]

MODE = Mode(1.0, 0.1)

LATE = 1.1
"""The second impulse of figure 2.6 comes at this multiple of its right time; Hyde says "slightly to the right"."""


def rows() -> list[Row]:
    """Every statement of the chapter that can be checked."""
    return [*_two_impulses(), *_misprint(), *_three_impulses(), *_late(), *_shaped_steps()]


def late_pair() -> Shaper:
    """The two-impulse shaper of figure 2.4 with its second impulse late."""
    right = design.zv(MODE)
    return Shaper(LATE * right.times, right.amplitudes)


def late_copy() -> Shaper:
    """Figure 2.7: the late pair, and its copy applied immediately after it."""
    return late_pair() * late_pair()


def _two_impulses() -> list[Row]:
    plant = ModalPlant(MODE)
    times = np.linspace(0.0, 5.0, 501)
    area = MODE.omega_d / MODE.omega**2  # so that the response begins as exp(-z w t) sin(w_d t)
    simulated = plant.impulse_train([0.0], [area], at=times).output
    formula = np.exp(-MODE.damping * MODE.omega * times) * np.sin(MODE.omega_d * times)
    gap = difference(simulated, formula)
    shaper = design.zv(MODE)
    left = float(plant.impulse_residual(shaper.times, shaper.amplitudes)[0])
    unshaped = float(residual_vibration(Shaper([0.0], [1.0]), 1.0, 0.1))
    three = design.zvd(MODE)
    off = float(plant.impulse_residual(three.times, three.amplitudes)[0])
    by_formula = [float(residual_vibration(three, f, 0.1)) for f in (0.7, 0.9, 1.3)]
    simulated_off = [
        float(ModalPlant((f, 0.1)).impulse_residual(three.times, three.amplitudes)[0]) for f in (0.7, 0.9, 1.3)
    ]
    agreement = max(abs(a - b) for a, b in zip(by_formula, simulated_off, strict=True))
    band = insensitivity(shaper, MODE)
    return [
        claim(
            "(2.1), fig. 2.1",
            "impulse response, against the simulated plant",
            "exp(-z w t) sin(w_d t)",
            f"difference {shown(gap)} over 5 s",
            gap < ROUNDING,
        ),
        claim(
            "(2.2)",
            "amplitude after the last impulse, 0.7, 0.9, 1.3 Hz plants, against simulation",
            "equation (2.2)",
            f"difference {shown(agreement)}",
            agreement < ROUNDING,
            note="Here the exponent, -z w (t_N - t_i), is printed rightly.",
        ),
        claim(
            "fig. 2.3, 2.4",
            "two impulses, 1 Hz, z = 0.1: vibration after the second",
            "vibration free",
            f"{shown(left)} left, simulated",
            left < ROUNDING and off < ROUNDING,
            note=f"Impulses {shaper.amplitudes[0]:.4f} at 0 and {shaper.amplitudes[1]:.4f} at {shaper.times[1]:.4f} s.",
        ),
        claim("2.2", "an amplitude of one means as much as unshaped", "unity", f"V = {unshaped:g}", unshaped == 1.0),
        claim(
            "fig. 2.5",
            "two-impulse curve: zero at 1 Hz, rises steeply away from it",
            "zero; rises steeply",
            f"V = 0 at 1 Hz; above 5 % outside {band.low:.3f} to {band.high:.3f} Hz",
            left < ROUNDING and abs(band.value - 0.0751) < 5e-5,
        ),
    ]


def _misprint() -> list[Row]:
    cases = []
    for z in (0.01, 0.05, 0.1, 0.2):
        mode = Mode(1.0, z)
        cases.append((design.zvd(mode), mode, (1.0 - mode.decay_per_half_period) ** 2))
    k, shaper = MODE.decay_per_half_period, design.zvd(MODE)
    slope = shaper.times[1] * (2.0 * k**2 - 2.0 * k**4) / (1.0 + k) ** 2
    return [
        printed_zero("(2.3)", "the printed sum for the closed form (2.7), z = 0.01, 0.05, 0.1, 0.2: (1 - K)^2", cases),
        printed_zero("(2.6)", "the printed derivative for (2.7), z = 0.1", [(shaper, MODE, slope)], power=1, unit="s"),
        *reversed_shapers("(2.3), (2.6)", 0.1),
    ]


def _three_impulses() -> list[Row]:
    z, w = MODE.damping, MODE.omega
    k = np.exp(-z * np.pi / np.sqrt(1.0 - z**2))
    printed = np.array([1.0, 2.0 * k, k**2]) / (1.0 + 2.0 * k + k**2)
    times = np.pi / (w * np.sqrt(1.0 - z**2)) * np.arange(3)
    three, two = design.zvd(MODE), design.zv(MODE)
    proved = design.direct(MODE, order=1)
    gap = difference(three.amplitudes, printed) + difference(three.times, times)
    search = difference(proved.times, times)
    other = design.zvd((7.3, 0.1))
    bands = [insensitivity(shaper, MODE) for shaper in (two, three)]
    slope = [constraint(shaper, MODE, sign=+1, power=1) for shaper in (two, three)]
    step = 1e-4
    flat = [
        abs(float(residual_vibration(three, f, d))) / step
        for f, d in ((1.0 + step, 0.1), (1.0 - step, 0.1), (1.0, 0.1 + step), (1.0, 0.1 - step))
    ]
    negative = Shaper([0.0, 1.0 / 6.0, 1.0 / 3.0], [1.0, -1.0, 1.0])
    left = float(ModalPlant((1.0, 0.0)).impulse_residual(negative.times, negative.amplitudes)[0])
    return [
        claim(
            "(2.7), fig. 2.10",
            "three impulses at 1 Hz, z = 0.1: printed formula against ours",
            " ".join(f"{a:.4f}" for a in printed) + " at " + " ".join(f"{t:.4f}" for t in times) + " s",
            f"difference {shown(gap)}",
            gap < ROUNDING,
        ),
        claim(
            "(2.6), (2.7)",
            "the closed form is the one with the smallest t_3",
            f"t_3 = {times[2]:.4f} s",
            f"shortest positive: {proved.duration:.4f} s, proved",
            proved.design.status == "optimal" and search < 1e-7,
            note="Found by the engine without the closed form; no positive shaper is shorter.",
        ),
        claim(
            "(2.6)",
            "zero slope over frequency also means zero slope over damping (difference quotients of V, 1e-4)",
            "both zero",
            f"below {max(flat):.1e}",
            max(flat) < 0.01 < float(residual_vibration(two, 1.0 + step, 0.1)) / step,
        ),
        claim(
            "(2.7)",
            "amplitudes depend on the damping only (1 and 7.3 Hz)",
            "only z dependent",
            "the same",
            np.allclose(other.amplitudes, three.amplitudes, rtol=0.0, atol=ROUNDING)
            and not np.allclose(other.times, three.times),
        ),
        claim(
            "fig. 2.11",
            "three-impulse curve is flat about 1 Hz where that of two impulses is steep",
            "flat around 1 Hz",
            f"slope {shown(slope[1])} against {slope[0]:.2f} s; 5 % band {bands[1].low:.3f} to {bands[1].high:.3f} Hz",
            slope[1] < ROUNDING < slope[0] and bands[1].value > 4.0 * bands[0].value,
        ),
        number(
            "2.3",
            "delay of three impulses: about one period",
            "1 period",
            three.duration * MODE.frequency,
            "periods",
            within=0.05,
            note='"About" read as 5 %; it is the damped period, 1 / sqrt(1 - z^2).',
        ),
        claim(
            "2.3",
            "negative impulses can shorten a shaper (1, -1, 1 at 0, T/6, T/3; z = 0)",
            "decreased",
            f"0.333 against 0.500 periods, {shown(left)} left",
            left < ROUNDING and negative.duration < design.zv((1.0, 0.0)).duration,
        ),
    ]


def _late() -> list[Row]:
    plant = ModalPlant(MODE)
    pair, triple = late_pair(), late_copy()
    left = [float(plant.impulse_residual(shaper.times, shaper.amplitudes)[0]) for shaper in (pair, triple)]
    return [
        claim(
            "fig. 2.6, 2.8",
            "second impulse late: some vibration remains",
            "some remains",
            f"{100.0 * left[0]:.1f} % with the second impulse 10 % late",
            0.05 < left[0] < 0.5,
            note='Hyde prints no number for "slightly"; 10 % was chosen.',
        ),
        claim(
            "fig. 2.7",
            "the pair and its copy are one three-impulse shaper",
            "three impulses",
            f"{len(triple)} impulses at {', '.join(f'{t:.4f}' for t in triple.times)} s",
            len(triple) == 3,
        ),
        claim(
            "fig. 2.9",
            "the copy suppresses what the flawed pair left",
            "suppressed",
            f"{100.0 * left[1]:.1f} % left: the square",
            abs(left[1] - left[0] ** 2) < ROUNDING,
        ),
    ]


def _shaped_steps() -> list[Row]:
    found: list[Row] = []
    plant = ModalPlant(MODE)
    unshaped = float(plant.step_train([0.0], [1.0]).residual_amplitudes[0])
    dt = 0.001
    for figure, shaper in (("fig. 2.12, 2.13", design.zv(MODE)), ("fig. 2.14, 2.15", design.zvd(MODE))):
        look = np.linspace(shaper.duration, shaper.duration + 5.0, 2001)
        response = plant.step_train(shaper.times, shaper.amplitudes, at=look)
        ripple = float(np.abs(response.output - 1.0).max())
        command = shaper.shape(np.ones(3000), dt)
        reached = dt * float(np.argmax(command > 1.0 - ROUNDING))
        found += [
            claim(
                figure,
                f"step through {len(shaper)} impulses: residual vibration of the response",
                "effective",
                f"{shown(ripple)} left of {unshaped:.2f} unshaped",
                ripple < ROUNDING < unshaped,
            ),
            claim(
                figure,
                "the staircase reaches its full value at the last impulse",
                "delay = t_N",
                f"at {reached:.3f} s, t_N = {shaper.duration:.4f} s",
                0.0 <= reached - shaper.duration < dt,
            ),
        ]
    command = np.clip(np.random.default_rng(2).normal(size=2000), -1.0, 1.0)
    largest = max(float(np.abs(shape(MODE).shape(command, dt)).max()) for shape in (design.zv, design.zvd))
    found.append(
        claim(
            "(2.5)",
            "amplitudes that sum to one never exceed the limits of the command (random, both shapers)",
            "not exceeded",
            f"{largest:.2f} of 1",
            largest <= 1.0 + ROUNDING,
        )
    )
    three = insensitivity(design.zvd(MODE), MODE)
    found.append(
        beyond(
            "fig. 2.5, 2.11",
            "5 % band of two and of three impulses, relative to 1 Hz",
            f"{insensitivity(design.zv(MODE), MODE).value:.4f} and {three.value:.4f}",
            abs(three.value - 0.3402) < 5e-5,
        )
    )
    return found
