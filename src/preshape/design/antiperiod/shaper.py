"""Antiperiod shapers: the paper's two and three impulses, and as many as no vibration really needs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from typing import Literal, get_args

from preshape.design.antiperiod.common_frequency import checked_tolerance
from preshape.design.antiperiod.exact import different_decays, exact_impulses
from preshape.design.antiperiod.printed import checked_amplitudes, three_impulses, two_impulses
from preshape.design.antiperiod.subsets import Subset, fewest_subsets
from preshape.design.each_mode import recorded
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["Impulses", "antiperiod"]

Impulses = Literal["exact", "exact_robust", "two", "three"]
"""Which shaper: as many impulses as zero vibration needs, the same convolved with itself, or the paper's."""

NOTHING = 1e-12
"""Residual vibration [-] up to which only rounding is left and the design is exact."""

MOST_IMPULSES = 50_000
"""Convolved subsets may take more impulses than anybody could use or a computer hold."""


def antiperiod(
    modes: ModesLike,
    *,
    impulses: Impulses = "exact",
    frequency_tolerance: float = 1e-3,
    mode_amplitudes: Sequence[float] | None = None,
) -> Shaper:
    """A shaper with few impulses for modes whose damped frequencies are odd multiples of a common one.

    Its impulses are an antiperiod T_a = 1 / (2 f_c) apart: an odd number of half periods of every mode. Modes that
    have no antiperiod together are sorted into as few subsets as possible that have one, whose shapers are convolved.

    Few impulses are not a short shaper, and not a robust one. T_a is m_1 half periods of the lowest mode. And mode i
    sees an impulse only every m_i half periods, so the band it may lie in shrinks by m_i: an insensitivity of
    0.0637 / m_i at 5 % and low damping where ZV has 0.0637, and 0.287 / m_i for "three" and, with equal decay rates,
    "exact_robust", where ZVD has 0.287.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-].
    impulses : {"exact", "exact_robust", "two", "three"}
        "exact": prod (1 + K_i q) / (1 + K_i) over the different decay rates, no vibration at any mode; one impulse more
        than there are different decay rates. "exact_robust": the same convolved with itself, with zero slope as well.
        "two" and "three": as Singh & Heppler print them; with different decay rates vibration remains at each mode,
        because their condition asks only that the sum of all modes vanish.
    frequency_tolerance : float
        Largest relative deviation of each damped frequency from its multiple of the common one [-], 0 to 0.05; 0
        means rounding. A deviation d leaves about (pi / 2) m_i d of residual vibration ("exact").
    mode_amplitudes : sequence of float, optional
        A_i of "two" and "three": the amplitude of each mode in the response to an impulse [-]; all 1 unless given.

    Returns
    -------
    Shaper
        ``design.status`` is "exact" where nothing but rounding is left at every mode as given, else "feasible".
        ``design.settings`` has, in the order of the modes, "integers", "deviations" [-] and "residuals" [-]; and for
        each subset "subsets" (positions of its modes, from 0), "common_frequencies" [Hz, damped] and "antiperiods"
        [s]; "search" says how the subsets were found.

    Raises
    ------
    InputError
        If an argument is out of range, `mode_amplitudes` is given for an exact shaper, the paper's conditions give no
        positive impulses, or the subsets are so many that their shapers cannot be convolved.

    References
    ----------
    Singh & Heppler (1993); eq. 22 and 32-38 for the printed shapers.

    Examples
    --------
    >>> shaper = antiperiod([(1.0, 0.0), (7.0, 0.0)])
    >>> shaper.times.tolist(), shaper.amplitudes.tolist(), shaper.design.settings["integers"]
    ([0.0, 0.5], [0.5, 0.5], [1, 7])
    >>> damped = antiperiod([(1.0, 0.01), (7.0, 0.01)], impulses="two")
    >>> damped.design.status, max(damped.design.settings["residuals"]) > 0.05
    ('feasible', True)
    """
    wanted, tolerance = Modes(modes), checked_tolerance(frequency_tolerance)
    if impulses not in get_args(Impulses):
        raise InputError(f"impulses is {impulses!r}: give one of {', '.join(map(repr, get_args(Impulses)))}.")
    if mode_amplitudes is not None and impulses not in ("two", "three"):
        raise InputError(f"impulses={impulses!r} does not depend on mode_amplitudes: leave them out.")
    weights = checked_amplitudes(mode_amplitudes, len(wanted))

    def steps(subset: Subset) -> int:
        single = 2 if impulses in ("exact_robust", "three") else 1
        if impulses in ("two", "three"):
            return single
        return single * len(different_decays(_modes_of(wanted, subset), _spacing(subset)))

    partition = fewest_subsets(wanted, tolerance, lambda subset: steps(subset) * _spacing(subset))
    count = math.prod(steps(subset) + 1 for subset in partition.subsets)
    if count > MOST_IMPULSES:
        raise InputError(
            f"the modes fall into {len(partition.subsets)} subsets with an antiperiod each, {count:.3g} impulses "
            "convolved: raise frequency_tolerance, give fewer modes, or use design.direct."
        )
    shaper = reduce(Shaper.convolve, [_one(wanted, subset, impulses, weights) for subset in partition.subsets])
    residuals = [float(residual_vibration(shaper, mode.frequency, mode.damping)) for mode in wanted]
    places = [(subset.common, subset.indices.index(i)) for i, subset in _subset_of_each(partition.subsets)]
    settings = {
        "impulses": impulses,
        "frequency_tolerance": tolerance,
        "integers": [common.integers[place] for common, place in places],
        "deviations": [common.deviations[place] for common, place in places],
        "residuals": residuals,
        "subsets": [list(subset.indices) for subset in partition.subsets],
        "common_frequencies": [subset.common.frequency for subset in partition.subsets],
        "antiperiods": [_spacing(subset) for subset in partition.subsets],
        "search": partition.search,
    }
    if mode_amplitudes is not None:
        settings["mode_amplitudes"] = weights
    status = "exact" if max(residuals) <= NOTHING else "feasible"
    return recorded(shaper, Design("antiperiod", wanted, settings, status))


def _one(wanted: Modes, subset: Subset, impulses: Impulses, weights: Sequence[float]) -> Shaper:
    """The shaper of one subset."""
    modes, integers, spacing = _modes_of(wanted, subset), subset.common.integers, _spacing(subset)
    if impulses in ("exact", "exact_robust"):
        times, amplitudes = exact_impulses(modes, spacing, 1 if impulses == "exact" else 2)
    else:
        printed = two_impulses if impulses == "two" else three_impulses
        times, amplitudes = printed(modes, integers, [weights[i] for i in subset.indices], spacing)
    return Shaper.normalised(times, amplitudes)


def _modes_of(wanted: Modes, subset: Subset) -> Modes:
    return Modes([wanted[i] for i in subset.indices])


def _spacing(subset: Subset) -> float:
    """T_a, half the common period [s]."""
    return 0.5 / subset.common.frequency


def _subset_of_each(subsets: Sequence[Subset]) -> list[tuple[int, Subset]]:
    """Each mode's position with its subset, in the order of the modes."""
    return sorted(((i, subset) for subset in subsets for i in subset.indices), key=lambda pair: pair[0])
