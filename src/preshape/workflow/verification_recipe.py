"""What to run on the machine for a verification: the same move unshaped and shaped, recorded by the sensor.

Sources. Klipper: ACCELEROMETER_MEASURE starts, and called again stops and writes /tmp/<sensor>-<NAME>.csv; NAME holds
letters, digits, - and _ only (klippy/extras/adxl345.py). SET_INPUT_SHAPER SHAPER_FREQ_<axis>=0 switches off
(Klipper's documentation, Resonance Compensation). RepRapFirmware: M956 P S A0 F and M593 P"none" (Duet's documentation
of M956, M593 and "Using accelerometers").
"""

from __future__ import annotations

import math

from preshape.errors import InputError
from preshape.export import render
from preshape.shaper import Shaper

__all__ = ["RECIPES", "recipe"]

REST = 1.0
"""Rest before each move [s]: what rings from the last one dies away."""

QUIET = 0.3
AFTER = 1.0
"""Recorded before the move, and after the stop [s]."""

RRF_RATE = 1344.0
"""Samples per second of the LIS3DH at its default, by Duet's documentation [Hz]."""

STEP = 0.001
"""Between two positions of a table [s]."""

LONGEST = 100.0
"""Of a table [s]."""

LARGEST = 1e6
LEAST = 1e-3


def _klipper(axis: str, distance: float, speed: float, acceleration: float, shaper: Shaper | None, repeats: int) -> str:
    upper, lasting = axis.upper(), _duration(distance, speed, acceleration)
    setting = [
        f"SET_INPUT_SHAPER SHAPER_TYPE_{upper}=mzv SHAPER_FREQ_{upper}=50 DAMPING_RATIO_{upper}=0.1"
        " ; PUT YOUR SHAPER HERE, see: preshape export klipper"
    ]
    if shaper is not None:
        setting = _klipper_lines(shaper, axis)
    lines = [
        "; Home first. Put the head where the move fits; all moves are relative and come back.",
        f"; Compare with: preshape verify --lasting {lasting:.5g} --before ... --after ... --shaper ...",
        "; The sensor is [adxl345]; for a named one add CHIP=name to each ACCELEROMETER_MEASURE.",
        "; The files are /tmp/adxl345-<NAME>.csv on the printer's computer.",
        f"SET_VELOCITY_LIMIT VELOCITY={speed:g} ACCEL={acceleration:g}",
        "; Newer Klipper brakes early on short moves unless told not to; older ones do not know this parameter.",
        "SET_VELOCITY_LIMIT MINIMUM_CRUISE_RATIO=0",
        "G91",
    ]
    for kind, switched in (("before", [f"SET_INPUT_SHAPER SHAPER_FREQ_{upper}=0"]), ("after", setting)):
        lines += ["", f"; {'unshaped' if kind == 'before' else 'shaped'}", *switched]
        for number in range(1, repeats + 1):
            lines += [
                f"G4 P{1e3 * REST:.0f}",
                "M400",
                "ACCELEROMETER_MEASURE",
                f"G4 P{1e3 * QUIET:.0f}",
                f"G1 {upper}{distance:g} F{60.0 * speed:g}",
                "M400",
                f"G4 P{1e3 * AFTER:.0f}",
                "M400",
                f"ACCELEROMETER_MEASURE NAME={kind}_{axis}_{number}",
                f"G1 {upper}{-distance:g} F{60.0 * speed:g}",
            ]
    return "\n".join([*lines, "G90", "; RESTART, or your own lines, restore the limits and the shaper.", ""])


def _rrf(axis: str, distance: float, speed: float, acceleration: float, shaper: Shaper | None, repeats: int) -> str:
    upper, lasting = axis.upper(), _duration(distance, speed, acceleration)
    moving = lasting + (shaper.duration if shaper else 0.2)
    samples = math.ceil(RRF_RATE * (QUIET + moving + AFTER))
    lines = [
        "; Home first. Put the head where the move fits; all moves are relative and come back.",
        f"; Compare with: preshape verify --lasting {lasting:.5g} --before ... --after ... --shaper ...",
        "; P0 is a sensor on the main board; on a CAN board write its address, such as P121.0 (see M955).",
        f"; {samples} samples at {RRF_RATE:g} Hz (LIS3DH); another rate needs another number.",
        "; The files are in 0:/sys/accelerometer. Discard those whose last line counts overflows.",
        f"M201 {upper}{acceleration:g}",
        f"M203 {upper}{60.0 * speed:g}",
        f"M204 P{acceleration:g} T{acceleration:g}",
        "G91",
    ]
    shaped = ['M593 P"zvd" F40 S0.1 ; PUT YOUR SHAPER HERE, see: preshape export rrf']
    if shaper is not None:
        shaped = _settings(shaper, "rrf", None)
    for kind, switched in (("before", ['M593 P"none"']), ("after", shaped)):
        lines += ["", f"; {'unshaped' if kind == 'before' else 'shaped'}", *switched]
        for number in range(1, repeats + 1):
            lines += [
                "M400",
                f"G4 P{1e3 * REST:.0f}",
                f'M956 P0 S{samples} A0 F"{kind}_{axis}_{number}.csv"',
                f"G4 P{1e3 * QUIET:.0f}",
                f"G1 {upper}{distance:g} F{60.0 * speed:g}",
                "M400",
                f"G4 P{1e3 * (AFTER + 1.0):.0f} ; the file is being written",
                f"G1 {upper}{-distance:g} F{60.0 * speed:g}",
            ]
    return "\n".join([*lines, "G90", '; Your own M201, M203, M204 and M593 restore the machine: M98 P"config.g".', ""])


