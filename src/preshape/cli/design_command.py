"""`preshape design --family ... --mode F[:Z] ...`"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from preshape import design
from preshape.band import Band
from preshape.cli.options import BandOption, Decorator, mode_option, spelled
from preshape.mode import Mode

__all__ = ["command"]


def _wishes(command: Callable[..., None]) -> Callable[..., None]:
    """An option a wish, as the list of the families says."""
    for option in reversed(tuple(design.OPTIONS.values())):
        command = _wish(option)(command)
    return command


def _wish(option: design.Option) -> Decorator:
    if option.kind == "flag":
        return click.option(spelled(option.name), is_flag=True, default=None, help=option.summary)
    kinds = {"number": float, "whole": int, "choice": click.Choice(option.choices)}
    return click.option(
        spelled(option.name), type=kinds[option.kind], metavar=option.letter or None, help=option.summary
    )


@click.command("design")
@click.option("--family", type=click.Choice(design.ASKED_FAMILIES), required=True, help="Which kind of shaper.")
@mode_option("Natural frequency [Hz] and damping ratio; once for each mode.")
@click.option(
    "--band",
    "bands",
    type=BandOption(),
    multiple=True,
    help="Band of frequencies [Hz], with damping ratios if you like, that the shaper must cover instead of modes: one "
    "for ei, any number for si.",
)
@_wishes
@click.option(
    "--json", "json_file", metavar="FILE|-", help="Write the shaper as JSON; - for standard output and nothing else."
)
def command(
    family: str, modes: tuple[Mode, ...], bands: tuple[Band, ...], json_file: str | None, **wishes: Any
) -> None:
    """Design a shaper for known modes, or for bands of frequencies.

    \b
    preshape design --family zvd --mode 47.3:0.05
    preshape design --family direct --mode 9.8 --mode 31.7:0.01 --json shaper.json
    preshape design --family ei --band 40:60 --tolerance 0.05
    preshape design --family si --band 0.9:1.1 --band 2.7:3.3:0.01:0.03 --tolerance 0.05
    """
    from preshape.cli.screens import shaper_screen
    from preshape.shaper_file import to_json

    asked = {name: value for name, value in wishes.items() if value is not None}
    shaper = design.designed(family, modes, bands, asked, spelled=spelled)
    if json_file == "-":
        click.echo(to_json(shaper.to_dict()), nl=False)
        return
    saved = None if json_file is None else shaper.save(Path(json_file))
    shaper_screen(shaper)
    if saved is not None:
        click.echo(f"Shaper: {saved}")
