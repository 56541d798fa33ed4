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
    limit_sentence,
    pick_table,
    robustness_sentence,
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
    sentences = gain_sentences(trade)
    stock = trade.stock.score
    assert f"max_accel {stock.maximum_acceleration:.0f} mm/s²" in sentences[0]
    for name, sentence in zip(("performance", "quality", "improved"), sentences[1:], strict=True):
        pick = next(one for one in trade.picks if one.name == name)
        faster = pick.score.maximum_acceleration / stock.maximum_acceleration - 1.0
        assert sentence.startswith(name.capitalize()) and f"{100.0 * faster:+.1f} %" in sentence
    assert trade.improved is not None
    faster = trade.improved.score.maximum_acceleration / stock.maximum_acceleration - 1.0
    assert trade.acceleration_gain == pytest.approx(faster)


def test_a_share_is_said_with_what_it_is_of(trade: TradeOff) -> None:
    """ "At most 5 %" alone says nothing: of the vibration; and a stock choice that leaves none cannot be undercut."""
    text = " ".join(gain_sentences(trade))
    assert "at most 5 % of the vibration" in text
    assert trade.stock.score.remaining_vibration < 5e-5 and "stock leaves none to take away" in text
    score = trade.stock.score
    loud = replace(trade.stock, score=replace(score, remaining_vibration=0.08))
    assert trade.quality is not None
    quiet = replace(trade.quality, score=replace(trade.quality.score, remaining_vibration=0.05))
    assert "3 % of the vibration less than stock" in gain_sentences(replace(trade, stock=loud, quality=quiet))[2]


def page_of(calibration: Calibration) -> str:
    return as_html(calibration_document(calibration, new_record(calibration.job, calibration.shaper, ())))


def test_what_the_picks_cost_when_the_frequencies_are_off_is_said_and_marked(
    gantry: Calibration, trade: TradeOff
) -> None:
    assert trade.fragile and all(pick.left > trade.stock.left for pick in trade.fragile)
    sentence, page = robustness_sentence(trade), page_of(gantry)
    for pick in trade.fragile:
        assert f"{pick.name} {100.0 * pick.left:.0f} %" in sentence
    assert f"the {100.0 * trade.stock.left:.0f} % of stock" in sentence and "5 % off" in sentence
    assert f'<p class="warning">{escape(sentence)}</p>' in page
    assert page.count('<tr class="fragile">') == len(trade.fragile)
    robust = {pick.name: replace(pick, left=trade.stock.left) for pick in trade.picks}
    calm = replace(trade, **robust)
    assert calm.fragile == () and "no pick leaves more" in robustness_sentence(calm)
    quiet_page = page_of(replace(gantry, trade_off=calm))
    assert '<tr class="fragile">' not in quiet_page and escape(robustness_sentence(calm)) in quiet_page


def test_the_number_of_impulses_is_said_with_where_it_comes_from(trade: TradeOff) -> None:
    assert "what every firmware that takes impulses holds" in limit_sentence(trade, None)
    assert limit_sentence(trade, trade.impulses) == "The picks have at most 5 impulses: as was asked."
    assert "not 100" in limit_sentence(replace(trade, impulses=25), 100)


def test_nothing_gained_is_said(trade: TradeOff) -> None:
    score = replace(trade.stock.score, remaining_vibration=0.03)
    stock = replace(trade.stock, score=score)
    same = {name: replace(stock, name=name) for name in ("performance", "quality", "improved")}
    nothing = replace(trade, stock=stock, **same)
    assert nothing.acceleration_gain == 0.0 and nothing.vibration_gain == 0.0
    text = " ".join(gain_sentences(nothing))
    assert text.count("nothing gained over stock") == 3 and "+" not in text


def test_a_missing_pick_is_said(trade: TradeOff) -> None:
    without = replace(trade, improved=None, quality=None)
    assert [pick.name for pick in without.picks] == [pick.name for pick in trade.picks if pick.name == "performance"]
    text = " ".join(gain_sentences(without))
    assert "No quality" in text and "No improved" in text
    assert "<svg" in as_svg(trade_off_figure(without))


def test_the_table_has_the_stock_choice_and_the_picks(trade: TradeOff) -> None:
    table = pick_table(trade)
    assert len(table.rows) == 1 + len(trade.picks)
    assert "5 % off" in table.titles[-1][-1]
    for row, point in zip(table.rows, (trade.stock, *trade.picks), strict=True):
        assert float(row[-1]) == pytest.approx(100.0 * point.left, abs=0.051)
        assert point.name.removeprefix("Klipper ") in row[0] and int(row[1]) == len(point.shaper)
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
