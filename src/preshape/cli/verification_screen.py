"""A verification on the terminal: the verdict, the modes, the residuals, what is doubtful."""

from __future__ import annotations

from rich.table import Table
from rich.text import Text

from preshape.cli.screens import console
from preshape.report import TextTable, Verification, residual_table, verification_table

__all__ = ["verification_screen"]


def verification_screen(verification: Verification) -> None:
    """Sentence, troubles, tables."""
    screen = console()
    screen.print(Text(verification.sentence, style="bold cyan"))
    for sentence in verification.trouble:
        screen.print(Text(f"! {sentence}", style="bold yellow"))
    if verification.modes:
        unit = f" [{verification.unit}]" if verification.unit else ""
        screen.print(_drawn(f"\nModes, amplitude at the stop{unit}", verification_table(verification)))
    title = f"\nRoot mean square after the stop, {verification.stretch}, below {verification.below:.3g} Hz"
    screen.print(_drawn(title, residual_table(verification)))
    if verification.floor is not None:
        screen.print(f"Noise before the move, all axes and frequencies: {verification.floor:.3g} {verification.unit}")
    stops = [
        f"{one.name} {one.stop:.4f} s" + (f" (± {1e3 * one.stop_spread:.1f} ms)" if one.stop_spread else "")
        for one in (*verification.unshaped, *verification.shaped)
    ]
    screen.print(Text(f"Stops: {'; '.join(stops)}", style="dim"))


def _drawn(title: str, table: TextTable) -> Table:
    drawn = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 1, 0, 0))
    last = len(table.titles) - 1
    for number, lines in enumerate(table.titles):
        words = lines[0] == "verdict"
        left = number == 0 or (words and number == last)
        drawn.add_column("\n".join(lines), justify="left" if left else "right", no_wrap=not words)
    for row in table.rows:
        drawn.add_row(*row)
    return drawn
