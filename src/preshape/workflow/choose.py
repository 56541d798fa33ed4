"""Which candidate, and the one sentence why."""

from __future__ import annotations

from collections.abc import Iterable

from preshape.errors import InputError
from preshape.report import Candidate

__all__ = ["choose", "ranked"]


def ranked(candidates: Iterable[Candidate], tolerance: float) -> tuple[Candidate, ...]:
    """The best first: those allowed before those excluded, within the tolerance before those above it.

    Within the tolerance Klipper's score decides, which weighs vibration against smoothing; above it, the remaining
    vibration itself.
    """

    def rank(candidate: Candidate) -> tuple[bool, bool, float]:
        left = candidate.score.remaining_vibration
        enough = left <= tolerance
        return bool(candidate.excluded), not enough, candidate.score.value if enough else left

    return tuple(sorted(candidates, key=rank))


def choose(candidates: tuple[Candidate, ...], tolerance: float) -> tuple[Candidate, str]:
    """The first of the ranked candidates and the reason; InputError when every one is excluded."""
    best = candidates[0]
    if best.excluded:
        fewest = min(len(candidate.shaper) for candidate in candidates)
        raise InputError(f"every shaper has {best.excluded}: the shortest needs {fewest}; raise --max-impulses.")
    allowed = [candidate for candidate in candidates if not candidate.excluded]
    good = [candidate for candidate in allowed if candidate.score.remaining_vibration <= tolerance]
    left = f"{100.0 * best.score.remaining_vibration:.1f} %"
    if not good:
        return best, (
            f"No candidate brings the measured vibration down to the {100.0 * tolerance:g} % allowed; "
            f"{best.name} leaves the least, {left}."
        )
    if len(good) == 1:
        return best, (
            f"{best.name} is the only candidate that leaves at most {100.0 * tolerance:g} % of the measured vibration "
            f"({left})."
        )
    shortest = min(good, key=lambda candidate: candidate.shaper.duration)
    others = f"of the {len(good)} candidates that leave at most {100.0 * tolerance:g} % of the measured vibration"
    if shortest is best:
        return best, f"{best.name} leaves {left} and is the shortest {others}."
    return best, (
        f"{best.name} leaves {left} and has the best balance of vibration and smoothing {others}; the shortest "
        f"of them, {shortest.name}, leaves {100.0 * shortest.score.remaining_vibration:.1f} %."
    )
