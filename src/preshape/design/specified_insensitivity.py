"""Specified insensitivity (SI): the shortest shaper that keeps vibration below a tolerance in given bands of modes.

EI shapers make a band as wide as their humps allow; here the bands come first: one a mode, with a range of damping
ratios, or measured sets of modes (positions, payloads, temperatures) of which the worst counts. The engine finds the
shortest positive shaper and proves it, on the continuum of frequencies, dampings and times.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real

from preshape.band import Band, BandsLike, bands_of
from preshape.checks import not_negative, tolerance_of
from preshape.design.negative_impulses import warned
from preshape.engine import (
    AtMostImpulses,
    Constraint,
    ImpulsesBetween,
    PartialSumsBetween,
    ServoGrid,
    VibrationAtMost,
    edges_of,
    largest_vibration,
    minimum_duration,
)
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["bands_of_sets", "specified_insensitivity"]


def specified_insensitivity(
    bands: BandsLike,
    tolerance: float = 0.05,
    *,
    impulses: tuple[float, float] | None = None,
    partial_sums: tuple[float, float] | None = None,
    at_most: int | None = None,
    dt: float | None = None,
) -> Shaper:
    """The shortest shaper with V <= `tolerance` for every natural frequency and damping ratio in every band.

    Parameters
    ----------
    bands : Band, (low, high[, damping[, most damping]]) or several
        Natural frequencies [Hz] and damping ratios [-]. :func:`bands_of_sets` makes them from measured sets of modes.
    tolerance : float
        V allowed [-], between 0 and 1.
    impulses : (float, float), optional
        Least (0 or below) and largest amplitude of an impulse [-]; by default all are positive, unless `partial_sums`
        are given. Others need `dt`, for without a grid two opposite impulses near each other are limited by nothing.
    partial_sums : (float, float), optional
        Least and largest level of a shaped unit step [-], what the actuator must hold; needs `dt`. Impulses may be
        negative then: ask for ``impulses=(0, inf)`` too if they must not.
    at_most : int, optional
        Most impulses allowed.
    dt : float, optional
        Servo period [s]: impulses on its multiples only.

    Returns
    -------
    Shaper
        ``design.status`` is "optimal" when proved: with ``design.certificate`` for positive impulses anywhere; on a
        grid because one slot fewer is impossible (a statement of the conic solver, to 1e-8). "feasible" otherwise:
        ``design.settings["gap"]`` is the part of the duration that a shorter one could save at most, where known.
        ``design.residual`` is the largest V in the bands. With negative impulses ``settings["high_frequency_gain"]``
        warns of what they excite above the bands.

    Raises
    ------
    InputError
        If a band reaches 0 Hz, the tolerance is out of range, or nothing meets all limits: it says which, and the
        nearest that does.

    References
    ----------
    Singhose, Seering & Singer (1996), whose sampled search this replaces by an exact one; the durations for one
    undamped band are those of the certified optimum.

    Examples
    --------
    >>> shaper = specified_insensitivity([(0.9, 1.1), (2.7, 3.3)], tolerance=0.05)
    >>> round(shaper.duration, 4), len(shaper), shaper.design.status
    (1.0032, 6, 'optimal')
    """
    wanted = bands_of(bands)
    limit = tolerance_of(tolerance)
    constraints: list[Constraint] = [VibrationAtMost(band, limit) for band in wanted]
    settings: dict[str, object] = {
        "tolerance": limit,
        "bands": [[band.low, band.high, band.least_damping, band.highest_damping] for band in wanted],
    }
    if impulses is not None:
        low, high = _pair("impulses", impulses)
        constraints.append(ImpulsesBetween(low, high))
        settings["impulses"] = _finite(low, high)
    if partial_sums is not None:
        low, high = _pair("partial_sums", partial_sums)
        constraints.append(PartialSumsBetween(low, high))
        settings["partial_sums"] = _finite(low, high)
    if at_most is not None:
        constraints.append(AtMostImpulses(at_most))
        settings["at_most"] = at_most
    if dt is not None:
        constraints.append(ServoGrid(dt))
        settings["dt"] = dt
    found = minimum_duration(constraints)
    if found.status == "infeasible":
        raise InputError(found.reason)
    if found.status == "feasible":
        settings["gap"] = found.gap if math.isfinite(found.gap) else None
    modes = _middles(wanted)
    shaper = Shaper.normalised(found.times, found.amplitudes)
    leads = shaper.duration - shaper.times[::-1]
    worst = largest_vibration(edges_of(wanted, limit), leads, shaper.amplitudes[::-1]).vibration
    if found.status == "optimal" and found.certificate is None:
        settings["proved"] = "no shaper on this grid within these limits is shorter"
    design = Design("si", modes, settings, found.status, residual=float(worst), certificate=found.certificate)
    shaper = Shaper(shaper.times, shaper.amplitudes, design)
    return warned(shaper, max(band.high for band in wanted)) if (shaper.amplitudes < 0.0).any() else shaper


def bands_of_sets(sets: Iterable[ModesLike], spread: float = 0.0) -> tuple[Band, ...]:
    """Bands from measured sets of modes, one set a position, payload or temperature; the worst of them counts.

    Parameters
    ----------
    sets : iterable of modes
        Each a list of (frequency [Hz], damping) pairs as measured.
    spread : float
        How far each frequency may be off [-], such as 0.02 for 2 %; every mode becomes a band of that width.

    Raises
    ------
    InputError
        If there is no set, or the spread is not in [0, 1).

    Examples
    --------
    >>> stretched_and_folded = [[(4.1, 0.01), (11.0, 0.02)], [(5.3, 0.01), (12.5, 0.02)]]
    >>> shaper = specified_insensitivity(bands_of_sets(stretched_and_folded, spread=0.02))
    >>> shaper.design.status, len(shaper)
    ('optimal', 5)
    """
    part = not_negative("spread", spread, "(a fraction)")
    if part >= 1.0:
        raise InputError(f"spread {part:g} would reach 0 Hz: give a fraction of the frequency, such as 0.02 for 2 %.")
    found: list[Band] = []
    for modes in sets:
        for mode in Modes(modes):
            band = Band(mode.frequency * (1.0 - part), mode.frequency * (1.0 + part), mode.damping)
            if band not in found:
                found.append(band)
    if not found:
        raise InputError("no set of modes was given: measure at least one.")
    return tuple(found)


def _pair(name: str, limits: object) -> tuple[float, float]:
    """Two numbers, infinite ones allowed."""
    if isinstance(limits, list | tuple) and len(limits) == 2 and all(isinstance(limit, Real) for limit in limits):
        return float(limits[0]), float(limits[1])
    raise InputError(f"{name} is {limits!r}: give two numbers, the lower one first.")


def _finite(low: float, high: float) -> list[float | None]:
    """Limits as a file can hold them: no limit is None."""
    return [limit if math.isfinite(limit) else None for limit in (low, high)]


def _middles(bands: tuple[Band, ...]) -> Modes | None:
    """A mode in the middle of each band, for what looks at single modes; None when two coincide."""
    middles = list(dict.fromkeys(band.middle for band in bands))
    try:
        return Modes(middles)
    except InputError:
        return None
