"""What there is to say about the antiperiod of several modes, before any shaper is designed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from preshape.design.antiperiod.common_frequency import CommonFrequency, common_frequency, largest_integer
from preshape.design.antiperiod.existence import all_odd, diophantine_divisors
from preshape.mode import Mode, Modes, ModesLike

__all__ = ["AntiperiodAnalysis", "antiperiod_analysis", "antiperiodic"]


LISTED = 6
"""Up to this many modes are named one by one in the reason."""


@dataclass(frozen=True)
class AntiperiodAnalysis:
    """Whether the modes have an antiperiod, and why.

    Parameters
    ----------
    modes : Modes
        The modes that were looked at.
    frequency_tolerance : float
        Relative deviation [-] that was allowed on each damped frequency.
    common : CommonFrequency or None
        The common damped frequency [Hz], the integers and the deviations; None if the integers would be too large.
    all_odd : bool or None
        Whether the integers, which have no common divisor, are all odd.
    diophantine_divisors : (int, int) or None
        The paper's two greatest common divisors; equal when its system of equations has a solution.
    exists : bool
        Whether there is an antiperiod.
    antiperiod : float or None
        T_a, half the common period [s].
    reason : str
        A sentence that says why there is one or not.
    """

    modes: Modes
    frequency_tolerance: float
    common: CommonFrequency | None
    all_odd: bool | None
    diophantine_divisors: tuple[int, int] | None
    exists: bool
    antiperiod: float | None
    reason: str


def antiperiod_analysis(modes: ModesLike, frequency_tolerance: float = 1e-3) -> AntiperiodAnalysis:
    """Look for the common frequency of the modes, and test whether they have an antiperiod.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; the damped frequencies are the ones that count.
    frequency_tolerance : float
        Largest relative deviation of each damped frequency from its multiple [-], 0 to 0.05; 0 means rounding. The
        integers are the smallest ones within it, and whether they are odd depends on it.

    Raises
    ------
    InputError
        If a mode is not one, or the tolerance is out of range.

    References
    ----------
    Singh & Heppler (1993), section 2.

    Examples
    --------
    >>> found = antiperiod_analysis([(30.0, 0.0), (105.0, 0.0), (385.0, 0.0)])
    >>> found.exists, found.diophantine_divisors
    (False, (24, 12))
    >>> print(found.reason)
    No antiperiod: 30 Hz is the even multiple 6 of the common frequency 5 Hz, and 105 Hz the odd multiple 21.
    """
    wanted = Modes(modes)
    common = common_frequency(wanted, frequency_tolerance)
    if common is None:
        reason = (
            f"No antiperiod: no frequency has multiples up to {largest_integer(frequency_tolerance)} that agree with "
            f"all {len(wanted)} modes within {frequency_tolerance:g}."
        )
        return AntiperiodAnalysis(wanted, float(frequency_tolerance), None, None, None, False, None, reason)
    odd = all_odd(common.integers)
    return AntiperiodAnalysis(
        modes=wanted,
        frequency_tolerance=float(frequency_tolerance),
        common=common,
        all_odd=odd,
        diophantine_divisors=diophantine_divisors(common.integers),
        exists=odd,
        antiperiod=0.5 / common.frequency if odd else None,
        reason=_reason(wanted, common),
    )


def antiperiodic(modes: Sequence[Mode], frequency_tolerance: float) -> CommonFrequency | None:
    """The common frequency of modes that have an antiperiod, or None: the search's short form of the analysis."""
    common = common_frequency(list(modes), frequency_tolerance)
    return common if common is not None and all(m % 2 == 1 for m in common.integers) else None


def _reason(modes: Modes, common: CommonFrequency) -> str:
    names = [f"{mode.omega_d / (2.0 * math.pi):.4g} Hz" for mode in modes]
    base = f"the common frequency {common.frequency:.4g} Hz"
    odd = [i for i, m in enumerate(common.integers) if m % 2 == 1]
    if len(odd) < len(names):
        even = next(i for i in range(len(names)) if i not in odd)
        return (
            f"No antiperiod: {names[even]} is the even multiple {common.integers[even]} of {base}, and "
            f"{names[odd[0]]} the odd multiple {common.integers[odd[0]]}."
        )
    found = f"An antiperiod of {0.5 / common.frequency:.4g} s"
    if len(names) == 1:
        return f"{found}: half a period of the only mode."
    if len(names) > LISTED:
        return f"{found}: all {len(names)} modes are odd multiples, up to {max(common.integers)}, of {base}."
    multiples = ", ".join(str(m) for m in common.integers)
    return f"{found}: {', '.join(names)} are the odd multiples {multiples} of {base}."
