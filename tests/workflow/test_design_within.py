"""Design under a controller's limits: on simulated spectra, and on every measured one against Klipper's choice."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from preshape.errors import InputError
from preshape.export import TARGETS, Limits, klipper, render
from preshape.report import TradeOff, gain_sentences
from preshape.workflow import design_within

ROOT = Path(__file__).resolve().parents[2]
GANTRY = ROOT / "examples" / "data" / "gantry_x.csv"
REAL_FILES = sorted((ROOT.parent / "shared" / "data").glob("*.csv"))

FREQUENCIES = np.arange(5.0, 130.0, 1.25)
ROUNDING = 1.0 + 1e-9


def peaks(*of: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """A spectrum of (frequency [Hz], height, damping)."""
    ratio = [FREQUENCIES / f for f, _, _ in of]
    rows = [h / ((1.0 - r**2) ** 2 + (2.0 * z * r) ** 2) for r, (_, h, z) in zip(ratio, of, strict=True)]
    return FREQUENCIES, np.sum(rows, axis=0)


SIMULATED = {
    "one mode": [peaks((55.0, 1.0, 0.05))],
    "two modes": [peaks((48.0, 1.0, 0.04), (79.0, 0.6, 0.06))],
    "two positions": [peaks((48.0, 1.0, 0.04)), peaks((53.0, 1.0, 0.04))],
    "three modes": [peaks((35.0, 1.0, 0.05), (61.0, 0.8, 0.05), (98.0, 0.7, 0.03))],
}


def check_promises(trade: TradeOff, spectra: object) -> None:
    """What each pick promises, all scored anew by Klipper's own formula, and that the stock choice is Klipper's."""
    stock = klipper.recommend(spectra).chosen
    assert trade.stock.score == stock.score
    for point in (*trade.picks, *trade.optimum, *trade.families):
        again = klipper.score(point.shaper, spectra)
        assert again.remaining_vibration == pytest.approx(point.score.remaining_vibration, abs=1e-12)
        assert again.smoothing == pytest.approx(point.score.smoothing, rel=1e-12)
    assert trade.quality is not None and trade.improved is not None and trade.performance is not None
    for pick in (trade.quality, trade.improved):
        assert pick.score.remaining_vibration <= stock.score.remaining_vibration * ROUNDING
        assert pick.score.smoothing <= stock.score.smoothing * ROUNDING
    assert trade.improved.score.maximum_acceleration >= stock.score.maximum_acceleration / ROUNDING
    assert trade.performance.score.remaining_vibration <= trade.allowed * ROUNDING
    assert trade.performance.score.maximum_acceleration >= trade.improved.score.maximum_acceleration / ROUNDING
    smoothing = [one.score.smoothing for one in trade.optimum]
    assert smoothing == sorted(smoothing) and len(smoothing) >= 2
    left = [one.score.remaining_vibration for one in trade.optimum]
    assert left == sorted(left, reverse=True)
    tail = stock.shaper.duration - stock.shaper.centroid
    for pick in trade.picks:
        assert pick.shaper.amplitudes.min() > 0.0
        assert pick.shaper.duration - pick.shaper.centroid <= tail * ROUNDING  # no gain by looking later


@pytest.mark.parametrize("name", SIMULATED)
def test_the_picks_keep_their_promises(name: str) -> None:
    trade = design_within(SIMULATED[name])
    check_promises(trade, SIMULATED[name])
    assert all(len(pick.shaper) <= 5 for pick in trade.picks)


@pytest.mark.parametrize("name", SIMULATED)
def test_every_pick_beats_the_stock_choice_in_what_it_is_for(name: str) -> None:
    """The stock choice is among the optimiser's starts: to return more than that start is what it is for."""
    trade = design_within(SIMULATED[name])
    stock = trade.stock.score
    assert trade.performance is not None and trade.improved is not None and trade.quality is not None
    assert trade.performance.score.maximum_acceleration > 1.2 * stock.maximum_acceleration
    assert trade.improved.score.maximum_acceleration > 1.005 * stock.maximum_acceleration
    if stock.remaining_vibration > 1e-4:
        assert trade.quality.score.remaining_vibration < 0.9 * stock.remaining_vibration
    assert all(pick.shaper.times.tolist() != trade.stock.shaper.times.tolist() for pick in trade.picks)


def test_one_narrow_mode_gains_acceleration() -> None:
    trade = design_within(SIMULATED["one mode"], maximum_impulses=10)
    assert trade.acceleration_gain > 0.05


