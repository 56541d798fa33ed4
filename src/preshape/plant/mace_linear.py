"""The linear MACE model: a flexible spacecraft bus that floats, a heavy payload on a gimbal at its right end.

Hyde tested his shapers on a model of MIT's Middeck Active Control Experiment: the bus is a uniform Bernoulli-Euler beam
of six finite elements, the payload a point mass at the end of a rigid member that stands across the bus, a motor
between the two. He prints its frequencies, not its parameters. Two ratios settle all five frequencies: sqrt(E I / (m
L^4)), and the payload's mass to the bus's. What they leave open is the scale of mass and torque; here a payload with
gimbal weighs about 20 lb, as elsewhere in his text, and the torque is what shakes the far end as much as he says.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from preshape.checks import not_negative, positive
from preshape.plant.beam import Beam
from preshape.plant.beam_parts import HingedPayload
from preshape.plant.exact import Motion
from preshape.plant.flexible_structure import FlexibleStructure
from preshape.profile import Profile

__all__ = ["linear_mace", "linear_mace_beam", "linear_mace_torque", "peak_to_peak", "torque_pulses"]

LENGTH = 1.5
"""Of the bus [m] (Hyde 4.3)."""

ELEMENTS = 6
"""Hyde 5.2.1."""

BENDING = 3.970206
"""sqrt(E I / (m L^4)) [rad/s], m the mass per length: identified from the frequencies of Hyde 5.2.1."""

PAYLOAD_RATIO = 11.305
"""Mass of the payload by that of the bus: identified with it."""

BUS_MASS = 0.80
"""[kg]. The frequencies do not depend on it; the payload weighs 20 lb with it."""

ARM = 0.15
"""From the gimbal's axis to the point mass, across the bus [m]. Nothing but the payload's own angle depends on it."""

WIDTH, DELAY = 0.25, 0.75
"""Of a torque pulse, and from the first to the opposite one [s]; Hyde prints neither."""

UNSHAPED_RESIDUAL = 1.2e-3
"""Of the far end after an unshaped slew, peak to peak [m]: "roughly 1.2 mm" (Hyde 5.2.2)."""

FASTEST_SAMPLES = 40
"""A period of the fastest mode: samples miss (pi / 40)^2 / 2, 0.3 %, of a peak of that mode at most."""


def linear_mace_beam(elements: int = ELEMENTS) -> Beam:
    """The bus with its payload, in any number of elements.

    Examples
    --------
    >>> linear_mace_beam().modes.frequencies[:5].round(1).tolist()
    [9.8, 31.7, 66.2, 114.1, 175.9]
    """
    density = BUS_MASS / LENGTH
    return Beam(
        LENGTH,
        elements,
        bending_stiffness=BENDING**2 * density * LENGTH**4,
        mass_per_length=density,
        payloads=[HingedPayload(LENGTH, PAYLOAD_RATIO * BUS_MASS, across=ARM)],
    )


def linear_mace(*, damping: float = 0.0, count: int | None = None, elements: int = ELEMENTS) -> FlexibleStructure:
    """The model of Hyde 5.2, driven by the torque of the gimbal.

    Parameters
    ----------
    damping : float
        Damping ratio of all modes [-]; his shapers for it assume 0.
    count : int, optional
        How many flexible modes; all 12 of the six elements unless given.
    elements : int
        Of the bus.

    Returns
    -------
    FlexibleStructure
        Input "torque" [N m], on the payload and reversed on the bus. Outputs "left" and "right", the displacements of
        the bus's ends across it [m]; "bus" and "payload", angles of the bus at the gimbal and of the payload [rad];
        "centre", the displacement of the centre of mass [m].

    References
    ----------
    Hyde, section 5.2.1.

    Examples
    --------
    >>> plant = linear_mace()
    >>> len(plant.modes()), round(plant.modes()[0].frequency, 3)
    (12, 9.802)
    """
    beam = linear_mace_beam(elements)
    looks = {
        "left": beam.displacement(0.0),
        "right": beam.displacement(LENGTH),
        "bus": beam.slope(LENGTH),
        "payload": beam.payload_angle(),
        "centre": beam.centre_of_mass(),
    }
    return beam.plant(beam.hinge_angle(), looks, damping=damping, count=count, name="torque")


def torque_pulses(torque: float, width: float = WIDTH, delay: float = DELAY) -> Profile:
    """The slew of Hyde 5.2.2: a square torque pulse, the payload turns on, and an opposite pulse stops it.

    Parameters
    ----------
    torque : float
        Of the first pulse [N m].
    width : float
        Of each pulse [s].
    delay : float
        From the start of the first to the start of the second [s], at least `width`.

    Examples
    --------
    >>> torque_pulses(2.0)([0.1, 0.5, 0.8, 1.5]).tolist()
    [2.0, 0.0, -2.0, 0.0]
    """
    width = positive("width", width, "s")
    not_negative("delay beyond the width", delay - width, "s")
    return Profile.steps([0.0, width, delay, delay + width], [torque, -torque, -torque, torque])


def peak_to_peak(motion: Motion, output: str, start: float | None = None, span: float = 1.0) -> float:
    """Largest minus smallest value of an output over a time, sampled finely for its fastest mode.

    Parameters
    ----------
    motion : Motion
        What the plant does.
    output : str
        Which of its outputs.
    start : float, optional
        Where the time begins [s]; where the command ends unless given.
    span : float
        How long it is [s].

    Examples
    --------
    >>> motion = linear_mace().motion(torque_pulses(linear_mace_torque()))
    >>> round(1e3 * peak_to_peak(motion, "left"), 6)
    1.2
    """
    begin = motion.end_time if start is None else start
    fastest = max(mode.frequency for mode in motion.modes)
    samples = int(np.ceil(FASTEST_SAMPLES * fastest * positive("span", span, "s"))) + 1
    return float(np.ptp(motion(output, np.linspace(begin, begin + span, samples))))


@cache
def linear_mace_torque(residual: float = UNSHAPED_RESIDUAL, width: float = WIDTH, delay: float = DELAY) -> float:
    """The torque [N m] whose pulses leave the far end vibrating by `residual` [m], peak to peak in the second after."""
    motion = linear_mace().motion(torque_pulses(1.0, width, delay))
    return positive("residual", residual, "m") / peak_to_peak(motion, "left")
