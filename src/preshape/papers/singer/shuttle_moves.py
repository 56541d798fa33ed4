"""The experiment of figure 12 two hundred times: poses, pulses, sequences, and what every move leaves at the end point.

The memo shows one move of a simulator that is not public and says "comparable results were obtained for a variety of
moves tested". Here the arm of :mod:`preshape.plant.shuttle_arm` makes a variety of moves: random poses, a 4 s pulse of
all six joint rates at random, between a tenth and all of the fastest. Each is made plain, with three impulses for the
mode that swings the end point most (linearised where the move ends), and with three for each of the two that do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape import Mode, Shaper, design
from preshape.plant import Simulation
from preshape.plant.shuttle_arm import (
    ANGLE_LIMITS,
    CALIBRATED_JOINTS,
    CALIBRATION_POSE,
    IMPERFECTIONS,
    RATE_LIMITS,
    JointHardware,
    ShuttleArm,
)

__all__ = [
    "ALL",
    "FIGURE_MOVE",
    "LINEAR",
    "TIGHT",
    "Experiment",
    "Moves",
    "left",
    "random_moves",
    "run_experiment",
    "stated_move",
]

Matrix = NDArray[np.float64]

PULSE = 4.0
"""[s], as printed."""

DT = 0.04
"""Between samples of the results [s]."""

STEP = 0.004
"""Of these simulations [s]; at 2.5 ms the median factors differ by less than 3 %."""

WATCHED = 2.4
"""After a command's end [s]: what the end point does then is the residual."""

SLOWEST = 0.1
"""Of the fastest rates: the smallest level of a random pulse."""

SEED = 1027
"""The memo's number."""

LINEAR, ALL, TIGHT = "none", "all", "all but freeplay"

FIGURE_MOVE = 0.5 * RATE_LIMITS * np.array([1.0, 1.0, 0.0, 0.0, 0.0, 0.0])
"""A move to draw: both shoulder joints at half their fastest [rad/s], in the pose of the calibration."""

VARIANTS: dict[str, tuple[str, ...]] = {
    LINEAR: (),
    **{name: (name,) for name in IMPERFECTIONS},
    ALL: IMPERFECTIONS,
    TIGHT: tuple(name for name in IMPERFECTIONS if name != "freeplay"),
}


@dataclass(frozen=True, eq=False)
class Moves:
    """Pulses and their sequences.

    Attributes
    ----------
    poses, rates : ndarray, shape (run, joint)
        [rad], [rad/s]
    modes : list of Mode
        For each run what its three impulses are for.
    shapers : dict of str to list of Shaper or None
        "unshaped", "three" impulses, and three for each of "two" modes, each with one for each run.
    """

    poses: Matrix
    rates: Matrix
    modes: list[Mode]
    shapers: dict[str, list[Shaper | None]]

    def three(self) -> tuple[list[Shaper], list[Mode]]:
        """The sequences of three impulses and their modes."""
        return [shaper for shaper in self.shapers["three"] if shaper is not None], self.modes

    def commands(self, which: str, samples: int) -> list[Matrix]:
        """Rates of every run, shape (joint, sample) [rad/s]."""
        return [_pulse(rates, shaper, samples) for rates, shaper in zip(self.rates, self.shapers[which], strict=True)]

    def ends(self, which: str) -> list[int]:
        """The sample from which on a command has surely ended, also for joints that read it late."""
        late = CALIBRATED_JOINTS.reading
        return [
            int(np.ceil((PULSE + late + (0.0 if shaper is None else shaper.duration)) / DT - 1e-9))
            for shaper in self.shapers[which]
        ]


@dataclass(frozen=True, eq=False)
class Experiment:
    """What is left.

    Attributes
    ----------
    moves : Moves
    residuals : dict of str to dict of str to ndarray of shape (run,)
        By what is on ("none", an imperfection, "all"), then by sequence [m].
    drawn : dict of str to Simulation
        The stated move, all on, "unshaped" and with "three" impulses.
    ended : dict of str to int
        The samples at which its commands have ended.
    """

    moves: Moves
    residuals: dict[str, dict[str, Matrix]]
    drawn: dict[str, Simulation]
    ended: dict[str, int]

    def factors(self, variant: str, which: str = "three") -> Matrix:
        """What the residual is divided by in every run [-]."""
        return self.residuals[variant]["unshaped"] / self.residuals[variant][which]

    def drawn_factor(self) -> float:
        """The same of the stated move [-]."""
        return left(self.drawn["unshaped"], self.ended["unshaped"]) / left(self.drawn["three"], self.ended["three"])


