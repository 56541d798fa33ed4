"""Singer & Seering, sections 2.2 to 2.4: what the sequences tolerate, several modes, shaped commands."""

from __future__ import annotations

import math

import numpy as np

from preshape import Mode, Shaper, design
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, claim, number, shown
from preshape.papers.singer.sequences import CLOSED, sums
from preshape.plant import ModalPlant
from preshape.vibration import insensitivity, residual_vibration

__all__ = ["TWO", "rows"]

BANDS = {"two": ("fig. 3", 5.0, 5.0), "three": ("fig. 5", 20.0, 20.0), "four": ("fig. 7", 30.0, 40.0)}
"""Figure, and how far the frequency may be off below and above, as printed [%]."""

TWO = [(1.0, 0.05), (2.5, 0.05)]
"""Modes for figure 9, which names none."""

ABOUT = 0.15
"""The printed bands are approximate; read as within this fraction of what is printed."""


def rows() -> list[Row]:
    """In the order of the memo."""
    return [*_bands(), *_damping(), *_higher_modes(), *_shaping()]


def _bands() -> list[Row]:
    found: list[Row] = []
    for words, (figure, below, above) in BANDS.items():
        printed = f"about +-{below:.0f} %" if below == above else f"about -{below:.0f} % +{above:.0f} %"
        for z in (0.0, 0.2):
            band = insensitivity(CLOSED[words]((1.0, z)), (1.0, z))
            low, high = 100.0 * (1.0 - band.low), 100.0 * (band.high - 1.0)
            undamped = 200.0 / math.pi * math.asin(0.05 ** (1.0 / (list(CLOSED).index(words) + 1)))
            found.append(
                claim(
                    figure,
                    f"{words} impulses: frequency band with at most 5 %, z = {z:g}",
                    printed,
                    f"-{low:.1f} % +{high:.1f} %",
                    abs(low - below) <= ABOUT * below and abs(high - above) <= ABOUT * above,
                    because=Because(
                        "The memo names no damping. Undamped bands are symmetric, 2/pi asin(0.05^(1/(n-1))), and "
                        "narrower; all three printed ones fit a damping of about 0.2.",
                        z == 0.0 and abs(low - undamped) < 1e-6 and abs(high - undamped) < 1e-6,
                    ),
                    note=f'The memo names no damping; z = 0.2 fits. "About" read as {100.0 * ABOUT:.0f} % of it.',
                )
            )
    off = [float(residual_vibration(shape((1.0, 0.0)), 1.1)) for shape in (design.zv, design.zvd)]
    found.append(
        claim(
            "2.4",
            "Posicast, two impulses: residual vibration for a small frequency change (10 %, z = 0)",
            "considerable",
            f"{100.0 * off[0]:.1f} %; three impulses {100.0 * off[1]:.1f} %",
            off[0] > 0.05 > off[1],
        )
    )
    return found


def _damping() -> list[Row]:
    found: list[Row] = []
    mode = Mode(1.0, 0.05)
    slope = sums(design.zvd(mode), mode, 1)
    change = 1e-5
    flat = [float(residual_vibration(design.zvd(mode), 1.0, 0.05 + d)) / change for d in (change, -change)]
    found.append(
        claim(
            "2.2.2",
            "the derivative over damping vanishes with that over frequency (three impulses, z = 0.05)",
            "zero",
            f"(7): {shown(slope)}; difference quotient below {10 ** math.ceil(math.log10(max(flat))):.0e}",
            slope < ROUNDING and max(flat) < 1e-3,
        )
    )
    known = {"two": (0.0174, 0.0863), "three": (0.0, 0.2576), "four": (0.0, 0.5176)}
    for words, shape in CLOSED.items():
        shaper = shape(mode)
        low, high = _damping_band(shaper)
        expected = known[words]
        found.append(
            claim(
                "fig. 8",
                f"{words} impulses for z = 0.05: damping ratios with at most 5 %",
                "extremely large variations tolerated",
                f"z = {low:.3f} to {high:.3f}",
                high - low >= 0.05 and abs(low - expected[0]) < 1e-3 and abs(high - expected[1]) < 1e-3,
                note="Taken as: at least as wide as the damping ratio itself.",
            )
        )
    return found


