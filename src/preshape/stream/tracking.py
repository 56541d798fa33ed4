"""The shaper of a stream that follows its modes: designed anew from the one in force, or kept.

This is what Hyde's section 6.2 asks for: new shapers "created as the system moves".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from preshape.checks import not_negative
from preshape.design import direct, direct_near
from preshape.errors import InputError
from preshape.kernel import Taps
from preshape.mode import Mode, Modes, ModesLike
from preshape.shaper import Shaper
from preshape.stream.parts import taps_of

__all__ = ["Tracked", "mismatch", "remembered", "restored", "tracked"]


@dataclass(frozen=True)
class Tracked:
    """What :meth:`Stream.track` did.

    Parameters
    ----------
    shaper : Shaper
        In force now; ``shaper.design`` has its modes and its certificate.
    start : {"kept", "near", "full", "missed"}
        "kept": the modes are within the tolerance of those that the shaper is for. "near": redesigned from the one
        before, by Newton's method. "full": that did not lead there, a search did. "missed": that did not lead there,
        and no search was allowed; the shaper is the one before. Later calls start from that one and may miss too: give
        ``design.direct(modes)`` to another thread and its result to :meth:`Stream.retune`.
    mismatch : float
        How far the modes that were asked for are from those of the shaper in force [-]: the largest relative distance
        of two poles; for a frequency alone its relative difference, for a damping ratio alone about its difference.
    """

    shaper: Shaper
    start: Literal["kept", "near", "full", "missed"]
    mismatch: float

    @property
    def changed(self) -> bool:
        """Whether the shaper in force is another one than before."""
        return self.start in ("near", "full")


def tracked(shapers: Sequence[Shaper] | None, modes: ModesLike, tolerance: float, search: bool) -> Tracked:
    """The shaper for the modes now, from the one in force; see :meth:`Stream.track`."""
    shaper = _trackable(shapers)
    allowed = not_negative("tolerance", tolerance, "(a ratio)")
    wanted = Modes(modes)
    apart = mismatch(shaper, wanted)
    if apart <= allowed:
        return Tracked(shaper, "kept", apart)
    fresh = None if shaper.design.certificate is None else direct_near(shaper, wanted)
    if fresh is not None:
        return Tracked(fresh, "near", 0.0)
    if not search:
        return Tracked(shaper, "missed", apart)
    made = shaper.design.settings
    return Tracked(direct(wanted, made["order"], prefer=made.get("prefer")), "full", 0.0)


def mismatch(shaper: Shaper, modes: Modes) -> float:
    """The largest relative distance of the modes' poles from those the shaper is for [-].

    Examples
    --------
    >>> round(mismatch(direct([(1.0, 0.0), (2.0, 0.0)]), Modes([(1.0, 0.0), (2.02, 0.0)])), 6)
    0.01
    """
    designed = shaper.design.modes
    assert designed is not None
    if len(designed) != len(modes):
        raise InputError(
            f"{len(modes)} modes are to be tracked, the shaper in force is for {len(designed)}: give as many."
        )
    return max(_distance(mode, other) for mode, other in zip(designed, modes, strict=True))


def remembered(shapers: Sequence[Shaper] | None) -> Mapping[str, Any] | None:
    """What the saved state of a stream needs for tracking to go on; None for a stream that cannot track."""
    return shapers[0].to_dict() if shapers is not None and _can_be_tracked(shapers) else None


def restored(data: Mapping[str, Any] | None, stages: Sequence[Taps], dt: float) -> tuple[Shaper, ...] | None:
    """The shaper of a saved state, if there is one; InputError when it is not the one that shapes."""
    if data is None:
        return None
    shapers = (Shaper.from_dict(data),)
    (delays, weights), *others = taps_of(shapers, dt)
    if (
        others
        or len(stages) != 1
        or not (np.array_equal(delays, stages[0][0]) and np.array_equal(weights, stages[0][1]))
    ):
        raise InputError("the state of the stream holds another shaper than it shapes with: save it again.")
    return shapers


def _distance(designed: Mode, mode: Mode) -> float:
    return abs(mode.pole - designed.pole) / designed.omega


def _can_be_tracked(shapers: Sequence[Shaper]) -> bool:
    made = shapers[0].design
    direct_ones = made.family == "direct" and made.modes is not None and "order" in made.settings
    return len(shapers) == 1 and direct_ones and "grid_method" not in made.settings


def _trackable(shapers: Sequence[Shaper] | None) -> Shaper:
    if shapers is None:
        raise InputError(
            "the saved stream had no shaper that can be tracked: save one whose shaper is from design.direct, or "
            "retune to one."
        )
    if len(shapers) > 1:
        raise InputError(
            f"the stream has {len(shapers)} shapers in a row: track one, made by design.direct for all modes."
        )
    if not _can_be_tracked(shapers):
        raise InputError(
            f"the stream shapes with {shapers[0]!r}, from which no redesign can start: make it with a shaper of "
            "design.direct, not moved to a grid."
        )
    return shapers[0]
