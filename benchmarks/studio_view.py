"""Everything the studio draws of one design for four modes, against a script of SciPy's lsim and plain NumPy.

The peer is given the shaper, and computes the curves: sensitivity by an outer product, each mode's band from 2,000
frequencies, step and move without and with the shaper at four samples a point drawn, for their peaks. It finds no
zeros. Each run of ours is at modes that were not seen before, and designs the shaper.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from scipy.signal import StateSpace, lsim
from timing import once, row

from preshape import Shaper
from preshape.mode import Mode
from preshape.workflow.workbench import AskedDesign, View, Workbench, view_of
from preshape.workflow.workbench.curves import STEP, profile_of

MODES = ((9.8, 0.02), (17.0, 0.01), (31.7, 0.015), (52.0, 0.03))

FAMILIES = ("direct", "zvd", "ei", "um_zv", "si")

RUNS, FINER = 15, 4


def main() -> None:
    """One row a family: the median of several drags of all modes."""
    for family in FAMILIES:
        view_of(_bench(family, 0))  # imports
        ours, views = [], []
        for run in range(1, RUNS + 1):
            view, seconds = once(partial(view_of, _bench(family, run)))
            ours.append(seconds)
            views.append(view)
        view = views[-1]
        drawn = view.designs[0].drawn
        assert drawn is not None
        theirs = []
        for _ in range(3):
            (curve, motions), seconds = once(partial(_plain, view, drawn.shaper))
            theirs.append(seconds)
        np.testing.assert_allclose(curve, drawn.vibration, atol=1e-9)
        for motion, exact in zip(
            motions, (view.unshaped_step, drawn.step, view.unshaped_move, drawn.move), strict=True
        ):
            assert np.abs(motion[::FINER] - exact.position).mean() < 0.1  # a step between samples arrives late
        row(
            f"view, {family}, {len(drawn.shaper)} impulses",
            float(np.median(ours)),
            "lsim and outer products",
            float(np.median(theirs)),
            "claim: below 20 ms but for si",
        )


def _bench(family: str, run: int) -> Workbench:
    modes = tuple(Mode(frequency * (1.0 + 1e-3 * run), damping) for frequency, damping in MODES)
    return Workbench(modes, (AskedDesign("A", family),))


def _plain(view: View, shaper: Shaper) -> tuple[np.ndarray, list[np.ndarray]]:
    """Sensitivity curve, then step and move without and with the shaper."""
    f, z = view.frequencies, view.dampings
    rates = 2.0 * np.pi * f * (z + 1j * np.sqrt(1.0 - z**2))
    curve = np.abs(np.exp(np.outer(rates, shaper.times - shaper.duration)) @ shaper.amplitudes)
    for mode in view.workbench.modes:
        f = np.linspace(0.0, view.frequencies[-1], 2000)
        rates = 2.0 * np.pi * f * (mode.damping + 1j * np.sqrt(1.0 - mode.damping**2))
        above = np.abs(np.exp(np.outer(rates, shaper.times - shaper.duration)) @ shaper.amplitudes) > 0.05
        np.flatnonzero(above & (f < mode.frequency)).max(initial=0)
        np.flatnonzero(above & (f > mode.frequency)).min(initial=f.size)
    blocks = [np.array([[0.0, 1.0], [-(m.omega**2), -2.0 * m.damping * m.omega]]) for m in view.workbench.modes]
    size = 2 * len(blocks)
    a, b, c = np.zeros((size, size)), np.zeros((size, 1)), np.zeros((1, size))
    for k, (block, mode) in enumerate(zip(blocks, view.workbench.modes, strict=True)):
        a[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = block
        b[2 * k + 1, 0], c[0, 2 * k] = mode.omega**2, 1.0 / len(blocks)
    system: Any = StateSpace(a, b, c, np.zeros((1, 1)))
    motions = []
    for kind, times in ((STEP, view.step_times), (view.workbench.move, view.move_times)):
        fine = np.linspace(0.0, times[-1], FINER * (times.size - 1) + 1)
        for command in (profile_of(kind), profile_of(kind).shaped(shaper)):
            position = lsim(system, command(fine), fine, interp=False)[1]
            np.abs(position - command(fine)).max()
            motions.append(position)
    return curve, motions


if __name__ == "__main__":
    main()
