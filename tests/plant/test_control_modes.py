"""Modes of python-control systems, beside what python-control says of the same poles, and what cannot be one."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape.errors import InputError
from preshape.plant import LinearPlant, modes_of

control = pytest.importorskip("control")

MODES = st.lists(
    st.tuples(st.floats(0.5, 40.0), st.floats(0.0, 0.7)), min_size=1, max_size=3, unique_by=lambda mode: round(mode[0])
)


def denominator(modes: list[tuple[float, float]]) -> np.ndarray:
    polynomial = np.ones(1)
    for frequency, damping in modes:
        omega = 2.0 * np.pi * frequency
        polynomial = np.polymul(polynomial, [1.0, 2.0 * damping * omega, omega**2])
    return polynomial


@settings(max_examples=40, deadline=None)
@given(MODES, st.sampled_from([None, 0.002, 0.005]), st.booleans())
def test_the_modes_are_those_that_the_system_was_made_of_and_that_damp_says(
    modes: list[tuple[float, float]], step: float | None, matrices: bool
) -> None:
    system = control.tf(denominator(modes)[-1:], np.polymul(denominator(modes), [1.0, 30.0]))
    if step is not None:
        system = control.sample_system(system, step)
    if matrices:
        system = control.ss(system)
    found = modes_of(system)
    expected = sorted(modes)
    assert [mode.frequency for mode in found] == pytest.approx([f for f, _ in expected], rel=2e-4)
    assert [mode.damping for mode in found] == pytest.approx([z for _, z in expected], abs=2e-4)
    omega, damping, poles = control.damp(system, doprint=False)
    upper = np.flatnonzero(np.imag(poles) > 1e-6 * np.abs(poles))
    upper = upper[np.argsort(omega[upper])]
    assert [mode.omega for mode in found] == pytest.approx(omega[upper].tolist(), rel=2e-4)
    assert [mode.damping for mode in found] == pytest.approx(damping[upper].tolist(), abs=2e-4)


def test_rigid_bodies_and_real_poles_do_not_oscillate() -> None:
    moving = np.polymul(denominator([(3.0, 0.02)]), [1.0, 5.0, 0.0, 0.0])
    continuous = control.tf([1.0], moving)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sampled = control.sample_system(continuous, 0.01)
    for system in (continuous, sampled, control.ss(continuous)):
        assert [mode.frequency for mode in modes_of(system)] == pytest.approx([3.0], rel=1e-5)


def test_several_inputs_and_outputs_share_their_modes() -> None:
    first, second = denominator([(2.0, 0.1)]), denominator([(5.0, 0.01)])
    system = control.tf([[[1.0], [1.0]], [[1.0], [2.0]]], [[first, second], [second, first]])
    assert [mode.frequency for mode in modes_of(system)] == pytest.approx([2.0, 5.0])


@pytest.mark.parametrize("step", [0, 0.01])
def test_a_growing_motion_is_refused(step: float) -> None:
    system = control.tf([1.0], denominator([(2.0, -0.1)]))
    system = control.sample_system(system, step) if step else system
    with pytest.raises(InputError, match=r"unstable: a motion at 1\.99 Hz grows as exp\(1\.257 t\)"):
        modes_of(system)


def test_what_has_no_modes_is_refused() -> None:
    with pytest.raises(InputError, match="nothing vibrates"):
        modes_of(control.tf([1.0], [1.0, 2.0]))
    with pytest.raises(InputError, match="nothing vibrates"):
        modes_of(control.tf([1.0], [1.0, 0.5], 0.1))
    with pytest.raises(InputError, match="unstable"):
        modes_of(control.tf([1.0], [1.0, 1.5], 0.1))
    with pytest.raises(InputError, match="dt is True"):
        modes_of(control.tf([1.0], [1.0, -1.0, 0.5], True))
    with pytest.raises(InputError, match="float has neither"):
        modes_of(3.0)


def test_it_is_the_plant_that_matrices_give() -> None:
    system = control.ss(control.tf([1.0], denominator([(2.0, 0.1), (7.0, 0.01)])))
    assert modes_of(system) == LinearPlant.from_control(system).modes()
