"""Singer & Seering, section 2.4: a command that is known in advance, rescaled to the actuator's limit."""

from __future__ import annotations

import numpy as np

from preshape import Mode, Profile, design
from preshape.command import trapezoid
from preshape.command.known import fastest_within, rescaled
from preshape.papers.reproduction import Row
from preshape.papers.rows import ROUNDING, beyond, claim, shown
from preshape.papers.singer.sequences import CLOSED
from preshape.plant import ModalPlant

__all__ = ["rows"]

PULSES = Profile.steps([0.0, 0.2, 0.4], [1.0, -2.0, 1.0])
"""A motor input at its limit of 1, forth and back; our choice."""

LOOKS = np.linspace(0.0, 3.0, 30_001)


def rows() -> list[Row]:
    """In the order of the memo."""
    mode = Mode(1.0, 0.1)
    found = [rescaled(PULSES, shape(mode), 1.0) for shape in CLOSED.values()]
    negative = rescaled(PULSES, design.um_zv(mode), 1.0)
    shaped = [one.shaped for one in (*found, negative) if isinstance(one.shaped, Profile)]
    reached = [float(np.abs(one(LOOKS)).max()) for one in shaped]
    off = max(abs(peak - 1.0) for peak in reached)
    plant = ModalPlant(mode)
    left = max(plant.motion(one).residual("output") / plant.motion(PULSES).residual("output") for one in shaped)
    move = trapezoid(0.05, maximum_speed=1.0, maximum_acceleration=1.0, dt=0.001).profile
    assert move is not None
    times = [
        fastest_within(move, shape(mode), maximum_speed=1.0, maximum_acceleration=1.0) for shape in CLOSED.values()
    ]
    peaks = [float(np.abs(one.shaped(LOOKS, 2)).max()) for one in times]
    return [
        claim(
            "2.4",
            "a known input, convolved and rescaled: its maximum is the actuator limit (0.4 s of pulses, 1 Hz, z = 0.1)",
            "the actuator limit",
            f"times {', '.join(f'{one.factor:.2f}' for one in found)}: limit missed by {shown(off)}",
            off < ROUNDING,
            note="Two, three, four impulses; peaks of the exact input, looked for on a grid of 0.1 ms.",
        ),
        beyond(
            "2.4",
            "vibration that the rescaled inputs leave, over what the unshaped one leaves",
            shown(left),
            left < ROUNDING,
        ),
        beyond(
            "2.4",
            "impulses 1, -1, 1 sum to one too, but their input exceeds the command's maximum: rescaled it is times",
            f"{negative.factor:.2f}",
            negative.factor < 1.0,
            note="Not the sum of one alone is the guarantee, but that the impulses are positive, as the memo's are.",
        ),
        beyond(
            "2.4",
            "a move of given distance (0.05 m, 1 m/s^2) is made faster instead, to the same limit: time saved",
            ", ".join(f"{1e3 * one.saved:.0f} ms" for one in times),
            min(one.saved for one in times) > 0.0 and max(abs(peak - 1.0) for peak in peaks) < 1e-9,
            note="Two, three, four impulses, against shaping the move that is at the limit unshaped.",
        ),
    ]
