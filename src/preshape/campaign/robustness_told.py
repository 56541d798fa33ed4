"""What a robustness campaign says: how much remains, with which share of the machines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape.campaign.kind import Column, Results, Told
from preshape.report import CampaignPanel, Cloud, Curves

__all__ = ["robustness_told"]

SHARES = np.linspace(0.0, 1.0, 501)
"""Of the machines, at which a distribution is drawn."""

MOST_DRAWN = 2000
"""Points of a cloud."""

RESULTS = ("unshaped", "shaped", "remaining", "duration")


def robustness_told(results: Results, columns: Sequence[Column], output: str, tolerance: float) -> Told:
    """Quantiles and shares; distributions, and what remains over what varies most with it."""
    numbers = {name: values[np.isfinite(results.numbers["remaining"])] for name, values in results.numbers.items()}
    remaining = 100.0 * numbers["remaining"]
    unit = {column.name: column.unit for column in columns}
    if not remaining.size:
        return Told((), (), {}, ("no machine vibrates unshaped, so nothing can remain.",))
    median, high, most = np.quantile(remaining, [0.5, 0.95, 1.0])
    within = 100.0 * float(np.mean(remaining <= 100.0 * tolerance))
    rows = (
        ("remaining, median", f"{median:.3g} %"),
        ("remaining, 95 % of the machines below", f"{high:.3g} %"),
        ("remaining, at most", f"{most:.3g} %"),
        (f"machines within {100.0 * tolerance:g} %", f"{within:.1f} %"),
        (f"{output} unshaped, median", f"{np.median(numbers['unshaped']):.4g} {unit['unshaped']}"),
        (f"{output} shaped, median", f"{np.median(numbers['shaped']):.4g} {unit['shaped']}"),
        ("duration of the shaper, median", f"{np.median(numbers['duration']):.4g} s"),
    )
    swings = [
        (name, np.quantile(values[values > 0.0], SHARES), 100.0 * SHARES)
        for name in ("unshaped", "shaped")
        if (values := numbers[name]).any()
    ]
    panels: list[CampaignPanel] = [
        Curves("Vibration after the move", f"{output} [{unit['shaped']}]", "machines below [%]", tuple(swings), True),
        Curves(
            "What remains of it", "shaped / unshaped [%]", "machines below [%]",
            (("remaining", np.quantile(remaining, SHARES), 100.0 * SHARES),),
        ),
    ]  # fmt: skip
    varied = [column.name for column in columns if column.name not in RESULTS]
    step = max(1, remaining.size // MOST_DRAWN)
    for name in sorted(varied, key=lambda one: -_explained(numbers[one], remaining))[:2]:
        label = f"{name} [{unit[name]}]" if unit[name] != "-" else f"{name}, true / known [-]"
        panels.append(Cloud(f"Over {name}", label, "remaining [%]", numbers[name][::step], remaining[::step]))
    return Told(rows, tuple(panels), {})


def _explained(x: np.ndarray, y: np.ndarray) -> float:
    """Part of the variance of y that a parabola of x explains."""
    if x.size < 4 or np.ptp(x) == 0.0 or np.ptp(y) == 0.0:
        return 0.0
    basis = np.vander((x - x.mean()) / np.ptp(x), 3)
    found, *_ = np.linalg.lstsq(basis, y, rcond=None)
    return 1.0 - float(np.var(y - basis @ found) / np.var(y))
