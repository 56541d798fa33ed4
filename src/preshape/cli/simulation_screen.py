"""A simulation on the terminal: what is left of the vibration of every output, and a bar while it runs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from preshape.cli.screens import console
from preshape.plant.protocol import Progress as Tell
from preshape.report import ShapedSimulation

__all__ = ["progress_bar", "simulation_screen"]


@contextmanager
def progress_bar(what: str) -> Iterator[Tell]:
    """A bar on standard error for as long as this lasts, where that is a terminal; gives what to tell it."""
    screen = console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn())
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as bar:
        task = bar.add_task(what, total=1.0)
        yield lambda done: bar.update(task, completed=done)


def simulation_screen(result: ShapedSimulation) -> None:
    """A table with two rows an output, and notes."""
    screen = console()
    screen.print(
        f"Command: {result.command_end:.4g} s, shaped {result.shaped_end:.4g} s; simulated "
        f"{result.unshaped.times[-1]:.4g} s at {1e3 * result.dt:g} ms. Modes: {'; '.join(map(str, result.modes))}."
    )
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for title in ("output", "", "vibration left", "of it", "peak", "settled [s]"):
        table.add_column(title, justify="left" if title in ("output", "") else "right", no_wrap=True)
    for name, motions in result.motions.items():
        unit = result.unshaped.units[name]
        for kind, motion in zip(("unshaped", "shaped"), motions, strict=True):
            share = result.remaining(name)
            table.add_row(
                name if kind == "unshaped" else "",
                kind,
                f"{motion.residual:.4g} {unit}".rstrip(),
                f"{100.0 * share:.3g} %" if kind == "shaped" and np.isfinite(share) else "",
                f"{motion.peak:.4g} {unit}".rstrip(),
                f"{motion.settling_time:.4g}" if np.isfinite(motion.settling_time) else "not yet",
                style="bold cyan" if kind == "shaped" else None,
            )
    screen.print(table)
    for note in result.notes:
        screen.print(Text(f"! {note}", style="bold yellow"))
