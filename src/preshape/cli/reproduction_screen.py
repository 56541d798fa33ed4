"""A reproduced paper on the terminal: five columns, and under a row, across the whole width, why it differs."""

from __future__ import annotations

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from preshape.cli.screens import console
from preshape.papers import Reproduction, Row, summary

__all__ = ["reproduction_screen"]

VERDICT_WIDTH, GAP = 10, 2

SHARES = (0.165, 0.355, 0.22, 0.26)
"""Of the width that the verdict leaves: where, what, printed, computed."""

STYLES = {"reproduced": "green", "differs": "yellow", "beyond the paper": "cyan"}


def reproduction_screen(reproduction: Reproduction) -> None:
    """Title, one entry a row, and the count of verdicts."""
    screen = console()
    screen.print(Text(f"\n{reproduction.title}", style="bold"))
    screen.print()
    screen.print(_line(screen.width, ["where", "what", "printed", "computed", "verdict"], "bold", "bold"))
    screen.print(Text("-" * screen.width, style="dim"))
    for row in reproduction.rows:
        style = STYLES[row.verdict] if row.explained else "bold red"
        cells = [row.source, row.what, row.printed, row.computed, row.verdict]
        screen.print(_line(screen.width, cells, "", style))
        if row.explanation or not row.explained:
            screen.print(Padding(Text(_why(row), style="dim" if row.explained else "bold red"), (0, 0, 0, 4)))
    screen.print()
    screen.print(Text(f"{reproduction.paper}: {summary(reproduction)}", style="bold"))


def _why(row: Row) -> str:
    return f"> {row.explanation}" if row.explanation else "> NOT EXPLAINED"


def _line(width: int, cells: list[str], style: str, verdict_style: str) -> Table:
    line = Table.grid(padding=(0, GAP, 0, 0))
    room = width - VERDICT_WIDTH - len(SHARES) * GAP
    for share in SHARES:
        line.add_column(width=int(share * room), style=style, overflow="fold")
    line.add_column(width=VERDICT_WIDTH, style=verdict_style)
    line.add_row(*(Text(cell) for cell in cells))
    return line
