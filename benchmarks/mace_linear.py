"""The linear MACE model, twelve modes and the rigid body, under a million samples: against scipy.signal.lsim."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lsim
from timing import best_of, once, row

from preshape import design
from preshape.plant import (
    FlexibleStructure,
    Output,
    linear_mace,
    linear_mace_beam,
    linear_mace_torque,
    torque_pulses,
)

SAMPLES = 1_000_000
DT = 2e-5
"""[s]; the fastest mode, 1362 Hz, gets 37 samples a period."""
SLEW_EVERY = 2.0
"""[s]: ten slews there and back, shaped for three modes, and the torque ripple of a motor on top."""
RIPPLE = 0.01
AGREEMENT = 1e-9
"""Of the peak of each output; bending is a two-hundredth of how far the far end moves."""

Matrix = NDArray[np.float64]


def command() -> NDArray[np.float64]:
    """Samples that excite everything: shaped slews and white noise."""
    modes = linear_mace().modes()
    slew = torque_pulses(linear_mace_torque()).shaped(design.direct(modes[:3])).sample(DT)
    values = RIPPLE * linear_mace_torque() * np.random.default_rng(0).standard_normal(SAMPLES)
    for k, start in enumerate(range(0, SAMPLES - slew.size, round(SLEW_EVERY / DT))):
        values[start : start + slew.size] += (-1) ** k * slew
    return values


def main() -> None:
    """The displacement of the far end and what of it is bending, held command, both ways."""
    plant, beam = linear_mace(), linear_mace_beam()
    torque = command()
    modes, weights = plant.modes(), plant.weights("left")
    # The rigid body from the beam itself: its acceleration at the left end for a unit torque.
    shapes = beam.modes.rigid_shapes
    rigid = float((beam.displacement(0.0).row @ shapes) @ (shapes.T @ beam.hinge_angle().row))
    looks = {"left": Output(weights.tolist(), rigid=rigid, unit="m"), "bending": Output(weights.tolist(), unit="m")}
    ours = FlexibleStructure(modes, plant.gains, looks, unit="N m")

    count = len(modes)
    a: Matrix = np.zeros((2 * count + 2, 2 * count + 2))
    b, c = np.zeros((2 * count + 2, 1)), np.zeros((2, 2 * count + 2))
    for k, mode in enumerate(modes):
        a[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = [[0.0, 1.0], [-(mode.omega**2), 0.0]]
        b[2 * k + 1, 0], c[:, 2 * k] = plant.gains[k], weights[k]
    a[-2, -1], b[-1, 0], c[0, -2] = 1.0, 1.0, rigid
    system = (a, b, c, np.zeros((2, 1)))
    times = DT * np.arange(SAMPLES)

    (_, expected, _), theirs = once(lambda: lsim(system, torque, times, interp=False))
    found = ours.simulate(torque, DT).outputs
    of_the_model = plant.simulate(torque, DT).outputs["left"]
    gaps = [
        float(np.abs(one - other).max() / np.abs(other).max())
        for one, other in zip((found["left"], found["bending"], of_the_model), expected.T[[0, 1, 0]], strict=True)
    ]
    assert max(gaps) < AGREEMENT, gaps
    row(
        f"linear MACE, {count} modes, {SAMPLES:.0e} samples, 2 outputs, agreement {max(gaps):.0e} of each peak",
        best_of(lambda: ours.simulate(torque, DT)),
        "scipy.signal.lsim",
        theirs,
        "claim: >= 20",
    )


if __name__ == "__main__":
    main()
