"""Singer & Seering, sections 2.1 to 2.2.1 and 2.4: the equations, the closed forms, and that they are shortest."""

from __future__ import annotations

import math

import numpy as np

from preshape import Mode, Shaper, design
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, claim, difference, number, shown
from preshape.plant import ModalPlant
from preshape.vibration import residual_vibration

__all__ = ["CLOSED", "rows", "sums"]

CLOSED = {"two": design.zv, "three": design.zvd, "four": design.zvdd}


def rows() -> list[Row]:
    """In the order of the memo."""
    return [*_derivation(), *_closed_forms()]


def _derivation() -> list[Row]:
    b, phase, t = np.array([1.0, 0.7]), np.array([0.3, 1.1]), np.linspace(0.0, 7.0, 701)
    cosine, sine = float(b @ np.cos(phase)), float(b @ np.sin(phase))
    together = b @ np.sin(np.add.outer(phase, t))
    errors = [
        float(np.abs(together - math.hypot(cosine, sine) * np.sin(t + math.atan(ratio))).max())
        for ratio in (cosine / sine, sine / cosine)
    ]
    mode = Mode(1.0, 0.1)
    right = [sums(shape(mode), mode, power) for shape in (design.zv, design.zvd) for power in (0,)]
    slope = sums(design.zvd(mode), mode, 1)
    four = max(sums(design.zvdd(mode), mode, power) for power in (0, 1, 2))
    literal = _derivative_of_sums(design.zvd(mode), mode)
    return [
        claim(
            "(2)",
            "phase psi of the sum of two sines (B = 1, 0.7; phi = 0.3, 1.1): error of the sum",
            "0",
            f"{errors[0]:.3f}",
            errors[0] < ROUNDING,
            because=Because(
                "Misprint: the fraction is upside down. psi = atan(sum B sin phi / sum B cos phi) gives 0; the "
                "amplitude, which is what the memo goes on with, is right.",
                errors[1] < ROUNDING,
            ),
        ),
        claim(
            "(4)-(6)",
            "both sums are zero for the two- and three-impulse closed forms, z = 0.1",
            "0",
            shown(max(right)),
            max(right) < ROUNDING,
            note="The exponent, -z w (t_N - t_j), is right here; Hyde and the slides lost its t_N.",
        ),
        claim(
            "(7)",
            "setting (7) to zero sets the derivative of (6) over frequency to zero (three impulses, z = 0.1)",
            "equivalent",
            f"(7): {shown(slope)}; derivative of (6): {shown(literal)}",
            slope < ROUNDING and literal < ROUNDING,
            note="Term by term (7) is not that derivative; both vanish together once (6) does. So with (8).",
        ),
        claim("(8)", "q = 0, 1, 2 are zero for four impulses, z = 0.1", "0", shown(four), four < ROUNDING),
    ]


def _closed_forms() -> list[Row]:
    found: list[Row] = []
    mode = Mode(1.0, 0.1)
    z = mode.damping
    k = math.exp(-z * math.pi / math.sqrt(1.0 - z**2))
    for words, figure, weights in (
        ("two", "fig. 2", [1.0, k]),
        ("three", "fig. 4", [1.0, 2.0 * k, k**2]),
        ("four", "fig. 6", [1.0, 3.0 * k, 3.0 * k**2, k**3]),
    ):
        shaper = CLOSED[words](mode)
        gap = difference(shaper.amplitudes, np.array(weights) / sum(weights))
        gap += difference(shaper.times, np.arange(len(weights)) * math.pi / mode.omega_d)
        found.append(
            claim(
                figure,
                f"{words} impulses: printed closed form against ours, z = 0.1",
                "amplitudes and times",
                f"difference {shown(gap)}",
                gap < ROUNDING,
            )
        )
    look = np.linspace(0.0, 1.5, 1501)
    overshoot = ModalPlant(mode).step_train([0.0], [1.0], at=look).output
    at_half = float(ModalPlant(mode).step_train([0.0], [1.0], at=[math.pi / mode.omega_d]).output[0]) - 1.0
    found += [
        number(
            "fig. 2",
            "K is the overshoot of the step response (simulated), z = 0.1: K = 0.7292",
            f"{k:.4f}",
            at_half,
        ),
        claim(
            "fig. 2",
            "dT is the time of the first overshoot",
            f"dT = {math.pi / mode.omega_d:.4f} s",
            f"largest at {look[int(np.argmax(overshoot))]:.3f} s",
            abs(look[int(np.argmax(overshoot))] - math.pi / mode.omega_d) < 0.001,
        ),
        _scanned_k(mode),
    ]
    for order, words in enumerate(CLOSED):
        pairs = [(CLOSED[words]((1.0, z)), design.direct((1.0, z), order=order)) for z in (0.0, 0.05, 0.2)]
        gap = max(abs(closed.duration - shortest.duration) for closed, shortest in pairs)
        proved = all(shortest.design.status == "optimal" for _, shortest in pairs)
        found.append(
            claim(
                "2.4",
                f"{words} impulses: no shorter positive sequence meets the constraints (z = 0, 0.05, 0.2)",
                "shortest",
                "proved by certificate" if proved else "not proved",
                proved and gap < 1e-7,
            )
        )
    return found


def _scanned_k(mode: Mode) -> Row:
    """Figure 6 as the scanned memo has it: K = exp(-sqrt(1 - z^2))."""
    printed, right = math.exp(-math.sqrt(1.0 - mode.damping**2)), mode.decay_per_half_period
    left = []
    for k in (printed, right):
        shaper = Shaper.normalised(0.5 * mode.damped_period * np.arange(4), [1.0, 3.0 * k, 3.0 * k**2, k**3])
        left.append(float(residual_vibration(shaper, mode.frequency, mode.damping)))
    return claim(
        "fig. 6",
        "K as our scan of the memo reads, exp(-sqrt(1 - z^2)): vibration left at the design point, z = 0.1",
        "0",
        f"{100.0 * left[0]:.1f} % (K = {printed:.3f})",
        left[0] < ROUNDING,
        because=Because(
            "Lost in print or scan: K = exp(-z pi / sqrt(1 - z^2)), as the overshoot of figure 2 must be; it gives 0.",
            left[1] < ROUNDING,
        ),
    )


def sums(shaper: Shaper, mode: Mode, power: int) -> float:
    """The larger of the two sums of (6), (7) or (8), |.| [s^power]."""
    weights = shaper.amplitudes * shaper.times**power
    weights = weights * np.exp(-mode.damping * mode.omega * (shaper.duration - shaper.times))
    phases = shaper.times * mode.omega_d
    return float(max(abs(weights @ np.sin(phases)), abs(weights @ np.cos(phases))))


def _derivative_of_sums(shaper: Shaper, mode: Mode) -> float:
    """The larger of the two derivatives of (6) over w, term by term [s]."""
    z, before, root = mode.damping, shaper.duration - shaper.times, math.sqrt(1.0 - mode.damping**2)
    weights = shaper.amplitudes * np.exp(-z * mode.omega * before)
    sine, cosine = np.sin(shaper.times * mode.omega_d), np.cos(shaper.times * mode.omega_d)
    of_sine = weights @ (-z * before * sine + shaper.times * root * cosine)
    of_cosine = weights @ (-z * before * cosine - shaper.times * root * sine)
    return float(max(abs(of_sine), abs(of_cosine)))
