"""Hyde, section 5.3: what he prints of the non-linear MACE model beside ours, calibrated to his frequencies."""

from __future__ import annotations

import math

import numpy as np

from preshape import Shaper, design
from preshape.papers.hyde.chapter5_frequencies import frequency_rows
from preshape.papers.hyde.chapter5_slews import DT, SETTLED, Experiments, Slew, installed, residual
from preshape.papers.reproduction import Row
from preshape.papers.rows import Because, beyond, claim, number
from preshape.plant.mace import CALIBRATED_GAINS, GimbalLimits
from preshape.vibration import residual_vibration

__all__ = ["left_out", "rows"]

LEFT_OPEN_LOOP = (1.9, 12.5)
"""What Hyde finds in what is left after the shaped open-loop slew [Hz] (5.3.3)."""

SAME = 0.05
"""How near [-] a peak of ours must come to one of his to be the same: what the calibration asks of open-loop modes."""


def left_out() -> list[Row]:
    """The one row that stands here when the model cannot be simulated."""
    return [
        claim(
            "5.3",
            "the non-linear MACE model: frequencies and slews",
            "four tables, three slews",
            "left out",
            False,  # nothing of it was computed, so nothing of it holds
            because=Because("Exudyn is not installed: pip install 'preshape[plants]' brings it.", not installed()),
        )
    ]


def rows(done: Experiments) -> list[Row]:
    """Sections 5.3.2 to 5.3.5."""
    return [*frequency_rows(done), *_sizes(done), *_open_loop(done), *_shaped(done), *_merit(done)]


def _sizes(done: Experiments) -> list[Row]:
    small, large = done.small["unshaped"], done.large["unshaped"]
    start, between = done.outboard.rung[0], done.on_the_way[-40.0][0]
    peak = small.simulation.times[int(np.argmax(small.simulation.outputs["payload angle"]))]
    swings = [1e3 * residual(each.simulation, 2.0) for each in (small, large)]
    reason = Because(
        "Larger here: what a step does to the bus goes with the payload's inertia about its axis, and one small "
        "enough for his swing puts the fundamentals up to 9 % off. The calibration weighs swings least.",
        swings[0] > 0.15 and swings[1] > 0.5,
    )
    return [
        number("5.3.2", "peak overshoot time of a slew", "4.2 s", float(peak), "s", within=0.1),
        number("5.3.4", "unshaped 40 deg slew, peak to peak", "0.15 mm", swings[0], "mm", because=reason),
        number("5.3.4", "unshaped 120 deg slew, peak to peak", "0.50 mm", swings[1], "mm", because=reason),
        claim(
            "5.3.4",
            "unshaped, 120 deg against 40 deg",
            "3.3 x",
            f"{swings[1] / swings[0]:.1f} x",
            abs(swings[1] / swings[0] - 10.0 / 3.0) < 0.3,
            because=Because(
                "Less here after two seconds: where the slew of 120 deg starts the fundamental is damped most, "
                f"{start.damping:.3f}, at -40 deg {between.damping:.3f}.",
                start.damping > 1.3 * between.damping > 1.3 * done.on_the_way[-20.0][0].damping,
            ),
        ),
    ]


def _open_loop(done: Experiments) -> list[Row]:
    plain, shaped = done.open_loop["unshaped"], done.open_loop["open loop"]
    peaks = _swings(shaped, 4.0)
    shaper, convolved = done.shapers["open loop"], design.convolved([(f, 0.01) for f in done.vertical.averaged.peaks])
    saved = 100.0 * (1.0 - shaper.duration / convolved.duration)
    ends = done.vertical.plant.modes(math.radians(40.0))
    return [
        claim(
            "5.3.3",
            "open loop, 40 deg: the shaper greatly reduces the vibration",
            "sub-millimetre; greatly reduced",
            f"{1e3 * residual(plain.simulation, 4.5):.3f} mm, shaped {1e3 * residual(shaped.simulation, 4.5):.4f} mm",
            residual(shaped.simulation, 4.5) < 0.2 * residual(plain.simulation, 4.5) < 2e-4,
            note="Pulses of 0.7 s, 3 s apart: he prints neither.",
        ),
        claim(
            "5.3.3",
            "what is left is at frequencies of the new configuration",
            " and ".join(f"{printed:g}" for printed in LEFT_OPEN_LOOP) + " Hz",
            ", ".join(f"{peak:.2f} Hz" for peak in peaks),
            len(peaks) == len(LEFT_OPEN_LOOP)
            and all(abs(peak / printed - 1.0) <= SAME for peak, printed in zip(peaks, LEFT_OPEN_LOOP, strict=True)),
            because=Because(
                "The fundamental of our model hardly moves from vertical to 40 deg inboard with the loops open "
                f"({done.vertical.plant.modes()[0].frequency:.2f} to {ends[0].frequency:.2f} Hz); its fourth mode "
                f"falls to {ends[-1].frequency:.1f} Hz, as Hyde's may have to 12.5 Hz.",
                abs(peaks[0] / ends[0].frequency - 1.0) < 0.1 and ends[-1].frequency < 18.5,
            ),
        ),
        number(
            "5.3.3", "saving over the convolved sequence, our measured frequencies", "25 %", saved, "%", within=10.0
        ),
    ]


