"""An export on the terminal: what was written, what the controller will do, what comes next; and all the targets."""

from __future__ import annotations

from rich.table import Table
from rich.text import Text

from preshape.cli.screens import console
from preshape.export import TARGETS, AnyTarget, Exported, ExportedSettings
from preshape.workflow import SavedExport

__all__ = ["export_screen", "held_by", "target_table"]


def target_table() -> None:
    """Every target with its versions and limits."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), show_header=False)
    for target in TARGETS.values():
        table.add_row(Text(target.name, style="bold cyan"), target.summary)
        for versions, held in _held(target).items():
            table.add_row("", Text(f"version {versions}: {held}", style="dim"))
    screen = console()
    screen.print(table)
    screen.print(
        "\nThe first version and precision named are the defaults; --target-version and --precision choose others. "
        "Targets that hold taps need --rate."
    )


def held_by(target: AnyTarget) -> str:
    """What a target holds; where versions differ, each of them."""
    held = _held(target)
    if len(held) == 1:
        return next(iter(held.values()))
    return "; ".join(f"{versions}: {each}" for versions, each in held.items())


def _held(target: AnyTarget) -> dict[str, str]:
    """What the versions hold, those that hold the same together."""
    alike: dict[str, list[str]] = {}
    for version in target.versions:
        alike.setdefault(str(target.limits_of(version)), []).append(version)
    return {", ".join(versions): held for held, versions in alike.items()}


def export_screen(exported: Exported | ExportedSettings, saved: SavedExport) -> None:
    """The files, the shaper as the controller runs it, the next step."""
    if isinstance(exported, Exported):
        _samples_screen(exported, saved)
    else:
        _settings_screen(exported, saved)


def _settings_screen(exported: ExportedSettings, saved: SavedExport) -> None:
    """The files, what the controller executes and leaves, beside what was asked for."""
    screen = console()
    placed = exported.placed
    axes = f", {' and '.join(placed.axes)}" if placed.axes else ""
    heading = f"{placed.name}: {placed.asked.design.family}, target {exported.target.name} ({placed.version}){axes}"
    screen.print(Text(heading, style="bold"))
    for path in saved.files:
        screen.print(f"  {path}", soft_wrap=True)
    for note in placed.notes:
        screen.print(note)
    does = placed.shaper
    screen.print(f"\nIt executes {does.design.family}: {does.parts} in {1e3 * does.duration:.6g} ms.")
    if placed.asked.design.modes is None:
        screen.print("what it leaves of the vibration is not known: the shaper's file does not say its modes")
    else:
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
        for title in ("mode", "it leaves", "the shaper leaves"):
            table.add_column(title, justify="left" if title == "mode" else "right")
        for mode, (left, asked) in zip(placed.asked.design.modes, placed.residuals, strict=True):
            table.add_row(str(mode), f"{100.0 * left:.2g} %", f"{100.0 * asked:.2g} %")
        screen.print(table)
    screen.print()
    for line in exported.target.next_step(placed):
        screen.print(line, soft_wrap=True)


def _samples_screen(exported: Exported, saved: SavedExport) -> None:
    """The files, the shaper on the controller's grid, the next step."""
    screen = console()
    placed, design = exported.placed, exported.placed.shaper.design
    screen.print(
        Text(f"{placed.name}: {design.family}, target {exported.target.name} ({placed.version})", style="bold")
    )
    for path in saved.files:
        screen.print(f"  {path}", soft_wrap=True)
    screen.print(
        f"\n{placed.delays.size} taps every {1e3 * placed.dt:.6g} ms, {placed.precision} precision; latency "
        f"{placed.latency_samples} samples = {1e3 * placed.latency:.6g} ms"
    )
    if design.modes is None:
        screen.print("what it leaves of the vibration is not known: the shaper's file does not say its modes")
    else:
        table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
        for title in ("mode", "vibration left", "samples a period"):
            table.add_column(title, justify="left" if title == "mode" else "right")
        left, each = design.settings["residuals"], design.settings["samples_per_period"]
        for mode, residual, samples in zip(design.modes, left, each, strict=True):
            table.add_row(str(mode), f"{100.0 * residual:.2g} %", f"{samples:.4g}")
        screen.print(table)
    if (placed.weights < 0.0).any():
        screen.print(Text("! some taps are negative: the shaped command may exceed the command", style="bold yellow"))
    for note in exported.notes:
        screen.print(Text(f"! {note}", style="bold yellow"))
    screen.print()
    for line in exported.target.next_step(placed):
        screen.print(line, soft_wrap=True)