def _csv(axis: str, distance: float, speed: float, acceleration: float, shaper: Shaper | None, repeats: int) -> str:
    """Position over time, unshaped and shaped, at 1 kHz."""
    import numpy as np

    from preshape.command import trapezoid

    length = _duration(distance, speed, acceleration) + (shaper.duration if shaper else 0.0) + AFTER
    if length > LONGEST:
        raise InputError(f"the move takes {length:.0f} s: a table holds {LONGEST:g} s at most, so move less or faster.")
    move = trapezoid(
        distance, maximum_speed=speed, maximum_acceleration=acceleration, dt=STEP, rest=length, quantity="position [mm]"
    )
    position = np.concatenate([np.zeros(round(QUIET / STEP)), move.values])
    position = position[: round((QUIET + length) / STEP) + 1]
    columns = [position] if shaper is None else [position, shaper.shape(position, STEP)[: position.size]]
    rows = [",".join(["time [s]", "unshaped [mm]", "shaped [mm]"][: 1 + len(columns)])]
    rows += [f"{k * STEP:.3f}," + ",".join(f"{v:.9g}" for v in row) for k, row in enumerate(zip(*columns, strict=True))]
    return "\n".join([*rows, ""])


RECIPES = {"klipper": _klipper, "rrf": _rrf, "csv": _csv}
"""What a recipe can be written for."""


def recipe(
    target: str,
    *,
    axis: str,
    distance: float,
    speed: float,
    acceleration: float,
    shaper: Shaper | None = None,
    repeats: int = 3,
) -> str:
    """The moves of a verification, unshaped and shaped, with the sensor's recording commands.

    Parameters
    ----------
    target : str
        "klipper", "rrf" (RepRapFirmware) or "csv": positions over time at 1 kHz for any other controller.
    axis : str
        "x", "y" or "z".
    distance, speed, acceleration : float
        Of the move [mm, mm/s, mm/s²]; of a CSV in any unit of length.
    shaper : Shaper, optional
        Written into the recipe, as `preshape export` would for this controller; without it a line says where to put
        yours.
    repeats : int
        Recordings of each kind, 1 to 20.

    Returns
    -------
    str
        G-code with comments, or a table.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> text = recipe("rrf", axis="x", distance=100.0, speed=200.0, acceleration=4000.0)
    >>> text.count("M956"), text.count('M593 P"none"')
    (6, 1)
    """
    if target not in RECIPES:
        raise InputError(f"there is no recipe for {target!r}: it is one of {', '.join(RECIPES)}.")
    if axis not in ("x", "y", "z"):
        raise InputError(f"axis {axis!r} is not known: it is x, y or z.")
    for name, value in (("distance", distance), ("speed", speed), ("acceleration", acceleration)):
        if not LEAST <= value <= LARGEST:
            raise InputError(f"{name} {value:g} is out of range: give {LEAST:g} to {LARGEST:g}.")
    if isinstance(repeats, bool) or not isinstance(repeats, int) or not 1 <= repeats <= 20:
        raise InputError(f"{repeats!r} repeats make no sense: give 1 to 20.")
    return RECIPES[target](axis, distance, speed, acceleration, shaper, repeats)


def _settings(shaper: Shaper, target: str, axis: str | None) -> list[str]:
    """The lines that `preshape export` would have the user paste, without blank ones."""
    exported = render(shaper, target, axis=axis)
    written = next(str(text) for name, text in exported.files.items() if name.endswith(exported.target.ending))
    return [line for line in written.splitlines() if line.strip()]


def _klipper_lines(shaper: Shaper, axis: str) -> list[str]:
    """What Klipper's configuration would say, as the command that says it while the printer runs."""
    settings = _settings(shaper, "klipper", axis)
    comments = [f"; {line.lstrip('# ')}" for line in settings if line.startswith("#")]
    pairs = [line.split("#")[0].split(":" if ":" in line else "=") for line in settings if line[:1].isalpha()]
    words = " ".join(f"{name.strip().upper()}={value.strip()}" for name, value in pairs)
    return [*comments, f"SET_INPUT_SHAPER {words}"]


def _duration(distance: float, speed: float, acceleration: float) -> float:
    reached = min(speed, math.sqrt(distance * acceleration))
    return distance / reached + reached / acceleration
