"""The candidates of a calibration: every closed family tuned to the spectra, and the multi-mode designs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from preshape import design
from preshape.errors import InputError
from preshape.export import klipper
from preshape.identify import IdentifiedMode
from preshape.mode import Mode, Modes
from preshape.report import FREQUENCY_ERROR, Candidate
from preshape.shaper import Shaper

__all__ = ["designed_candidates", "machine_dampings"]

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

DEFAULT_DAMPING = 0.1
"""What is assumed [-] when no mode was found and none is given; Klipper assumes the same."""

SEARCH_FACTORS = (0.6, 2.5)
"""Families are tuned from this multiple of the lowest peak to this multiple of the highest."""

SEARCH_RATIO = 1.005
"""Ratio of neighbouring frequencies in the search: half a percent is finer than any machine holds."""

LOUD = 0.2
"""Bins above this fraction of the highest one bound the search."""


def machine_dampings(modes: Sequence[IdentifiedMode], damping: float | None) -> tuple[float, ...]:
    """The damping ratios at which shapers are tested; the worst counts.

    Klipper tests 0.075, 0.1 and 0.15, since it does not know the machine's. Where the modes were identified, their own
    damping ratios and the ends of the first one's confidence interval are tested instead.
    """
    if damping is not None:
        return (damping,)
    if not modes:
        return klipper.TESTED_DAMPINGS
    return tuple(sorted({*modes[0].damping_interval, *(mode.mode.damping for mode in modes)}))


def designed_candidates(
    spectra: Sequence[klipper.Spectrum],
    modes: Sequence[IdentifiedMode],
    stock: klipper.KlipperFit,
    *,
    damping: float | None = None,
    maximum_impulses: int | None = None,
) -> Iterator[Candidate]:
    """All candidates with their scores, in no order; `stock` is what Klipper itself would choose.

    A family that does not exist at this damping (EI has a limit) is left out; one with more impulses than the
    controller holds is kept and marked, so that the user sees what the limit costs.
    """
    dampings = machine_dampings(modes, damping)
    ratio = damping if damping is not None else modes[0].mode.damping if modes else DEFAULT_DAMPING
    grid = _search_grid(spectra)

    def candidate(name: str, shaper: Shaper) -> Candidate:
        return Candidate(
            name=name,
            shaper=shaper,
            score=klipper.score(shaper, spectra, dampings),
            worst=klipper.remaining_vibration(shaper, spectra, dampings, frequency_error=FREQUENCY_ERROR),
            excluded=_exclusion(shaper, maximum_impulses),
        )

    for name, family in TUNED.items():
        try:
            fitted = klipper.tune(
                name,
                _of_frequency(family),
                spectra,
                grid,
                damping=ratio,
                dampings=dampings,
                frequency_error=FREQUENCY_ERROR,
            )
        except InputError:
            continue
        yield candidate(f"{name} at {fitted.frequency:.4g} Hz", fitted.shaper)
    yield candidate(f"Klipper's {stock.name} at {stock.frequency:.1f} Hz", stock.shaper)
    if len(modes) > 1:
        wanted = Modes([mode.mode for mode in modes])
        for name, family_of_several in SEVERAL.items():
            yield candidate(name, family_of_several(wanted))


def _of_frequency(family: Callable[[Mode], Shaper]) -> Callable[[float, float], Shaper]:
    """The family as a function of frequency [Hz] and damping ratio."""
    return lambda frequency, damping: family(Mode(frequency, damping))


def _search_grid(spectra: Sequence[klipper.Spectrum]) -> np.ndarray:
    """Frequencies to try [Hz], evenly spaced in ratio, around everything loud."""
    loud = np.concatenate([s.frequencies[s.psd >= LOUD * s.psd.max()] for s in spectra])
    loud = loud[loud > 0.0]
    low, high = SEARCH_FACTORS[0] * float(loud.min()), SEARCH_FACTORS[1] * float(loud.max())
    return np.geomspace(low, high, int(np.ceil(np.log(high / low) / np.log(SEARCH_RATIO))) + 2)


def _exclusion(shaper: Shaper, maximum_impulses: int | None) -> str:
    """Why the controller cannot hold this shaper; empty when it can."""
    too_many = maximum_impulses is not None and len(shaper) > maximum_impulses
    return f"more than {maximum_impulses} impulses" if too_many else ""
