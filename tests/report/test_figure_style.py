"""One style: colours that everybody can tell apart, lines that differ without them, and no other colour anywhere."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

import preshape.report
from preshape import Mode
from preshape.identify import IdentifiedMode
from preshape.report import Calibration, calibration_figure
from preshape.report.figures import SERIES
from preshape.workflow import calibrate

REPORT = Path(preshape.report.__file__).parent
GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"

SEEN = {
    "by all": np.eye(3),
    "without red": np.array([
        [0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998],
    ]),
    "without green": np.array([
        [0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881],
    ]),
    "without blue": np.array([
        [1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900],
    ]),
}  # fmt: skip
"""Full colour blindness on linear RGB: Machado, Oliveira and Fernandes (2009), table 1 at severity 1."""

TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
"""Linear sRGB to CIE XYZ (IEC 61966-2-1)."""

APART = 20.0
"""Distance in CIE L*a*b*; 2.3 is just noticeable side by side."""


def linear(colour: str) -> NDArray[np.float64]:
    rgb = np.array(to_rgb(colour))
    return np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)


def lab(rgb: NDArray[np.float64]) -> NDArray[np.float64]:
    relative = TO_XYZ @ np.clip(rgb, 0.0, 1.0) / np.array([0.95047, 1.0, 1.08883])
    f = np.where(relative > 0.008856, np.cbrt(relative), 7.787 * relative + 16.0 / 116.0)
    return np.array([116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])])


@pytest.mark.parametrize("eyes", SEEN)
def test_the_colours_of_curves_stay_apart_for_everybody(eyes: str) -> None:
    colours = {colour: lab(SEEN[eyes] @ linear(colour)) for colour, _, _ in SERIES}
    assert len(colours) == len(SERIES) == 6
    for one, other in itertools.combinations(colours, 2):
        assert np.linalg.norm(colours[one] - colours[other]) > APART, (one, other)


def test_every_curve_has_a_line_of_its_own_and_stands_out_of_the_paper() -> None:
    assert len({str(line) for _, line, _ in SERIES}) == len(SERIES)
    for colour, _, _ in SERIES:
        luminance = float(TO_XYZ[1] @ linear(colour))
        assert 1.05 / (luminance + 0.05) >= 3.0, colour  # what WCAG 2.1 asks of graphics


def test_no_figure_has_a_colour_of_its_own() -> None:
    """Every colour of a drawing stands in figures.py; pages and sheets have theirs in their style sheets."""
    drawings = [path for path in REPORT.glob("*.py") if path.name not in ("figures.py", "html.py")]
    assert len(drawings) > 15
    for path in drawings:
        text = path.read_text()
        assert not re.search(r"#[0-9a-fA-F]{3,8}\b", text), path.name
        for colour in re.findall(r"""color\w*=["'](\w+)["']""", text):
            assert colour in ("white", "none", "face"), path.name  # "face": that of the cell itself


@pytest.fixture(scope="module")
def gantry() -> Calibration:
    return calibrate(GANTRY)


@pytest.mark.parametrize(
    "frequencies",
    [(47.3, 78.6), (47.3, 50.0, 55.0, 78.6, 150.0, 180.0), (20.0, 21.0, 22.0, 23.0), (185.0, 190.0, 196.0)],
)
def test_no_name_of_a_mode_hides_another_or_the_legend(gantry: Calibration, frequencies: tuple[float, ...]) -> None:
    modes = tuple(IdentifiedMode(Mode(f, 0.02), (f, f), (0.01, 0.03), 0.2) for f in frequencies)
    figure = calibration_figure(replace(gantry, modes=modes))
    figure.draw_without_rendering()
    axes = figure.axes[0]
    names = [text for text in axes.texts if "Hz" in text.get_text()]
    legend = axes.get_legend()
    assert len(names) == len(frequencies) and legend is not None
    boxes = [text.get_window_extent() for text in names] + [legend.get_window_extent()]
    for one, other in itertools.combinations(boxes, 2):
        assert not one.overlaps(other)
    for box in boxes:
        assert box.x0 >= 0 and box.x1 <= figure.bbox.width and box.y0 >= 0 and box.y1 <= figure.bbox.height
