"""The trade-off: nothing is below the optimum, and what is left is the worst within the error."""

from __future__ import annotations

import json

import numpy as np
import pytest

from preshape import design
from preshape.mode import Mode
from preshape.vibration import residual_vibration
from preshape.workflow.workbench import AskedDesign, Workbench, left_at_error, plain_trade_off, trade_off_of

MODES = (Mode(10.0, 0.02), Mode(26.0, 0.01))


def test_no_positive_shaper_is_shorter_than_the_optimum_that_leaves_as_much() -> None:
    found = trade_off_of(Workbench(MODES, (AskedDesign("A", "zvd"), AskedDesign("B", "sd_zv"))))
    assert found.remarks == ()
    assert [point.name for point in found.designs] == ["A"]
    assert all(point.proved for point in found.optimum)
    for level, point in zip((0.5, 0.3, 0.2, 0.1, 0.05, 0.02), found.optimum, strict=True):
        assert point.left <= level * (1.0 + 1e-6)
        for other in found.families:
            if not other.name.startswith(("um", "ps")) and other.left <= level:
                assert other.duration >= point.duration * (1.0 - 1e-9), (other, point)
    assert json.dumps(plain_trade_off(found), allow_nan=False)


@pytest.mark.parametrize("family", ["zv", "ei", "two_hump_ei", "direct", "um_zv"])
def test_what_is_left_is_the_largest_of_a_fine_grid(family: str) -> None:
    shaper = design.FAMILIES[family](MODES)
    grid = np.linspace(0.95, 1.05, 20_001)
    worst = max(float(residual_vibration(shaper, grid * mode.frequency, mode.damping).max()) for mode in MODES)
    found = left_at_error(shaper, MODES)
    assert worst <= found * (1.0 + 1e-12) and found == pytest.approx(worst, rel=1e-5)


def test_patience_ends_the_optimum_and_says_so() -> None:
    ticks = iter(range(100))
    found = trade_off_of(Workbench(MODES), patience=1.5, clock=lambda: float(next(ticks)))
    assert len(found.optimum) == 1
    assert found.remarks == ("the optimum stops above 30 %: these modes take long to solve.",)
