"""Hyde's section 5.3: verdicts follow from the numbers, so that a model which had his modes would say "reproduced"."""

from __future__ import annotations

import math

import pytest

from preshape.papers import Row
from preshape.papers.hyde import chapter5_frequencies, chapter5_mace
from preshape.papers.hyde.chapter5_frequencies import _each_is_a_mode, _tables
from preshape.plant.mace import CALIBRATED_GAINS, Mace


def _cluster() -> dict[str, Row]:
    return {row.what: row for row in _tables() if row.what.endswith("modes 2 to 4")}


def test_the_cluster_differs_because_one_mode_is_not_three() -> None:
    rows = _cluster()
    assert [row.verdict for row in rows.values()] == ["differs"] * 2 and all(row.explained for row in rows.values())
    assert rows["60 deg inboard, modes 2 to 4"].printed == "13.40, 14.20, 15.90 Hz"


def test_the_cluster_would_be_reproduced_if_he_had_printed_our_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    ours = [mode.frequency for mode in Mace(CALIBRATED_GAINS).modes(math.radians(60.0))]
    monkeypatch.setattr(chapter5_frequencies, "CLOSED_LOOP", {60: (1.88, *(1.02 * each for each in ours[-3:]))})
    assert [row.verdict for row in _cluster().values()] == ["reproduced"]


@pytest.mark.parametrize(
    ("modes", "all_there"),
    [
        ([1.8, 13.2, 14.3, 16.1, 22.0], True),
        ([1.8, 13.8, 16.1], False),  # 13.8 Hz is near two that are printed, and is one mode
        ([1.8, 13.8, 13.8, 16.1], True),
        ([1.8, 12.7, 14.3, 16.1], False),  # 12.7 Hz is more than 5 % off
        ([], False),
    ],
)
def test_every_printed_frequency_needs_a_mode_of_its_own(modes: list[float], all_there: bool) -> None:
    assert _each_is_a_mode((13.4, 14.2, 15.9), modes) is all_there


def test_where_the_model_can_be_simulated_left_out_has_no_excuse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: object())
    (row,) = chapter5_mace.left_out()
    assert row.verdict == "differs" and not row.explained
