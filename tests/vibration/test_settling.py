"""Residual and settling together, against the simulated decay."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import design
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.profile import Profile
from preshape.vibration import residual_vibration, settling


@given(st.floats(0.5, 2.0), st.floats(0.01, 0.3), st.sampled_from(["zv", "zvd", "ei"]), st.floats(0.005, 0.2))
def test_at_the_settling_time_the_amplitude_is_the_tolerance(f: float, z: float, family: str, tolerance: float) -> None:
    shaper = getattr(design, family)((1.0, 0.05))
    found = settling(shaper, f, z, tolerance=tolerance)
    assert found.residual == pytest.approx(float(residual_vibration(shaper, f, z)), rel=1e-12)
    plant = ModalPlant((f, z))
    unit = plant.impulse_train([0.0], [1.0]).residual_amplitudes[0]
    # The envelope of the free vibration, at the time that is claimed, by the plant's phasor.
    after = plant.impulse_train(
        [*shaper.times, float(found.time)] if found.time > shaper.duration else shaper.times,
        [*shaper.amplitudes, 0.0] if found.time > shaper.duration else shaper.amplitudes,
    ).residual_amplitudes[0]
    if found.time > shaper.duration:
        assert after / unit == pytest.approx(tolerance, rel=1e-9)
    else:
        assert found.time == shaper.duration and after <= tolerance * unit * (1 + 1e-9)
    alone = plant.impulse_train([0.0, float(found.unshaped_time)], [1.0, 0.0]).residual_amplitudes[0]
    assert alone / unit == pytest.approx(tolerance, rel=1e-9)


def test_the_output_itself_is_settled_by_then() -> None:
    shaper = design.zvd((1.0, 0.05))
    for f in (0.7, 1.0, 1.25):
        found = settling(shaper, f, 0.05, tolerance=0.05)
        motion = ModalPlant((f, 0.05)).motion(Profile.steps(shaper.times, shaper.amplitudes))
        # A step's vibration is at most 1/sqrt(1-z^2) of the step, as an impulse's is of its own: the same tolerance.
        assert motion.settling_time("output", 0.05 / math.sqrt(1 - 0.05**2)) <= found.time + 1e-12


def test_what_never_settles() -> None:
    shaper = design.zv((1.0, 0.0))
    found = settling(shaper, [1.0, 1.3], [0.0, 0.0])
    assert found.time.tolist() == [shaper.duration, math.inf]
    assert np.isinf(found.unshaped_time).all()
    assert found.relative[0] == 0.0 and math.isnan(found.relative[1])


def test_a_long_robust_shaper_wins_only_where_the_model_is_wrong() -> None:
    right = [
        float(settling(design.zv((1.0, 0.01)), 1.0, 0.01).time),
        float(settling(design.zvd((1.0, 0.01)), 1.0, 0.01).time),
    ]
    wrong = [
        float(settling(design.zv((1.0, 0.01)), 1.1, 0.01).time),
        float(settling(design.zvd((1.0, 0.01)), 1.1, 0.01).time),
    ]
    assert right[0] < right[1] and wrong[0] > wrong[1]


def test_wrong_input_is_named() -> None:
    shaper = design.zv((1.0, 0.0))
    for arguments, sentence in [(([0.0], 0.1), "0 Hz"), (([1.0], 1.0), "damping ratio"), (([-1.0], 0.1), "negative")]:
        with pytest.raises(InputError, match=sentence):
            settling(shaper, *arguments)
    with pytest.raises(InputError, match="tolerance 0"):
        settling(shaper, 1.0, 0.1, tolerance=0.0)
