"""Options that several commands share, and the little parsers behind them."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from typing import Any

import click

from preshape.band import Band
from preshape.errors import InputError
from preshape.mode import Mode

__all__ = [
    "BandOption",
    "Decorator",
    "ModeOption",
    "mode_option",
    "sample_rate_option",
    "spelled",
    "tolerance_option",
    "typed",
]

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


def spelled(name: str) -> str:
    """An option's name as it is typed."""
    return "--" + name.replace("_", "-")


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


class BandOption(click.ParamType[Band]):
    """LOW:HIGH, with one damping ratio or two behind."""

    name = "LO:HI[:Z[:Z]]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Band:
        if isinstance(value, Band):
            return value
        parts = str(value).split(":")
        try:
            numbers = [float(part) for part in parts]
        except ValueError:
            numbers = []
        if not 2 <= len(numbers) <= 4:
            self.fail(
                f"{value!r} is not LOW:HIGH[:DAMPING[:DAMPING]] in hertz: write 8:12 or 8:12:0.01:0.03.", param, ctx
            )
        try:
            return Band(*numbers)
        except InputError as error:
            self.fail(str(error), param, ctx)


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


def typed(context: click.Context) -> str:
    """The command line as it was typed, so that a shell would take it again."""
    return shlex.join(["preshape", *context.find_root().obj])
