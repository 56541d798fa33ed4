"""Options that several commands share, and the little parsers behind them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from preshape.errors import InputError
from preshape.mode import Mode

__all__ = ["ModeOption", "RangeOption", "mode_option", "sample_rate_option", "tolerance_option"]

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class ModeOption(click.ParamType[Mode]):
    """FREQUENCY or FREQUENCY:DAMPING."""

    name = "F[:Z]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Mode:
        if isinstance(value, Mode):
            return value
        parts = str(value).split(":")
        try:
            numbers = [float(part) for part in parts]
        except ValueError:
            numbers = []
        if len(numbers) not in (1, 2):
            self.fail(f"{value!r} is not FREQUENCY[:DAMPING]: write 47.3 or 47.3:0.05.", param, ctx)
        try:
            return Mode(*numbers)
        except InputError as error:
            self.fail(str(error), param, ctx)


class RangeOption(click.ParamType[tuple[float, float]]):
    """LOW:HIGH."""

    name = "LO:HI"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        if isinstance(value, tuple):
            return value
        parts = str(value).split(":")
        try:
            low, high = (float(part) for part in parts)
        except ValueError:
            self.fail(f"{value!r} is not LOW:HIGH in hertz: write 8:12.", param, ctx)
        return low, high


def mode_option(help_text: str) -> Decorator:
    """--mode, as often as there are modes."""
    return click.option("--mode", "modes", type=ModeOption(), multiple=True, help=help_text)


def tolerance_option(help_text: str, default: float | None) -> Decorator:
    """--tolerance."""
    return click.option(
        "--tolerance", type=float, default=default, show_default=default is not None, metavar="V", help=help_text
    )


def sample_rate_option() -> Decorator:
    """--sample-rate."""
    return click.option(
        "--sample-rate", type=float, metavar="HZ", help="Samples per second, for a table without a time column."
    )
