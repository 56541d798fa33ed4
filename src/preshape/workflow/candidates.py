"""The candidates of a calibration: every closed family tuned to the spectra, and the multi-mode designs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from preshape import design
from preshape.errors import InputError
from preshape.export import klipper
from preshape.identify import IdentifiedMode
from preshape.mode import Mode, Modes
from preshape.report import Candidate
from preshape.shaper import Shaper

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
    "direct, order 0": lambda modes: design.direct(modes, 0),
    "direct, order 1": lambda modes: design.direct(modes, 1),
}
"""All identified modes at once."""

DEFAULT_DAMPING = 0.1
"""What is assumed [-] when no mode was found and none is given; Klipper assumes the same."""

SEARCH_FACTORS = (0.6, 2.5)
"""Families are tuned from this multiple of the lowest peak to this multiple of the highest."""

SEARCH_RATIO = 1.003
"""Ratio of neighbouring frequencies in the search: a third of a percent is finer than any machine holds."""

LOUD = 0.2
"""Bins above this fraction of the highest one bound the search."""


def designed_candidates(
    spectra: Sequence[klipper.Spectrum],
    modes: Sequence[IdentifiedMode],
    *,
    damping: float | None = None,
    maximum_impulses: int | None = None,
) -> Iterator[Candidate]:
    """All candidates with their scores, in no order.

    A family that does not exist at this damping (EI has a limit) is left out; one with more impulses than the
    controller holds is kept and marked, so that the user sees what the limit costs.
    """
    if damping is None:
        damping = modes[0].mode.damping if modes else DEFAULT_DAMPING
    grid = _search_grid(spectra)
    for name, family in TUNED.items():
        try:
            fitted = klipper.tune(name, _of_frequency(family), spectra, grid, damping=damping)
        except InputError:
            continue
        yield _limited(Candidate(f"{name} at {fitted.frequency:.4g} Hz", fitted.shaper, fitted.score), maximum_impulses)
    if len(modes) > 1:
        wanted = Modes([mode.mode for mode in modes])
        for name, family_of_several in SEVERAL.items():
            shaper = family_of_several(wanted)
            yield _limited(Candidate(name, shaper, klipper.score(shaper, spectra)), maximum_impulses)


def _of_frequency(family: Callable[[Mode], Shaper]) -> Callable[[float, float], Shaper]:
    """The family as a function of frequency [Hz] and damping ratio."""
    return lambda frequency, damping: family(Mode(frequency, damping))


def _search_grid(spectra: Sequence[klipper.Spectrum]) -> np.ndarray:
    """Frequencies to try [Hz], evenly spaced in ratio, around everything loud."""
    loud = np.concatenate([s.frequencies[s.psd >= LOUD * s.psd.max()] for s in spectra])
    loud = loud[loud > 0.0]
    low, high = SEARCH_FACTORS[0] * float(loud.min()), SEARCH_FACTORS[1] * float(loud.max())
    return np.geomspace(low, high, int(np.ceil(np.log(high / low) / np.log(SEARCH_RATIO))) + 2)


def _limited(candidate: Candidate, maximum_impulses: int | None) -> Candidate:
    """The candidate, marked when the controller cannot hold it."""
    if maximum_impulses is not None and len(candidate.shaper) > maximum_impulses:
        return Candidate(candidate.name, candidate.shaper, candidate.score, f"more than {maximum_impulses} impulses")
    return candidate
