"""Servo grids: on the grid, within all limits, and one slot fewer impossible says a linear programme."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from preshape import Band, Mode, design
from preshape.engine import (
    AtMostImpulses,
    ImpulsesBetween,
    PartialSumsBetween,
    ServoGrid,
    VibrationAtMost,
    ZeroVibration,
    deflection_at_most,
    edges_of,
    largest_vibration,
    minimum_duration,
)
from preshape.plant import ModalPlant


def least(
    slots: int, dt: float, bands: list[tuple[float, ...]], low: float, levels: tuple[float, float] | None
) -> float:
    """Largest V that must remain, at sampled modes, polygons of 64 sides around the discs: a lower bound."""
    leads = np.arange(slots + 1) * dt
    modes = [(f, z) for a, b, *zs in bands for z in {*(zs or [0.0])} for f in np.linspace(a, b, 25)]
    rates = np.array([2.0 * np.pi * f * (z + 1j * math.sqrt(1.0 - z * z)) for f, z in modes])
    turns = np.exp(2j * np.pi * np.arange(64) / 64)
    sides = np.concatenate([(turn * np.exp(np.multiply.outer(-rates, leads))).real for turn in turns])
    rows, limits = [np.column_stack([sides, -np.ones(len(sides))])], [np.zeros(len(sides))]
    if levels is not None:
        sums = np.triu(np.ones((slots + 1, slots + 1)))[1:]  # leads fall in time
        rows += [np.column_stack([sums, np.zeros(slots)]), np.column_stack([-sums, np.zeros(slots)])]
        limits += [np.full(slots, levels[1]), np.full(slots, -levels[0])]
    return float(
        linprog(
            np.append(np.zeros(slots + 1), 1.0),
            A_ub=np.vstack(rows),
            b_ub=np.concatenate(limits),
            A_eq=[[1.0] * (slots + 1) + [0.0]],
            b_eq=[1.0],
            bounds=[(low, None)] * (slots + 1) + [(0.0, None)],
            method="highs-ipm",
        ).fun
    )


@pytest.mark.parametrize(
    ("bands", "dt", "levels"),
    [
        ([(0.9, 1.1)], 0.05, None),
        ([(0.9, 1.1, 0.0, 0.1)], 0.03, None),
        ([(0.9, 1.1), (2.7, 3.3, 0.02)], 0.04, None),
        ([(0.9, 1.1, 0.05)], 0.04, (0.0, 1.0)),
        ([(0.9, 1.1)], 0.05, (-1.0, 1.0)),
    ],
)
def test_one_slot_fewer_is_impossible_says_a_linear_programme(
    bands: list[tuple[float, ...]], dt: float, levels: tuple[float, float] | None
) -> None:
    shaper = design.specified_insensitivity(bands, dt=dt, partial_sums=levels)
    slots = round(shaper.duration / dt)
    np.testing.assert_allclose(shaper.times / dt, np.rint(shaper.times / dt), atol=1e-9)
    assert shaper.design.status == "optimal" and "grid" in shaper.design.settings["proved"]
    assert shaper.design.residual <= 0.05 + 1e-8
    low = 0.0 if levels is None else -3.0
    assert least(slots, dt, bands, low, levels) <= 0.05 + 1e-8
    assert least(slots - 1, dt, bands, low, levels) > 0.05
    if levels is not None:
        assert levels[0] - 1e-6 <= np.cumsum(shaper.amplitudes).min() <= np.cumsum(shaper.amplitudes).max() <= 1 + 1e-6
    else:
        assert (shaper.amplitudes > 0.0).all()


@settings(max_examples=12)
@given(st.floats(0.8, 1.2), st.floats(0.0, 0.3), st.floats(0.0, 0.15), st.floats(0.02, 0.1), st.floats(0.02, 0.12))
def test_a_grid_costs_something_but_not_much_more_than_a_slot_or_two(
    low: float, width: float, damping: float, tolerance: float, dt: float
) -> None:
    band = (low, low + width, damping)
    anywhere = design.specified_insensitivity(band, tolerance)
    on_grid = design.specified_insensitivity(band, tolerance, dt=dt)
    assert anywhere.duration * (1.0 - 1e-7) <= on_grid.duration <= anywhere.duration + 3.0 * dt
    leads = on_grid.duration - on_grid.times[::-1]
    worst = largest_vibration(edges_of([Band(*band)], tolerance), leads, on_grid.amplitudes[::-1])
    assert worst.vibration <= tolerance + 1e-8


@pytest.mark.parametrize("damping", [(0.5, 0.9), (0.9, 0.9)])
def test_heavy_damping_is_measured_at_the_last_impulse_too(damping: tuple[float, float]) -> None:
    """To wait is shortest here: the shaper says how long by a tiny last impulse, and does not call less enough."""
    band = Band(1.0, 1.2, *damping)
    for wishes in ({"dt": 0.01}, {}):
        shaper = design.specified_insensitivity(band, **wishes)
        leads = shaper.duration - shaper.times[::-1]
        worst = largest_vibration(edges_of([band], 0.05), leads, shaper.amplitudes[::-1])
        assert worst.vibration <= 0.05 * (1.0 + 1e-6) and shaper.duration > 0.4
        assert len(shaper) > 1


@pytest.mark.parametrize(("limit", "dt", "slots"), [(4, 0.1, 12), (3, 0.09, 12)])
def test_a_limit_on_the_impulses_against_every_set_tried(limit: int, dt: float, slots: int) -> None:
    """All sets of so many places, each a small linear programme that allows a little more than is asked."""
    band = (0.9, 1.1)
    found = minimum_duration([VibrationAtMost(Band(*band), 0.05), ServoGrid(dt), AtMostImpulses(limit)])
    assert found.status == "optimal" and found.times.size <= limit
    assert round(found.times[-1] / dt) <= slots
    frequencies = np.linspace(*band, 9)
    turns = np.exp(2j * np.pi * np.arange(32) / 32)
    columns = np.exp(-2j * np.pi * np.multiply.outer(frequencies, np.arange(slots + 1) * dt))
    fewer = round(found.times[-1] / dt) - 1
    for inner in combinations(range(1, fewer), limit - 2):
        chosen = columns[:, [0, *inner, fewer]]
        sides = np.concatenate([(turn * chosen).real for turn in turns])
        answer = linprog(
            np.append(np.zeros(limit), 1.0),
            A_ub=np.column_stack([sides, -np.ones(len(sides))]),
            b_ub=np.zeros(len(sides)),
            A_eq=[[1.0] * limit + [0.0]],
            b_eq=[1.0],
        )
        assert answer.fun > 0.05


def test_fewer_impulses_on_a_grid_are_proved_or_say_what_they_could_save() -> None:
    asked = [VibrationAtMost(Band(0.9, 1.1), 0.05), VibrationAtMost(Band(2.7, 3.3), 0.05), ServoGrid(0.02)]
    free, six = minimum_duration(asked), minimum_duration([*asked, AtMostImpulses(6)])
    assert six.times.size == 6 and free.times.size > 6 and six.times[-1] >= free.times[-1] - 1e-12
    assert (six.gap == 0.0) is (six.status == "optimal") and six.gap < 1.0


def test_bounds_of_impulses_partial_sums_and_numbers_hold_together() -> None:
    asked = [
        ZeroVibration(Mode(1.0, 0.05)),
        ImpulsesBetween(-0.5, 0.75),
        PartialSumsBetween(0.0, 1.0),
        AtMostImpulses(5),
        ServoGrid(0.025),
    ]
    found = minimum_duration(asked)
    sums = np.cumsum(found.amplitudes)
    assert found.times.size <= 5 and -0.5 - 1e-7 <= found.amplitudes.min() <= found.amplitudes.max() <= 0.75 + 1e-7
    assert sums.min() >= -1e-6 and sums.max() <= 1.0 + 1e-6
    plant = ModalPlant((1.0, 0.05)).impulse_train(found.times, found.amplitudes).residual_amplitudes[0]
    assert plant < 1e-6 * ModalPlant((1.0, 0.05)).impulse_train([0.0], [1.0]).residual_amplitudes[0]


def test_partial_sums_alone_bound_the_impulses_and_nothing_else_does() -> None:
    """PS-ZV has impulses of 2: they are found with partial sums in [-1, 1], undamped on a grid that holds it."""
    cosine = math.acos(0.25) / (2.0 * math.pi)
    dt = (0.5 - cosine) / 29.0  # 0.290215 T is 29 slots; 0.209785 T nearly 21
    found = minimum_duration([ZeroVibration(Mode(1.0)), PartialSumsBetween(-1.0, 1.0), ServoGrid(dt)])
    assert 29.0 * dt - 1e-9 <= found.times[-1] <= 30.0 * dt + 1e-9
    assert np.abs(found.amplitudes).max() > 1.0


def test_a_deflection_limit_holds_in_a_simulation_and_lengthens() -> None:
    mode, dt = Mode(1.0, 0.05), 0.02
    plant = ModalPlant((1.0, 0.05), drive="acceleration")
    fine = np.linspace(0.0, 3.0, 6001)
    alone = np.abs(plant.impulse_train([0.0], [1.0], at=fine).output).max()
    durations = []
    for limit in (0.3, 0.5, 0.9):
        found = minimum_duration(
            [ZeroVibration(mode), ImpulsesBetween(0.0), deflection_at_most(mode, limit, dt), ServoGrid(dt)]
        )
        peak = np.abs(plant.impulse_train(found.times, found.amplitudes, at=fine).output).max()
        assert peak <= limit * alone * (1.0 + 3e-3)  # between samples it may bulge by (pi f dt)^2 / 2 = 0.2 %
        durations.append(float(found.times[-1]))
    assert durations == sorted(durations, reverse=True) and durations[0] > durations[-1] + dt
