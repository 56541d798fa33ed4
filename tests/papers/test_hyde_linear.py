"""Hyde's section 5.2 by this file's own arithmetic: rows that say what the numbers say, and a fault that shows."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.papers import Row
from preshape.papers.hyde import chapter5_linear
from preshape.papers.hyde.chapter5_linear import Slewed
from preshape.plant import linear_mace


@pytest.fixture(scope="module")
def slew() -> Slewed:
    return chapter5_linear.slewed()


@pytest.fixture(scope="module")
def rows(slew: Slewed) -> list[Row]:
    return chapter5_linear.rows(slew)


def row_of(rows: list[Row], start: str) -> Row:
    (found,) = [row for row in rows if row.what.startswith(start)]
    return found


def left_of(frequencies: np.ndarray, times: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
    """|sum A exp(2 pi i f t)|."""
    return np.abs(np.exp(2j * math.pi * np.multiply.outer(frequencies, times)) @ amplitudes)


def test_all_is_reproduced_but_a_digit_of_the_caption(rows: list[Row]) -> None:
    assert [row.what for row in rows if row.verdict == "differs"] == [
        "third mode that the shaper is designed for, as the caption has it"
    ]
    assert all(row.explained for row in rows)
    assert sum(row.verdict == "reproduced" for row in rows) >= 13
    assert sum(row.verdict == "beyond the paper" for row in rows) >= 9


def test_what_three_modes_leave_by_sums_of_exponentials(slew: Slewed, rows: list[Row]) -> None:
    plant = linear_mace()
    frequencies = np.array([mode.frequency for mode in plant.modes()])
    pulses = left_of(frequencies, slew.command.times, slew.command.jumps)
    unshaped = np.abs(plant.static_deflections("left")) * pulses
    through = unshaped * left_of(frequencies, slew.printed.times, slew.printed.amplitudes)
    # The sums of amplitudes bound what is seen, and mode 1 makes most of it.
    assert 0.5 * slew.left() < unshaped.sum() < 0.6 * slew.left()
    assert slew.left(slew.printed) < 2.0 * through.sum() < 0.004 * slew.left()
    assert row_of(rows, "cancelling three of the twelve").computed == "0.0035 of 1.200 mm left: 0.29 %"


def test_lengths_for_more_modes(rows: list[Row]) -> None:
    starts = [f"the solution failed for more than three modes; for the first {count}" for count in (4, 5, 12)]
    assert [row_of(rows, start).computed for start in starts] == [
        "0.119339 s, 12, 0.42 %",
        "0.119600 s, 14, 0.35 %",
        "0.120495 s, 34, 0.00 %",
    ]


def test_a_shaper_that_does_not_cancel_is_a_difference_that_nothing_explains(slew: Slewed) -> None:
    longer = {count: Shaper(1.002 * one.times, one.amplitudes) for count, one in slew.direct.items()}
    wrong = chapter5_linear.rows(replace(slew, direct=longer))
    red = [row.what for row in wrong if not row.explained]
    assert len(red) == 4 and sum("failed for more than three" in what for what in red) == 3


def test_a_model_with_other_frequencies_is_a_difference_that_nothing_explains(slew: Slewed) -> None:
    wrong = chapter5_linear.rows(replace(slew, plant=slew.plant.retuned(1.01)))
    assert sum(not row.explained for row in wrong if row.what.startswith("natural frequency")) == 5


def test_the_printed_shaper_is_hyde_s_three_modes() -> None:
    assert design.direct(chapter5_linear.PRINTED).duration == pytest.approx(0.119229, abs=5e-7)
