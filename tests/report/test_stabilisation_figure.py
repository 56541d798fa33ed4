"""The stabilisation diagram shows every pole once, the chosen ones marked, and the modes with their intervals."""

import numpy as np
import pytest
from tests.identify.simulation import decay
from tests.identify.test_operational import MODES, record

from preshape.errors import InputError
from preshape.identify import find_modes
from preshape.report import as_svg, stabilisation_figure


def test_every_pole_is_drawn_once_and_apart_in_grey():
    found = find_modes(record(0))
    axes, behind = stabilisation_figure(found).axes
    drawn = {line.get_label(): line for line in axes.lines if not line.get_label().startswith("_")}
    diagram, end = found.stabilisation, axes.get_xlim()[1]
    inside = diagram.frequencies <= end
    assert sum(line.get_xdata().size for line in drawn.values()) == inside.sum()
    chosen = drawn["at the chosen order"]
    assert set(chosen.get_ydata()) == {diagram.order}
    styles = {(line.get_marker(), str(line.get_markerfacecolor())) for line in drawn.values()}
    assert len(styles) == 3  # told apart by form and filling, not by colour alone
    texts = [text.get_text() for text in axes.texts]
    assert len(texts) == len(MODES)
    assert all("damping" in text and " to " in text for text in texts)
    fitted = behind.lines[0].get_ydata()
    assert np.isfinite(fitted).all()
    assert axes.get_xlabel() == "frequency [Hz]"


def test_the_same_bytes():
    found = find_modes(record(1))
    assert as_svg(stabilisation_figure(found)) == as_svg(stabilisation_figure(found))


def test_a_ring_down_has_none():
    with pytest.raises(InputError, match="ring-down identification has no stabilisation diagram"):
        stabilisation_figure(find_modes(decay([(40.0, 0.05)], [1.0], np.random.default_rng(0))))
