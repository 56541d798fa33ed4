"""`preshape shape SHAPER.json COMMAND.csv --out OUT.csv`"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from preshape.cli.options import sample_rate_option
from preshape.errors import InputError

if TYPE_CHECKING:
    from preshape.workflow import ShapedFile

__all__ = ["command"]


@click.command("shape")
@click.argument("shaper", type=click.Path(path_type=Path), metavar="SHAPER.json")
@click.argument("command_file", type=click.Path(path_type=Path), metavar="COMMAND.csv")
@click.option(
    "--out", type=click.Path(path_type=Path), required=True, metavar="OUT.csv", help="Where the shaped command goes."
)
@click.option("--column", "columns", multiple=True, metavar="NAME=FILE", help="Another shaper for one column.")
@click.option("--own-delays", is_flag=True, help="Leave each column its shaper's delay; otherwise all wait for one.")
@click.option("--advance", is_flag=True, help="Begin ahead by the delay: nothing is late at constant speed.")
@click.option("--contour", is_flag=True, help="Say how far the path of all columns leaves its curve.")
@click.option("--figure", type=click.Path(path_type=Path), metavar="FIGURE", help="Draw that: .svg, .png or .pdf.")
@sample_rate_option()
def command(
    shaper: Path,
    command_file: Path,
    out: Path,
    columns: tuple[str, ...],
    own_delays: bool,
    advance: bool,
    contour: bool,
    figure: Path | None,
    sample_rate: float | None,
) -> None:
    """Shape every column of COMMAND.csv: a time column [s] and one column an axis, or columns and --sample-rate.

    \b
    preshape shape x.json part.csv --column y=y.json --advance --contour --out shaped.csv
    """
    from preshape.shaper import Shaper
    from preshape.workflow import shape_file

    named = dict(_column(one) for one in columns)
    if len(named) < len(columns):
        raise InputError("a column was given two shapers with --column: give one.")
    done = shape_file(
        Shaper.load(shaper),
        command_file,
        out,
        columns={name: Shaper.load(path) for name, path in named.items()},
        delays="own" if own_delays else "equal",
        advance=advance,
        contour=contour,
        figure=figure,
        sample_rate=sample_rate,
    )
    click.echo(
        f"{done.path}: {len(done.channels)} column(s), {done.samples_before} samples became {done.samples_after} "
        f"at {1e3 * done.dt:g} ms"
    )
    for line in _about(done):
        click.echo(line)


def _column(text: str) -> tuple[str, Path]:
    """NAME=FILE."""
    name, equals, path = text.partition("=")
    if not (name and equals and path):
        raise InputError(f"--column {text} is not NAME=FILE: write --column y=y.json.")
    return name, Path(path)


def _about(done: ShapedFile) -> list[str]:
    """What is late, and how far the path leaves its curve."""
    late = ", ".join(
        f"{name} {1e3 * delay:.4g} ms" for name, delay in zip(done.channels, done.shaped.delays, strict=True)
    )
    lines = [f"late at constant speed: {late}"]
    if done.shaped.start < 0.0:
        lines.append(f"the shaped command begins {-1e3 * done.shaped.start:.4g} ms before the command")
    if done.contour is not None:
        error, unit = done.contour, f" {done.unit}".rstrip()
        place = ", ".join(f"{name} {value:.6g}" for name, value in zip(done.channels, error.place, strict=True))
        lines.append(
            f"contour error at the samples at most {error.largest:.3g}{unit}, at {place}; between them at most "
            f"{error.bound:.3g}{unit}; RMS {error.rms:.3g}{unit}"
        )
    return [*lines, *([f"Figure: {done.figure}"] if done.figure else [])]
