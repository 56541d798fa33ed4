"""`preshape reproduce [PAPER ...]`"""

from __future__ import annotations

import click

__all__ = ["command"]

DEFAULT_FOLDER = "\0"
"""Stands for --out without a folder."""


@click.command("reproduce")
@click.argument("names", nargs=-1, metavar="[PAPER]...")
@click.option(
    "--out",
    is_flag=False,
    flag_value=DEFAULT_FOLDER,
    metavar="[DIR]",
    help="Draw the figures as SVG and a page with table and figures, in this folder.  [DIR if left out: "
    "reproduction-PAPER]",
)
@click.pass_context
def command(context: click.Context, names: tuple[str, ...], out: str | None) -> None:
    """Recompute what the papers print: printed and computed value, verdict, and why where they differ.

    PAPER is hyde, singer, singh, slides or robertson; all of them unless named. The exit code is 0 when every
    difference has its explanation, 1 when one has not.

    \b
    preshape reproduce hyde
    preshape reproduce singer singh --out my-folder
    preshape reproduce hyde --out
    """
    from preshape.cli.reproduction_screen import reproduction_screen
    from preshape.cli.screens import console
    from preshape.papers import papers_named, save_reproductions

    papers = papers_named(names)
    progress, done = console(stderr=True), []
    for paper in papers:
        with progress.status(f"{paper.name}: computing ..."):
            done.append(paper.reproduce())
        reproduction_screen(done[-1])
    if out is None:
        click.echo("No figure was drawn; --out [DIR] draws them, and a page of table and figures.")
    else:
        folder = "-".join(["reproduction", *dict.fromkeys(names)]) if out == DEFAULT_FOLDER else out
        with progress.status("drawing ...") as status:
            page = save_reproductions(done, folder, status.update)
        click.echo(f"Page: {page}\nFigures: {sum(len(one.figures) for one in done)} SVG files beside it")
    unexplained = [row for one in done for row in one.rows if not row.explained]
    if unexplained:
        click.echo(f"{len(unexplained)} difference(s) without an explanation.", err=True)
    context.exit(1 if unexplained else 0)
