"""The figure of a rest-to-rest command shows its limits, and says when something still vibrates."""

import numpy as np
import pytest

from preshape.command.rest_to_rest import bang_bang, deflection_limiting, time_optimal
from preshape.plant import FlexibleBody, FloatingOscillator
from preshape.report import move_figure

PLANT = FloatingOscillator(1.0, 1.0, 1.0)


def test_force_deflection_and_way_are_drawn_with_their_limits() -> None:
    move = deflection_limiting(PLANT, 10.0, maximum_force=1.0, deflection_limit=0.3)
    force, deflection, way = move_figure(move).axes
    assert [axes.get_ylabel() for axes in (force, deflection, way)] == ["force [N]", "deflection [m]", "centre [m]"]
    assert way.get_xlabel() == "time [s]"
    drawn = np.asarray(deflection.lines[0].get_ydata())
    assert np.abs(drawn).max() == pytest.approx(0.3, rel=1e-5)
    assert any(text.get_text() == "limit 0.3 m" for text in deflection.texts)
    assert np.asarray(way.lines[0].get_ydata())[-1] == pytest.approx(10.0)
    assert "nothing after the move" in deflection.get_title(loc="left")


def test_it_says_that_bang_bang_leaves_vibration() -> None:
    title = move_figure(bang_bang(PLANT, 5.0, maximum_force=1.0)).axes[1].get_title(loc="left")
    assert "still after the move" in title


def test_outputs_of_several_modes_are_told_apart() -> None:
    body = FlexibleBody(2.0, [(0.2, 0.0), (0.5, 0.0)], [1.0, 0.5])
    move = time_optimal(body, 5.0, maximum_force=1.0, deflection_limits=0.9, outputs=[[1.0, 1.0]])
    deflection = move_figure(move).axes[1]
    assert np.abs(np.asarray(deflection.lines[0].get_ydata())).max() <= 0.9 + 1e-9
    both = move_figure(time_optimal(body, 5.0, maximum_force=1.0)).axes[1]
    styles = {line.get_linestyle() for line in both.lines[:2]}
    assert len(styles) == 2
