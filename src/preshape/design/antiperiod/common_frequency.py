"""The common frequency of several modes: the largest whose multiples are the damped frequencies, within a tolerance.

With x_i = f_i / m_i, one frequency f_c lies within the relative tolerance e of every mode, |m_i f_c - f_i| <= e f_i,
exactly if (max x - min x) / (max x + min x) <= e, and the f_c that makes the largest deviation smallest is the
harmonic mean of the extreme x. For two modes this says that m_2 / m_1 lies in an interval around f_2 / f_1; the
continued fraction gives the fraction with the smallest terms in it. For more modes these fractions bound m_1 from
below, and m_1 is counted up from there, the other integers being the nearest ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from preshape.checks import not_negative
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike

__all__ = ["CommonFrequency", "checked_tolerance", "common_frequency", "largest_integer", "simplest_fraction"]

LARGEST_TOLERANCE = 0.05
"""Relative deviation [-] above which integers above 5 say nothing, see :func:`largest_integer`."""

LARGEST_INTEGER = 10_000
"""No integer is larger, however small the tolerance: an antiperiod holds half as many periods of that mode."""

ROUNDING = 1e-13
"""Relative deviation [-] that rounding of given frequencies makes: what a tolerance of 0 means."""

COUNTED_AT_ONCE = 256
"""Candidates for m_1 in one array operation."""


@dataclass(frozen=True)
class CommonFrequency:
    """A frequency whose whole multiples are the modes' damped frequencies, within a tolerance.

    Parameters
    ----------
    frequency : float
        f_c, the common damped frequency [Hz].
    integers : tuple of int
        m_i, one a mode in the order of the modes; their greatest common divisor is 1.
    deviations : tuple of float
        m_i f_c / f_i - 1, one a mode [-].
    """

    frequency: float
    integers: tuple[int, ...]
    deviations: tuple[float, ...]


def common_frequency(modes: ModesLike, frequency_tolerance: float = 1e-3) -> CommonFrequency | None:
    """The common frequency with the smallest integers, or None when they would be too large to mean anything.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; the damped frequencies are the ones that count.
    frequency_tolerance : float
        Largest relative deviation of each damped frequency from its multiple [-], 0 to 0.05; 0 means rounding.

    Returns
    -------
    CommonFrequency or None
        None when an integer would exceed :func:`largest_integer`.

    Raises
    ------
    InputError
        If a mode is not one, or the tolerance is out of range.

    References
    ----------
    Singh & Heppler (1993), eq. 5-7 and 22, and the continued fraction of their conclusions.

    Examples
    --------
    >>> common = common_frequency([(30.0, 0.0), (105.0, 0.0), (385.0, 0.0)])
    >>> common.frequency, common.integers
    (5.0, (6, 21, 77))
    """
    wanted, tolerance = Modes(modes), checked_tolerance(frequency_tolerance)
    frequencies = [mode.omega_d / (2.0 * np.pi) for mode in wanted]
    integers = _smallest_integers(frequencies, tolerance, largest_integer(tolerance))
    if integers is None:
        return None
    quotients = [f / m for f, m in zip(frequencies, integers, strict=True)]
    common = 2.0 / (1.0 / min(quotients) + 1.0 / max(quotients))
    deviations = tuple(m * common / f - 1.0 for f, m in zip(frequencies, integers, strict=True))
    return CommonFrequency(common, integers, deviations)


def largest_integer(frequency_tolerance: float) -> int:
    """The largest integer that a tolerance [-] allows: 1 / (4 tolerance), and never more than 10 000.

    Beyond it the intervals that the tolerance leaves around neighbouring multiples overlap: any frequency would be a
    multiple of any other, and which integer is meant would be ambiguous.

    Parameters
    ----------
    frequency_tolerance : float
        Relative deviation [-], 0 to 0.05.
    """
    return int(min(LARGEST_INTEGER, 0.25 / max(checked_tolerance(frequency_tolerance), ROUNDING)))


def checked_tolerance(frequency_tolerance: float) -> float:
    """The tolerance [-] as a float, if it is one."""
    tolerance = not_negative("frequency_tolerance", frequency_tolerance, "(relative)")
    if tolerance > LARGEST_TOLERANCE:
        raise InputError(
            f"frequency_tolerance {tolerance:g} is above {LARGEST_TOLERANCE:g}: every frequency would be a multiple of "
            "every other; give what the frequencies are known to, such as 0.001."
        )
    return tolerance


def simplest_fraction(low: Fraction, high: Fraction) -> Fraction:
    """The fraction with the smallest terms in the closed interval [low, high], 0 < low <= high.

    Its continued fraction is the common beginning of those of both ends, and one term more.

    Examples
    --------
    >>> simplest_fraction(Fraction("3.14"), Fraction("3.15"))
    Fraction(22, 7)
    """
    terms: list[int] = []
    while (whole := low.numerator // low.denominator) < low and whole + 1 > high:
        terms.append(whole)
        low, high = 1 / (high - whole), 1 / (low - whole)
    value = Fraction(whole if whole == low else whole + 1)
    for term in reversed(terms):
        value = term + 1 / value
    return value


def _smallest_integers(frequencies: list[float], tolerance: float, limit: int) -> tuple[int, ...] | None:
    """m_i, or None when one would exceed the limit."""
    allowed = max(tolerance, ROUNDING)
    lowest = min(frequencies)
    spread = Fraction(1.0 + allowed) / Fraction(1.0 - allowed)
    fractions = []
    for frequency in frequencies:
        ratio = Fraction(frequency) / Fraction(lowest)
        fractions.append(simplest_fraction(max(Fraction(1), ratio / spread), ratio * spread))
    least = max(fraction.denominator for fraction in fractions)
    ratios = np.array(frequencies) / lowest
    most = int((limit + 0.5) / float(ratios.max()))
    if len(frequencies) <= 2:
        found = np.array([int(fraction * least) for fraction in fractions])
        return _within(found, limit)
    for start in range(least, most + 1, COUNTED_AT_ONCE):
        multiples = np.arange(start, min(start + COUNTED_AT_ONCE, most + 1))[:, np.newaxis] * ratios
        nearest = np.rint(multiples)
        quotients = multiples / nearest
        low, high = quotients.min(axis=1), quotients.max(axis=1)
        fits = np.flatnonzero(high - low <= allowed * (high + low))
        if fits.size:
            return _within(nearest[fits[0]].astype(int), limit)
    return None


def _within(integers: NDArray[np.int_], limit: int) -> tuple[int, ...] | None:
    return tuple(integers.tolist()) if integers.max() <= limit else None
