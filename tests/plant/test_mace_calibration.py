"""The calibrated MACE model against Hyde's tables, and its linearisation against closed forms and its own laws."""

import math
from dataclasses import replace

import numpy as np
import pytest

from preshape.errors import InputError
from preshape.plant.mace import (
    CALIBRATED,
    CALIBRATED_GAINS,
    GimbalLimits,
    Mace,
    MaceGains,
    calibrate,
    calibration_table,
)
from preshape.plant.mace.calibration import BOUNDS
from preshape.plant.mace.linear import Linearised, bending_damping, oscillations
from preshape.plant.mace.structure import LENGTH, NODE_INERTIA, POUND


def test_every_number_asked_for_is_within_its_tolerance() -> None:
    rows = calibration_table()
    assert sum(row.tolerance == 0.05 for row in rows) == 4
    assert [row for row in rows if not row.holds] == []
    assert len({row.what for row in rows}) == len(rows) == 18


def test_the_outboard_fundamental_is_above_the_inboard_one_and_both_above_the_open_loops() -> None:
    closed = Mace(CALIBRATED_GAINS)
    inboard, outboard = (closed.modes(math.radians(angle))[0].frequency for angle in (60, -60))
    assert Mace().modes()[0].frequency < inboard < outboard


def test_no_parameter_is_outside_its_physical_range() -> None:
    for part in (CALIBRATED, CALIBRATED_GAINS):
        for name in type(part).__slots__:
            if name != "gimbal_mass":
                low, high = BOUNDS[name]
                assert low - 1e-3 * high <= getattr(part, name) <= high * 1.001
    whole = CALIBRATED.gimbal_mass + CALIBRATED.stage_mass
    assert BOUNDS["gimbal_total"][0] * 0.999 <= whole <= BOUNDS["gimbal_total"][1] * 1.001
    assert CALIBRATED.total_mass / POUND == pytest.approx(60.0, rel=0.03)


def test_a_bus_alone_is_the_free_beam_of_the_textbook() -> None:
    bare = replace(
        CALIBRATED, node_mass=1e-9, gimbal_mass=1e-9, gimbal_inertia=1e-9, axial_stiffness=1e7, axis_height=0.0, arm=0.0
    )
    model = Linearised(bare, elements=4)
    # The attitude unit and payloads are constants of the article: take them out of the matrices instead.
    middle, last = 8, 16
    for index in (3 * middle, 3 * middle + 1):
        model.mass[index, index] -= bare.middle_mass
    model.mass[3 * middle + 2, 3 * middle + 2] -= bare.attitude_inertia + bare.middle_mass * bare.attitude_offset**2
    for index in (3 * middle, 3 * middle + 2):
        other = 6 * middle + 2 - index
        model.mass[index, other] -= bare.middle_mass * bare.attitude_offset
    for node in range(0, last + 1, 4):
        model.mass[3 * node + 2, 3 * node + 2] -= NODE_INERTIA
    for node in (0, last):
        for index in (3 * node, 3 * node + 1):
            model.mass[index, index] -= bare.turning_mass
    model.mass[2, 2] -= bare.payload_inertia
    free = np.sqrt(np.linalg.eigvals(np.linalg.solve(model.mass, model.stiffness)).real.clip(0.0))
    slowest = np.sort(free[free > 1.0])[:3]
    textbook = np.array([4.730041, 7.853205, 10.995608]) ** 2 / LENGTH**2
    expected = textbook * math.sqrt(bare.bending_stiffness / bare.bus_density)
    np.testing.assert_allclose(slowest, expected, rtol=1e-3)


def test_open_loop_bending_has_the_damping_it_was_given() -> None:
    frequencies, dampings = oscillations(Linearised(CALIBRATED, damping=0.01).poles())
    np.testing.assert_allclose(dampings[:6], 0.01, rtol=0.05)
    assert (np.abs(frequencies[:4] / Linearised(CALIBRATED).undamped()[:4] - 1.0) < 1e-3).all()


def test_damping_takes_nothing_from_rigid_motion() -> None:
    damper = bending_damping(CALIBRATED, 2, 0.01)
    places = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, 9)
    up = np.column_stack([np.ones(9), np.zeros(9)]).ravel()
    turn = np.column_stack([places, np.ones(9)]).ravel()
    scale = np.abs(damper).max()
    assert np.abs(damper @ up).max() < 1e-9 * scale and np.abs(damper @ turn).max() < 1e-9 * scale
    assert np.linalg.eigvalsh(damper).min() > -1e-9 * scale


def test_elements_hardly_matter() -> None:
    coarse, fine = (Linearised(CALIBRATED, 0.5, elements=n).undamped()[:4] for n in (2, 8))
    np.testing.assert_allclose(coarse, fine, rtol=1e-4)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: replace(CALIBRATED, node_mass=0.0), "node_mass is 0"),
        (lambda: MaceGains(1.0, math.nan, 1.0, 1.0), "attitude_damping is nan"),
        (lambda: GimbalLimits(speed=-1.0), "speed is -1 rad/s"),
        (lambda: Mace(angle=math.inf), "payload's angle is inf"),
        (lambda: Mace(damping=-0.1), "damping is -0.1"),
        (lambda: Mace(elements=0), "elements is 0"),
        (lambda: calibrate(starts=0), "starts is 0"),
    ],
)
def test_wrong_parameters_are_named(make: object, says: str) -> None:
    with pytest.raises(InputError) as refused:
        make()  # type: ignore[operator]
    assert says in str(refused.value)


def test_unstable_gains_have_no_modes_and_say_how_fast_they_grow() -> None:
    with pytest.raises(
        InputError,
        match=r"With these gains and the payload at 0 deg the loop is unstable, motion grows by e every 0\.\d+ s",
    ):
        Mace(MaceGains(75.0, 100.0, -5.0, -1.0)).modes()


@pytest.mark.slow
def test_calibration_finds_the_constants_again() -> None:
    structure, gains = calibrate()
    found, kept = calibration_table(structure, gains), calibration_table()
    for new, old in zip(found, kept, strict=True):
        assert new.holds
        assert new.found == pytest.approx(old.found, rel=0.01), new.what
