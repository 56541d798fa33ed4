"""`preshape design --family ... --mode F[:Z] ...`"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from preshape import design
from preshape.band import Band
from preshape.cli.options import BandOption, Decorator, mode_option, spelled, typed
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
@click.option(
    "--report", type=click.Path(path_type=Path), metavar="FILE", help="Write a report: .html, or .pdf with Typst."
)
@click.pass_context
def command(
    context: click.Context,
    /,
    family: str,
    modes: tuple[Mode, ...],
    bands: tuple[Band, ...],
    json_file: str | None,
    report: Path | None,
    **wishes: Any,
) -> None:
    """Design a shaper for known modes, or for bands of frequencies.

    \b
    preshape design --family zvd --mode 47.3:0.05
    preshape design --family direct --mode 9.8 --mode 31.7:0.01 --json shaper.json
    preshape design --family ei --band 40:60 --tolerance 0.05
    preshape design --family si --band 0.9:1.1 --band 2.7:3.3:0.01:0.03 --tolerance 0.05
    """
    from preshape.cli.screens import shaper_screen
    from preshape.files import write_atomically
    from preshape.report import DesignJob, report_bytes, report_format
    from preshape.shaper_file import to_json
    from preshape.workflow import asked_design_report, designed

    job = DesignJob(
        family=family,
        modes=tuple((mode.frequency, mode.damping) for mode in modes),
        bands=tuple((band.low, band.high, band.least_damping, band.highest_damping) for band in bands),
        **wishes,
    )
    kind = None if report is None else report_format(report)
    shaper = designed(job)
    sheets = None if kind is None else report_bytes(asked_design_report(job, shaper, command_line=typed(context)), kind)
    if report is not None and sheets is not None:
        write_atomically(report, sheets)
    if json_file == "-":
        click.echo(to_json(shaper.to_dict()), nl=False)
        return
    saved = None if json_file is None else shaper.save(Path(json_file))
    shaper_screen(shaper)
    if saved is not None:
        click.echo(f"Shaper: {saved}")
    if report is not None:
        click.echo(f"Report: {report}")
