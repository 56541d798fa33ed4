"""The tables, the page and the figure say what the calibration says, with units, whatever the input is called."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from preshape.report import (
    Calibration,
    Record,
    as_html,
    calibration_document,
    calibration_figure,
    candidate_table,
    mode_table,
)
from preshape.workflow import calibrate
from preshape.workflow.record import new_record

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"


@pytest.fixture(scope="module")
def gantry() -> Calibration:
    return calibrate(GANTRY, maximum_impulses=5)


@pytest.fixture(scope="module")
def crane(tmp_path_factory: pytest.TempPathFactory) -> Calibration:
    """A swinging load at 0.2 Hz, from a file with a name to be careful with."""
    times = np.arange(0.0, 60.0, 0.05)
    wave = np.exp(-0.01 * 2 * np.pi * 0.2 * times) * np.cos(2 * np.pi * 0.2 * times)
    wave += 0.002 * np.random.default_rng(0).normal(size=times.size)
    path = tmp_path_factory.mktemp("crane") / "<b>sway & co.csv"
    path.write_text("time,sway [m]\n" + "\n".join(f"{t:.2f},{x:.5f}" for t, x in zip(times, wave, strict=True)) + "\n")
    return calibrate(path)


def test_the_candidate_table_shows_the_candidates_in_their_units(gantry: Calibration) -> None:
    table = candidate_table(gantry)
    assert ("duration", "[ms]") in table.titles
    for row, candidate in zip(table.rows, gantry.candidates, strict=True):
        assert row[1] == candidate.name
        assert int(row[2]) == len(candidate.shaper)
        assert float(row[3]) == pytest.approx(1e3 * candidate.shaper.duration, abs=0.051)
        assert float(row[4]) == pytest.approx(100.0 * candidate.left, abs=0.051)
        assert float(row[5]) == pytest.approx(100.0 * candidate.score.remaining_vibration, abs=0.051)
        assert float(row[6]) == pytest.approx(candidate.score.smoothing, abs=0.00051)
        assert float(row[7]) == pytest.approx(candidate.score.maximum_acceleration, abs=0.51)
    marks = [row[0] for row in table.rows]
    assert marks[0] == ">" and marks.count(">") == 1
    assert marks.count("x") == sum(len(candidate.shaper) > 5 for candidate in gantry.candidates) > 0


def test_a_crane_is_shown_in_seconds_and_without_a_printer_s_measures(crane: Calibration) -> None:
    table = candidate_table(crane)
    assert crane.klipper is None
    assert ("duration", "[s]") in table.titles and len(table.titles) == 5
    assert float(table.rows[0][3]) == pytest.approx(crane.shaper.duration, abs=0.00051)
    assert float(mode_table(crane).rows[0][0]) == pytest.approx(0.2, rel=1e-3)
    page = as_html(calibration_document(crane, recorded(crane)))
    assert "Klipper" not in page


def recorded(calibration: Calibration) -> Record:
    return new_record(calibration.job, calibration.shaper, calibration.inputs)


def test_the_page_of_a_calibration_is_complete_and_escapes_names(crane: Calibration) -> None:
    record = recorded(crane)
    page = as_html(calibration_document(crane, record))
    assert "&lt;b&gt;sway &amp; co.csv" in page and "<b>sway" not in page
    assert f"preshape {record.versions['preshape']}" in page
    for section in ("Measurement and modes", "Candidates", "The shaper", "Predicted and simulated", "Robustness"):
        assert f"<h2>{section}" in page
    assert f"{crane.inputs[0].sha256}  &lt;b&gt;sway &amp; co.csv" in page


@pytest.mark.parametrize("which", ["gantry", "crane"])
def test_every_axis_of_the_figure_has_a_unit_and_nothing_is_cut_off(which: str, request: pytest.FixtureRequest) -> None:
    figure = calibration_figure(request.getfixturevalue(which))
    figure.draw_without_rendering()
    width, height = figure.bbox.width, figure.bbox.height
    for axes in figure.axes:
        assert re.search(r"\[(Hz|ms|s|-)\]", axes.get_xlabel())
        assert axes.get_ylabel()
        for text in [axes.title, axes.xaxis.label, axes.yaxis.label, *axes.texts]:
            box = text.get_window_extent()
            assert box.x0 >= 0 and box.x1 <= width and box.y0 >= 0 and box.y1 <= height, text.get_text()
    title = figure._suptitle
    assert title is not None and title.get_window_extent().x1 <= width


def test_the_same_calibration_gives_the_same_page(gantry: Calibration) -> None:
    record = recorded(gantry)
    assert as_html(calibration_document(gantry, record)) == as_html(calibration_document(gantry, record))
