"""`preshape export TARGET SHAPER.json [--rate HZ] --out FOLDER`"""

from __future__ import annotations

from pathlib import Path

import click

__all__ = ["command"]


def _show_targets(ctx: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value and not ctx.resilient_parsing:
        from preshape.cli.export_screen import target_table

        target_table()
        ctx.exit()


@click.command("export")
@click.option(
    "--list", is_flag=True, is_eager=True, expose_value=False, callback=_show_targets, help="Show the targets."
)
@click.argument("target", metavar="TARGET")
@click.argument("shaper", type=click.Path(path_type=Path), metavar="SHAPER.json")
@click.option(
    "--rate", type=float, metavar="HZ", help="Samples per second of the controller, for a target that works on samples."
)
@click.option(
    "--axis", type=click.Choice(["x", "y", "z"]), help="For a target with settings for each.  [default: x and y alike]"
)
@click.option(
    "--out", type=click.Path(file_okay=False, path_type=Path), required=True, metavar="FOLDER", help="Where to."
)
@click.option(
    "--name", default="shaper", show_default=True, metavar="NAME", help="Of files and identifiers, such as gantry_x."
)
@click.option("--target-version", metavar="VERSION", help="Of the target, as --list shows.  [default: its first]")
@click.option("--precision", metavar="PRECISION", help="double or single, as --list shows.  [default: its first]")
@click.option(
    "--grid",
    metavar="METHOD",
    help="How impulses between samples are placed: exact, linear, nearest or optimised.  [default: exact, or linear "
    "for a shaper that does not know its modes]",
)
@click.option("--force", is_flag=True, help="Replace files that are there and are not of an export.")
def command(
    target: str,
    shaper: Path,
    rate: float | None,
    axis: str | None,
    out: Path,
    name: str,
    target_version: str | None,
    precision: str | None,
    grid: str | None,
    force: bool,
) -> None:
    """Write a shaper for somebody else's controller; `preshape export --list` shows which.

    An export replaces an earlier one in the same folder, but never a file that was changed since, or that was not its.

    \b
    preshape export c shaper.json --rate 1000 --out firmware --name gantry_x
    preshape export c shaper.json --rate 1000 --out firmware --precision single
    preshape export linuxcnc shaper.json --rate 1000 --out hal --target-version master
    preshape export klipper shaper.json --axis x --out printer
    preshape export rrf shaper.json --out printer --target-version 3.5
    """
    from preshape.checks import positive
    from preshape.cli.export_screen import export_screen
    from preshape.export import render
    from preshape.shaper import Shaper
    from preshape.workflow import save_export

    dt = None if rate is None else 1.0 / positive("--rate", rate, "Hz")
    exported = render(
        Shaper.load(shaper), target, dt=dt, name=name, version=target_version, precision=precision, grid=grid, axis=axis
    )
    export_screen(exported, save_export(exported, out, force=force))
