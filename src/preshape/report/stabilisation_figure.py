"""The stabilisation diagram: poles over model orders, on the spectrum that they must explain."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape.errors import InputError
from preshape.identify import Identification
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, SOFT, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["stabilisation_figure"]

LOWEST_SHOWN = 1e-5
"""The density is shown down to this part of its highest value."""

ROOM = 1.42
"""Height of the figure over that of the columns."""

BEYOND = 1.6
"""The frequency axis ends at this multiple of the highest mode, if the spectrum reaches that far."""


def stabilisation_figure(found: Identification) -> Figure:
    """Poles over model orders, the chosen order, and the measured and the fitted spectrum.

    A mode is a column of filled dots that stands from a low order up. Open dots come and go: they are noise.

    Parameters
    ----------
    found : Identification
        Of a machine at work, by :func:`preshape.identify.operational_modes`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the identification has no stabilisation diagram.
    """
    diagram = found.stabilisation
    if diagram is None:
        raise InputError(
            f"a {found.method} identification has no stabilisation diagram: it belongs to machines at work, as "
            "operational_modes finds them."
        )
    figure = new_figure(10.0, 6.0)
    axes = figure.add_subplot()
    modes = sorted(found.modes, key=lambda mode: mode.mode.frequency)
    spectrum = found.spectrum
    end = float(spectrum.frequencies[-1])
    known = np.flatnonzero(np.isfinite(found.fitted))
    if known.size:
        end = float(spectrum.frequencies[known[-1]])
    if modes:
        end = min(end, BEYOND * modes[-1].mode.frequency)
    shown = (spectrum.frequencies > 0.0) & (spectrum.frequencies <= end)
    top = float(spectrum.total[shown].max())
    behind = axes.twinx()
    behind.fill_between(spectrum.frequencies[shown], LOWEST_SHOWN, spectrum.total[shown] / top, color=SOFT, linewidth=0)
    behind.plot(
        spectrum.frequencies[shown], found.fitted[shown] / top, color=ACCENT, linewidth=1.4, label="fitted spectrum"
    )
    behind.set_yscale("log")
    # The highest peak ends where the columns do; above there is room for the labels.
    behind.set_ylim(LOWEST_SHOWN, LOWEST_SHOWN ** (1.0 - ROOM))
    behind.set_yticks(10.0 ** np.arange(np.log10(LOWEST_SHOWN), 0.5))
    behind.minorticks_off()
    behind.set_ylabel("power over the highest (grey: measured)", fontsize=9.5, color=INK)
    behind.tick_params(labelsize=9, colors=INK)
    behind.spines["top"].set_visible(False)
    axes.set_zorder(behind.get_zorder() + 1)
    axes.patch.set_visible(False)
    inside = diagram.frequencies <= end
    fleeting, stable = inside & ~diagram.stable, inside & diagram.stable & ~diagram.chosen
    axes.plot(
        diagram.frequencies[fleeting],
        diagram.orders[fleeting],
        "o",
        markersize=4,
        markerfacecolor="none",
        markeredgecolor=MUTED,
        markeredgewidth=0.8,
        label="comes and goes",
    )
    axes.plot(diagram.frequencies[stable], diagram.orders[stable], "o", color=INK, markersize=4.5, label="comes back")
    taken = inside & diagram.chosen
    axes.plot(
        diagram.frequencies[taken], diagram.orders[taken], "D", color=SECOND, markersize=8, label="at the chosen order",
        markeredgecolor=INK, markeredgewidth=0.8,
    )  # fmt: skip
    axes.axhline(diagram.order, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    highest = float(diagram.orders.max())
    for number, mode in enumerate(modes):
        low, high = mode.damping_interval
        axes.annotate(
            f"{mode.mode.frequency:.4g} Hz\ndamping {mode.mode.damping:.3f}\n({low:.3f} to {high:.3f})",
            (mode.mode.frequency, highest * (1.09 if number % 2 == 0 else 1.26)),
            ha="center",
            va="center",
            fontsize=8.5,
            color=INK,
        )
    axes.set_xlim(0.0, end)
    axes.set_ylim(0.0, ROOM * highest)
    axes.set_yticks(np.arange(0.0, highest + 1.0, 4.0))
    tidy(
        axes,
        "frequency [Hz]",
        "model order",
        f"Poles that come back; order {diagram.order} is used",
    )
    lines = [*axes.get_legend_handles_labels()[0], *behind.get_legend_handles_labels()[0]]
    axes.legend(handles=lines, fontsize=8.5, loc="upper right", frameon=True, framealpha=0.95, edgecolor="white")
    return figure
