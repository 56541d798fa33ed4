"""The figure of a shaped path shows the largest error where it is, and tells its paths apart without colour."""

from __future__ import annotations

import numpy as np
import pytest

from preshape import design
from preshape.command import trapezoid
from preshape.command.path import shaped_path
from preshape.errors import InputError
from preshape.report import as_svg, contour_figure

DT = 0.001
X, Y = design.zvd((38.0, 0.05)), design.zvd((61.0, 0.05))
WAY = trapezoid(40.0, maximum_speed=100.0, maximum_acceleration=3000.0, dt=DT).values
LINE = np.outer([0.8, 0.6], WAY)


def test_errors_are_drawn_along_the_path_and_the_worst_place_is_enlarged() -> None:
    paths = {
        "equal delays": shaped_path(LINE, [X, Y], DT),
        "own delays": shaped_path(LINE, [X, Y], DT, delays="own"),
        "one shaper": shaped_path(LINE, X, DT),
    }
    figure = contour_figure(paths, unit="mm")
    whole, close, along = figure.axes
    errors = [path.contour_error() for path in paths.values()]
    for line, error in zip(along.lines, errors, strict=True):
        assert np.asarray(line.get_ydata()).max() == pytest.approx(error.largest)
        assert np.asarray(line.get_xdata())[-1] == pytest.approx(40.0, rel=1e-2)
    worst = max(errors, key=lambda error: error.largest)
    low, high = close.get_xlim()
    assert low < worst.place[0] < high and high - low < 10.0 * worst.largest
    assert np.asarray(whole.lines[-1].get_xydata())[0] == pytest.approx(worst.nearest[:, worst.index])
    assert len({line.get_linestyle() for line in along.lines}) == 3
    assert whole.get_xlabel() == "x [mm]" and along.get_ylabel() == "contour error [mm]"
    legend = along.get_legend()
    assert legend is not None
    texts = [text.get_text() for text in legend.get_texts()]
    assert texts[2] == "one shaper: at most nothing" and texts[1].startswith("own delays: at most 0.2")
    assert as_svg(figure).startswith("<svg")


def test_a_path_that_keeps_its_curve_is_drawn_too() -> None:
    assert as_svg(contour_figure({"shaped": shaped_path(LINE, X, DT)})).startswith("<svg")


def test_wrong_input_gets_a_sentence() -> None:
    with pytest.raises(InputError, match="one to 3"):
        contour_figure({})
    with pytest.raises(InputError, match="one axis"):
        contour_figure({"shaped": shaped_path(LINE[:1], X, DT)})
