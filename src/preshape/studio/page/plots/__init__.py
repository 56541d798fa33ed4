"""The charts of the page, one a file: what each is, and what it shows of a picture."""

from preshape.studio.page.plots.chart import DESIGNS, Chart, Drawing, Picture
from preshape.studio.page.plots.impulses import IMPULSES
from preshape.studio.page.plots.poles import POLES
from preshape.studio.page.plots.responses import DEFLECTION, MOVE, STEP
from preshape.studio.page.plots.sensitivity import SENSITIVITY
from preshape.studio.page.plots.spectrum import SPECTRUM
from preshape.studio.page.plots.trade_off import TRADE_OFF

__all__ = ["CHARTS", "DESIGNS", "TRADE_OFF", "Chart", "Drawing", "Picture"]

CHARTS: tuple[Chart, ...] = (SPECTRUM, SENSITIVITY, IMPULSES, MOVE, STEP, DEFLECTION, POLES)
"""Those that are drawn at once, in the order of the page; the trade-off takes longer and comes after them."""
