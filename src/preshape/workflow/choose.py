"""Which candidate, and the one sentence why."""

from __future__ import annotations

from collections.abc import Iterable

from preshape.errors import InputError
from preshape.export import klipper
from preshape.report import FREQUENCY_ERROR, Candidate

__all__ = ["choose", "ranked"]


def ranked(candidates: Iterable[Candidate], tolerance: float, clear: bool) -> tuple[Candidate, ...]:
    """The best first: those allowed before those excluded, within the tolerance before those above it.

    Within the tolerance the least smoothing wins, above it the least vibration. On a measurement that is not clear the
    tolerance could be met by smoothing away every move, so there Klipper's score decides, which weighs both.
    """

    def rank(candidate: Candidate) -> tuple[bool, bool, float]:
        smoothing = candidate.score.smoothing
        if not clear:
            return candidate.excluded, False, klipper.combined(candidate.left, smoothing)
        enough = candidate.left <= tolerance
        return candidate.excluded, not enough, smoothing if enough else candidate.left

    return tuple(sorted(candidates, key=rank))


def choose(candidates: tuple[Candidate, ...], tolerance: float, clear: bool) -> tuple[Candidate, str]:
    """The first of the ranked candidates and one sentence why; InputError when every one is excluded."""
    best = candidates[0]
    if best.excluded:
        fewest = min(len(candidate.shaper) for candidate in candidates)
        raise InputError(f"no candidate has so few impulses: the smallest has {fewest}; raise --max-impulses to it.")
    left = f"{100.0 * best.left:.1f} % of the vibration with all frequencies {100.0 * FREQUENCY_ERROR:g} % off"
    if not clear:
        return best, (
            "This measurement is no ground to tune a shaper on: see to the machine and measure again. Until then "
            f"{best.name} is the least bad; on paper it leaves {left}."
        )
    good = [one for one in candidates if not one.excluded and one.left <= tolerance]
    allowed = f"{100.0 * tolerance:g} % allowed"
    if not good:
        return best, f"{best.name} leaves {left}, more than the {allowed}, but no candidate leaves less."
    if len(good) == 1:
        return best, f"{best.name} leaves {left} and is the only candidate within the {allowed}."
    return best, (
        f"{best.name} leaves {left} and smooths moves least of the {len(good)} candidates within the {allowed}; "
        f"next is {good[1].name}."
    )
