"""Klipper's recommendation: every printed digit of its own results, and the rules walked through one by one."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from preshape.errors import InputError
from preshape.export import klipper

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
GOLDEN = DATA / "klipper_reference_results.json"
FILES = [
    "katodo_resonances_x_20220226.csv",
    "katodo_resonances_x_20220403_175607.csv",
    "katodo_resonances_x_20220403_182037_set3.csv",
    "katodo_resonances_y_20220226.csv",
    "katodo_resonances_y_20220403_180145.csv",
    "sammcj_calibration_data_x_20230321_165958.csv",
    "sammcj_calibration_data_y_20230321_165958.csv",
    "sammcj_resonances_x_20230321_171058.csv",
    "sammcj_resonances_y_20230321_171849.csv",
]


def golden() -> dict[str, Any]:
    if not GOLDEN.exists():
        pytest.skip(f"the real measurements are not here: {DATA}")
    results: dict[str, Any] = json.loads(GOLDEN.read_text())
    return results


def measured(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies as printed (Klipper takes them so) and psd_xyz, normalised once."""
    table = np.genfromtxt(DATA / name, delimiter=",", skip_header=1)
    frequencies, psd = table[:, 0], table[:, 4]
    return frequencies, psd if "calibration" in name else klipper.normalise_to_frequencies(frequencies, psd)


def printed(fit: klipper.KlipperFit) -> dict[str, Any]:
    """A fit with as many digits as the golden file has."""
    return {
        "name": fit.name,
        "freq": fit.frequency,
        "vibr_pct": round(100.0 * fit.score.remaining_vibration, 2),
        "smoothing": round(fit.score.smoothing, 4),
        "max_accel": round(fit.score.maximum_acceleration),
        "score": float(f"{fit.score.value:.6g}"),
    }


def test_the_golden_file_is_about_these_measurements() -> None:
    assert sorted(golden()) == FILES


@pytest.mark.parametrize("name", FILES)
def test_every_printed_digit_of_klippers_own_results(name: str) -> None:
    expected = golden()[name]
    found = klipper.recommend(measured(name))
    assert [printed(fit) for fit in found.fits] == expected["fits"]
    assert (found.chosen.name, found.chosen.frequency) == (expected["recommended"], expected["freq"])
    assert found.chosen in found.fits


@pytest.mark.parametrize("name", FILES)
def test_a_fits_shaper_has_the_fits_score(name: str) -> None:
    """The scan at once and the score of the one shaper are two ways to the same numbers."""
    golden()
    frequencies, psd = measured(name)
    for fit in klipper.recommend((frequencies, psd)).fits:
        again = klipper.score(fit.shaper, (frequencies, psd))
        for field in ("remaining_vibration", "smoothing", "maximum_acceleration", "value"):
            assert getattr(again, field) == pytest.approx(getattr(fit.score, field), rel=1e-9, abs=1e-12)


BINS = np.arange(4.7, 160.0, 1.56)


def resonances(*modes: tuple[float, float, float]) -> np.ndarray:
    power = np.zeros(BINS.size)
    for frequency, damping, height in modes:
        r = BINS / frequency
        power += height * (2 * damping) ** 2 / ((1 - r**2) ** 2 + (2 * damping * r) ** 2)
    return power


def walk(frequencies: np.ndarray, psd: np.ndarray) -> tuple[list[tuple[str, float]], str, bool]:
    """Klipper's rules by ECOSYSTEM 1.8, one candidate after the other; also whether another frequency took over."""
    best: dict[str, Any] | None = None
    fits, upgraded = [], False
    for name in ("zv", "mzv", "ei", "2hump_ei", "3hump_ei"):
        family = klipper.FAMILIES[name]
        tried = []
        for f in np.arange(family.minimum_frequency, 150.0, 0.2)[::-1]:
            rated = klipper.score(family.pulses(f, 0.1), (frequencies, psd))
            tried.append(
                {"name": name, "f": f, "v": rated.remaining_vibration, "s": rated.smoothing, "value": rated.value}
            )
        least = min(item["v"] for item in tried)
        near = [item for item in tried if item["v"] < least * 1.1 + 0.0005]
        chosen = min(near, key=lambda item: item["value"])
        if best is None or chosen["value"] * 1.2 < best["value"]:
            best = chosen
        elif chosen["value"] * 1.05 < best["value"] and chosen["s"] * 1.1 < best["s"]:
            best = chosen
        limit_v, limit_s = best["v"], best["s"]
        strictly_better = [item for item in tried if item["v"] < limit_v and item["s"] < limit_s]
        if strictly_better:
            best = chosen = min(strictly_better, key=lambda item: item["v"])
            upgraded = True
        fits.append(chosen)
    assert best is not None
    if best["name"] == "zv":
        best = next((item for item in fits[1:] if item["v"] * 1.1 < best["v"]), best)
    return [(item["name"], round(float(item["f"]), 1)) for item in fits], best["name"], upgraded


