"""Where the machine vibrates: the measured spectrum, or that of the modes alone; the modes are handles over it."""

from __future__ import annotations

import numpy as np

from preshape.studio.page.plots.chart import Axis, Chart, Drawing, Picture, Points, frame, gapped, line, listed

__all__ = ["SPECTRUM"]

DEPTH = 1e-5
"""What is below this part of the highest point is not shown."""


def _modelled(picture: Picture) -> Points:
    """Power of the plant's acceleration for a white command, relative to its highest."""
    bench = picture.view.workbench
    gains = bench.plant.gains or (1.0,) * len(bench.modes)
    frequencies = np.union1d(picture.view.frequencies[1:], [mode.frequency for mode in bench.modes])
    s = 2j * np.pi * frequencies
    total = np.zeros_like(s)
    for gain, mode in zip(gains, bench.modes, strict=True):
        total += gain * mode.omega**2 / (s**2 + 2.0 * max(mode.damping, 1e-3) * mode.omega * s + mode.omega**2)
    power = np.abs(s**2 * total) ** 2
    return frequencies, power / power.max()


def _drawing(picture: Picture) -> Drawing:
    measured, modes = picture.measured, picture.view.workbench.modes
    series: dict[str, Points | None] = {"measured": None, "fitted": None, "model": None}
    if measured is None:
        series["model"] = _modelled(picture)
        name, detail, unit = "power of the modes [-]", "model", "model"
        highest = 1.0
    else:
        name = f"density [{measured.unit.replace('^2', '²')}]" if measured.unit else "density"
        detail, unit = measured.name, "measured"
        shown = (measured.frequencies > 0.0) & (measured.frequencies <= picture.top)
        density = measured.density[shown]
        highest = float(density.max()) if density.size else 1.0
        floor = DEPTH * highest
        x = measured.frequencies[shown]
        series["measured"] = x, np.where(density > floor, density, floor)
        fitted = measured.fitted[shown]
        series["fitted"] = x, np.where(fitted > floor, fitted, np.nan)
    low, high = 10.0 ** np.floor(np.log10(DEPTH * highest)), 10.0 ** np.ceil(np.log10(highest))
    series["command.modes"] = gapped([[(mode.frequency, low), (mode.frequency, high)] for mode in modes])
    at = [
        f"mode {index} at {mode.frequency:.4g} hertz, damping ratio {mode.damping:.3g}"
        for index, mode in enumerate(modes, 1)
    ]
    return Drawing(
        series,
        label=f"Spectrum, {unit}: {listed(at)}",
        detail=detail,
        option={
            "xAxis": [{"max": picture.top}],
            "yAxis": [{"name": name, "min": low, "max": high}],
        },
    )


SPECTRUM = Chart(
    "spectrum",
    "Spectrum and modes",
    frame(
        Axis("frequency [Hz]", {"min": 0}),
        Axis(
            "power of the modes [-]",
            {
                "type": "log",
                "axisLabel": {"fontSize": 11, ":formatter": "v => v.toExponential(0).replace('e+', 'e')"},
            },
        ),
        [
            line("command.modes", "modes", tooltip={"show": False}),
            line("measured", "measured"),
            line("fitted", "fitted modes"),
            line("model", "modes alone"),
        ],
    ),
    _drawing,
)
