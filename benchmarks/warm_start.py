"""The redesign when modes have moved by 1 %, from the shaper before, against the design from nothing."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from functools import partial

import numpy as np
from timing import best_of, once, row

from preshape import Modes, Shaper, design

MODES = [(1.65, 0.01), (5.42, 0.01), (6.90, 0.01), (19.08, 0.01)]
"""Hyde's MACE, open loop."""

MOVED, SETS = 0.01, 100


def compare(what: str, before: Shaper, factors: Sequence[Sequence[float]]) -> None:
    """Median times over sets of modes, each frequency multiplied by its factor; both ways must agree."""
    warm, cold, searched = [], [], 0
    for each in factors:
        modes = Modes([(f * factor, z) for (f, z), factor in zip(MODES, each, strict=True)])
        shaper, seconds = once(partial(design.direct, modes, near=before))
        again, longer = once(partial(design.direct, modes))
        assert shaper.design.status == "optimal" and abs(shaper.duration / again.duration - 1.0) < 1e-9
        warm.append(seconds)
        cold.append(longer)
        searched += shaper.design.settings["start"] == "full"
    share = f"{100.0 * searched / len(factors):.0f} % of {len(factors)} needed the full search"
    row(f"4 modes, {what}, warm, median", float(np.median(warm)), "cold", float(np.median(cold)), share)


def main() -> None:
    """All modes by the same fraction, as with another payload; then each on its own."""
    before = design.direct(MODES)
    together = Modes([(frequency * (1.0 + MOVED), damping) for frequency, damping in MODES])
    assert design.direct(together, near=before).design.settings["start"] == "near"
    row(
        "4 modes, all moved by 1 %, warm",
        best_of(lambda: design.direct(together, near=before)),
        "cold",
        best_of(lambda: design.direct(together)),
        "claim: under 0.5 ms",
    )
    every = list(itertools.product((1.0 - MOVED, 1.0 + MOVED), repeat=len(MODES)))
    compare("each moved by +1 or -1 % on its own", before, every)
    random = 1.0 + MOVED * np.random.default_rng(7).uniform(-1.0, 1.0, (SETS, len(MODES)))
    compare("each moved by up to 1 % at random", before, random.tolist())


if __name__ == "__main__":
    main()
