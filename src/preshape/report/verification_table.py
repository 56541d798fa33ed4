"""The tables of a verification as text."""

from __future__ import annotations

import math

from preshape.report.tables import TextTable
from preshape.report.verification import Estimate, Verification

__all__ = ["residual_table", "verification_table"]


def verification_table(verification: Verification) -> TextTable:
    """A row for each mode: amplitudes at the stop, measured ratio with its interval, prediction, verdict."""
    titles = (
        ("mode",),
        ("before",),
        ("after",),
        ("measured ratio [%]", "(95 % interval)"),
        ("predicted [%]", "(range)"),
        ("verdict",),
    )
    rows = []
    for one in verification.modes:
        predicted = "" if one.predicted is None else f"{_percent(one.predicted[1])} ({_range(*one.predicted[::2])})"
        rows.append(
            (
                str(one.mode.mode),
                f"{one.before.value:.3g}",
                f"{one.after.value:.3g}",
                f"{_percent(one.ratio.value)} ({_range(one.ratio.low, one.ratio.high)})",
                predicted,
                "new with the shaper" if one.new else one.verdict,
            )
        )
    return TextTable(titles, tuple(rows))


def residual_table(verification: Verification) -> TextTable:
    """A row for each axis and one for all: root mean square after the stop, and its ratio."""
    unit = f" [{verification.unit}]" if verification.unit else ""
    titles = (("axis",), (f"before{unit}",), ("95 % interval",), (f"after{unit}",), ("95 % interval",), ("ratio [%]",),
              ("95 % interval",))  # fmt: skip
    rows = zip((*verification.axes, "total"), verification.before, verification.after, verification.ratio, strict=True)
    return TextTable(
        titles,
        tuple(
            (axis, f"{b.value:.3g}", _interval(b), f"{a.value:.3g}", _interval(a), _percent(r.value),
             _range(r.low, r.high))
            for axis, b, a, r in rows
        ),
    )  # fmt: skip


def _interval(estimate: Estimate) -> str:
    return f"{estimate.low:.3g} - {estimate.high:.3g}"


def _percent(ratio: float) -> str:
    return f"{100.0 * ratio:.3g}" if math.isfinite(ratio) else "unknown"


def _range(low: float, high: float) -> str:
    return f"{100.0 * low:.3g} - {100.0 * high:.3g}" if math.isfinite(high) else f"{100.0 * low:.3g} - open"
