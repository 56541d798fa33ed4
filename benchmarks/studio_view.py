"""Everything the studio draws of one design for four modes, against SciPy's lsim and plain NumPy for a part of it.

The peer computes less: the sensitivity curve by an outer product, and step and move, unshaped and shaped, sampled; no
design, no peak between samples, no bands, no zeros. Each run of ours is at modes that were not seen before.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import StateSpace, lsim
from timing import once, row

from preshape import Shaper
from preshape.mode import Mode
from preshape.workflow.workbench import AskedDesign, View, Workbench, view_of

MODES = ((9.8, 0.02), (17.0, 0.01), (31.7, 0.015), (52.0, 0.03))

FAMILIES = ("direct", "zvd", "ei", "um_zv", "si")

RUNS = 15


def main() -> None:
    """One row a family: the median of several drags of all modes."""
    for family in FAMILIES:
        view_of(_bench(family, 0))  # imports
        ours, views = [], []
        for run in range(1, RUNS + 1):
            view, seconds = once(lambda run=run: view_of(_bench(family, run)))  # type: ignore[misc]
            ours.append(seconds)
            views.append(view)
        view = views[-1]
        drawn = view.designs[0].drawn
        assert drawn is not None
        theirs = []
        for _ in range(3):
            (curve, motions), seconds = once(lambda: _plain(view, drawn.shaper))
            theirs.append(seconds)
        np.testing.assert_allclose(curve, drawn.vibration, atol=1e-9)
        for motion, exact in zip(motions, (view.unshaped_step, drawn.step), strict=False):
            assert np.abs(motion - exact.position).max() < 0.15  # a step between samples arrives up to one late
        row(
            f"view, {family}, {len(drawn.shaper)} impulses",
            float(np.median(ours)),
            "lsim and outer product for the curves alone",
            float(np.median(theirs)),
            "claim: ours below 20 ms but for si, and below the peer",
        )


def _bench(family: str, run: int) -> Workbench:
    modes = tuple(Mode(frequency * (1.0 + 1e-3 * run), damping) for frequency, damping in MODES)
    return Workbench(modes, (AskedDesign("A", family),))


def _plain(view: View, shaper: Shaper) -> tuple[np.ndarray, list[np.ndarray]]:
    """Sensitivity curve, then step and move without and with the shaper."""
    f, z = view.frequencies, view.dampings
    rates = 2.0 * np.pi * f * (z + 1j * np.sqrt(1.0 - z**2))
    curve = np.abs(np.exp(np.outer(rates, shaper.times - shaper.duration)) @ shaper.amplitudes)
    blocks = [np.array([[0.0, 1.0], [-(m.omega**2), -2.0 * m.damping * m.omega]]) for m in view.workbench.modes]
    size = 2 * len(blocks)
    a, b, c = np.zeros((size, size)), np.zeros((size, 1)), np.zeros((1, size))
    for k, (block, mode) in enumerate(zip(blocks, view.workbench.modes, strict=True)):
        a[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = block
        b[2 * k + 1, 0], c[0, 2 * k] = mode.omega**2, 1.0 / len(blocks)
    system = StateSpace(a, b, c, [[0.0]])
    drawn = view.designs[0].drawn
    assert drawn is not None
    motions = []
    for times, response in (
        (view.step_times, view.unshaped_step),
        (view.step_times, drawn.step),
        (view.move_times, view.unshaped_move),
        (view.move_times, drawn.move),
    ):
        motions.append(lsim(system, response.command, times, interp=False)[1])
    return curve, motions


if __name__ == "__main__":
    main()
