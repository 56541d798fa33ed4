"""What Klipper itself would recommend on measured spectra: the peer that our designs are compared with."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.export.klipper.families import DEFAULT_DAMPING, FAMILIES, KlipperFamily
from preshape.export.klipper.scoring import SQUARE_CORNER_VELOCITY, TESTED_DAMPINGS, KlipperScore
from preshape.export.klipper.spectra import MAXIMUM_FREQUENCY, SpectraLike, as_spectra
from preshape.export.klipper.tuning import KlipperFit, Scan

__all__ = ["KlipperRecommendation", "fit", "recommend"]

HIGHEST_FREQUENCY = 150.0
"""The scan stays below this frequency [Hz]."""

STEPS_PER_HERTZ = 5
"""The scan goes in steps of 0.2 Hz."""

CLEARLY_BETTER = 1.2
"""A family replaces the best so far when its score is better by this factor ..."""

BETTER_SCORE, BETTER_SMOOTHING = 1.05, 1.1
"""... or its score and its smoothing by these."""

BETTER_VIBRATION = 1.1
"""ZV wins only if no other family leaves less vibration by this factor."""


@dataclass(frozen=True)
class KlipperRecommendation:
    """Klipper's answer.

    Parameters
    ----------
    fits : tuple of KlipperFit
        Every family that it tries, in its order, as it prints them.
    chosen : KlipperFit
        The one that it recommends.
    """

    fits: tuple[KlipperFit, ...]
    chosen: KlipperFit


def fit(
    name: str,
    spectra: SpectraLike,
    *,
    damping: float = DEFAULT_DAMPING,
    dampings: Iterable[float] = TESTED_DAMPINGS,
    square_corner_velocity: float = SQUARE_CORNER_VELOCITY,
    maximum_frequency: float = MAXIMUM_FREQUENCY,
) -> KlipperFit:
    """Tune one family as Klipper does.

    Of the frequencies scanned, the one with the best score among those that leave nearly as little vibration as the
    best (1.1 times plus 0.05 %).

    Parameters
    ----------
    name : str
        "zv", "mzv", "zvd", "ei", "2hump_ei" or "3hump_ei".
    spectra : SpectraLike
        Normalised spectra: (frequencies [Hz], psd) with psd of shape (frequency,) or (dataset, frequency), or a list
        of such pairs. The worst case of the datasets counts.
    damping : float
        Damping ratio that the shaper is made for [-].
    dampings : iterable of float
        Damping ratios of the machine to try [-]; the worst counts.
    square_corner_velocity : float
        [mm/s]
    maximum_frequency : float
        Vibration above it is not looked at [Hz].

    Returns
    -------
    KlipperFit

    Raises
    ------
    InputError
        If the family is unknown, or a spectrum or value is not usable.

    References
    ----------
    ECOSYSTEM 1.8.

    Examples
    --------
    >>> frequencies = np.arange(5.0, 130.0, 1.25)
    >>> psd = 1.0 / ((1.0 - (frequencies / 55.0) ** 2) ** 2 + (0.2 * frequencies / 55.0) ** 2)
    >>> fit("zv", (frequencies, psd)).frequency
    54.2
    """
    family = _family(name)
    scan = Scan.of(
        name,
        family.pulses,
        _klipper_grid(family),
        as_spectra(spectra),
        damping,
        tuple(dampings),
        square_corner_velocity,
        maximum_frequency,
    )
    return scan.fit(scan.tuned())


def recommend(
    spectra: SpectraLike,
    *,
    damping: float = DEFAULT_DAMPING,
    dampings: Iterable[float] = TESTED_DAMPINGS,
    square_corner_velocity: float = SQUARE_CORNER_VELOCITY,
    maximum_frequency: float = MAXIMUM_FREQUENCY,
) -> KlipperRecommendation:
    """All families that Klipper tries, and its choice; parameters and errors as for :func:`fit`.

    The families come in turn, from the shortest. One that does not replace the best so far by score may still do so
    at another of its frequencies, where it beats the best in both vibration and smoothing: then it is tuned to that
    frequency instead (and differs from :func:`fit`).

    Examples
    --------
    >>> frequencies = np.arange(5.0, 130.0, 1.25)
    >>> psd = 1.0 / ((1.0 - (frequencies / 55.0) ** 2) ** 2 + (0.02 * frequencies / 55.0) ** 2)
    >>> recommend((frequencies, psd)).chosen.name
    'mzv'
    """
    datasets, ratios = as_spectra(spectra), tuple(dampings)
    first, *others = (
        Scan.of(
            family.name,
            family.pulses,
            _klipper_grid(family),
            datasets,
            damping,
            ratios,
            square_corner_velocity,
            maximum_frequency,
        )
        for family in FAMILIES.values()
        if family.tuned
    )
    best = first.fit(first.tuned())
    fits = [best]
    for scan in others:
        candidate = scan.fit(scan.tuned())
        if _replaces(candidate.score, best.score):
            best = candidate
        elif (other := scan.better_in_both(best.score)) is not None:
            best = candidate = scan.fit(other)
        fits.append(candidate)
    return KlipperRecommendation(tuple(fits), _not_zv(fits, best))


def _replaces(new: KlipperScore, best: KlipperScore) -> bool:
    """Whether the score alone makes `new` the best so far."""
    clearly = new.value * CLEARLY_BETTER < best.value
    both = new.value * BETTER_SCORE < best.value and new.smoothing * BETTER_SMOOTHING < best.smoothing
    return clearly or both


def _not_zv(fits: list[KlipperFit], best: KlipperFit) -> KlipperFit:
    """`best`, or instead of a ZV the first family that leaves clearly less vibration."""
    if best.name != "zv":
        return best
    limit = best.score.remaining_vibration
    better = (f for f in fits if f.name != "zv" and f.score.remaining_vibration * BETTER_VIBRATION < limit)
    return next(better, best)


def _klipper_grid(family: KlipperFamily) -> NDArray[np.float64]:
    """The frequencies that Klipper tries [Hz], each with the one decimal that it saves."""
    count = round((HIGHEST_FREQUENCY - family.minimum_frequency) * STEPS_PER_HERTZ)
    return np.round(family.minimum_frequency + np.arange(count) / STEPS_PER_HERTZ, 1)


def _family(name: str) -> KlipperFamily:
    try:
        return FAMILIES[name]
    except (KeyError, TypeError):
        raise InputError(f"Klipper has no shaper {name!r}: give one of {', '.join(FAMILIES)}.") from None
