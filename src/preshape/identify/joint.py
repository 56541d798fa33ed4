"""Several measurements of one machine as one identification."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.identify.identification import Identification
from preshape.identify.measurement import Spectrum
from preshape.identify.merge_modes import merged_modes

__all__ = ["jointly"]


def jointly(found: Sequence[Identification], maximum: int) -> Identification:
    """Merge what several measurements show: modes with intervals over all, and the mean of the spectra.

    Parameters
    ----------
    found : sequence of Identification
        At least one; spectra in one unit.
    maximum : int
        Largest number of modes.

    Raises
    ------
    InputError
        If the units differ.
    """
    if len(found) == 1:
        return found[0]
    units = {each.spectrum.unit for each in found}
    if len(units) > 1:
        raise InputError(
            f"the measurements are in different units ({', '.join(sorted(unit or 'none' for unit in units))}): "
            "give those of one kind together."
        )
    grid = found[0].spectrum.frequencies
    inside = grid <= min(each.spectrum.frequencies[-1] for each in found)
    grid = grid[inside]

    def mean(curves: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        rows = [np.interp(grid, each.spectrum.frequencies, curve) for each, curve in zip(found, curves, strict=True)]
        return np.asarray(np.mean(rows, axis=0))

    spectrum = Spectrum(
        grid,
        mean([each.spectrum.total for each in found])[None, :],
        ("sum",),
        found[0].spectrum.unit,
        window_duration=min(each.spectrum.window_duration for each in found),
        source=", ".join(each.spectrum.source for each in found if each.spectrum.source),
    )
    methods = sorted({each.method for each in found})
    trouble = tuple(
        f"{each.spectrum.source or f'measurement {number}'}: {sentence}"
        for number, each in enumerate(found, 1)
        for sentence in each.trouble
    )
    return Identification(
        merged_modes(found, maximum),
        spectrum,
        mean([each.fitted for each in found]),
        ", ".join(methods),
        trouble,
        all(each.clear for each in found),
        each=tuple(found),
    )
