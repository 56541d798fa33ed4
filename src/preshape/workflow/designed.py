"""A shaper by the options of ``preshape design``, as a report's record keeps them."""

from __future__ import annotations

import msgspec

from preshape import design
from preshape.band import Band
from preshape.mode import Mode
from preshape.report import DesignJob
from preshape.shaper import Shaper

__all__ = ["designed"]


def designed(job: DesignJob) -> Shaper:
    """The shaper that the options ask for.

    Raises
    ------
    InputError
        If the family is not known, does not take an option, or lacks one that it cannot do without.

    Examples
    --------
    >>> from preshape.report import DesignJob
    >>> len(designed(DesignJob(family="zvd", modes=((47.3, 0.05),))))
    3
    """
    wishes = {
        name: value
        for name, value in msgspec.structs.asdict(job).items()
        if name not in ("family", "modes", "bands") and value is not None
    }
    modes, bands = [Mode(*mode) for mode in job.modes], [Band(*band) for band in job.bands]
    return design.designed(job.family, modes, bands, wishes, spelled=_option)


def _option(name: str) -> str:
    """As it is typed on the command line, which the record repeats."""
    return "--" + name.replace("_", "-")
