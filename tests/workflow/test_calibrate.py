"""The main job on the gantry whose modes we know, on real files, and on Klipper's own numbers."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from preshape import Shaper, identify
from preshape.errors import InputError
from preshape.export import klipper
from preshape.plant import ModalPlant
from preshape.report import Calibration
from preshape.vibration import residual_vibration
from preshape.workflow import calibrate, save_calibration
from preshape.workflow.spectra import scored_spectrum

ROOT = Path(__file__).resolve().parents[2]
GANTRY = ROOT / "examples" / "data" / "gantry_x.csv"
TRUE_MODES = ((47.3, 0.045), (78.6, 0.060))
"""What the generator in examples/ simulates."""

DATA = ROOT.parent / "shared" / "data"
REAL_FILES = sorted(DATA.glob("*.csv"))
REFERENCE = DATA / "klipper_reference_results.json"


@pytest.fixture(scope="module")
def gantry() -> Calibration:
    return calibrate(GANTRY)


def test_the_gantry_s_modes_are_found(gantry: Calibration) -> None:
    assert len(gantry.modes) == 2
    for found, (frequency, damping) in zip(gantry.modes, TRUE_MODES, strict=True):
        assert found.mode.frequency == pytest.approx(frequency, rel=2e-3)
        assert found.mode.damping == pytest.approx(damping, rel=0.1)
        assert found.frequency_interval[0] <= frequency <= found.frequency_interval[1]
    assert gantry.clear and gantry.trouble == ()


def test_the_chosen_shaper_stills_the_true_machine(gantry: Calibration) -> None:
    """On the modes of the simulation, which the calibration has never seen."""
    plant = ModalPlant(list(TRUE_MODES))
    left = plant.impulse_residual(gantry.shaper.times, gantry.shaper.amplitudes)
    assert left.max() < 0.05
    assert gantry.move is not None and gantry.move.left < 1e-9  # on the modes it was designed for


def test_the_choice_smooths_least_of_those_within_the_tolerance(gantry: Calibration) -> None:
    assert gantry.chosen is gantry.candidates[0]
    assert gantry.chosen.left <= gantry.tolerance
    for other in gantry.candidates[1:]:
        assert other.left > gantry.tolerance or other.score.smoothing >= gantry.chosen.score.smoothing
    assert gantry.chosen.name in gantry.reason
    names = " ".join(candidate.name for candidate in gantry.candidates)
    for family in ("mzv ", "zvd ", "zvdd ", "two_hump_ei ", "three_hump_ei ", "convolved ", "direct ", "Klipper "):
        assert family in names


def test_what_is_left_is_what_the_plant_keeps_in_the_worst_case(gantry: Calibration) -> None:
    """The number in the table, by exact simulation of the identified modes, 5 % off either way."""
    modes = [(mode.mode.frequency, mode.mode.damping) for mode in gantry.modes]
    shares = np.array([mode.share for mode in gantry.modes])
    for candidate in gantry.candidates:
        rms = []
        for shift in (0.95, 0.975, 1.0, 1.025, 1.05):
            plant = ModalPlant([(frequency * shift, damping) for frequency, damping in modes])
            v = plant.impulse_residual(candidate.shaper.times, candidate.shaper.amplitudes)
            rms.append(float(np.sqrt(v**2 @ shares / shares.sum())))
        assert candidate.left == pytest.approx(max(rms), abs=2e-3)  # dampings vary within their intervals too
        assert candidate.left >= max(rms) - 1e-12


def test_klipper_s_measures_of_the_candidates_are_klipper_s(gantry: Calibration) -> None:
    file = gantry.files[0]
    for candidate in gantry.candidates:
        again = klipper.score(candidate.shaper, (file.scored.frequencies, file.scored.power))
        assert again == candidate.score


def test_a_direct_candidate_is_proved(gantry: Calibration) -> None:
    direct = [candidate.shaper for candidate in gantry.candidates if candidate.name.startswith("direct")]
    assert len(direct) == 2
    assert all(shaper.design.status == "optimal" for shaper in direct)
    for shaper in direct:
        for mode in gantry.modes:
            assert residual_vibration(shaper, mode.mode.frequency, mode.mode.damping) < 1e-12


def test_limits_and_wishes_are_kept() -> None:
    two = calibrate(GANTRY, maximum_impulses=2)
    assert len(two.shaper) == 2
    assert any(candidate.excluded for candidate in two.candidates)
    assert all(candidate.excluded == (len(candidate.shaper) > 2) for candidate in two.candidates)
    assert not two.chosen.excluded
    fixed = calibrate(GANTRY, damping=0.08)
    assert all(mode.mode.damping == 0.08 for mode in fixed.modes)
    strict = calibrate(GANTRY, tolerance=0.0001)
    assert strict.chosen.left == min(candidate.left for candidate in strict.candidates) > 0.0001
    assert "more than the 0.01 % allowed" in strict.reason


def test_several_files_count_as_one_machine() -> None:
    twice = calibrate([GANTRY, GANTRY])
    once = calibrate(GANTRY)
    assert [mode.mode for mode in twice.modes] == [mode.mode for mode in once.modes]
    assert twice.chosen.name == once.chosen.name


@pytest.mark.parametrize(
    ("wish", "sentence"),
    [
        ({"tolerance": 0.0}, r"outside \(0, 1\)"),
        ({"tolerance": 1.0}, r"outside \(0, 1\)"),
        ({"maximum_impulses": 1}, "cannot shape"),
        ({"damping": 1.0}, r"outside \[0, 1\)"),
        ({"damping": -0.1}, r"outside \[0, 1\)"),
    ],
)
def test_impossible_wishes_are_refused(wish: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        calibrate(GANTRY, **wish)
    with pytest.raises(InputError, match="no measurement"):
        calibrate([])


def test_what_is_saved_is_complete_and_readable(gantry: Calibration, tmp_path: Path) -> None:
    saved = save_calibration(gantry, tmp_path / "new" / "folder")
    assert Shaper.load(saved.shaper) == gantry.shaper
    ElementTree.parse(saved.figure)  # well-formed by itself
    page = saved.report.read_text()
    assert gantry.reason in page and "<svg" in page and page.rstrip().endswith("</html>")
    for outside in ("http://", "https://", "src=", "@import"):
        assert outside not in page.replace("http://www.w3.org", "").replace("http://purl.org", "").replace(
            "http://creativecommons.org", "").replace("https://matplotlib.org", "")  # fmt: skip
    picks = ["improved.json", "performance.json", "quality.json"]
    expected = ["calibration.svg", "report.html", "report.pdf", "settings", "shaper.json", "trade_off.svg", *picks]
    assert sorted(os.listdir(tmp_path / "new" / "folder")) == sorted(expected)
    assert gantry.trade_off is not None
    assert [Shaper.load(path) for path in saved.picks] == [pick.shaper for pick in gantry.trade_off.picks]
    fitting = {text.target for text in gantry.texts if text.fits}
    assert set(os.listdir(tmp_path / "new" / "folder" / "settings")) == fitting
    for path in saved.settings:
        assert path.read_text().strip()


def test_settings_of_an_earlier_run_do_not_stay_where_the_shaper_no_longer_fits(
    gantry: Calibration, tmp_path: Path
) -> None:
    text = next(text for text in gantry.texts if text.fits)
    save_calibration(gantry, tmp_path)
    folder = tmp_path / "settings" / text.target
    (folder / "notes.txt").write_text("mine")
    assert len(list(folder.iterdir())) > 1
    gone = replace(text, text="", note="too long", files={})
    save_calibration(replace(gantry, texts=(gone,)), tmp_path)
    assert {path.name for path in folder.iterdir() if path.suffix != ".outdated"} == {"notes.txt"}


def test_picks_of_an_earlier_run_do_not_stay_where_this_run_has_none(gantry: Calibration, tmp_path: Path) -> None:
    save_calibration(gantry, tmp_path)
    trade = gantry.trade_off
    assert trade is not None
    save_calibration(replace(gantry, trade_off=replace(trade, quality=None)), tmp_path)
    assert {path.name for path in tmp_path.glob("*.json")} == {"improved.json", "performance.json", "shaper.json"}
    save_calibration(replace(gantry, trade_off=None, texts=()), tmp_path)  # as of a crane
    left = {path.name for path in tmp_path.iterdir() if path.suffix != ".outdated"}
    assert left - {"report.pdf"} == {"calibration.svg", "report.html", "settings", "shaper.json"}
    settings = [path.name for path in (tmp_path / "settings").glob("*/*") if path.suffix != ".outdated"]
    assert settings == ["preshape_shaper.py"]  # the module for Klipper, which holds no impulses


def test_nothing_of_the_user_s_is_lost_with_them(gantry: Calibration, tmp_path: Path) -> None:
    """A pick and settings that were changed by hand are set aside, others are not touched."""
    save_calibration(gantry, tmp_path)
    assert gantry.trade_off is not None and gantry.trade_off.quality is not None
    changed = (tmp_path / "quality.json").read_text() + "\n"
    (tmp_path / "quality.json").write_text(changed)
    rrf = next((tmp_path / "settings" / "rrf").iterdir())
    mine = rrf.read_text() + "M593 ; mine\n"
    rrf.write_text(mine)
    (tmp_path / "settings" / "rrf" / "mine.g").write_text("M593 P0 ; mine")
    save_calibration(replace(gantry, trade_off=None, texts=()), tmp_path)
    assert (tmp_path / "quality.json.outdated").read_text() == changed
    assert rrf.with_name(rrf.name + ".outdated").read_text() == mine
    assert (tmp_path / "settings" / "rrf" / "mine.g").read_text() == "M593 P0 ; mine"


def test_every_calibration_of_a_printer_ends_with_settings_for_the_axis() -> None:
    texts = {text.target: text for text in calibrate(GANTRY, axis="x").texts}
    assert texts["rrf"].fits and texts["kalico"].fits and texts["klipper-plugin"].fits
    assert "shaper_a_x" in texts["kalico"].text and "shaper_a_y" not in texts["kalico"].text
    assert all(text.note for text in texts.values() if not text.fits)


def test_a_folder_that_cannot_be_written_is_refused(gantry: Calibration, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="cannot make the folder"):
        save_calibration(gantry, tmp_path / "file")


def test_an_interrupted_run_leaves_the_old_results(
    gantry: Calibration, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_calibration(gantry, tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}

    def interrupted(descriptor: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        save_calibration(gantry, tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


@pytest.mark.skipif(not REAL_FILES, reason="the measurements of ../shared/data are not on this machine")
@pytest.mark.parametrize("path", REAL_FILES, ids=lambda path: path.stem)
def test_every_real_file_is_calibrated(path: Path, tmp_path: Path) -> None:
    calibration = calibrate(path)
    saved = save_calibration(calibration, tmp_path)
    assert Shaper.load(saved.shaper) == calibration.shaper
    assert calibration.clear or calibration.trouble
    if path.stem.startswith("sammcj"):  # up to ten peaks: nothing to tune a shaper on
        assert not calibration.clear
        assert "see to the machine" in calibration.reason


@pytest.mark.skipif(not REFERENCE.exists(), reason="Klipper's reference results are not on this machine")
def test_klipper_s_own_numbers_are_met_on_every_printed_digit_through_our_readers() -> None:
    for name, expected in json.loads(REFERENCE.read_text()).items():
        measurement = identify.read(DATA / name)
        scored = scored_spectrum(measurement, identify.find_modes(measurement))
        answer = klipper.recommend((scored.frequencies, scored.power))
        assert (answer.chosen.name, answer.chosen.frequency) == (expected["recommended"], expected["freq"])
        for fit, row in zip(answer.fits, expected["fits"], strict=True):
            printed = {
                "name": fit.name,
                "freq": fit.frequency,
                "vibr_pct": round(100.0 * fit.score.remaining_vibration, 2),
                "smoothing": round(fit.score.smoothing, 4),
                "max_accel": round(fit.score.maximum_acceleration),
                "score": float(f"{fit.score.value:.6g}"),
            }
            assert printed == row


def test_shares_and_intervals_are_sensible(gantry: Calibration) -> None:
    assert sum(mode.share for mode in gantry.modes) <= 1.0 + 1e-9
    for mode in gantry.modes:
        low, high = mode.damping_interval
        assert 0.0 <= low <= mode.mode.damping <= high < 1.0
    assert np.isfinite([candidate.score.value for candidate in gantry.candidates]).all()
