"""`preshape compare --mode F[:Z] --distance D --maximum-acceleration A ...`"""

from __future__ import annotations

import json
from pathlib import Path

import click

from preshape.cli.options import mode_option
from preshape.errors import InputError
from preshape.mode import Mode

__all__ = ["command"]


@click.command("compare")
@mode_option("Natural frequency [Hz] and damping ratio of what vibrates; once for each mode, the most important first.")
@click.option("--gain", "gains", type=float, multiple=True, metavar="G", help="Share of each mode.  [default: equal]")
@click.option("--distance", type=float, required=True, metavar="D", help="How far [m].")
@click.option("--maximum-acceleration", type=float, required=True, metavar="A", help="Limit [m/s²].")
@click.option("--maximum-speed", type=float, metavar="V", help="Limit [m/s].  [default: none]")
@click.option("--maximum-jerk", type=float, metavar="J", help="Limit [m/s³].  [default: none]")
@click.option(
    "--tolerance",
    type=float,
    default=0.02,
    show_default=True,
    metavar="V",
    help="Settled is within this part of what a step of acceleration, speed or way leaves.",
)
@click.option("--within", type=float, metavar="W", help="Settled is within this [m], instead of --tolerance.")
@click.option(
    "--frequency-error",
    type=float,
    default=0.1,
    show_default=True,
    metavar="E",
    help="How far off the frequencies may be, as a part of them.",
)
@click.option("--unit", default="m", show_default=True, metavar="UNIT", help="Unit of length of all that is given.")
@click.option("--out", type=click.Path(path_type=Path), metavar="FILE", help="Draw the figure: .svg, .png or .pdf.")
@click.option("--json", "json_file", metavar="FILE|-", help="Write all numbers; - for standard output, nothing else.")
def command(
    modes: tuple[Mode, ...],
    gains: tuple[float, ...],
    distance: float,
    maximum_acceleration: float,
    maximum_speed: float | None,
    maximum_jerk: float | None,
    tolerance: float,
    within: float | None,
    frequency_error: float,
    unit: str,
    out: Path | None,
    json_file: str | None,
) -> None:
    """Compare every kind of command for one move: how soon it is still, how far it bends, how robust it is.

    The modes ride on a carriage that follows the command exactly; all commands keep the same limits.

    \b
    preshape compare --mode 1.2:0.01 --distance 0.5 --maximum-speed 1 --maximum-acceleration 5 --out figure.svg
    """
    from preshape.cli.comparison_screen import comparison_screen
    from preshape.cli.screens import console
    from preshape.files import write_atomically
    from preshape.report import comparison_figure, figure_bytes, figure_format
    from preshape.workflow import compare

    if not modes:
        raise InputError("no mode was given: name at least one, such as --mode 1.2:0.01.")
    kind = None if out is None else figure_format(out)
    progress = console(stderr=True)
    with progress.status("making and measuring the commands ..."):
        comparison = compare(
            list(modes),
            distance,
            maximum_acceleration=maximum_acceleration,
            maximum_speed=maximum_speed,
            maximum_jerk=maximum_jerk,
            gains=list(gains) or None,
            tolerance=tolerance,
            within=within,
            frequency_error=frequency_error,
            unit=unit,
        )
    written = []
    if out is not None and kind is not None:
        with progress.status("drawing ..."):
            written.append(f"Figure: {write_atomically(out, figure_bytes(comparison_figure(comparison), kind))}")
    text = json.dumps(comparison.to_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    if json_file == "-":
        click.echo(text, nl=False)
        return
    if json_file is not None:
        written.append(f"Numbers: {write_atomically(json_file, text)}")
    comparison_screen(comparison)
    for line in written:
        click.echo(line)
