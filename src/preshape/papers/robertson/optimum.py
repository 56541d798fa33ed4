"""Beyond Robertson: how near his commands are to the shortest that there are, each proved."""

from __future__ import annotations

from preshape import Mode
from preshape.command import rest_to_rest
from preshape.papers.reproduction import Row
from preshape.papers.robertson.moves import DISTANCES, FORCE, LIMIT, MODE, OSCILLATOR, Kind, move
from preshape.papers.rows import ROUNDING, beyond, shown
from preshape.plant import FloatingOscillator

__all__ = ["rows"]

SAME = 1e-9
"""Durations that differ by no more, relatively, are the same."""


def rows() -> list[Row]:
    """The limited command, on-off, other ways to keep the limit, a damped oscillator."""
    return [_limited(), _on_off(), *_other_ways(), _damped()]


def _limited() -> Row:
    gaps, durations, proved = [], [], True
    for distance in DISTANCES:
        best = _shortest(OSCILLATOR, distance, LIMIT)
        closed = move("limited", distance).duration
        gaps.append(abs(closed / (best.lower_bound or 0.0) - 1.0))
        durations.append(closed)
        proved = proved and best.status == "optimal"
    return beyond(
        "II.A",
        "no command that keeps the limit 0.3 is shorter than ours (5, 10, 15, 20 units): duration, gap to bound",
        ", ".join(f"{value:.4f}" for value in durations) + f" s; below {SAME:.0e}",
        proved and max(gaps) < SAME,
    )


def _on_off() -> Row:
    extra, part, shorter = [], 0.0, True
    for distance in DISTANCES:
        best = _shortest(OSCILLATOR, distance, OSCILLATOR.static_deflection(FORCE))
        extra.append(move("on-off", distance).duration - best.duration)
        part = max(part, extra[-1] / best.duration)
        shorter = shorter and best.status == "optimal" and set(abs(best.levels)) == {FORCE}
    return beyond(
        "II.A",
        "the shortest that deflects by no more than on-off, 0.5, saves (5, 10, 15, 20 units)",
        ", ".join(f"{value:.4f}" for value in extra) + " s",
        shorter and 0.03 < min(extra) and part < 0.01,
        note=f"It is at full force all the time, proved; on-off is at most {100.0 * part:.1f} % longer.",
    )


def _other_ways() -> list[Row]:
    ours = move("limited", 10.0)
    found = []
    ways: tuple[tuple[Kind, str], ...] = (
        ("lean", "force off instead of backwards at the start (1, 0, 0.6)"),
        ("weak", "on-off with 60 % of the force"),
    )
    for kind, what in ways:
        other = move(kind, 10.0)
        motion = OSCILLATOR.motion(other.force)
        peak, left = motion.peak("deflection").value, motion.residual("deflection")
        longer = other.duration / ours.duration - 1.0
        found.append(
            beyond(
                "II.A",
                f"10 units, {what}: keeps 0.3 too, and takes longer by",
                f"{100.0 * longer:.1f} %",
                abs(peak - LIMIT) < 1e-12 and left < ROUNDING and 0.0 < longer < 0.04,
                note=f"Peak {peak:.6f}, vibration left {shown(left)}, simulated.",
            )
        )
    return found


def _damped() -> Row:
    plant = FloatingOscillator.from_mode(1.0, 1.0, Mode(MODE.frequency, 0.1))
    best = _shortest(plant, 10.0, LIMIT)
    motion = plant.motion(best.force)
    peak, left = motion.peak("deflection").value, motion.residual("deflection")
    return beyond(
        "II.A",
        "with z = 0.1, 10 units: shortest command that keeps 0.3, and its levels",
        f"{best.duration:.4f} s; " + ", ".join(f"{level:.3g}" for level in best.levels),
        best.status == "optimal" and abs(peak - LIMIT) < 1e-9 and left < 1e-9,
        note="The text says that the commands depend on damping; by the engine, proved, and simulated exactly.",
    )


def _shortest(plant: FloatingOscillator, distance: float, limit: float) -> rest_to_rest.RestToRest:
    return rest_to_rest.time_optimal(plant, distance, maximum_force=FORCE, deflection_limits=limit)
