"""The figure of a comparison: labels hide nothing, the printed page tells curves apart, the sentences are true."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from preshape.errors import InputError
from preshape.report import (
    Comparison,
    LeftOut,
    as_svg,
    comparison_figure,
    comparison_sentences,
    comparison_table,
    length_unit,
)
from preshape.workflow import compare

MOVES = {
    "one": compare((1.2, 0.01), 0.5, maximum_speed=1.0, maximum_acceleration=5.0),
    "jerk": compare([(1.2, 0.01), (3.4, 0.02)], 0.5, maximum_speed=1.0, maximum_acceleration=5.0, maximum_jerk=50.0),
    "fast": compare([(45.0, 0.0), (90.0, 0.0)], 0.1, maximum_acceleration=5.0),
}


@pytest.mark.parametrize("name", MOVES)
def test_labels_hide_neither_each_other_nor_a_point(name: str) -> None:
    result: Comparison = MOVES[name]
    figure = comparison_figure(result)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    axes = figure.axes[0]
    labels = [text for text in axes.texts if not text.get_text().startswith("settled")]
    boxes = [Text.get_window_extent(text, renderer) for text in labels]  # without the line to its point
    named = ", ".join(text.get_text() for text in labels)
    assert all(one.name.rpartition(" + ")[2] in named for one in result.contenders)
    points = np.array([axes.transData.transform((one.move_time, length_unit(result).per_unit * one.worst_residual))
                       for one in result.contenders])  # fmt: skip
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k]), labels[k].get_text()
        inside = (points > [box.x0, box.y0]).all(axis=1) & (points < [box.x1, box.y1]).all(axis=1)
        assert not inside.any(), labels[k].get_text()


def test_curves_differ_in_style_as_well_as_in_colour() -> None:
    for result in MOVES.values():
        lines = [line for line in comparison_figure(result).axes[1].lines if not str(line.get_label()).startswith("_")]
        looks = {(str(line.get_linestyle()), float(line.get_linewidth())) for line in lines}
        assert len(looks) == len(lines) >= 4


def test_sentences_and_table_say_what_the_numbers_say() -> None:
    result = MOVES["one"]
    first, robust = comparison_sentences(result)
    best = min(result.contenders, key=lambda one: one.settling_time)
    assert best.name in first and f"{best.settling_time:.4g} s" in first
    fine = [one for one in result.contenders if one.worst_residual <= result.within]
    assert min(fine, key=lambda one: one.move_time).name in robust
    assert "Nothing leaves less than" in comparison_sentences(MOVES["jerk"])[1]
    table = comparison_table(result)
    assert len(table.rows) == len(result.contenders) and {len(row) for row in table.rows} == {len(table.titles)}
    row = table.rows[[one.name for one in result.contenders].index("trapezoid")]
    assert row[1] == "0.7" and float(row[3]) == pytest.approx(1e3 * result["trapezoid"].residual, rel=5e-3)
    assert "never" in {row[2] for row in comparison_table(MOVES["fast"]).rows}


def test_without_contenders_there_is_a_sentence_instead_of_a_figure() -> None:
    left_out = (LeftOut("trapezoid", "its acceleration jumps"), LeftOut("ZV", "it is too long"))
    nothing = replace(MOVES["one"], contenders=(), left_out=left_out)
    with pytest.raises(InputError, match=r"nothing to draw: all 2 are left out.*; allow more"):
        comparison_figure(nothing)
    with pytest.raises(InputError, match="none settles first"):
        _ = nothing.first_to_settle
    assert comparison_sentences(nothing)[0] == "No command can make this move." and not comparison_table(nothing).rows


def test_the_figure_of_the_how_to_is_in_the_documentation() -> None:
    docs = Path(__file__).resolve().parents[2] / "docs"
    assert "../images/comparison.svg" in (docs / "how-to" / "compare.md").read_text()
    drawn = as_svg(comparison_figure(MOVES["one"]))
    assert drawn.startswith("<svg") and (docs / "images" / "comparison.svg").read_text().startswith("<svg")
