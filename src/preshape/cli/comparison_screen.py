"""A comparison on the terminal: the point first, the table, what must be known, and what could not be made."""

from __future__ import annotations

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from preshape.cli.screens import console
from preshape.report import Comparison, comparison_sentences, comparison_table, move_sentence, table_sentence

__all__ = ["comparison_screen"]


def comparison_screen(comparison: Comparison) -> None:
    """Sentences, the contenders with the two best marked, notes, and the rest with reasons."""
    screen = console()
    screen.print(move_sentence(comparison))
    first, robust = comparison_sentences(comparison)
    screen.print(Text(first, style="bold cyan"))
    screen.print(Text(robust, style="bold green"))
    screen.print()
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
    texts = comparison_table(comparison)
    for number, lines in enumerate(texts.titles):
        table.add_column("\n".join(lines), justify="right" if number else "left", no_wrap=True)
    for contender, row in zip(comparison.contenders, texts.rows, strict=True):
        style = None
        if contender is comparison.first_robust:
            style = "bold green"
        elif contender is comparison.first_to_settle:
            style = "bold cyan"
        table.add_row(*row, style=style)
    screen.print(table)
    screen.print(Text(table_sentence(comparison), style="dim"))
    notes = [(one.name, one.note) for one in comparison.contenders if one.note]
    _listed("Notes", notes)
    _listed("Left out", [(one.name, one.reason) for one in comparison.left_out])


def _listed(title: str, rows: list[tuple[str, str]]) -> None:
    """Names and what is said of them; names of which the same is said share a line."""
    if not rows:
        return
    screen = console()
    grouped: dict[str, list[str]] = {}
    for name, text in rows:
        grouped.setdefault(text, []).append(name)
    screen.print(Text(f"\n{title}", style="bold"))
    for text, names in grouped.items():
        screen.print(Padding(Text(f"{', '.join(names)}: {text}"), (0, 0, 0, 2)))
