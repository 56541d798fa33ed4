"""Which axis of a machine's settings is meant."""

from __future__ import annotations

from collections.abc import Mapping

from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["of_axis"]


def of_axis(shapers: Mapping[str, Shaper], axis: str | None, axes: tuple[str, ...], nothing: str) -> Shaper:
    """The shaper of `axis`, or without one that of the only axis that is set, or of all if they are alike.

    Parameters
    ----------
    shapers : mapping of str to Shaper
        Of the axes that are set.
    axis : str, optional
        Which one.
    axes : tuple of str
        That the machine has.
    nothing : str
        What to say where no shaper is set.

    Raises
    ------
    InputError
        If there is no such axis, nothing is set, or the axes differ and none is named.
    """
    if axis is not None:
        axis = axis.lower()
        if axis not in axes:
            raise InputError(f"axis {axis!r} has no shaper of its own there: it is {', '.join(axes)}.")
        if axis not in shapers:
            raise InputError(f"axis {axis}: {nothing}")
        return shapers[axis]
    if not shapers:
        raise InputError(nothing)
    first = next(iter(shapers.values()))
    if any(other != first for other in shapers.values()):
        raise InputError(
            f"the shapers of {' and '.join(shapers)} differ: say which axis, such as {next(iter(shapers))}."
        )
    return first
