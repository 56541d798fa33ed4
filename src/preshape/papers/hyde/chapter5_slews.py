"""Hyde, sections 5.3.3 to 5.3.5: the slews of the non-linear MACE model, plain and through each shaper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape import Shaper, design
from preshape.mode import Mode
from preshape.papers.hyde.chapter5_identified import Spectra, article, closed_loop, open_loop, rung_down
from preshape.plant import Simulation

__all__ = [
    "ADDED",
    "ASSUMED",
    "DT",
    "PERIOD",
    "SETTLED",
    "Experiments",
    "Slew",
    "experiments",
    "installed",
    "residual",
]

DT = 2e-3
"""Of commands and simulation [s], Hyde's "servo rate" (5.3.3); half of it changes the residuals by less than 0.1 %."""

END = 10.0
"""Of a simulation [s]; Hyde's details end there or before."""

ASSUMED = 0.01
"""The damping ratio that he gives every mode [-] (5.3.2)."""

ADDED = (1.50, 2.00)
"""Frequencies added to the inboard ones [Hz] (5.3.5)."""

OURS = 0.02
"""Tolerance of our own shaper over the measured bands [-]."""

BETWEEN = (-40.0, -20.0, 0.0, 20.0, 40.0)
"""Where the frequencies of the slew are measured besides its ends [deg]."""

PULSE, DELAY = 0.7, 3.0
"""Of the open-loop torque pulses, and from the first to the opposite one [s]; Hyde prints neither."""

OPEN_LOOP_SLEW = 40.0
"""[deg] (5.3.3)."""

SETTLED = 6.0
"""From here on [s] residuals are compared: both responses "die out at about 6 seconds" (5.3.4)."""

PERIOD = 0.57
"""Of the fundamental [s]."""


@dataclass(frozen=True, eq=False)
class Slew:
    """One slew: its name, the shaper if any, what the article did, and what is left [m], peak to peak."""

    name: str
    shaper: Shaper | None
    simulation: Simulation

    @property
    def residual(self) -> float:
        """In a period of the fundamental, the largest after 6 s, slow motion taken out."""
        return residual(self.simulation, SETTLED)


@dataclass(frozen=True, eq=False)
class Experiments:
    """Everything of section 5.3.

    Attributes
    ----------
    vertical, inboard, outboard : Spectra
        Open loop; closed loop at +60 and -60 deg.
    on_the_way : mapping of float to tuple of Mode
        Closed loop, by payload angle [deg].
    shapers : mapping of str to Shaper
        "open loop", and the variants of 5.3.5 by their names; "ours" last, for the bands
        that were measured on the way.
    open_loop, small, large : mapping of str to Slew
        40 deg open loop, 40 and 120 deg closed loop, by the name of the shaper; "unshaped" first.
    """

    vertical: Spectra
    inboard: Spectra
    outboard: Spectra
    on_the_way: Mapping[float, tuple[Mode, ...]]
    shapers: Mapping[str, Shaper]
    open_loop: Mapping[str, Slew]
    small: Mapping[str, Slew]
    large: Mapping[str, Slew]


def installed() -> bool:
    """Whether the non-linear model can be simulated here."""
    from importlib.util import find_spec

    return find_spec("exudyn") is not None


