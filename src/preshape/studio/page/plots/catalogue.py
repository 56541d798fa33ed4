"""The charts of the page, in its order."""

from __future__ import annotations

from preshape.studio.page.plots.chart import Chart
from preshape.studio.page.plots.impulses import IMPULSES
from preshape.studio.page.plots.poles import POLES
from preshape.studio.page.plots.responses import DEFLECTION, MOVE, STEP
from preshape.studio.page.plots.sensitivity import SENSITIVITY
from preshape.studio.page.plots.spectrum import SPECTRUM

__all__ = ["CHARTS"]

CHARTS: tuple[Chart, ...] = (SPECTRUM, SENSITIVITY, IMPULSES, MOVE, STEP, DEFLECTION, POLES)
"""Those that are drawn at once; the trade-off takes longer and comes after them."""
