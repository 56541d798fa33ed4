"""What can be wished of a shaper beside its modes: the list that the command line and the studio ask by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from preshape.design.families import CLOSED_FAMILIES

__all__ = ["OPTIONS", "Option"]


@dataclass(frozen=True)
class Option:
    """One wish.

    Parameters
    ----------
    name : str
        What the families' functions call it.
    kind : {"number", "whole", "choice", "flag"}
        A number, a whole number, one of `choices`, or yes.
    summary : str
        What it is, for the user, with its unit.
    letter : str
        What stands for its value in a line of help.
    choices : tuple of str
        What can be chosen.
    """

    name: str
    kind: Literal["number", "whole", "choice", "flag"]
    summary: str
    letter: str = ""
    choices: tuple[str, ...] = ()


_ALL = (
    Option("tolerance", "number", "Vibration tolerated: height of the humps (EI), everywhere in the bands (si).", "V"),
    Option("order", "whole", "Vanishing derivatives (zvdk, direct, mesh).", "Q"),
    Option("humps", "whole", "Number of humps (k_hump_ei).", "K"),
    Option("negative_amplitude", "number", "Size of the negative impulse (sna_zv), as 0.5.", "B"),
    Option("deflection_ratio", "number", "Deflection while moving, of the unshaped (sd_zv).", "R"),
    Option("form", "choice", "Kind of sd_zv shaper.  [default: impulses]", "", ("impulses", "box")),
    Option("base", "choice", "Family that is convolved.  [default: zvd]", "", tuple(CLOSED_FAMILIES)),
    Option(
        "impulses",
        "choice",
        "Which antiperiod shaper.  [default: exact]",
        "",
        ("exact", "exact_robust", "two", "three"),
    ),
    Option(
        "frequency_tolerance",
        "number",
        "Relative error allowed on each frequency, to make it a multiple of a common one (antiperiod).  "
        "[default: 0.001]",
        "E",
    ),
    Option("damping", "number", "Damping ratio in the band.  [default: 0]", "Z"),
    Option("duration", "number", "Longest duration [s] (mesh).  [default: the shortest]", "S"),
    Option("cost", "choice", "Any solution, or the flattest (mesh).", "", ("zero", "second_derivative")),
    Option("prefer", "choice", "Which of several equally short ones (direct).", "", ("flattest", "fewest")),
    Option("fewest", "flag", "Look for the fewest impulses, for some seconds (mesh)."),
    Option("at_most", "whole", "Most impulses allowed (mesh, si).", "N"),
    Option("dt", "number", "Sample time of the controller: put the impulses on its grid.", "S"),
)

OPTIONS: Mapping[str, Option] = MappingProxyType({option.name: option for option in _ALL})
"""By name, in the order in which they are shown; bands are asked for beside them."""
