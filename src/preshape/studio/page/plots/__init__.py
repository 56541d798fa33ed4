"""The charts of the page, one a file: what each is, and what it shows of a picture."""

from preshape.studio.page.plots.catalogue import CHARTS
from preshape.studio.page.plots.chart import DESIGNS, Chart, Drawing, Picture
from preshape.studio.page.plots.trade_off import TRADE_OFF

__all__ = ["CHARTS", "DESIGNS", "TRADE_OFF", "Chart", "Drawing", "Picture"]