def _damping_band(shaper: Shaper) -> tuple[float, float]:
    """The damping ratios around 0.05 with at most 5 % left, to 0.0001."""
    dampings = np.linspace(0.0, 0.9999, 10000)
    above = np.flatnonzero(residual_vibration(shaper, 1.0, dampings) > 0.05)
    centre = int(np.argmin(np.abs(dampings - 0.05)))
    low = dampings[above[above < centre].max() + 1] if (above < centre).any() else 0.0
    high = dampings[above[above > centre].min() - 1] if (above > centre).any() else 1.0
    return float(low), float(high)


def _higher_modes() -> list[Row]:
    singles = [design.zvd(mode) for mode in TWO]
    together, direct = design.convolved(TWO), design.direct(TWO)
    left = float(ModalPlant(TWO).impulse_residual(together.times, together.amplitudes).max())
    far = design.direct([(1.0, 0.0), (10.0, 0.0)])
    pairs = [(1.0, 1.3), (1.0, 2.0), (1.0, 2.9), (1.0, 3.5), (1.0, 10.0)]
    saved = [1.0 - design.direct([(a, 0.0), (b, 0.0)]).duration / (1.0 / a + 1.0 / b) for a, b in pairs]
    return [
        claim(
            "2.3, fig. 9",
            "two three-impulse sequences convolved (1 and 2.5 Hz, z = 0.05): vibration left in either mode",
            "without vibration",
            f"{shown(left)} (simulated)",
            left < ROUNDING,
        ),
        claim(
            "2.3",
            "length of the convolved sequence",
            "sum of the lengths",
            f"{together.duration:.4f} s",
            abs(together.duration - sum(single.duration for single in singles)) < ROUNDING,
        ),
        number(
            "2.3",
            "impulses of the sequence solved directly, 1 and 2.5 Hz, z = 0.05",
            "5 impulses",
            float(len(direct)),
            "impulses",
            digits=0,
        ),
        number(
            "2.3",
            "the same for 1 and 10 Hz, z = 0",
            "5 impulses",
            float(len(far)),
            "impulses",
            digits=0,
            because=Because(
                "Five positive impulses exist only for f2 <= 3 f1 (see Hyde, section 3.4.3.c); the shortest, proved, "
                "has 7.",
                far.design.status == "optimal" and len(far) == 7,
            ),
        ),
        claim(
            "2.3",
            "directly solved sequences are always shorter (f2/f1 = 1.3, 2, 2.9, 3.5, 10)",
            "always shorter",
            "by " + ", ".join(f"{100.0 * s:.0f}" for s in saved) + " %",
            min(saved) > 0.0,
            note="Five pairs, no proof; the engine found no counterexample.",
        ),
    ]


def _shaping() -> list[Row]:
    rng = np.random.default_rng(1)
    command = np.clip(rng.normal(size=500), -1.0, 1.0)
    dt = 0.01
    largest = max(float(np.abs(shape((1.3, 0.1)).shape(command, dt)).max()) for shape in CLOSED.values())
    step = design.zv((1.0, 0.1)).shape(np.ones(200), dt)
    k = Mode(1.0, 0.1).decay_per_half_period
    posicast = 1.0 / (1.0 + k)
    first, last = float(step[0]), float(step[-1])
    delay = len(design.zvd((1.0, 0.0)).shape(command, dt)) * dt - len(command) * dt
    return [
        claim(
            "2.4",
            "a shaped command never exceeds the largest value of the command (random, three shapers)",
            "never exceeds",
            f"{largest:.2f} of 1",
            largest <= 1.0 + ROUNDING,
        ),
        claim(
            "2.4",
            "a two-impulse sequence and a step give Posicast: 1/(1 + K), then 1",
            f"{posicast:.4f}, 1",
            f"{first:.4f}, {last:.4g}",
            abs(first - posicast) < ROUNDING and abs(last - 1.0) < ROUNDING,
        ),
        number("2.4, fig. 10", "time penalty: the length of the sequence (three impulses, 1 Hz)", "1.00 s", delay, "s"),
    ]
