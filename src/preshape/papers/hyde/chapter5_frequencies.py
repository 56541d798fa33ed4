"""Hyde, section 5.3.2: the frequencies of his non-linear MACE model beside those of ours, calibrated and identified."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations

import numpy as np

from preshape.papers.hyde.chapter5_identified import Spectra
from preshape.papers.hyde.chapter5_slews import Experiments
from preshape.papers.reproduction import Row
from preshape.papers.rows import Because, beyond, claim, number
from preshape.plant.mace import CALIBRATED_GAINS, Mace, calibration_table
from preshape.plant.mace.calibration import CLOSED_LOOP

__all__ = ["frequency_rows"]

SEEN = 0.06
"""How near [-] white noise comes to the linearised modes: a quarter hertz of smoothing, runs of six seconds."""

FITTED = 0.02
"""How near [-] modes fitted to free vibration come to them; the payload drifts a little meanwhile."""

CLUSTER = 0.05
"""How near [-] a mode must come to a printed one of 13 to 16 Hz to be that one: what is asked of the open loop."""


def frequency_rows(done: Experiments) -> list[Row]:
    """The three tables, and what white noise shows of them."""
    return [*_tables(), *_identified(done)]


def _tables() -> list[Row]:
    found = []
    table = calibration_table()
    for fit in table:
        if fit.tolerance is not None and "[Hz]" in fit.what:
            found.append(
                number(
                    "5.3.2",
                    fit.what.replace(" [Hz]", ""),
                    f"{fit.printed:g} Hz",
                    fit.found,
                    "Hz",
                    within=fit.tolerance * fit.printed,
                    note=f"Calibrated to it, within {100.0 * fit.tolerance:.0f} % asked.",
                )
            )
    for angle, (_, *printed) in CLOSED_LOOP.items():
        side = "inboard" if angle > 0 else "outboard"
        near = sorted({round(fit.found, 2) for fit in table if fit.what.startswith(f"60 deg {side}, mode")})
        modes = Mace(CALIBRATED_GAINS).modes(math.radians(angle))
        found.append(
            claim(
                "5.3.2",
                f"60 deg {side}, modes 2 to 4",
                ", ".join(f"{value:.2f}" for value in printed) + " Hz",
                ", ".join(f"{value:.2f} Hz" for value in near),
                _each_is_a_mode(printed, [mode.frequency for mode in modes]),
                because=Because(
                    "Not reproduced but for one: the gimbal's own rotation on the end of the bus, at 19 Hz with the "
                    "payload vertical, lower the more it leans. The open-loop table has nothing between 6.9 and "
                    "19.08 Hz, and a bus in the plane gets no modes from its loops. Flexible mounts of gimbals and "
                    "attitude unit were tried: they put a mode at 14 Hz into the open loop.",
                    len(near) == 1 and 12.0 < near[0] < 18.0,
                ),
            )
        )
    return found


def _identified(done: Experiments) -> list[Row]:
    spectra = {"open loop": done.vertical, "inboard": done.inboard, "outboard": done.outboard}
    noise = {name: _nearest(each, each.averaged.peaks) for name, each in spectra.items()}
    fitted = {name: _nearest(each, [mode.frequency for mode in each.rung]) for name, each in spectra.items()}
    working = {name: _nearest(each, [mode.mode.frequency for mode in each.working]) for name, each in spectra.items()}
    return [
        claim(
            "5.3.2",
            "white noise, averaged spectra of several 30 s runs, open loop: four modes",
            "4 modes",
            ", ".join(f"{peak:.2f}" for peak in done.vertical.averaged.peaks) + " Hz",
            len(done.vertical.averaged.peaks) == 4 and noise["open loop"] < SEEN,
            note=f"At most {100.0 * noise['open loop']:.0f} % from the linearised modes.",
        ),
        claim(
            "5.3.2",
            "twenty 6 s runs, closed loop: of the open loop's second and third mode nothing is seen",
            "none from 5 to 8 Hz",
            "; ".join(
                ", ".join(f"{peak:.2f}" for peak in each.averaged.peaks) + " Hz"
                for each in (done.inboard, done.outboard)
            ),
            not any(5.0 < peak < 8.0 for each in (done.inboard, done.outboard) for peak in each.averaged.peaks),
            note="The attitude unit holds the middle of the bus: the third is damped away, and the second stays in the "
            "left half, at 5.5 Hz, where the noise does not reach it.",
        ),
        claim(
            "5.3.2",
            "frequencies shift with the payload's angle, outboard above inboard",
            "2.18 and 1.88 Hz",
            f"{done.outboard.rung[0].frequency:.2f} and {done.inboard.rung[0].frequency:.2f} Hz",
            done.outboard.rung[0].frequency > done.inboard.rung[0].frequency,
        ),
        beyond(
            "5.3.2",
            "the same noise, then free vibration fitted by `identify`: largest difference from the linearised modes",
            ", ".join(f"{name} {100.0 * each:.1f} %" for name, each in fitted.items()),
            max(fitted.values()) < FITTED,
        ),
        beyond(
            "5.3.2",
            "the shaken records themselves, both sensors together (SSI-cov, order found): largest difference from the "
            "linearised modes",
            "; ".join(f"{name} {_listed(each)}, {100.0 * working[name]:.1f} %" for name, each in spectra.items()),
            max(working.values()) < SEEN,
            note="With damping ratios, which averaged spectra do not give. Modes with less than some percent of the "
            "vibration are left out: three minutes tell too little of them.",
        ),
        beyond(
            "5.3.2",
            "damping ratio of the fundamental, closed loop, by payload angle",
            ", ".join(f"{angle:+.0f} deg {modes[0].damping:.3f}" for angle, modes in sorted(done.on_the_way.items())),
            all(modes[0].damping > 0.01 for modes in done.on_the_way.values()),
            printed="about 1 %",
            note="The gimbal's loop damps what turns the payload, more the farther it leans outboard.",
        ),
    ]


def _each_is_a_mode(printed: Sequence[float], modes: Sequence[float]) -> bool:
    """Whether every printed frequency is within `CLUSTER` of a mode of its own; both increase."""
    return any(
        all(abs(mode / value - 1.0) <= CLUSTER for value, mode in zip(printed, chosen, strict=True))
        for chosen in combinations(modes, len(printed))
    )


def _listed(seen: Spectra) -> str:
    """Modes of the shaken records with their damping ratios."""
    return ", ".join(f"{each.mode.frequency:.2f} Hz ({each.mode.damping:.3f})" for each in seen.working)


def _nearest(seen: Spectra, found: list[float] | tuple[float, ...]) -> float:
    """Largest relative difference of what was found from the nearest linearised mode."""
    modes = np.array([mode.frequency for mode in seen.plant.modes()])
    return max(float(np.abs(modes / value - 1.0).min()) for value in found)
