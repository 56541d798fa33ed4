"""Design under a controller's limits in one call: measurements in, picks and their gain over the stock choice out."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable
from typing import TypeAlias, cast

from preshape import identify
from preshape.checks import positive, tolerance_of, whole_number
from preshape.errors import InputError
from preshape.export import TARGETS, Limits, klipper
from preshape.export.klipper import Room
from preshape.export.klipper.spectra import SpectraLike
from preshape.mode import Modes
from preshape.report import TradeOff
from preshape.workflow.candidates import designed_candidates
from preshape.workflow.remaining import lines_to_still
from preshape.workflow.spectra import scored_spectrum
from preshape.workflow.trade_off import found_trade_off

__all__ = ["EVERY_CONTROLLER", "design_within", "room_of"]

Paths: TypeAlias = "str | os.PathLike[str] | Iterable[str | os.PathLike[str]]"

EVERY_CONTROLLER = 5
"""Most impulses unless told: what RepRapFirmware and Kalico hold; more has gained next to nothing on measured files."""

MOST = 25
"""More impulses than any known firmware holds are not looked for."""

SMALLEST = 0.01
"""Least amplitude [-]: a smaller impulse mostly moves the moment at which Klipper looks."""


def design_within(
    measured: Paths | SpectraLike,
    *,
    limits: str | Limits | None = None,
    version: str | None = None,
    maximum_impulses: int | None = None,
    longest: float | None = None,
    dt: float | None = None,
    remaining: float = 0.05,
) -> TradeOff:
    """The best shapers that a controller can hold, for measured vibration, by Klipper's own measures.

    Three picks are made: the highest max_accel at a vibration that is allowed; the least vibration at no more
    smoothing than the stock choice; and the highest max_accel with no more of either than the stock choice. All have
    positive impulses, and end no later after their centroid than the stock choice (scaled with the smoothing on the
    curve), because Klipper's measure would reward a late last impulse.

    Parameters
    ----------
    measured : paths or spectra
        One file or several, as for :func:`preshape.workflow.calibrate`; or normalised spectra, as for
        :func:`preshape.export.klipper.score`. The worst case of all counts.
    limits : str or Limits, optional
        A target that takes impulses, by name ("rrf", "kalico", "klipper-plugin", "c" ...), or what a controller holds;
        by default 5 impulses.
    version : str, optional
        Of the target; by default its first.
    maximum_impulses : int, optional
        At most so many, 2 to 25, if the limits allow them.
    longest : float, optional
        Longest duration [s], if the limits allow it.
    dt : float, optional
        Time grid [s] of the impulses; needed for a target that works on samples.
    remaining : float
        Vibration [-] that the performance pick may leave by Klipper's measure; the stock choice's, if that is more.

    Returns
    -------
    TradeOff
        The picks, every family, the optimum over smoothing, and the gain over the stock choice, 0 when there is none.

    Raises
    ------
    InputError
        If a file or spectrum cannot be used, or a limit is not understood or leaves no shaper.

    References
    ----------
    ECOSYSTEM 1.8 (the measures) and 1.10 (the linear programme behind the starts).

    Examples
    --------
    >>> import numpy as np
    >>> frequencies = np.arange(5.0, 130.0, 1.25)
    >>> psd = 1.0 / ((1.0 - (frequencies / 55.0) ** 2) ** 2 + (0.1 * frequencies / 55.0) ** 2)
    >>> trade = design_within((frequencies, psd), limits="rrf")
    >>> len(trade.improved.shaper) <= 5, trade.acceleration_gain > 0.0
    (True, True)
    """
    room = room_of(limits, version, maximum_impulses, longest, dt)
    tolerance_of(remaining)
    spectra, modes, clear = _read(measured)
    advice = klipper.recommend(spectra)
    candidates = [one for one in designed_candidates(spectra, modes, None, tolerance=remaining, clear=clear)]
    return found_trade_off(
        spectra,
        candidates,
        advice,
        room,
        modes=Modes([mode.mode for mode in modes]) if modes else None,
        lines=lines_to_still(spectra, modes, clear),
        remaining=remaining,
    )


def room_of(
    limits: str | Limits | None = None,
    version: str | None = None,
    maximum_impulses: int | None = None,
    longest: float | None = None,
    dt: float | None = None,
) -> Room:
    """What limits and wishes leave a shaper; parameters and errors as for :func:`design_within`."""
    held = _held(limits, version)
    impulses = EVERY_CONTROLLER if held.taps is None and limits is None else min(held.taps or MOST, MOST)
    if maximum_impulses is not None:
        wanted = whole_number("the largest number of impulses", maximum_impulses, 2, 10_000)
        impulses = min(wanted, MOST if limits is None else impulses)
    grid = None if dt is None else positive("dt", dt, "s")
    longest_held = held.longest
    if held.samples is not None:
        if grid is None:
            raise InputError(f"target {limits} works on samples: say its sample time dt [s], such as 0.001.")
        longest_held = min(longest_held, held.samples * grid)
    if longest is not None:
        longest_held = min(longest_held, positive("the longest duration", longest, "s"))
    if longest_held <= held.shortest:
        raise InputError(
            f"no shaper is at most {longest_held:g} s long where {held.shortest:g} s is the least: allow a longer one."
        )
    return Room(impulses, max(held.smallest, SMALLEST), held.shortest, longest_held, math.inf, grid)


def _held(limits: str | Limits | None, version: str | None) -> Limits:
    if limits is None or isinstance(limits, Limits):
        if version is not None:
            raise InputError(f"version {version!r} is one of a target: name the target as limits, such as 'rrf'.")
        return limits or Limits(taps=None)
    if limits not in TARGETS:
        raise InputError(f"target {limits!r} is not known: it is {', '.join(TARGETS)}.")
    target = TARGETS[limits]
    held = target.limits_of(target.version_of(version))
    if held.taps is None:
        takers = [name for name, one in TARGETS.items() if one.limits.taps is not None]
        raise InputError(
            f"target {limits} takes families and no impulses, so there is nothing to design: it is one of "
            f"{', '.join(takers)}."
        )
    return held


def _read(
    measured: Paths | SpectraLike,
) -> tuple[tuple[klipper.Spectrum, ...], tuple[identify.IdentifiedMode, ...], bool]:
    """Spectra, merged modes, and whether the measurements are clear; spectra alone have no modes."""
    if isinstance(measured, str | os.PathLike):
        paths = [measured]
    else:
        listed = measured if isinstance(measured, klipper.Spectrum | tuple) else list(measured)
        if isinstance(listed, klipper.Spectrum) or not listed or not isinstance(listed[0], str | os.PathLike):
            return klipper.as_spectra(cast("SpectraLike", listed)), (), False
        paths = list(cast("Iterable[str | os.PathLike[str]]", listed))
    measurements = [identify.read(path) for path in paths]
    found = [identify.find_modes(measurement) for measurement in measurements]
    scored = [scored_spectrum(one, modes) for one, modes in zip(measurements, found, strict=True)]
    spectra = klipper.as_spectra([(one.frequencies, one.power) for one in scored])
    return spectra, identify.merged_modes(found), all(one.clear for one in found)
