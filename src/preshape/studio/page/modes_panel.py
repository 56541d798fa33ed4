"""The modes as a table to edit, and the place where a measurement is dropped."""

from __future__ import annotations

from html import escape

from preshape.studio.page.edits import shown
from preshape.studio.page.fields import bare_number
from preshape.workflow.workbench import MOST_MODES, Measured, Workbench

__all__ = ["drop_zone", "modes_panel"]


def modes_panel(workbench: Workbench) -> str:
    """The table; its trouble places stand below their fields."""
    only = len(workbench.modes) == 1
    rows = "".join(
        f"<tr><td>{index + 1}</td>"
        f"<td>{bare_number(f'mode.{index}.frequency', shown(mode.frequency), f'Mode {index + 1}, natural frequency in hertz')}</td>"
        f"<td>{bare_number(f'mode.{index}.damping', shown(mode.damping), f'Mode {index + 1}, damping ratio', 'ratio')}</td>"
        f'<td><button type="button" class="plain" id="delete-{index}" data-do="delete-mode {index}" '
        f'aria-label="Delete mode {index + 1}" aria-disabled="{str(only).lower()}">✕</button></td></tr>'
        for index, mode in enumerate(workbench.modes)
    )
    full = len(workbench.modes) >= MOST_MODES
    return (
        '<div class="row"><h2 id="modes-title">Modes</h2>'
        f'<button type="button" id="add-mode" data-do="add-mode" aria-disabled="{str(full).lower()}">+ mode</button></div>'
        '<table class="modes" aria-labelledby="modes-title"><thead><tr><th scope="col"><span class="for-reader">Number</span></th>'
        '<th scope="col">frequency [Hz]</th><th scope="col">damping [-]</th>'
        f'<th scope="col"><span class="for-reader">Delete</span></th></tr></thead><tbody>{rows}</tbody></table>'
    )


def drop_zone(measured: Measured | None, address: str, most: int, trouble: str = "") -> str:
    """What was dropped and what was found in it, or the invitation."""
    note, found = "Drop a measurement file anywhere, or choose one.", ""
    if measured is not None:
        note = f"{measured.name} ({measured.format})"
        found = _found(measured)
        trouble = " ".join(measured.trouble) or trouble
    forget = '<button type="button" id="forget" data-do="forget">Remove</button>' if measured is not None else ""
    return (
        f'<div class="drop" id="drop" data-address="{escape(address)}" data-most="{most}">'
        f'<div class="row"><label class="file-button" for="measurement-file">Measurement …</label>'
        f'<input type="file" class="for-reader" id="measurement-file" aria-describedby="drop-note drop-trouble">{forget}</div>'
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
        '<div class="row"><button type="button" id="take" data-do="take">Take these modes</button></div>'
    )
