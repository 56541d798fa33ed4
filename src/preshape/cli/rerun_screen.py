"""What the terminal shows of a report that was run again."""

from __future__ import annotations

from rich.text import Text

from preshape.cli.screens import console
from preshape.report import GivenJob, printable
from preshape.workflow import Rerun

__all__ = ["rerun_screen"]


def rerun_screen(result: Rerun) -> None:
    """Whether the shaper and the page are the same, and what else has changed."""
    screen = console()
    record = result.record
    screen.print(f"Made {record.made} by preshape {printable(record.versions['preshape'])}")
    for one in record.inputs:
        screen.print(f"Input: {one.name}, {one.size} bytes, SHA-256 as recorded", soft_wrap=True)
    if isinstance(record.job, GivenJob):
        screen.print(Text("Nothing to run again: the shaper was handed over without its options.", style="bold"))
    else:
        screen.print(Text(_shapers(result), style="bold" if result.identical else "bold yellow"))
        screen.print(_page(result))
    for name, then, now in result.versions:
        screen.print(f"{name}: {then} then, {now} now", soft_wrap=True)
    screen.print(f"Written to: {result.folder}", soft_wrap=True)


def _shapers(result: Rerun) -> str:
    if result.identical:
        return f"The shaper is identical to the last bit: {result.shaper.parts}."
    if result.difference is None:
        then = result.record.found().parts
        return f"The shaper is another one: {then} then, {result.shaper.parts} now."
    times, amplitudes = result.difference
    if times == amplitudes == 0.0:
        return "The impulses are identical to the last bit, but not what is recorded of where they come from."
    return f"The shaper differs: times by up to {times:.2g} of its duration, amplitudes by up to {amplitudes:.2g}."


def _page(result: Rerun) -> str:
    if result.page is None:
        return "Whether the page was changed cannot be told with other versions than it was written by."
    if result.page:
        return "The page is, byte for byte, what preshape writes of it."
    return "The page is not what preshape writes of it: it was changed."