def random_moves(count: int = 200, seed: int = SEED) -> Moves:
    """Poses within the joints' limits, rates within theirs, and the sequences for them."""
    rng = np.random.default_rng(seed)
    limits = ANGLE_LIMITS.copy()
    limits[5] = -np.pi, np.pi
    poses = rng.uniform(limits[:, 0], limits[:, 1], (count, 6))
    rates = rng.uniform(-1.0, 1.0, (count, 6)) * RATE_LIMITS * rng.uniform(SLOWEST, 1.0, (count, 1))
    return _with_sequences(poses, rates)


def stated_move() -> Moves:
    """The one that is drawn."""
    return _with_sequences(np.array([CALIBRATION_POSE]), FIGURE_MOVE[np.newaxis])


def run_experiment(
    count: int = 200,
    *,
    step: float = STEP,
    joints: JointHardware = CALIBRATED_JOINTS,
    progress: Callable[[float], object] | None = None,
) -> Experiment:
    """All moves, linear, with each imperfection alone, and with all of them.

    Parameters
    ----------
    count : int
        Moves.
    step : float
        Of the simulations [s].
    joints : JointHardware
        Whose imperfections are switched.
    progress : function, optional
        Called with the part done, 0 to 1.
    """
    moves = random_moves(count)
    residuals = {}
    for number, (variant, on) in enumerate(VARIANTS.items()):
        arm = ShuttleArm(joints=joints.only(*on))
        # What sequences for two modes add is asked of the linear arm and of the whole one.
        which = ["unshaped", "three", "two"] if variant in (LINEAR, ALL) else ["unshaped", "three"]

        def told(part: float, number: int = number) -> None:
            if progress is not None:
                progress((number + part) / len(VARIANTS))

        residuals[variant] = _residuals(arm, moves, which, step, told)
    one = stated_move()
    arm = ShuttleArm(CALIBRATION_POSE, joints=joints.only(*IMPERFECTIONS))
    ended = {which: one.ends(which)[0] for which in ("unshaped", "three")}
    samples = _samples(one, ["unshaped", "three"])
    drawn = {which: arm.simulate(one.commands(which, samples)[0], DT, step=step) for which in ended}
    return Experiment(moves, residuals, drawn, ended)


def left(done: Simulation, start: int, watched: float = WATCHED, dt: float = DT) -> float:
    """Largest distance of the end point from where it is on average, from a sample on, for some time [s, m]."""
    window = np.array([done.outputs[f"end point {axis}"] for axis in "xyz"])[:, start : start + round(watched / dt)]
    return float(np.linalg.norm(window - window.mean(axis=1, keepdims=True), axis=0).max())


def _with_sequences(poses: Matrix, rates: Matrix) -> Moves:
    arm = ShuttleArm()
    chosen: list[Mode] = []
    three: list[Shaper | None] = []
    two: list[Shaper | None] = []
    grid = CALIBRATED_JOINTS.reading
    for pose, rate in zip(poses, rates, strict=True):
        end = pose + PULSE * rate
        modes, swings = arm.modes(end), arm.end_point_steps(rate, end)
        first, second = np.argsort(swings)[::-1][:2].tolist()
        chosen.append(modes[first])
        # The arm's computer sends a command every 80 ms; impulses in between would reach the joints at other times.
        three.append(design.on_grid(design.zvd(modes[first]), grid))
        two.append(design.on_grid(design.convolved([modes[first], modes[second]]), grid))
    return Moves(poses, rates, chosen, {"unshaped": [None] * len(poses), "three": three, "two": two})


def _residuals(
    arm: ShuttleArm, moves: Moves, which: list[str], step: float, progress: Callable[[float], object]
) -> dict[str, Matrix]:
    samples = _samples(moves, which)
    commands = [command for one in which for command in moves.commands(one, samples)]
    ends = [end for one in which for end in moves.ends(one)]
    done = arm.simulate_all(np.tile(moves.poses, (len(which), 1)), commands, DT, step=step, progress=progress)
    values = np.array([left(one, end) for one, end in zip(done, ends, strict=True)])
    return dict(zip(which, values.reshape(len(which), -1), strict=True))


def _samples(moves: Moves, which: list[str]) -> int:
    return max(max(moves.ends(one)) for one in which) + round(WATCHED / DT)


def _pulse(rates: Matrix, shaper: Shaper | None, samples: int) -> Matrix:
    command = np.zeros((6, samples))
    command[:, : round(PULSE / DT)] = rates[:, np.newaxis]
    if shaper is None:
        return command
    return np.array([shaper.shape(row, DT)[:samples] for row in command])
