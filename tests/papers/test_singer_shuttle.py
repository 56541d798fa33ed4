"""The Shuttle arm's moves: seeded, as theory has it for linear joints, and red when the sequences are wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from preshape import design
from preshape.papers.singer import shuttle_moves
from preshape.papers.singer.shuttle_arm import rows
from preshape.papers.singer.shuttle_moves import ALL, LINEAR, Experiment, random_moves, run_experiment
from preshape.plant.shuttle_arm import ANGLE_LIMITS, CALIBRATED_JOINTS, RATE_LIMITS, ShuttleArm
from preshape.vibration import residual_vibration

FEW = 16


@pytest.fixture(scope="module")
def few() -> Experiment:
    return run_experiment(FEW)


def test_moves_are_seeded_and_within_the_joints_limits() -> None:
    moves, again = random_moves(FEW), random_moves(FEW)
    assert np.array_equal(moves.poses, again.poses)
    assert np.array_equal(moves.rates, again.rates)
    assert (moves.poses >= ANGLE_LIMITS[:, 0]).all() and (moves.poses <= ANGLE_LIMITS[:, 1]).all()
    assert (np.abs(moves.rates) <= RATE_LIMITS).all()
    steps = np.concatenate([shaper.times for shaper in moves.three()[0]]) / CALIBRATED_JOINTS.reading
    assert steps == pytest.approx(np.round(steps), abs=1e-9), "impulses on the arm's grid"


def test_linear_residuals_are_those_of_the_modes(few: Experiment) -> None:
    """Swings of the linearised arm where the move ends, and what the sequence leaves of each: a bound, and near."""
    ratios = []
    for k, (pose, rate) in enumerate(zip(few.moves.poses, few.moves.rates, strict=True)):
        end = pose + shuttle_moves.PULSE * rate
        arm = ShuttleArm()
        swings, modes = arm.end_point_steps(rate, end), arm.modes(end)
        late = CALIBRATED_JOINTS.reading
        alone = [swing * np.exp(-mode.damping * mode.omega * late) for swing, mode in zip(swings, modes, strict=True)]
        # The stop's swing and what is left of the start's.
        bound = sum(a * (1 + np.exp(-m.damping * m.omega * 4.0)) for a, m in zip(alone, modes, strict=True))
        left = few.residuals[LINEAR]["unshaped"][k]
        assert left < 1.1 * bound
        shaper = few.moves.three()[0][k]
        kept = sum(
            a * residual_vibration(shaper, mode.frequency, mode.damping) for a, mode in zip(alone, modes, strict=True)
        )
        ratios.append(few.residuals[LINEAR]["three"][k] / (kept + 1e-3 * left))
    assert np.median(ratios) < 1.5


def test_a_shorter_step_gives_the_same_distribution(few: Experiment) -> None:
    fine = run_experiment(FEW, step=0.002)
    for variant in (LINEAR, "stiffening", "saturation", ALL):
        assert np.median(fine.factors(variant)) == pytest.approx(np.median(few.factors(variant)), rel=0.06), variant
        assert fine.residuals[variant]["unshaped"] == pytest.approx(few.residuals[variant]["unshaped"], rel=0.1)


def test_progress_rises_to_one() -> None:
    told: list[float] = []
    run_experiment(2, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_sequences_for_a_wrong_frequency_are_a_difference_that_nothing_explains(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    zvd = design.zvd
    monkeypatch.setattr(design, "zvd", lambda mode: zvd((2.2 * mode.frequency, mode.damping)))
    monkeypatch.setattr(design, "convolved", lambda modes: zvd((2.2 * modes[0].frequency, modes[0].damping)))
    assert not all(row.explained for row in rows(run_experiment(40)))


def test_without_the_gap_the_sequences_leave_less(few: Experiment) -> None:
    small = run_experiment(FEW, joints=replace(CALIBRATED_JOINTS, gap=CALIBRATED_JOINTS.gap / 10.0))
    before, after = (np.median(one.residuals[ALL]["three"]) for one in (few, small))
    assert after < 0.7 * before
