"""`preshape shape SHAPER.json COMMAND.csv --out OUT.csv`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.cli.options import sample_rate_option

__all__ = ["command"]


@click.command("shape")
@click.argument("shaper", type=click.Path(path_type=Path), metavar="SHAPER.json")
@click.argument("command_file", type=click.Path(path_type=Path), metavar="COMMAND.csv")
@click.option(
    "--out", type=click.Path(path_type=Path), required=True, metavar="OUT.csv", help="Where the shaped command goes."
)
@sample_rate_option()
def command(shaper: Path, command_file: Path, out: Path, sample_rate: float | None) -> None:
    """Shape every column of COMMAND.csv: a time column [s] and one column an axis, or columns and --sample-rate."""
    from preshape.shaper import Shaper
    from preshape.workflow import shape_file

    done = shape_file(Shaper.load(shaper), command_file, out, sample_rate=sample_rate)
    click.echo(
        f"{done.path}: {len(done.channels)} column(s), {done.samples_before} samples became {done.samples_after} "
        f"at {1e3 * done.dt:g} ms"
    )
