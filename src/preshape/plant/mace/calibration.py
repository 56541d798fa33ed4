"""The unknown parameters of MACE from Hyde's three frequency tables, and the table that shows how well they fit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import whole_number
from preshape.plant.mace.linear import Linearised, fundamental_swing, oscillations
from preshape.plant.mace.structure import (
    CALIBRATED,
    CALIBRATED_GAINS,
    POUND,
    MaceGains,
    MaceStructure,
)

__all__ = ["BOUNDS", "CLOSED_LOOP", "OPEN_LOOP", "FitRow", "calibrate", "calibration_table"]

OPEN_LOOP = (1.65, 5.42, 6.90, 19.08)
"""Payloads vertical, no control [Hz] (Hyde 5.3.2)."""

CLOSED_LOOP = {60: (1.88, 13.40, 14.20, 15.90), -60: (2.18, 14.25, 15.25, 15.90)}
"""By payload angle [deg], inboard positive; [Hz] (Hyde 5.3.2)."""

SLOW = (0.15, 0.6)
"""The closed loop's slow mode [Hz], and the damping ratio that puts its overshoot at 4.2 s as Hyde has it (5.3.2): the
damped frequency is then 1 / (2 x 4.2 s) = 0.119 Hz, and sqrt(1 - (0.119 / 0.15)^2) = 0.6."""

SWING = 0.15
"""Of the far end in an unshaped slew from -20 to 20 deg, peak to peak [mm] (Hyde 5.3.4)."""

DAMPING = 0.01
"""Of the bus's bending [-]: "about 1 %" (Hyde 5.3.2)."""

LIGHT = 0.15
"""A closed-loop mode with less damping than this shows in a spectrum."""

FLEXIBLE = 1.4
"""Closed-loop modes below this [Hz] are those of the loops on the rigid article."""

TOLERANCES = (0.05, 0.08)
"""What is asked of the open-loop modes, and of the closed loop's fundamental: residuals are counted in these."""

BOUNDS: dict[str, tuple[float, float]] = {
    "bus_density": (0.2, 0.6),
    "bending_stiffness": (15.0, 130.0),
    "axial_stiffness": (3e5, 1.5e6),
    "node_mass": (0.15, 0.8),
    "gyro_mass": (0.0, 3.0 * POUND),
    "attitude_offset": (0.0, 0.2),
    "attitude_inertia": (0.02, 0.3),
    "gimbal_total": (13.5 * POUND, 16.5 * POUND),
    "gimbal_offset": (0.0, 0.15),
    "gimbal_inertia": (0.01, 0.12),
    "stage_mass": (0.0, 6.0 * POUND),
    "axis_height": (0.02, 0.25),
    "arm": (0.02, 0.4),
    "payload_inertia": (0.004, 0.12),
    "attitude_stiffness": (1.0, 80.0),
    "attitude_damping": (1.0, 150.0),
    "gimbal_stiffness": (0.01, 1.5),
    "gimbal_damping": (0.01, 3.0),
}
"""What is physically plausible, in SI units. Polycarbonate tubes of 25 to 40 mm, the wiring in them; aluminium
nodes; a gimbal of about 15 lb of which up to 6 lb turn with the 5 lb payload; the wheels below the middle node."""

HEAVY = 0.3
"""Damping ratio that a loop's own modes must have, since they do not show in Hyde's spectra."""


SWING_WEIGHT = 1.0
"""Of the swing's logarithm: it decides between parameters that fit the frequencies alike, and gives way to them."""

EVEN = 4.0
"""Power of the second round's residuals, in units of their tolerances: below one they cost little, above one much."""


@dataclass(frozen=True)
class FitRow:
    """One printed number beside the model's.

    Attributes
    ----------
    what : str
    printed, found : float
        [Hz], or as `what` says.
    residual : float
        found / printed - 1 [-].
    tolerance : float or None
        What is asked of it [-]; None where the model is only compared.
    """

    what: str
    printed: float
    found: float
    tolerance: float | None

    @property
    def residual(self) -> float:
        return self.found / self.printed - 1.0

    @property
    def holds(self) -> bool:
        """Within its tolerance, if it has one."""
        return self.tolerance is None or abs(self.residual) <= self.tolerance

    def __str__(self) -> str:
        asked = "compared only" if self.tolerance is None else f"asked {100.0 * self.tolerance:.0f} %"
        return f"{self.what}: {self.printed:g}, model {self.found:.3f}, {100.0 * self.residual:+.1f} % ({asked})"


