"""Convolved shapers: one shaper a mode, of any closed family, one after the other."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from preshape.design.families import family_named
from preshape.mode import ModesLike
from preshape.shaper import Shaper

__all__ = ["convolved"]


def convolved(modes: ModesLike, family: str = "zvd", **settings: Any) -> Shaper:
    """The shapers of `family` for each mode, convolved: n^m impulses, as long as all of them together.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-].
    family : str
        A key of ``preshape.design.CLOSED_FAMILIES``.
    **settings
        What that family takes, such as ``tolerance``.

    Raises
    ------
    InputError
        If the family is unknown; or as the family does.

    References
    ----------
    Singer & Seering, section 2.3; Hyde 2.3.

    Examples
    --------
    >>> shaper = convolved([(1.0, 0.0), (10.0, 0.0)], "zvd")
    >>> len(shaper), round(shaper.duration, 6)
    (9, 1.1)
    """
    shaper = family_named(family)(modes, **settings)
    design = replace(shaper.design, family="convolved", settings={"base": family, **shaper.design.settings})
    return shaper.with_design(design)
