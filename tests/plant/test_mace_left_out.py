"""Without Exudyn chapter 5.3 is one row that says so, and everything else of Hyde's is there."""

import sys

import pytest

from preshape.errors import InputError
from preshape.papers.hyde import chapter5_mace, chapter5_slews
from preshape.plant.mace import CALIBRATED_GAINS, Mace


def test_the_row_says_what_is_missing_and_what_brings_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert not chapter5_slews.installed()
    (row,) = chapter5_mace.left_out()
    assert row.explained and "preshape[plants]" in row.explanation


def test_without_exudyn_modes_are_there_and_simulation_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "exudyn", None)
    plant = Mace(CALIBRATED_GAINS)
    assert len(plant.modes()) >= 2
    with pytest.raises(InputError, match=r"pip install 'preshape\[plants\]'"):
        plant.simulate([0.0, 0.1], 0.001)