def calibration_table(
    structure: MaceStructure = CALIBRATED, gains: MaceGains = CALIBRATED_GAINS, *, elements: int = 2
) -> list[FitRow]:
    """Every number of Hyde's that the calibration knows, beside the model's.

    The modes between 13.4 and 15.9 Hz of the closed loop are compared with the model's nearest visible one. The planar
    bus has one there, the gimbal's own rotation on its end of the bus; what the others are is not known. With the loops
    open the table of four modes up to 19 Hz has none of them, and a bus in the plane gets no new ones from its loops.
    Gimbals and attitude unit on mounts of 20 to 2000 N m/rad, fitted with all the rest, do not bring them either: they
    add an open-loop mode at 14 Hz that is not in the table, and closed-loop ones at 13, 18 and 22 Hz.

    Examples
    --------
    >>> print(calibration_table()[0])
    open loop, mode 1 [Hz]: 1.65, model 1.729, +4.8 % (asked 5 %)
    """
    free = Linearised(structure, elements=elements).undamped()
    rows = [
        FitRow(f"open loop, mode {k} [Hz]", printed, float(found), TOLERANCES[0])
        for k, (printed, found) in enumerate(zip(OPEN_LOOP, free, strict=False), start=1)
    ]
    for angle, printed in CLOSED_LOOP.items():
        side = "inboard" if angle > 0 else "outboard"
        frequencies, dampings = _closed(structure, gains, math.radians(angle), elements)
        seen = frequencies[(frequencies > FLEXIBLE) & (dampings < LIGHT)]
        rows.append(FitRow(f"60 deg {side}, fundamental [Hz]", printed[0], float(seen[0]), TOLERANCES[1]))
        rows += [
            FitRow(f"60 deg {side}, mode {k} [Hz], the nearest", value, _nearest(seen, value), None)
            for k, value in enumerate(printed[1:], start=2)
        ]
        rows.append(FitRow(f"60 deg {side}, slow mode [Hz]", SLOW[0], float(frequencies[0]), TOLERANCES[1]))
        rows.append(FitRow(f"60 deg {side}, its damping [-]", SLOW[1], float(dampings[0]), None))
    swing = 1e3 * _swing(structure, gains, elements)
    rows.append(FitRow("far end, unshaped 40 deg slew, peak to peak [mm]", SWING, swing, None))
    rows.append(FitRow("total weight [lb]", 60.0, structure.total_mass / POUND, 0.03))
    return rows


def calibrate(*, starts: int = 8, seed: int = 3, elements: int = 2) -> tuple[MaceStructure, MaceGains]:
    """Fit the linearised model to Hyde's tables within :data:`BOUNDS`, from several seeded starts.

    Parameters
    ----------
    starts : int
        How many starts; the best fit counts. On two in three the fit ends at the same point.
    seed : int
        Of the starts.
    elements : int
        A strut.

    Returns
    -------
    MaceStructure, MaceGains
        The best fit.

    Notes
    -----
    Two rounds of least squares from each start: residuals in units of their tolerances, then those that are asked for
    squared once more, which evens them out.
    """
    from scipy.optimize import least_squares

    whole_number("starts", starts, 1, 1000)
    generator = np.random.default_rng(seed)
    best, least = None, math.inf
    for _ in range(starts):
        start = generator.uniform(0.02, 0.98, len(BOUNDS))
        rough = least_squares(_residuals, start, bounds=(0, 1), args=(elements, 1.0), max_nfev=25)
        fine = least_squares(_residuals, rough.x, bounds=(0, 1), args=(elements, EVEN), max_nfev=60)
        if fine.cost < least:
            best, least = fine.x, float(fine.cost)
    assert best is not None
    return _unpacked(best)


def _unpacked(position: NDArray[np.float64]) -> tuple[MaceStructure, MaceGains]:
    """From a point of the unit cube to parameters."""
    value = {
        name: low + (high - low) * float(x) for (name, (low, high)), x in zip(BOUNDS.items(), position, strict=True)
    }
    value["gimbal_mass"] = value.pop("gimbal_total") - value["stage_mass"]
    gains = {name: value.pop(name) for name in list(value) if name in MaceGains.__slots__}
    return MaceStructure(**value), MaceGains(**gains)


def _residuals(position: NDArray[np.float64], elements: int, power: float) -> NDArray[np.float64]:
    structure, gains = _unpacked(position)
    free = Linearised(structure, elements=elements).undamped()[:4]
    asked = list(np.log(free / np.array(OPEN_LOOP)) / TOLERANCES[0])
    others = [(structure.total_mass / POUND / 60.0 - 1.0) / 0.03]
    for angle, printed in CLOSED_LOOP.items():
        frequencies, dampings = _closed(structure, gains, math.radians(angle), elements)
        seen = frequencies[(frequencies > FLEXIBLE) & (dampings < LIGHT)]
        asked.append(math.log(seen[0] / printed[0]) / TOLERANCES[1] if len(seen) else 10.0)
        others += [math.log(frequencies[0] / SLOW[0]) / 0.1, (dampings[0] - SLOW[1]) / 0.2]
        own = dampings[frequencies < FLEXIBLE]
        others.append(30.0 * float(np.maximum(0.0, HEAVY - own).sum()))
    others.append(math.log(1e3 * _swing(structure, gains, elements) / SWING) / SWING_WEIGHT)
    even = np.sign(asked) * np.abs(asked) ** power
    return np.concatenate([even, others])


def _closed(
    structure: MaceStructure, gains: MaceGains, angle: float, elements: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    model = Linearised(structure, angle, elements=elements, gains=gains, damping=DAMPING)
    return oscillations(model.poles())


def _swing(structure: MaceStructure, gains: MaceGains, elements: int) -> float:
    """Of the left sensor after a commanded step of 40 deg at -20 deg, the fundamental alone, peak to peak [m]."""
    model = Linearised(structure, math.radians(-20.0), elements=elements, gains=gains, damping=DAMPING)
    return fundamental_swing(model, elements, gains.gimbal_stiffness * math.radians(40.0), FLEXIBLE)


def _nearest(frequencies: NDArray[np.float64], wanted: float) -> float:
    return float(frequencies[np.argmin(np.abs(np.log(frequencies / wanted)))])
