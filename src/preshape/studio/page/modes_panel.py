"""The modes as a table to edit, and the place where a measurement is dropped."""

from __future__ import annotations

from html import escape

from preshape.mode import Mode
from preshape.studio.page.edits import shown
from preshape.studio.page.fields import bare_number, button, for_reader
from preshape.workflow.workbench import MOST_MODES, Measured, Workbench

__all__ = ["drop_zone", "modes_panel"]


def modes_panel(workbench: Workbench) -> str:
    """The table; its trouble places stand below their fields."""
    several = len(workbench.modes) > 1
    rows = "".join(_row(index, mode, several) for index, mode in enumerate(workbench.modes))
    more = button("add-mode", "add-mode", "+ mode", enabled=len(workbench.modes) < MOST_MODES)
    return (
        f'<div class="row"><h2 id="modes-title">Modes</h2>{more}</div>'
        '<table class="modes" aria-labelledby="modes-title"><thead><tr>'
        f'<th scope="col">{for_reader("Number")}</th>'
        '<th scope="col">frequency [Hz]</th><th scope="col">damping [-]</th>'
        f'<th scope="col">{for_reader("Delete")}</th></tr></thead><tbody>{rows}</tbody></table>'
    )


def _row(index: int, mode: Mode, several: bool) -> str:
    number = index + 1
    frequency = bare_number(
        f"mode.{index}.frequency", shown(mode.frequency), f"Mode {number}, natural frequency in hertz"
    )
    damping = bare_number(f"mode.{index}.damping", shown(mode.damping), f"Mode {number}, damping ratio", "ratio")
    delete = button(
        f"delete-{index}", f"delete-mode {index}", "✕", enabled=several, kind="plain", label=f"Delete mode {number}"
    )
    return f"<tr><td>{number}</td><td>{frequency}</td><td>{damping}</td><td>{delete}</td></tr>"


def drop_zone(measured: Measured | None, address: str, most: int, trouble: str = "") -> str:
    """What was dropped and what was found in it, or the invitation."""
    note, found = "Drop a measurement file anywhere, or choose one.", ""
    if measured is not None:
        note = f"{measured.name} ({measured.format})"
        found = _found(measured)
        trouble = " ".join(measured.trouble) or trouble
    forget = button("forget", "forget", "Remove") if measured is not None else ""
    return (
        f'<div class="drop" id="drop" data-address="{escape(address)}" data-most="{most}">'
        f'<div class="row"><label class="file-button" for="measurement-file">Measurement …</label>'
        '<input type="file" class="for-reader" id="measurement-file" aria-describedby="drop-note drop-trouble">'
        f"{forget}</div>"
        f'<p class="hint" id="drop-note" role="status">{escape(note)}</p>{found}'
        f'<p class="trouble" id="drop-trouble" role="alert">{escape(trouble)}</p></div>'
    )


def _found(measured: Measured) -> str:
    """Each mode with its 95 % interval."""
    if not measured.modes:
        return '<p class="hint">No mode was found in it.</p>'
    parts = []
    for one in measured.modes:
        low, high = one.frequency_interval
        parts.append(f"{one.mode.frequency:.4g} Hz ({low:.4g} to {high:.4g}), damping {one.mode.damping:.3g}")
    doubt = "" if measured.clear else " They are not to be trusted; look at the spectrum."
    return (
        f'<p class="hint">Found, with 95 % intervals: {escape("; ".join(parts))}.{doubt}</p>'
        f'<div class="row">{button("take", "take", "Take these modes")}</div>'
    )