@pytest.fixture(scope="module")
def measured() -> dict[Path, TradeOff]:
    return {path: design_within(path) for path in REAL_FILES}


@pytest.mark.skipif(not REAL_FILES, reason="the measurements of ../shared/data are not on this machine")
def test_no_real_file_is_worse_and_half_are_faster(measured: dict[Path, TradeOff]) -> None:
    """Issue 7: no more vibration at no more smoothing everywhere, and a higher max_accel in at least half."""
    for trade in measured.values():
        assert trade.quality is not None and trade.improved is not None
        for pick in (trade.quality, trade.improved):
            assert pick.score.remaining_vibration <= trade.stock.score.remaining_vibration * ROUNDING
            assert pick.score.smoothing <= trade.stock.score.smoothing * ROUNDING
    faster = [path.stem for path, trade in measured.items() if trade.acceleration_gain > 0.005]
    assert 2 * len(faster) >= len(measured), faster


@pytest.mark.skipif(not REAL_FILES, reason="the measurements of ../shared/data are not on this machine")
def test_real_points_are_scored_by_klipper_s_formula(measured: dict[Path, TradeOff]) -> None:
    from preshape import identify
    from preshape.workflow.spectra import scored_spectrum

    for path in REAL_FILES[:3]:
        measurement = identify.read(path)
        scored = scored_spectrum(measurement, identify.find_modes(measurement))
        check_promises(measured[path], klipper.as_spectra([(scored.frequencies, scored.power)]))


def test_several_files_are_one_worst_case() -> None:
    both = design_within([GANTRY, GANTRY])
    once = design_within(GANTRY)
    assert both.stock.score.remaining_vibration == pytest.approx(once.stock.score.remaining_vibration)
    assert once.picks and all(pick.shaper.design.modes is not None for pick in once.picks)


@pytest.mark.parametrize(("target", "most"), [("rrf", 5), ("kalico", 5), ("klipper-plugin", 10)])
def test_the_picks_fit_the_target_they_were_made_for(target: str, most: int) -> None:
    trade = design_within(SIMULATED["three modes"], limits=target)
    assert trade.impulses == most
    for pick in trade.picks:
        assert len(pick.shaper) <= most
        assert render(pick.shaper, target).files  # refuses what does not fit
    assert design_within(SIMULATED["one mode"], limits="klipper-plugin", version="kalico").impulses == 25


def test_a_time_grid_and_a_duration_are_kept() -> None:
    dt = 0.001
    trade = design_within(SIMULATED["two modes"], limits="c", dt=dt, maximum_impulses=6, longest=0.02)
    assert trade.performance is not None
    for pick in trade.picks:
        assert pick.shaper.times / dt == pytest.approx(np.round(pick.shaper.times / dt), abs=1e-6)
        assert pick.shaper.duration <= 0.02 * ROUNDING and len(pick.shaper) <= 6


def test_limits_that_are_too_tight_are_said_and_not_hidden() -> None:
    """With two impulses nothing is as still as the stock choice: the pick is missing, and the sentence says so."""
    trade = design_within(SIMULATED["three modes"], maximum_impulses=2)
    assert all(len(pick.shaper) == 2 for pick in trade.picks)
    assert trade.improved is None and trade.acceleration_gain == 0.0
    assert any(sentence.startswith("No improved") for sentence in gain_sentences(trade))


@pytest.mark.parametrize(
    ("wish", "sentence"),
    [
        ({"limits": "klipper"}, "takes families and no impulses"),
        ({"limits": "nobody"}, "is not known"),
        ({"limits": "rrf", "version": "1"}, "version '1' is not known"),
        ({"version": "3.6"}, "name the target"),
        ({"limits": "c"}, "works on samples"),
        ({"maximum_impulses": 1}, "from 2 to"),
        ({"longest": 0.0}, "above 0 s"),
        ({"limits": Limits(taps=5, shortest=0.01), "longest": 0.005}, "allow a longer one"),
        ({"remaining": 0.0}, "tolerance"),
    ],
)
def test_impossible_limits_are_refused(wish: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        design_within(SIMULATED["one mode"], **wish)  # type: ignore[arg-type]


def test_every_target_s_limits_are_understood() -> None:
    from preshape.workflow.design_within import room_of

    for name, target in TARGETS.items():
        if name in ("klipper", "marlin", "marlin-ft", "prusa"):
            continue
        grid = 0.001 if getattr(target.limits, "samples", None) is not None else None
        room = room_of(name, dt=grid)
        assert 2 <= room.impulses <= 25 and room.smallest >= 0.01
