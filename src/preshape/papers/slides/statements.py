"""What the slides state."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape import Mode, Shaper, design
from preshape.papers.hyde.convolution import SHUTTLE
from preshape.papers.hyde.exact import SOLVED, Interpretation
from preshape.papers.misprint import constraint, printed_zero, reversed_shapers
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, beyond, claim, difference, shown
from preshape.plant import ModalPlant
from preshape.vibration import insensitivity, residual_vibration

__all__ = ["MODE", "rows"]

MODE = Mode(1.0, 0.1)
"""Of the one-mode slides, as in the thesis."""


def rows(sequence: Shaper, steps: Interpretation) -> list[Row]:
    """In the order of the slides."""
    return [*_one_mode(), *_misprints(), *_many_modes(sequence, steps)]


def _one_mode() -> list[Row]:
    times = np.linspace(0.0, 5.0, 501)
    plant = ModalPlant(MODE, [MODE.omega_d / MODE.omega**2])
    decay, omega = MODE.damping * MODE.omega, MODE.omega_d
    train = Shaper([0.0, 0.3, 0.9], [0.5, 0.2, 0.3])

    def formula(shaper: Shaper) -> NDArray[np.float64]:
        since = times[:, np.newaxis] - shaper.times
        waves = np.exp(-decay * np.maximum(since, 0.0)) * np.sin(omega * since)
        return np.asarray(np.where(since >= 0.0, waves, 0.0) @ shaper.amplitudes)

    gaps = [
        difference(plant.impulse_train(shaper.times, shaper.amplitudes, at=times).output, formula(shaper))
        for shaper in (Shaper([0.0], [1.0]), train)
    ]
    weights = train.amplitudes * np.exp(-decay * (train.duration - train.times))
    amplitude = float(abs(np.sum(weights * np.exp(1j * omega * train.times))))
    simulated = float(ModalPlant(MODE).impulse_residual(train.times, train.amplitudes)[0])
    three = design.zvd(MODE)
    band = insensitivity(three, MODE)
    left = float(residual_vibration(three, 1.0, 0.1))
    return [
        claim(
            "impulse response",
            "A exp(-z w t) sin(w_d t), against the simulated plant",
            "equal",
            f"difference {shown(gaps[0])}",
            gaps[0] < ROUNDING,
        ),
        claim(
            "N impulses",
            "the sum of the single responses (three impulses), against simulation",
            "equal",
            f"difference {shown(gaps[1])}",
            gaps[1] < ROUNDING,
        ),
        claim(
            "amplitude",
            "Amp at t_N, the same three impulses, against simulation",
            "equal",
            f"difference {shown(amplitude - simulated)}",
            abs(amplitude - simulated) < ROUNDING,
            note="Here the exponent, -z w (t_N - t_i), is printed rightly.",
        ),
        claim(
            "insensitivity",
            "three-impulse sequence: zero and flat at the mode, 1 Hz, z = 0.1",
            "the curve",
            f"{shown(left)} at 1 Hz; at most 5 % from {band.low:.3f} to {band.high:.3f} Hz",
            left < ROUNDING and band.low < 0.84 and band.high > 1.17,
        ),
    ]


def _misprints() -> list[Row]:
    k, three = MODE.decay_per_half_period, design.zvd(MODE)
    slope = three.times[1] * (2.0 * k**2 - 2.0 * k**4) / (1.0 + k) ** 2
    pair = [Mode(1.0, 0.1), Mode(10.0, 0.1)]
    singles, both = [design.zvd(mode) for mode in pair], design.convolved(pair)
    cases = [
        (both, mode, (1.0 - mode.decay_per_half_period) ** 2 * constraint(singles[1 - i], mode, sign=-1))
        for i, mode in enumerate(pair)
    ]
    four = design.zvdd(MODE)
    second = four.times[1] ** 2 * abs(3.0 * k**2 * (1.0 - k**2) * (1.0 - 3.0 * k**2)) / (1.0 + k) ** 3
    return [
        printed_zero(
            "eliminating", "the printed sum for three impulses, 1 Hz, z = 0.1", [(three, MODE, (1.0 - k) ** 2)]
        ),
        printed_zero("eliminating", "the printed derivative for them", [(three, MODE, slope)], power=1, unit="s"),
        *reversed_shapers("eliminating", 0.1),
        printed_zero("constraints", "the printed sums for 1 and 10 Hz convolved, z = 0.1", cases),
        printed_zero(
            "cost function", "its printed sum for four impulses, z = 0.1", [(four, MODE, second)], power=2, unit="s^2"
        ),
    ]


def _many_modes(sequence: Shaper, steps: Interpretation) -> list[Row]:
    convolved, direct = design.convolved(SHUTTLE), design.direct(SHUTTLE)
    left = float(ModalPlant(SHUTTLE).impulse_residual(steps.solved.times, steps.solved.amplitudes).max())
    return [
        beyond(
            "problems",
            "convolved sequence for 0.20, 0.26, 0.45, 0.59 Hz: the problem",
            f"{convolved.duration:.2f} s, {len(convolved)} impulses",
            len(convolved) == 81 and abs(convolved.duration - sum(1.0 / f for f, _ in SHUTTLE)) < 1e-9,
            note="The slide names the modes only; the thesis says 12.76 s.",
        ),
        claim(
            "constraints",
            "four equations for each mode: the shortest positive sequence meets all sixteen",
            "all zero",
            f"largest {shown(_largest(direct))}",
            _largest(direct) < 1e-9,
        ),
        beyond(
            "linear",
            "linear approximation, mesh 0.05 s",
            f"{sequence.duration:.2f} s, {len(sequence)} impulses",
            (sequence.design.residual or 0.0) < SOLVED and sequence.duration >= direct.duration,
        ),
        beyond("interpreted", "interpreted sequence", f"{len(steps.guess)} impulses", len(steps.guess) == 9),
        beyond(
            "exact",
            "exact direct solution: length, and vibration left (simulated)",
            f"{steps.solved.duration:.4f} s; {shown(left) if left > SOLVED else '0'}",
            left < SOLVED and steps.solved.duration >= direct.duration - 1e-6,
        ),
        beyond(
            "exact",
            "shortest positive sequence, certified",
            f"{direct.duration:.8f} s",
            direct.design.status == "optimal" and abs(direct.duration - 10.67402391) < 1e-8,
        ),
    ]


def _largest(shaper: Shaper) -> float:
    """Largest of the constraint sums over the Shuttle arm's modes, times in parts of the length."""
    modes = [Mode(*mode) for mode in SHUTTLE]
    return max(
        constraint(shaper, mode, sign=+1, power=power) / shaper.duration**power for mode in modes for power in (0, 1)
    )
