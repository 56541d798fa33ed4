"""Which candidate, and the one sentence why."""

from __future__ import annotations

from collections.abc import Iterable

from preshape.errors import InputError
from preshape.export import klipper
from preshape.report import FREQUENCY_ERROR, Candidate

__all__ = ["choose", "ranked"]


def ranked(candidates: Iterable[Candidate], tolerance: float) -> tuple[Candidate, ...]:
    """The best first: those allowed before those excluded, within the tolerance before those above it.

    Vibration counts with the frequencies off by FREQUENCY_ERROR. Within the tolerance Klipper's score of it decides,
    which weighs vibration against smoothing; above it, the vibration itself.
    """

    def rank(candidate: Candidate) -> tuple[bool, bool, float]:
        enough = candidate.worst <= tolerance
        value = klipper.combined(candidate.worst, candidate.score.smoothing) if enough else candidate.worst
        return bool(candidate.excluded), not enough, value

    return tuple(sorted(candidates, key=rank))


def choose(candidates: tuple[Candidate, ...], tolerance: float, clear: bool) -> tuple[Candidate, str]:
    """The first of the ranked candidates and one sentence why; InputError when every one is excluded."""
    best = candidates[0]
    if best.excluded:
        fewest = min(len(candidate.shaper) for candidate in candidates)
        raise InputError(f"every shaper has {best.excluded}: the shortest needs {fewest}; raise --max-impulses.")
    left = f"{100.0 * best.score.remaining_vibration:.1f} % of the measured vibration"
    margin = f"{100.0 * best.worst:.1f} % with all frequencies {100.0 * FREQUENCY_ERROR:g} % off"
    if not clear:
        return best, (
            "This measurement is no ground to tune a shaper on: see to the machine and measure again. Until then "
            f"{best.name} is the least bad; on paper it leaves {left}, {margin}."
        )
    allowed = [candidate for candidate in candidates if not candidate.excluded]
    good = [candidate for candidate in allowed if candidate.worst <= tolerance]
    leaves = f"{best.name} leaves {left}, {margin},"
    if not good:
        return best, f"{leaves} more than the {100.0 * tolerance:g} % allowed, but no candidate leaves less."
    if len(good) == 1:
        return best, f"{leaves} and is the only candidate that stays below the {100.0 * tolerance:g} % allowed."
    others = f"the {len(good)} candidates that stay below the {100.0 * tolerance:g} % allowed"
    shortest = min(good, key=lambda candidate: candidate.shaper.duration)
    if shortest is best:
        return best, f"{leaves} and is the shortest of {others}."
    return best, (
        f"{leaves} and balances vibration and smoothing best of {others}; the shortest of them is {shortest.name} "
        f"({100.0 * shortest.worst:.1f} %)."
    )
