"""A campaign on the terminal: a bar while it runs, then its numbers, what failed, and where the files are."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from preshape.campaign import CampaignRun
from preshape.campaign.run import Progress as Tell
from preshape.cli.screens import console

__all__ = ["campaign_screen", "point_bar"]

SHOWN_FAILURES = 5
"""Different sentences that are shown; all are in the results."""


@contextmanager
def point_bar() -> Iterator[Tell]:
    """A bar on standard error for as long as this lasts, where that is a terminal; gives what to tell it.

    When the run is interrupted, it is said how much is kept.
    """
    screen, latest = console(stderr=True), (0, 0, 0)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[failed]}"),
    )
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as bar:
        task = bar.add_task("Points", total=None, failed="")

        def tell(done: int, failed: int, points: int) -> None:
            nonlocal latest
            latest = (done, failed, points)
            bar.update(task, completed=done + failed, total=points, failed=f"{failed} failed" if failed else "")

        try:
            yield tell
        except KeyboardInterrupt:
            if latest[2]:
                screen.print(f"{latest[0]} of {latest[2]} points are kept; the same command goes on.")
            raise


def campaign_screen(run: CampaignRun) -> None:
    """How far it is, the numbers, failures and notes, files."""
    screen, summary = console(), run.summary
    screen.print(Text(summary.sentence, style="bold"))
    if run.kept:
        screen.print(f"{run.kept} of them are from an earlier run.")
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), show_header=False)
    for _ in range(2):
        table.add_column(no_wrap=True)
    for row in summary.numbers:
        table.add_row(*row)
    screen.print(table)
    for sentence, count in summary.failures[:SHOWN_FAILURES]:
        screen.print(Text(f"! {count} failed: {sentence}", style="bold yellow"))
    if len(summary.failures) > SHOWN_FAILURES:
        screen.print(Text(f"! and {len(summary.failures) - SHOWN_FAILURES} other reasons, see the results"))
    for note in summary.notes:
        screen.print(Text(f"! {note}", style="bold yellow"))
    for path in run.files:
        screen.print(f"Written: {path}")
