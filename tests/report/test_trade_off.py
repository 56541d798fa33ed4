"""The trade-off says what was gained, also when it is nothing, and its figure shows what it was given."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from pathlib import Path

import pytest
from matplotlib.colors import to_rgb

from preshape.report import (
    Calibration,
    TradeOff,
    as_html,
    as_svg,
    calibration_document,
    gain_sentences,
    pick_table,
    trade_off_figure,
)
from preshape.report.figures import ACCENT, SECOND
from preshape.workflow import calibrate
from preshape.workflow.record import new_record

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"


@pytest.fixture(scope="module")
def gantry() -> Calibration:
    return calibrate(GANTRY)


@pytest.fixture(scope="module")
def trade(gantry: Calibration) -> TradeOff:
    assert gantry.trade_off is not None
    return gantry.trade_off


def test_the_numbers_in_the_sentences_are_those_of_the_picks(trade: TradeOff) -> None:
    text = " ".join(gain_sentences(trade))
    for point in (trade.stock, *trade.picks):
        assert f"max_accel {point.score.maximum_acceleration:.0f} mm/s²" in text
    assert trade.improved is not None
    faster = trade.improved.score.maximum_acceleration / trade.stock.score.maximum_acceleration - 1.0
    assert trade.acceleration_gain == pytest.approx(faster)
    assert "5 % off" in text  # what the picks cost in robustness is said beside what they gain


def test_nothing_gained_is_said(trade: TradeOff) -> None:
    stock = trade.stock
    same = {name: replace(stock, name=name) for name in ("performance", "quality", "improved")}
    nothing = replace(trade, **same)
    assert nothing.acceleration_gain == 0.0 and nothing.vibration_gain == 0.0
    text = " ".join(gain_sentences(nothing))
    assert text.count("nothing gained over stock") == 2 and "no less than stock" in text and "+" not in text


def test_a_missing_pick_is_said(trade: TradeOff) -> None:
    without = replace(trade, improved=None, quality=None)
    assert [pick.name for pick in without.picks] == [pick.name for pick in trade.picks if pick.name == "performance"]
    text = " ".join(gain_sentences(without))
    assert "No quality" in text and "No improved" in text
    assert "<svg" in as_svg(trade_off_figure(without))


def test_the_table_has_the_stock_choice_and_the_picks(trade: TradeOff) -> None:
    table = pick_table(trade)
    assert len(table.rows) == 1 + len(trade.picks)
    for row, point in zip(table.rows, (trade.stock, *trade.picks), strict=True):
        assert point.name in row[0] and int(row[1]) == len(point.shaper)
        assert float(row[5]) == pytest.approx(point.score.maximum_acceleration, abs=0.51)


def test_the_figure_shows_every_point_where_it_is(trade: TradeOff) -> None:
    axes = trade_off_figure(trade).axes[0]
    drawn = {(round(float(x), 9), round(float(y), 7)) for line in axes.lines for x, y in line.get_xydata()}
    low, high = axes.get_xlim()
    for point in (trade.stock, *trade.picks, *trade.families):
        if low <= point.score.smoothing <= high:
            assert (round(point.score.smoothing, 9), round(100.0 * point.score.remaining_vibration, 7)) in drawn
    names = " ".join(text.get_text() for text in axes.texts)
    assert "zv" in names and "ei" in names
    legend = axes.get_legend()
    assert legend is not None
    labels = " ".join(text.get_text() for text in legend.get_texts())
    for word in ("optimum", "stock choice", "performance", "quality", "improved"):
        assert word in labels
    assert "mm" in axes.get_xlabel() and "%" in axes.get_ylabel()


def test_the_marks_stay_apart_in_grey_print(trade: TradeOff) -> None:
    """Each group has a marker of its own, and the two strong colours differ in lightness."""
    axes = trade_off_figure(trade).axes[0]
    markers = [line.get_marker() for line in axes.lines if line.get_marker() not in ("None", None, "")]
    assert len(markers) == len(set(markers)) >= 6
    weights = (0.299, 0.587, 0.114)
    light = [sum(w * c for w, c in zip(weights, to_rgb(one), strict=True)) for one in (ACCENT, SECOND)]
    assert abs(light[0] - light[1]) > 0.15


def test_the_page_has_the_trade_off_and_the_settings(gantry: Calibration, trade: TradeOff) -> None:
    page = as_html(calibration_document(gantry, new_record(gantry.job, gantry.shaper, gantry.inputs)))
    assert page.count("<svg") == 3  # with the robustness
    for sentence in gain_sentences(trade):
        assert escape(sentence) in page
    for text in gantry.texts:
        assert escape(text.text if text.fits else text.note) in page
