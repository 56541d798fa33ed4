"""What the buttons do, by the events they send."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import replace

from preshape.errors import InputError
from preshape.studio.page.compute import EXPORT_TIME, REPORT_TIME
from preshape.studio.page.edits import with_mode, with_more_designs, without_design, without_mode
from preshape.studio.page.export_panel import ExportChoice, packaged_for
from preshape.studio.page.session import Session
from preshape.workflow.workbench import Workbench, shaper_named

__all__ = ["DEEDS"]

Deed = Callable[..., Awaitable[None]]


async def edit(session: Session, field: str, text: str, how: str = "") -> None:
    """A field was typed into, chosen or dragged."""
    await session.edit(field, text, how)


async def undo(session: Session) -> None:
    """One step back."""
    session.step(back=True)


async def redo(session: Session) -> None:
    """One step on."""
    session.step(back=False)


async def dropped(session: Session, _handle: str) -> None:
    """A handle was let go."""
    session.release()


async def measured(session: Session, key: str) -> None:
    """A measurement has come."""
    session.take_measurement(key)


async def take(session: Session) -> None:
    """Take the measured modes."""
    session.take_modes()


async def forget(session: Session) -> None:
    """Remove the measurement."""
    session.show_measurement("")


async def add_mode(session: Session) -> None:
    """One mode more."""
    session.become(with_mode(session.workbench), forced=True)


async def delete_mode(session: Session, index: str) -> None:
    """One mode less."""
    session.become(without_mode(session.workbench, int(index)), forced=True)


async def show_design(session: Session, name: str) -> None:
    """Bring a design to the front."""
    session.show_design(name)


async def add_design(session: Session) -> None:
    """One design more, like the active one."""
    new, session.active = with_more_designs(session.workbench, session.active)
    session.become(new, forced=True)


async def remove_design(session: Session) -> None:
    """Without the active design."""
    session.become(without_design(session.workbench, session.active), forced=True)


async def download(session: Session) -> None:
    """The export's file."""
    from nicegui import ui

    package = await session.shared.compute.run(EXPORT_TIME, packaged_for, session.workbench, session.export)
    ui.download.content(package.content, package.name)


async def report(session: Session, kind: str) -> None:
    """The report of the active design, as HTML or PDF."""
    from nicegui import ui

    if kind not in ("html", "pdf"):
        raise InputError(f"a report is html or pdf, not {kind[:10]!r}.")
    session.say({"say": "The report is being written …"})
    content = await session.shared.compute.run(
        REPORT_TIME, _reported, session.workbench, session.active, session.export, kind
    )
    ui.download.content(content, f"preshape_report_{session.active}.{kind}")


def _reported(workbench: Workbench, name: str, choice: ExportChoice, kind: str) -> bytes:
    """The report as bytes, with the export that is in front."""
    from preshape.report import as_html, as_pdf
    from preshape.workflow import design_report

    try:
        package = packaged_for(workbench, replace(choice, design=name))
        exports = [(f"{choice.target}: {file.name}", file.text) for file in package.files if file.text]
    except InputError:
        exports = []
    document = design_report(workbench.modes, shaper_named(workbench, name), exports=exports)
    return as_pdf(document) if kind == "pdf" else as_html(document).encode()


DEEDS: Mapping[str, Deed] = {
    "edit": edit,
    "undo": undo,
    "redo": redo,
    "dropped": dropped,
    "measured": measured,
    "take": take,
    "forget": forget,
    "add-mode": add_mode,
    "delete-mode": delete_mode,
    "show-design": show_design,
    "add-design": add_design,
    "remove-design": remove_design,
    "download": download,
    "report": report,
}
