"""The candidates of a calibration: every closed family tuned to the spectra, and the multi-mode designs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from preshape import design
from preshape.errors import InputError
from preshape.export import klipper
from preshape.identify import IdentifiedMode
from preshape.mode import Mode, Modes
from preshape.report import Candidate
from preshape.shaper import Shaper
from preshape.workflow.remaining import (
    DEFAULT_DAMPING,
    Lines,
    lines_to_still,
    remaining_amplitude,
    remaining_amplitudes,
)

__all__ = ["designed_candidates"]

TUNED: dict[str, Callable[[Mode], Shaper]] = {
    "zv": design.zv,
    "mzv": design.mzv,
    "zvd": design.zvd,
    "zvdd": design.zvdd,
    "ei": design.ei,
    "two_hump_ei": design.two_hump_ei,
    "three_hump_ei": design.three_hump_ei,
}
"""One frequency each, chosen by what is left of the measured spectra."""

SEVERAL: dict[str, Callable[[Modes], Shaper]] = {
    "convolved zv": lambda modes: design.convolved(modes, "zv"),
    "convolved mzv": lambda modes: design.convolved(modes, "mzv"),
    "convolved zvd": lambda modes: design.convolved(modes, "zvd"),
    "direct zv": lambda modes: design.direct(modes, 0),
    "direct zvd": lambda modes: design.direct(modes, 1),
}
"""All identified modes at once."""

SEARCH_FACTORS = (0.6, 2.5)
"""Families are tuned from this multiple of the lowest loud frequency to this multiple of the highest."""

SEARCH_RATIO = 1.003
"""Ratio of neighbouring frequencies in the search: a third of a percent is finer than any machine holds."""

COARSE_RATIO, WIDEST_SEARCH = 1.01, 60.0
"""The same on a measurement that is not clear, and the ratio of highest to lowest frequency searched there."""

LOUD = 0.02
"""What is above this fraction of the loudest bounds the search."""


def designed_candidates(
    spectra: Sequence[klipper.Spectrum],
    modes: Sequence[IdentifiedMode],
    stock: klipper.KlipperFit | None,
    *,
    tolerance: float,
    clear: bool,
    damping: float | None = None,
    maximum_impulses: int | None = None,
) -> Iterator[Candidate]:
    """All candidates with their scores, in no order; `stock` is what Klipper itself would choose, if anything.

    A family that does not exist at this damping (EI has a limit) is left out; one with more impulses than the
    controller holds is kept and marked, so that the user sees what the limit costs.
    """
    lines = lines_to_still(spectra, modes, clear, damping)
    ratio = damping if damping is not None else modes[0].mode.damping if modes else DEFAULT_DAMPING

    def candidate(name: str, shaper: Shaper) -> Candidate:
        return Candidate(
            name=name,
            shaper=shaper,
            left=remaining_amplitude(shaper, lines),
            score=klipper.score(shaper, spectra),
            excluded=maximum_impulses is not None and len(shaper) > maximum_impulses,
        )

    grid = _search_grid(lines, clear)
    for name, family in TUNED.items():
        try:
            unit = family(Mode(1.0, ratio))
        except InputError:
            continue
        frequency = _tuned(remaining_amplitudes(unit, lines, grid), grid, tolerance)
        yield candidate(f"{name} {frequency:.4g} Hz", family(Mode(frequency, ratio)))
    if stock is not None:
        yield candidate(f"Klipper {stock.name} {stock.frequency:.1f} Hz", stock.shaper)
    if len(modes) > 1:
        wanted = Modes([mode.mode for mode in modes])
        for name, family_of_several in SEVERAL.items():
            yield candidate(name, family_of_several(wanted))


def _search_grid(lines: Sequence[Lines], clear: bool) -> NDArray[np.float64]:
    """Frequencies to try [Hz], evenly spaced in ratio, around everything loud."""
    loud = np.concatenate([one.frequencies[one.weights >= LOUD * one.weights.max()] for one in lines])
    loud = loud[loud > 0.0]
    low, high = SEARCH_FACTORS[0] * float(loud.min()), SEARCH_FACTORS[1] * float(loud.max())
    ratio = SEARCH_RATIO if clear else COARSE_RATIO
    low = low if clear else max(low, high / WIDEST_SEARCH)
    return np.geomspace(low, high, int(np.ceil(np.log(high / low) / np.log(ratio))) + 2)


def _tuned(left: NDArray[np.float64], grid: NDArray[np.float64], tolerance: float) -> float:
    """The highest frequency (the shortest shaper) within the tolerance, or else the one that leaves least [Hz]."""
    enough = np.flatnonzero(left <= tolerance)
    return float(grid[enough[-1] if enough.size else np.argmin(left)])