CASES = {
    "one damped mode": [resonances((55.0, 0.1, 1.0))],
    "two modes": [resonances((48.0, 0.04, 1.0), (93.0, 0.05, 0.7))],
    "two datasets": [resonances((50.0, 0.04, 1.0)), resonances((66.0, 0.06, 20.0))],
    "another frequency": [resonances((48.5, 0.21, 0.15), (62.1, 0.02, 0.51), (126.5, 0.02, 0.15))],
    "score nearly enough": [resonances((101.8, 0.18, 0.4), (65.1, 0.03, 0.4), (50.1, 0.26, 0.2))],
    "score and smoothing enough": [resonances((132.4, 0.18, 0.8), (129.3, 0.03, 0.5), (61.0, 0.03, 0.6))],
    "smoothing nearly enough": [resonances((113.0, 0.04, 0.3), (12.3, 0.03, 0.9), (19.1, 0.09, 0.9))],
    "below the scan": [resonances((19.0, 0.167, 1.0))],
    "nearly nothing gained on zv": [resonances((17.6, 0.02, 0.8), (18.6, 0.02, 0.6), (113.5, 0.1, 0.1))],
    "one bin": [np.where(BINS == BINS[35], 1.0, 0.0)],
}


@pytest.mark.parametrize("case", CASES)
def test_the_scan_at_once_follows_the_rules_step_by_step(case: str) -> None:
    psd = np.array(CASES[case])
    expected_fits, expected_name, upgraded = walk(BINS, psd)
    found = klipper.recommend((BINS, psd))
    assert [(fit.name, fit.frequency) for fit in found.fits] == expected_fits
    assert found.chosen.name == expected_name
    alone = [klipper.fit(fit.name, (BINS, psd)).frequency for fit in found.fits]
    assert (alone != [fit.frequency for fit in found.fits]) == upgraded
    if case == "another frequency":
        assert upgraded


def test_zv_is_chosen_only_where_nothing_leaves_clearly_less() -> None:
    """ZV leaves a little of the one bin and others nothing; of the mode below the scan nobody can remove much."""
    assert klipper.recommend((BINS, CASES["one bin"][0])).chosen.name == "mzv"
    assert klipper.recommend((BINS, CASES["below the scan"][0])).chosen.name == "zv"
    assert klipper.recommend((BINS, CASES["nearly nothing gained on zv"][0])).chosen.name == "3hump_ei"


def test_spectra_come_as_pair_rows_or_list_of_pairs() -> None:
    """Datasets may lie on different frequencies; a dataset given twice changes nothing."""
    first, second = CASES["two datasets"]
    rows = klipper.fit("mzv", (BINS, [first, second]))
    assert klipper.fit("mzv", [(BINS, first), (BINS, second)]) == rows
    assert klipper.fit("mzv", ((BINS, first), (BINS, second))) == rows
    assert klipper.fit("mzv", [klipper.Spectrum(BINS, first), (BINS[:-9], second[:-9]), (BINS, second)]) == rows
    assert klipper.fit("mzv", [(BINS, first), (BINS, first)]) == klipper.fit("mzv", (BINS, first))
    assert klipper.fit("mzv", klipper.Spectrum(BINS, first)) == klipper.fit("mzv", (BINS, first))


def test_settings_reach_the_fit() -> None:
    spectrum = (BINS, CASES["one damped mode"][0])
    slow = klipper.fit("ei", spectrum, damping=0.05, dampings=[0.05], square_corner_velocity=20.0)
    again = klipper.score(slow.shaper, spectrum, [0.05], square_corner_velocity=20.0)
    assert slow.shaper == klipper.ei(slow.frequency, 0.05)
    assert slow.score.smoothing == pytest.approx(again.smoothing, rel=1e-12)
    assert slow.score.remaining_vibration == pytest.approx(again.remaining_vibration, rel=1e-9, abs=1e-12)
    assert klipper.fit("zvd", spectrum).shaper.design.family == "zvd"


@pytest.mark.parametrize(
    ("spectra", "sentence"),
    [
        ([], "no spectrum was given"),
        ("psd", "is not a spectrum"),
        (7.0, "is not a spectrum"),
        ([BINS, BINS], "an item of type ndarray"),
        ([(BINS, BINS, BINS)], "an item of type tuple"),
    ],
)
def test_what_is_not_a_spectrum_is_refused(spectra: Any, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        klipper.recommend(spectra)


def test_an_unknown_family_is_named_with_those_that_exist() -> None:
    with pytest.raises(InputError, match="no shaper 'zvdd': give one of zv, mzv, zvd, ei"):
        klipper.fit("zvdd", (BINS, CASES["one bin"][0]))
    with pytest.raises(InputError, match="allows for 3hump_ei"):
        klipper.recommend((BINS, CASES["one bin"][0]), damping=0.25)