def _shaped(done: Experiments) -> list[Row]:
    made = []
    for angle, slews, most in ((40, done.small, 0.025 / 0.15), (120, done.large, 0.09 / 0.50)):
        plain, shaped = (residual(slews[name].simulation, SETTLED) for name in ("unshaped", "outboard"))
        made.append(
            claim(
                "5.3.4",
                f"closed loop, {angle} deg, outboard shaper: most of the vibration is inhibited",
                f"peak {most:.2f} of the unshaped one, flat after about 6 s",
                f"{shaped / plain:.3f} of the unshaped one after 6 s",
                shaped < most * plain,
            )
        )
    left = _swings(done.large["outboard"], 3.0)
    made.append(
        number(
            "5.3.4",
            "120 deg, outboard shaper: frequency of what is left",
            "1.83 Hz",
            left[0],
            "Hz",
            within=0.15,
            note="Below both the frequency that the shaper was made for and Hyde's inboard one.",
        )
    )
    return made


def _merit(done: Experiments) -> list[Row]:
    """The order of merit of 5.3.5, and ours."""
    large = {name: 1e3 * slew.residual for name, slew in done.large.items()}
    small = {name: 1e3 * slew.residual for name, slew in done.small.items()}
    shapers = done.shapers
    turned = done.large["inboard"].simulation.outputs["payload angle"]
    halfway = math.degrees(float(turned[round(shapers["inboard"].duration / DT)]))
    worst = {name: _worst(shapers[name], done) for name in ("inboard", "with 1.5 Hz")}
    return [
        beyond(
            "5.3.5",
            "40 deg: the inboard shaper leaves less than the outboard one",
            f"{1e3 * small['inboard']:.2f} against {1e3 * small['outboard']:.2f} µm",
            small["inboard"] < small["outboard"],
            note="Hyde says it of 120 deg.",
        ),
        claim(
            "5.3.5",
            "120 deg: the inboard shaper leaves less than the outboard one",
            "less",
            f"{1e3 * large['inboard']:.2f} against {1e3 * large['outboard']:.2f} µm",
            large["inboard"] < large["outboard"],
            because=Because(
                f"When its last impulse comes the payload is still at {halfway:.0f} deg, where our fundamental is near "
                "the outboard one, which is also damped most; in the slew of 40 deg, which starts at -20 deg, the "
                "inboard shaper is the better one.",
                halfway < -30.0 and small["inboard"] < small["outboard"],
            ),
        ),
        claim(
            "5.3.5",
            "120 deg: adding 1.50 Hz to the inboard shaper is no better",
            "if anything worse",
            f"{1e3 * large['with 1.5 Hz']:.2f} against {1e3 * large['inboard']:.2f} µm",
            large["with 1.5 Hz"] >= large["inboard"],
            because=Because(
                "Better here: over the fundamentals measured on the way it leaves at most "
                f"{100.0 * worst['with 1.5 Hz']:.1f} %, the inboard one {100.0 * worst['inboard']:.1f} %.",
                worst["with 1.5 Hz"] < worst["inboard"],
            ),
        ),
        claim(
            "5.3.5",
            "120 deg: adding 1.50 and 2.00 Hz is clearly best of the four",
            "significant improvement",
            ", ".join(f"{name} {1e3 * large[name]:.2f} µm" for name in shapers if name in large and name != "ours"),
            large["with 1.5 and 2.0 Hz"] < 0.5 * min(large[name] for name in ("outboard", "inboard", "with 1.5 Hz")),
            note=f"Unshaped {large['unshaped']:.3f} mm.",
        ),
        beyond(
            "5.3.5",
            "120 deg: specified insensitivity, 2 % over the frequencies measured on the way",
            f"{1e3 * large['ours']:.2f} µm with {shapers['ours'].duration:.3f} s, {len(shapers['ours'])} impulses",
            large["ours"] < large["inboard"] and shapers["ours"].duration < shapers["inboard"].duration,
            note="Less than the inboard shaper's and shorter; Hyde's best takes "
            f"{shapers['with 1.5 and 2.0 Hz'].duration:.3f} s.",
        ),
        _torque(),
    ]


def _torque() -> Row:
    needed = CALIBRATED_GAINS.gimbal_stiffness * math.radians(120.0)
    limit = GimbalLimits().torque
    return beyond(
        "A.3.2",
        "a step of 120 deg asks the gimbal for more than its 40 oz-in of normal operation",
        f"{40.0 * needed / limit:.0f} oz-in",
        needed > limit,
        note="Saturation is not in Hyde's model (5.3.2); ours has it as an option.",
    )


def _worst(shaper: Shaper, done: Experiments) -> float:
    return max(
        float(residual_vibration(shaper, [modes[0].frequency], modes[0].damping)[0])
        for modes in done.on_the_way.values()
    )


def _swings(slew: Slew, start: float) -> list[float]:
    """Frequencies of the two highest peaks of the far end's velocity from `start` on [Hz], the lower first."""
    from scipy.signal import find_peaks

    values = np.gradient(slew.simulation.outputs["left sensor"], DT)[slew.simulation.times >= start]
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(len(values)), 1 << 16))
    frequencies = np.fft.rfftfreq(1 << 16, DT)
    places, _ = find_peaks(
        np.where((frequencies > 1.0) & (frequencies < 22.0), spectrum, 0.0), prominence=0.05 * spectrum.max()
    )
    highest = sorted(places, key=lambda k: -spectrum[k])[:2]
    return sorted(float(frequencies[k]) for k in highest)
