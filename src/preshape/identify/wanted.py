"""What the caller says about a file that its content does not tell."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from preshape.errors import MeasurementError
from preshape.identify.text import printable

__all__ = ["Wanted", "pick_part"]

SHOWN_PARTS = 12
"""So many names of measurements an error message lists."""

SHOWN_NAME = 40


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is wanted of a file.

    Attributes
    ----------
    sample_rate : float or None
        Samples per second [Hz], for files that do not say.
    part : str or None
        Which measurement, for files that hold several.
    """

    sample_rate: float | None = None
    part: str | None = None


def pick_part(names: Sequence[str], part: str | None, source: str) -> int:
    """Index of the measurement that is wanted; without a name there must be only one.

    A name counts when it is the beginning of one measurement's only: recorders add the time to it.

    Raises
    ------
    MeasurementError
        Listing the names there are.
    """
    if not names:
        raise MeasurementError(f"{source}: the file holds no measurement; record it again.")
    shown = [name if len(name) <= SHOWN_NAME else name[:SHOWN_NAME] + "..." for name in names[:SHOWN_PARTS]]
    listed = ", ".join(printable(name) for name in shown)
    if len(names) > SHOWN_PARTS:
        listed += f" and {len(names) - SHOWN_PARTS} more"
    if part is None:
        if len(names) > 1:
            raise MeasurementError(
                f"{source}: the file holds {len(names)} measurements ({listed}); say which one as part."
            )
        return 0
    exact = [index for index, name in enumerate(names) if name == part]
    found = exact or [index for index, name in enumerate(names) if name.startswith(part)]
    if len(found) != 1:
        what = "no measurement" if not found else f"{len(found)} measurements"
        raise MeasurementError(f"{source}: {what} in the file is called {part!r}; there are {listed}.")
    return found[0]
