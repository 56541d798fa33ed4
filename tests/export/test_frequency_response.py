"""A shaper as frequency response data of python-control."""

from __future__ import annotations

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.export import frequency_response

control = pytest.importorskip("control")


def test_it_is_the_transform_and_vanishes_at_the_undamped_mode() -> None:
    shaper = design.zvd((5.0, 0.0))
    omega = 2.0 * np.pi * np.array([0.0, 1.0, 5.0, 12.0])
    data = frequency_response(shaper, omega)
    assert isinstance(data, control.FrequencyResponseData)
    np.testing.assert_array_equal(data.omega, omega)
    # ZVD of an undamped mode is cos^2 of half the phase, delayed by its centroid.
    closed = np.cos(omega / (4.0 * 5.0)) ** 2 * np.exp(-1j * omega * shaper.centroid)
    np.testing.assert_allclose(data.complex.ravel(), closed, atol=1e-14)


def test_a_box_counts_as_its_average_and_a_plant_is_multiplied() -> None:
    shaper = Shaper([0.0, 0.5], [0.25, 0.25], boxes=[(0.1, 0.5, 1.25)])
    omega = np.linspace(0.5, 40.0, 30)
    fine = np.linspace(0.1, 0.5, 200_001)
    middle = 0.5 * (fine[:-1] + fine[1:])
    box = 1.25 * np.exp(-1j * np.multiply.outer(omega, middle)).sum(axis=1) * (fine[1] - fine[0])
    data = frequency_response(shaper, omega)
    np.testing.assert_allclose(data.complex.ravel(), 0.25 + 0.25 * np.exp(-0.5j * omega) + box, atol=1e-8)
    plant = control.tf([1.0], [1.0, 0.1, 9.0])
    np.testing.assert_allclose((plant * data).complex.ravel(), plant(1j * omega) * data.complex.ravel(), rtol=1e-12)


@pytest.mark.parametrize("omega", [[], [-1.0], [1.0, 1.0], [np.nan], 3.0, [[1.0]], "fast"])
def test_frequencies_must_increase(omega: object) -> None:
    with pytest.raises(InputError, match="increasing frequencies"):
        frequency_response(design.zv((5.0, 0.0)), omega)  # type: ignore[arg-type]
