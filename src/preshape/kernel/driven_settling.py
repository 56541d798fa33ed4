"""When an output of driven phasors has settled: the last time that it is outside a band about its end."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.kernel.driven_extremum import (
    BLOCK,
    PARTS,
    ROUNDING,
    SAMPLES_PER_PERIOD,
    Stretch,
    first_stretches,
    parts_of,
    split,
)
from preshape.kernel.driven_output import DrivenOutput

__all__ = ["last_outside"]

MOST_BLOCKS = 256
"""A ring-down longer than this many blocks is followed backwards for as many: where one mode rings longest, the last
moment outside is in the first block."""

TOUCHING = 1e-12
"""An output that leaves the band by less than this fraction of it only touches the edge."""


def last_outside(output: DrivenOutput, half_width: float) -> float:
    """The last time [s] at which \\|y - y(infinity)\\| > `half_width`; infinity if it never settles, 0 if never out.

    Parameters
    ----------
    output : DrivenOutput
        The output.
    half_width : float
        Half of the band [unit of the output], above zero.
    """
    phasors = output.phasors
    if phasors.starts.size == 0:
        return 0.0
    rest, amplitudes = output.ending()
    if rest[1:].any():
        return math.inf
    limit = half_width * (1.0 + TOUCHING)
    steady = phasors.poles.real == 0.0
    if amplitudes[steady].sum() > limit:
        return math.inf
    for stretch in chain(_tail(output, amplitudes, limit), reversed(list(first_stretches(phasors)))):
        last = _search(output, float(rest[0]), limit, stretch)
        if last is not None:
            return last
    return float(phasors.starts[0]) if abs(rest[0]) > limit else 0.0


def _tail(output: DrivenOutput, amplitudes: NDArray[np.float64], limit: float) -> Iterator[Stretch]:
    """What comes after the last step, the latest first, from when the free vibration cannot leave the band any more."""
    poles = output.phasors.poles
    end = 0.0
    if amplitudes.sum() > limit:
        spare = limit - amplitudes[poles.real == 0.0].sum()
        decaying = (poles.real < 0.0) & (amplitudes > 0.0)
        # When each decaying amplitude is below its equal share of what is spare, so is their sum.
        share = spare / np.count_nonzero(decaying)
        end = float(np.max(np.log(np.maximum(amplitudes[decaying] / share, 1.0)) / -poles.real[decaying], initial=0.0))
    last = output.phasors.starts.size - 1
    intervals = end * float(np.abs(poles).max(initial=0.0)) * SAMPLES_PER_PERIOD / (2.0 * np.pi)
    blocks = max(1, math.ceil(min(intervals / BLOCK, float(MOST_BLOCKS + 1))))
    length = end / blocks if blocks <= MOST_BLOCKS else BLOCK * end / intervals
    for k in range(min(blocks, MOST_BLOCKS)):
        since = max(end - (k + 1) * length, 0.0)
        yield split(last, since, length, int(parts_of(output.phasors, np.array([length]))[0]))
    if blocks > MOST_BLOCKS:
        raise InputError(
            f"the vibration takes {end:.3g} s to die out, too many periods to follow: give a wider band, or a damping "
            "ratio of 0 for what rings for ever."
        )


def _search(output: DrivenOutput, rest: float, limit: float, stretch: Stretch) -> float | None:
    """The last time in the stretches, which are in order, at which the output is outside; None when it never is."""
    starts = output.phasors.starts
    latest = -math.inf
    while True:
        segment, since, width, begin = stretch.nodes()
        here = output.looked(segment, since, width)
        away, times = np.abs(here.value - rest), starts[segment] + since
        outside = away > limit
        latest = max(latest, float(times[outside].max(initial=-math.inf)))
        most = np.maximum(away[begin], away[begin + 1]) + width[begin] ** 2 / 8.0 * here.most_curvature[begin]
        # An interval that ends outside has nothing later than its end; so has one that ended before the latest.
        open_ = (most > limit + ROUNDING * here.size[begin]) & ~outside[begin + 1] & (times[begin + 1] > latest)
        open_ &= width[begin] > 4.0 * np.finfo(float).eps * np.maximum(np.abs(times[begin]), width[begin])
        at = begin[open_]
        if at.size == 0:
            return latest if math.isfinite(latest) else None
        stretch = Stretch(segment[at], since[at], width[at], np.full(at.size, PARTS))
