"""`preshape rerun REPORT --out DIR`"""

from __future__ import annotations

from pathlib import Path

import click

from preshape.cli.options import typed

__all__ = ["command"]


@click.command("rerun")
@click.argument("report", type=click.Path(path_type=Path), metavar="REPORT")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    required=True,
    metavar="DIR",
    help="Folder for what comes out, and for the inputs that are in the report.",
)
@click.option(
    "--input",
    "inputs",
    type=click.Path(path_type=Path),
    multiple=True,
    metavar="FILE",
    help="An input that was too large to travel in the report; known by its SHA-256.",
)
@click.pass_context
def command(context: click.Context, report: Path, out: Path, inputs: tuple[Path, ...]) -> None:
    """Run again what a report was made from, and compare the shaper bit by bit.

    REPORT is a report.html or report.pdf of preshape calibrate or preshape design. Its inputs are taken out of it and
    checked, its options are read as data, and everything is computed anew. The exit code is 0 when the shaper is the
    same, 1 when it is not or the page was changed.

    \b
    preshape rerun report.html --out again
    """
    from preshape.cli.rerun_screen import rerun_screen
    from preshape.cli.screens import console
    from preshape.workflow import rerun

    with console(stderr=True).status("running it again ..."):
        result = rerun(report, out, inputs=inputs, command_line=typed(context))
    rerun_screen(result)
    context.exit(0 if result.identical and result.page is not False else 1)
