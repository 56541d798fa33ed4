"""Each constraint's rows, against what they stand for computed directly."""

from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Band, Mode
from preshape.engine import (
    AtMostImpulses,
    ImpulsesBetween,
    PartialSumsBetween,
    ResponseBetween,
    ServoGrid,
    VibrationAtMost,
    ZeroVibration,
    deflection_at_most,
)
from preshape.engine.constraints import Constraint
from preshape.errors import InputError
from preshape.plant import ModalPlant

LEADS = np.array([0.0, 0.2, 0.5, 0.9])
AMPLITUDES = np.array([0.3, -0.4, 0.9, 0.2])


def test_vibration_is_that_of_a_plant_after_the_impulses() -> None:
    """V from the rows, relative to one unit impulse, against the modal plant's exact response."""
    modes = [(1.0, 0.0), (1.3, 0.05), (2.0, 0.4)]
    rates = tuple(-complex(Mode(*mode).pole).conjugate() for mode in modes)
    rows = VibrationAtMost(Band(1.0, 2.0, 0.0, 0.4), 0.05, rates).rows(LEADS)
    np.testing.assert_array_equal(rows.radii, 0.05)
    times = LEADS[-1] - LEADS[::-1]
    for cone, mode in zip(rows.cones, modes, strict=True):
        plant = ModalPlant(mode, drive="acceleration")
        shaped = plant.impulse_train(times, AMPLITUDES[::-1]).residual_amplitudes[0]
        alone = plant.impulse_train([0.0], [1.0]).residual_amplitudes[0]
        assert abs(cone @ AMPLITUDES) == pytest.approx(shaped / alone, rel=1e-12)


@pytest.mark.parametrize(("low", "high"), [(-0.1, 1.2), (-math.inf, 1.1), (0.0, math.inf), (-math.inf, math.inf)])
def test_partial_sums_are_the_levels_before_the_last_impulse(low: float, high: float) -> None:
    rows = PartialSumsBetween(low, high).rows(LEADS)
    levels = np.cumsum(AMPLITUDES[::-1])[:-1]
    found = np.sort(np.concatenate([rows.limits - rows.inequalities @ AMPLITUDES])) if rows.limits.size else np.zeros(0)
    room = ([high - levels] if math.isfinite(high) else []) + ([levels - low] if math.isfinite(low) else [])
    np.testing.assert_allclose(found, np.sort(np.concatenate([np.zeros(0), *room])), atol=1e-14)


def test_a_response_is_the_shaped_one_at_even_times() -> None:
    """A ramp's response, sampled at and after the impulses; an impulse at a sample counts there."""
    rows = ResponseBetween(lambda t: t, -math.inf, 0.5, sample_time=0.1, until=0.3).rows(LEADS)
    times = 0.1 * np.arange(13)
    delays = np.maximum(times[:, None] - (LEADS[-1] - LEADS), 0.0)
    np.testing.assert_allclose(rows.inequalities @ AMPLITUDES, delays @ AMPLITUDES, atol=1e-14)
    step = ResponseBetween(np.ones_like, 0.0, 1.0, sample_time=0.1).rows(LEADS)
    levels = step.inequalities[:10] @ AMPLITUDES
    np.testing.assert_allclose(levels, [0.2] * 4 + [1.1] * 3 + [0.7] * 2 + [1.0], atol=1e-14)


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.6])
def test_deflection_is_relative_to_the_unshaped_peak(damping: float) -> None:
    """One impulse only: the largest row over fine samples is 1, the peak without a shaper."""
    mode = Mode(1.0, damping)
    once = deflection_at_most(mode, 0.4, 1e-4)
    times = 1e-4 * np.arange(20_000)
    assert np.abs(once.response(times)).max() == pytest.approx(1.0, abs=1e-7)
    plant = ModalPlant(mode, drive="acceleration").impulse_train([0.0], [1.0], at=times)
    np.testing.assert_allclose(plant.output / np.abs(plant.output).max(), -once.response(times), atol=1e-7)
    assert (once.low, once.high) == (-0.4, 0.4)


def test_what_asks_nothing_linear_has_no_rows() -> None:
    nothing: list[Constraint] = [ZeroVibration(Mode(1.0), 2), ServoGrid(0.1), AtMostImpulses(3)]
    for one in nothing:
        rows = one.rows(LEADS)
        assert rows.radii.size == rows.limits.size == 0 and (rows.low, rows.high) == (-math.inf, math.inf)
    np.testing.assert_allclose(ServoGrid(0.1).leads(3), [0.0, 0.1, 0.2, 0.3])
    assert (ImpulsesBetween(-1.0, 2.0).rows(LEADS).low, ImpulsesBetween(-1.0, 2.0).rows(LEADS).high) == (-1.0, 2.0)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: ImpulsesBetween(1.0, 0.5), "cannot sum to 1"),
        (lambda: ImpulsesBetween(0.1, 0.5), "not convex, since most places have none"),
        (lambda: ImpulsesBetween(-1.0, 0.0), "cannot sum to 1"),
        (lambda: ImpulsesBetween(-1.0, -1.0), "cannot sum to 1"),
        (lambda: ImpulsesBetween(math.nan, 1.0), "cannot sum to 1"),
        (lambda: PartialSumsBetween(0.0, 0.9), "cannot end at 1"),
        (lambda: PartialSumsBetween(1.0, 1.0), "cannot end at 1"),
        (lambda: VibrationAtMost(Band(1.0, 1.0), 0.0), "outside"),
        (lambda: VibrationAtMost(Band(1.0, 1.0), 1.0), "outside"),
        (lambda: VibrationAtMost(Band(1.0, 1.0), 1e-6), "too little for the conic solver"),
        (lambda: ServoGrid(0.0), "dt is 0 s: give a value above"),
        (lambda: ServoGrid(math.inf), "dt is inf"),
        (lambda: ServoGrid("1 ms"), "dt must be a number"),  # type: ignore[arg-type]
        (lambda: AtMostImpulses(0), "whole number from 1"),
        (lambda: AtMostImpulses(2.5), "whole number from 1"),  # type: ignore[arg-type]
        (lambda: ZeroVibration(Mode(1.0), -1), "whole number from 0"),
        (lambda: deflection_at_most(Mode(1.0), 0.0, 0.01), "deflection limit is 0"),
        (lambda: deflection_at_most(Mode(1.0), math.nan, 0.01), "deflection limit is nan"),
    ],
)
def test_what_cannot_be_asked_is_refused(make: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        make()  # type: ignore[operator]
