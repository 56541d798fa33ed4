"""The figure of a campaign shows differences that are there, and none that are not."""

from __future__ import annotations

import numpy as np
import pytest

from preshape.report import CampaignSummary, Curves, campaign_figure


def axis_of(values: np.ndarray) -> tuple[float, float]:
    curves = Curves("title", "length [m]", "insensitivity [-]", (("", np.arange(5.0), values),))
    figure = campaign_figure(CampaignSummary("Design map", 5, 5, (), (curves,), (), ()))
    return figure.axes[0].get_ylim()


@pytest.mark.parametrize("value", [0.29, -3.0])
def test_rounding_does_not_fill_the_axis(value: float) -> None:
    low, high = axis_of(value * (1.0 + 1e-15 * np.array([0.0, 3.0, -2.0, 1.0, 0.0])))
    assert low <= 0.0 <= high and high - low >= abs(value)


def test_a_small_change_does() -> None:
    low, high = axis_of(np.array([1.0, 1.001, 1.002, 1.001, 1.0]))
    assert high - low < 0.01
