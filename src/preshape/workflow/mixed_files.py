"""Several measurements in one call: are they of one axis of one machine?"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from preshape.identify import Measurement, TimeSeries

__all__ = ["axis_of", "mixed_up"]

SAME_RATE = 0.05
"""Relative difference of sample rates within which it is the same sensor: clocks drift."""

DOMINANT = 9.0
"""A channel with so many times the power of the next is the axis that was shaken."""

AXES = ("x", "y", "z")
_VECTOR = re.compile(r"axis=(-?\d+(?:\.\d+)?(?:,-?\d+(?:\.\d+)?){1,2})")
_LETTER = re.compile(r"(?<![a-z0-9])([xyz])(?![a-z])", re.IGNORECASE)


def axis_of(name: str, measurement: Measurement) -> str:
    """The axis that a measurement is of; empty where neither the file's name nor its content says.

    Parameters
    ----------
    name : str
        The file name: Klipper and RepRapFirmware put the axis into it, as a letter by itself or as `axis=1.000,-1.000`.
    measurement : TimeSeries or Spectrum
        Where the name is silent, the channel that has nine times the power of any other.
    """
    vector = _VECTOR.search(name)
    if vector:
        return "direction " + ",".join(f"{float(part):g}" for part in vector[1].split(",")[:2])
    letter = _LETTER.search(Path(name).stem)
    if letter:
        return letter[1].lower()
    if isinstance(measurement, TimeSeries):
        power = np.var(measurement.values, axis=-1)
    else:
        power = measurement.density.sum(axis=-1)
    order = np.argsort(power)[::-1]
    channels = [channel.lower() for channel in measurement.channels]
    if len(channels) < 2 or not set(channels) <= set(AXES) or power[order[0]] < DOMINANT * power[order[1]]:
        return ""
    return channels[int(order[0])]


def mixed_up(names: Sequence[str], measurements: Sequence[Measurement]) -> tuple[str, ...]:
    """Sentences on measurements that are not of one axis, or not of one machine; empty when they may be.

    Parameters
    ----------
    names : sequence of str
        File names, for the axis and for the sentences.
    measurements : sequence of TimeSeries or Spectrum
        In the same order.
    """
    found = []
    meant = "; if this is meant, say mixed=True (on the command line --mixed)."
    axes = {name: axis_of(name, one) for name, one in zip(names, measurements, strict=True)}
    if len({axis for axis in axes.values() if axis}) > 1:
        listed = "; ".join(f"{name}: {axis}" for name, axis in axes.items() if axis)
        found.append(
            f"the files are of different axes ({listed}), and one shaper for all of them is a compromise: "
            f"calibrate each axis by itself{meant}"
        )
    recordings = [(name, one) for name, one in zip(names, measurements, strict=True) if isinstance(one, TimeSeries)]
    rates = [one.sample_rate for _, one in recordings]
    units = {one.unit for _, one in recordings if one.unit}
    makers = {_maker(one) for one in measurements}
    if len(makers) > 1 or len(units) > 1 or (rates and max(rates) > (1.0 + SAME_RATE) * min(rates)):
        listed = "; ".join(f"{name}: {_described(one)}" for name, one in zip(names, measurements, strict=True))
        found.append(
            f"the files are not from one machine, or not from one sensor ({listed}): calibrate each machine by itself"
            f"{meant}"
        )
    return tuple(found)


def _maker(measurement: Measurement) -> str:
    """Whose file it is: the first word of the format."""
    return measurement.format.split()[0]


def _described(measurement: Measurement) -> str:
    if isinstance(measurement, TimeSeries):
        unit = f" in {measurement.unit}" if measurement.unit else ""
        return f"{measurement.format}, {measurement.sample_rate:.4g} Hz{unit}"
    return measurement.format