def experiments() -> Experiments:
    """Identify, design and slew, once for rows and figures."""
    vertical, inboard, outboard = open_loop(), closed_loop(60.0), closed_loop(-60.0)
    on_the_way = {-60.0: outboard.rung}
    for angle in BETWEEN:
        on_the_way[angle] = rung_down(article(angle))
    on_the_way[60.0] = inboard.rung
    end, start = _assumed(inboard.rung), _assumed(outboard.rung)
    shapers = {
        "open loop": design.direct(_assumed(vertical.averaged.peaks)),
        "outboard": design.direct(start),
        "inboard": design.direct(end),
        "with 1.5 Hz": design.direct([*_assumed(ADDED[:1]), *end]),
        "with 1.5 and 2.0 Hz": design.direct([*_assumed(ADDED), *end]),
        "ours": design.specified_insensitivity(_bands(on_the_way), OURS),
    }
    variants: dict[str, Shaper | None] = {"unshaped": None}
    variants |= {name: shaper for name, shaper in shapers.items() if name != "open loop"}
    pulses = _pulses()
    return Experiments(
        vertical,
        inboard,
        outboard,
        on_the_way,
        shapers,
        open_loop={
            "unshaped": _pulsed("unshaped", None, pulses),
            "open loop": _pulsed("open loop", shapers["open loop"], pulses),
        },
        small={name: _slewed(name, 20.0, shaper) for name, shaper in variants.items()},
        large={name: _slewed(name, 60.0, shaper) for name, shaper in variants.items()},
    )


def residual(simulation: Simulation, start: float) -> float:
    """The far end's largest swing in a period of the fundamental from `start` [s] on, peak to peak [m].

    A parabola is taken out of every period: what the slow loops still do is no vibration.
    """
    count = round(PERIOD / DT)
    values = simulation.outputs["left sensor"][simulation.times >= start - 1e-9]
    x = np.linspace(-1.0, 1.0, count)
    slow, _ = np.linalg.qr(np.vander(x, 3))
    windows = np.lib.stride_tricks.sliding_window_view(values, count)[:: count // 4]
    return float(np.ptp(windows - (windows @ slow) @ slow.T, axis=1).max())


def _assumed(modes: tuple[Mode, ...] | tuple[float, ...]) -> list[tuple[float, float]]:
    """Frequencies with Hyde's damping."""
    return [(m.frequency if isinstance(m, Mode) else m, ASSUMED) for m in modes]


def _bands(measured: Mapping[float, tuple[Mode, ...]]) -> list[tuple[float, float, float, float]]:
    """From the least to the most that was measured on the way, of the fundamental and of the fastest mode seen."""
    bands = []
    for pick in (0, -1):
        frequencies = [modes[pick].frequency for modes in measured.values()]
        dampings = [modes[pick].damping for modes in measured.values()]
        bands.append((min(frequencies), max(frequencies), min(dampings), max(dampings)))
    return bands


def _slewed(name: str, angle: float, shaper: Shaper | None) -> Slew:
    """From `angle` outboard to the same inboard [deg], a step of the commanded angle."""
    command = np.full(round(END / DT) + 1, 2.0 * math.radians(angle))
    plant = article(-angle)
    return Slew(name, shaper, plant.simulate(_through(shaper, command) + plant.angle, DT, step=DT))


def _pulsed(name: str, shaper: Shaper | None, pulses: NDArray[np.float64]) -> Slew:
    """A pair of opposite torque pulses with the loops open, from vertical."""
    return Slew(name, shaper, article().simulate(_through(shaper, pulses), DT, step=DT))


def _pulses() -> NDArray[np.float64]:
    """The torque that turns the payload by 40 deg [N m]: as if the rest stood still, then corrected by what it does."""
    times = DT * np.arange(round(END / DT) + 1)
    half = 0.5 * DT
    shape = np.where(times < PULSE - half, 1.0, 0.0)
    shape -= np.where((times >= DELAY - half) & (times < DELAY + PULSE - half), 1.0, 0.0)
    torque = 0.1
    for _ in range(2):
        turned = article().simulate(torque * shape, DT, step=DT).outputs["payload angle"]
        late = turned[(times > DELAY + PULSE) & (times < DELAY + PULSE + 2.0 * PERIOD)]
        torque *= math.radians(OPEN_LOOP_SLEW) / float(late.mean())
    return torque * shape


def _through(shaper: Shaper | None, command: NDArray[np.float64]) -> NDArray[np.float64]:
    return command if shaper is None else np.asarray(shaper.shape(command, DT))[: len(command)]
