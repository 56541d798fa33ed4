"""The figure of a simulation: what it says, and that it draws whatever comes."""

from __future__ import annotations

import numpy as np
import pytest

from preshape import design
from preshape.plant import LinearPlant, linear_mace, load_plant
from preshape.report import as_svg, simulation_figure
from preshape.report.simulation_figure import DRAWN, _drawn, _number
from preshape.workflow import simulate_plant


def test_the_titles_say_what_is_left() -> None:
    gantry = load_plant("examples/data/machine.toml")
    result = simulate_plant(gantry, np.minimum(np.arange(250) * 1e-3, 0.2), 1e-3, design.mesh(gantry.modes(), dt=1e-3))
    text = " ".join(axes.get_title(loc="left") for axes in simulation_figure(result).axes)
    assert "tool: does not vibrate afterwards, unshaped by 49.1 mm" in text and "189 ms longer when shaped" in text
    assert as_svg(simulation_figure(result)) == as_svg(simulation_figure(result))


def test_an_output_that_stands_still_and_many_outputs_draw() -> None:
    plant = linear_mace()
    result = simulate_plant(plant, [1.0, 0.0], 1e-3, design.zv(plant.modes()[0]))
    figure = simulation_figure(result)
    assert len(figure.axes) == 2 * (1 + min(len(plant.outputs), 5))
    assert as_svg(figure).startswith("<svg")


def test_several_inputs_without_units_draw() -> None:
    plant = LinearPlant([[0.0, 1.0], [-40.0, -0.4]], [[0.0, 0.0], [1.0, -0.5]], [1.0, 0.0])
    result = simulate_plant(plant, np.ones((2, 5)), 0.01, design.zv(plant.modes()))
    drawn = as_svg(simulation_figure(result))
    assert "input 1" in drawn and "input 2" in drawn


def test_long_curves_are_thinned_and_keep_every_peak() -> None:
    times = np.arange(1_000_000) * 1e-3
    values = np.sin(times)
    values[123_456] = 7.0
    values[654_321] = -5.0
    kept, drawn = _drawn(times, values)
    assert kept.size <= 1.1 * DRAWN and drawn.max() == 7.0 and drawn.min() == -5.0
    assert kept[0] == 0.0 and kept[-1] == times[-1] and (np.diff(kept) > 0.0).all()


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.0491, "m", "49.1 mm"), (1.29e-6, "m", "1.29 \u00b5m"), (3e-11, "rad", "0.03 nrad"), (2.0, "N m", "2 N m"),
        (0.05, "", "0.05"), (0.05, "deg", "0.05 deg"), (0.0, "m", "0 m"),
    ],
)  # fmt: skip
def test_numbers_have_the_prefix_that_suits(value: float, unit: str, text: str) -> None:
    assert _number(value, unit) == text
