"""Intervals hold the truth as often as they say, on machines that nothing was chosen on (benchmarks/verification.py has
more of them), whether the stop is found, given too late, or counted from the beginning."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from scipy.stats import binom
from tests.workflow.random_machines import Pair, draw

from preshape.errors import InputError
from preshape.report import DOUBTFUL, LESS, MORE, Verification
from preshape.workflow import verify

LATE = 0.006
"""Some modes are gone, and not found, when one looks so late [s]: they must not bend the others' ratios unnoticed."""

WAYS: dict[str, Callable[[Pair], dict[str, Any]]] = {
    "found": lambda pair: {},
    "late": lambda pair: {"stop": (pair.stops[0] + LATE, pair.stops[1] + LATE)},
    "counted": lambda pair: {"lasting": pair.lasting},
}


def holds_the_window(result: Verification, number: int) -> bool:
    """Whether the ratio of the root mean squares holds that of the same window without noise, at the true stops."""
    quiet = draw(11, number, 1e-5)
    begins = (quiet.stops[0] + result.wait, quiet.stops[1] + result.wait)
    truth = verify(quiet.before, quiet.after, stop=begins, window=result.window, below=result.below).ratio[-1].value
    return result.ratio[-1].low <= truth <= result.ratio[-1].high


@pytest.mark.parametrize("way", WAYS)
def test_intervals_of_a_ratio_hold_the_truth(way: str) -> None:
    judged = held = false = windows = 0
    for number in range(14):
        pair = draw(11, number, 0.01)
        result = verify(pair.before, pair.after, shaper=pair.told, **WAYS[way](pair))
        for one in result.modes:
            mode = pair.nearest(one.mode.mode.frequency)
            if mode is not None and not one.new:
                judged += 1
                held += one.ratio.low <= pair.truth(mode) <= one.ratio.high
                false += one.verdict in (LESS, MORE)
        windows += way == "found" and holds_the_window(result, number)
        off = abs(result.unshaped[0].stop - pair.stops[0])
        if way == "found" and off > 2.0 * result.unshaped[0].stop_spread:
            assert any("stop was not found" in one for one in result.trouble)
    assert judged >= 14
    assert held >= binom.ppf(0.001, judged, 0.95)
    assert false <= binom.ppf(0.999, judged, 0.05)
    assert way != "found" or windows >= binom.ppf(0.001, 14, 0.93)


def test_without_the_shaper_stops_that_were_found_are_not_believed() -> None:
    pair = draw(11, 0, 0.01)
    result = verify(pair.before, pair.after)
    assert {one.verdict for one in result.modes if not one.new} == {DOUBTFUL}
    assert all((one.ratio.low, one.ratio.high) == (0.0, float("inf")) for one in result.modes if not one.new)
    assert any("--shaper" in one and "--stop" in one for one in result.trouble)
    assert DOUBTFUL not in {one.verdict for one in verify(pair.before, pair.after, stop=pair.stops).modes}


def test_counting_needs_the_beginning() -> None:
    pair: Pair = draw(11, 1, 0.01)
    first = int(0.6 * pair.stops[0] * pair.before.sample_rate)
    cut = replace(pair.before, start=first / pair.before.sample_rate, values=pair.before.values[:, first:])
    with pytest.raises(InputError, match="beginning of the move"):
        verify(cut, pair.after, shaper=pair.told, lasting=pair.lasting)
