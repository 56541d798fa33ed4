"""Singh & Heppler, sections 4.2 and 5: few impulses against many, and what few impulses cost."""

from __future__ import annotations

import math

import numpy as np

from preshape import design
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, Because, beyond, claim, shown
from preshape.papers.singh.example import shaper_of
from preshape.papers.singh.signals import DAMPED, DT, LOWEST, UNDAMPED, after_the_end, applied, example_modes, response
from preshape.vibration import insensitivity, residual_vibration

__all__ = ["rows"]


def rows() -> list[Row]:
    """In the order of the paper."""
    return [*_comparison(), *_costs()]


def _comparison() -> list[Row]:
    shapers = {which: shaper_of(which, DAMPED) for which in ("two", "three", "four", "nine")}
    left = {which: after_the_end(applied(shaper), DAMPED) for which, shaper in shapers.items()}
    off = {which: after_the_end(shaper, DAMPED) for which, shaper in shapers.items()}
    during = {}
    for which in ("three", "nine"):
        shaper = applied(shapers[which])
        during[which] = float(np.abs(response(shaper, DAMPED, np.arange(0.0, shaper.duration, 0.2 * DT))).max())
    bands = [
        min(insensitivity(shaper_of(which, UNDAMPED), mode).value for mode in example_modes(UNDAMPED))
        for which in ("two", "four")
    ]
    text, captions = ("four", "two", "unit"), ("two", "unit", "four")
    late = [after_the_end(applied(shapers[which], [0, 1, 1][:n]), DAMPED) for which, n in (("two", 2), ("three", 3))]
    percent = {which: f"{100.0 * value:.2f} %" for which, value in left.items()}
    return [
        claim(
            "fig. 11-13",
            "which figure shows which: text (four, two impulses, unit) and captions",
            ", ".join(text),
            f"captions: {', '.join(captions)}",
            text == captions,
            because=Because(
                "Text and captions of the paper disagree; drawn here as captioned.", left["four"] < left["two"] < 1.0
            ),
        ),
        claim(
            "4.2",
            "two impulses, applied every 0.01 s: reduced, not eliminated; more left than by four",
            "larger than four",
            f"{percent['two']} against {percent['four']}",
            left["four"] < left["two"] < 0.2,
        ),
        claim(
            "4.2",
            "four may be more robust than two: smallest 5 % band of the two modes, z = 0",
            "more robust",
            f"{bands[1]:.4f} against {bands[0]:.4f}",
            bands[1] > bands[0],
            note="With two impulses mode 14 sees one every seven of its half periods.",
        ),
        claim(
            "fig. 14, 15",
            "three impulses as effective as nine, applied every 0.01 s",
            "just as effective",
            f"{percent['three']} against {percent['nine']}",
            left["three"] <= left["nine"],
        ),
        beyond(
            "fig. 14, 15",
            "the same without sampling",
            f"{100.0 * off['three']:.2f} % against {shown(off['nine'])}",
            off["nine"] < ROUNDING and 0.004 < off["three"] < 0.007,
            note="Nine impulses lose by being moved to the samples; three never were exact.",
        ),
        claim(
            "4.2",
            "three more robust than two: all but the first impulse one interval late",
            "more robust",
            f"{100.0 * late[1]:.1f} % against {100.0 * late[0]:.1f} %",
            late[1] < 0.5 * late[0],
        ),
        claim(
            "fig. 14, 15",
            "before the end, three diminish the vibration less than nine: peak response",
            "less",
            f"{during['three']:.2f} against {during['nine']:.2f}",
            during["three"] > during["nine"],
        ),
    ]


def _costs() -> list[Row]:
    two, three = shaper_of("two", UNDAMPED), shaper_of("three", UNDAMPED)
    period = 2.0 * math.pi / LOWEST
    digits = [design.antiperiod_analysis([(1.0, 0.0), (value, 0.0)], frequency_tolerance=0.0) for value in (3.0, 3.001)]
    spacing = [found.common.frequency if found.common is not None else math.nan for found in digits]
    bands = [[insensitivity(shaper, mode).value for mode in example_modes(UNDAMPED)] for shaper in (two, three)]
    fast = [value for row in bands for value in row]
    nodes = float(residual_vibration(three, 7.0 * LOWEST / (2.0 * math.pi)))
    return [
        claim(
            "5",
            "eliminating all modes takes at least a period of the lowest (two, three impulses; period pi)",
            f"at least {period:.4f} s",
            f"{two.duration:.4f}, {three.duration:.4f} s",
            min(two.duration, three.duration) >= period * (1.0 - 1e-9),
            because=Because(
                "True of three impulses; two take half the common period.",
                abs(two.duration - 0.5 * period) < 1e-9 and abs(three.duration - period) < 1e-9,
            ),
        ),
        claim(
            "5",
            "more digits lengthen the period of the signal: 3 and 3.001 times the lowest",
            "longer",
            f"{1.0 / spacing[0]:.0f} and {1.0 / spacing[1]:.0f} periods",
            abs(spacing[0] - 1.0) < 1e-9 and abs(spacing[1] - 0.001) < 1e-9,
        ),
        beyond(
            "5",
            "the 5 % band of mode 14 shrinks with m = 7: two and three impulses, relative",
            f"{bands[0][1]:.4f}, {bands[1][1]:.4f} (mode 2: {bands[0][0]:.4f}, {bands[1][0]:.4f})",
            all(abs(7.0 * row[1] - row[0]) < 1e-4 for row in bands) and min(fast) > 0.0 and nodes < ROUNDING,
            note="1/7 of what ZV and ZVD allow: the price of few impulses.",
        ),
    ]
