"""Every way out: a target, what it holds, its text, and the file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from html import escape
from typing import Any

from preshape.errors import InputError
from preshape.studio.page import fields
from preshape.studio.page.edits import shown
from preshape.workflow.workbench import ExportTarget, Package, Workbench, export_targets, packaged, shaper_named

__all__ = ["ExportChoice", "export_panel", "export_preview", "export_shape", "packaged_for"]

LONGEST_PREVIEW = 12_000
"""Characters of a file that are shown; the download holds all."""


@dataclass(frozen=True)
class ExportChoice:
    """What is exported, and how.

    Parameters
    ----------
    design : str
        Name of the design.
    target, version, precision, axis : str
        As :func:`preshape.workflow.workbench.packaged` takes them; empty for the target's default.
    rate : float
        Samples per second [Hz].
    name : str
        What the shaper is called in the files.
    """

    design: str = "A"
    target: str = "klipper"
    version: str = ""
    precision: str = ""
    axis: str = ""
    rate: float = 1000.0
    name: str = "shaper"

    def changed(self, part: str, text: str) -> ExportChoice:
        """With one part changed; InputError if it is not what the part takes."""
        value: Any = text.strip()
        if part == "rate":
            try:
                value = float(value.replace(",", ".", 1))
            except ValueError:
                raise InputError(f"{text[:30]!r} is not a number: write the sample rate as 1000.") from None
        if part == "target":
            return replace(self, target=value, version="", precision="", axis="")
        if part not in ("design", "version", "precision", "axis", "rate", "name"):
            raise InputError(f"there is no field {part[:30]!r}: reload the page.")
        return replace(self, **{part: value})


def packaged_for(workbench: Workbench, choice: ExportChoice) -> Package:
    """The files; InputError with the sentence that belongs in their place."""
    target = _target(choice.target)
    return packaged(
        shaper_named(workbench, choice.design),
        choice.target,
        rate=choice.rate if target.sampled else None,
        name=choice.name,
        version=choice.version or None,
        precision=choice.precision or None,
        axis=choice.axis or None,
    )


def export_shape(workbench: Workbench, choice: ExportChoice) -> tuple[object, ...]:
    """What the panel's form depends on."""
    return (
        choice.target,
        choice.version,
        tuple((design.name, design.family) for design in workbench.designs),
        choice.design,
    )


def export_panel(workbench: Workbench, choice: ExportChoice) -> str:
    """The fields; the preview is a panel of its own."""
    target = _target(choice.target)
    designs = [(design.name, f"{design.name}: {design.family}") for design in workbench.designs]
    targets = [(one.name, one.name) for one in export_targets()]
    rows = [
        fields.choice("export.target", choice.target, "Target", targets, tall=True),
        fields.choice("export.design", choice.design, "Design", designs, tall=True),
    ]
    if len(target.versions) > 1:
        rows.append(
            fields.choice(
                "export.version", choice.version, "Version", [(one, one) for one in target.versions], tall=True
            )
        )
    if target.sampled:
        rows.append(fields.number("export.rate", shown(choice.rate), "Sample rate [Hz]", tall=True))
    if len(target.precisions) > 1:
        rows.append(
            fields.choice(
                "export.precision", choice.precision, "Numbers", [(one, one) for one in target.precisions], tall=True
            )
        )
    if target.axes:
        axes = [("", "all axes"), *((one, one) for one in target.axes)]
        rows.append(fields.choice("export.axis", choice.axis, "Axis", axes, tall=True))
    rows.append(fields.text("export.name", choice.name, "Name"))
    version = choice.version or target.versions[0] if target.versions else ""
    limits = dict(zip(target.versions, target.limits, strict=False)).get(version, "")
    return (
        '<h2 id="export-title">Export</h2>'
        f'<div class="choices">{"".join(rows)}</div>'
        f'<p class="hint" id="export-limits">{escape(fields.sentence(target.summary))}. It holds: {escape(limits)}.</p>'
    )


def export_preview(package: Package | None, trouble: str) -> str:
    """The files as text, or why there are none."""
    if package is None:
        return f'<p class="trouble banner" role="alert">{escape(fields.sentence(trouble))}</p>'
    notes = "".join(f'<p class="hint">{escape(note)}</p>' for note in package.notes)
    shown_files = "".join(
        _file(index, file.name, file.text, len(file.content)) for index, file in enumerate(package.files)
    )
    steps = f'<p class="hint">{escape(" ".join(package.next_step))}</p>' if package.next_step else ""
    return (
        f'<div class="row">{fields.button("download", "download", f"Download {package.name}", kind="main")}</div>'
        f"{notes}{shown_files}{steps}"
    )


def _file(index: int, name: str, text: str, size: int) -> str:
    identity = f"export-text-{index}"
    if not text:
        return f'<p class="hint">{escape(name)}: {size} bytes, not text.</p>'
    shown_text, copy, cut = escape(text[:LONGEST_PREVIEW]), "", ""
    if len(text) > LONGEST_PREVIEW:
        told = f"Cut after {LONGEST_PREVIEW} of {len(text)} characters; the download holds all."
        cut = f'<p class="hint">{told}</p>'
    else:
        copy = f'<div class="row">{fields.button(f"copy-{index}", f"copy-text {identity}", "Copy")}</div>'
    shown = f'<pre id="{identity}" tabindex="0" role="region" aria-label="Text of {escape(name)}">{shown_text}</pre>'
    opened = " open" if index == 0 else ""
    return f'<details id="export-file-{index}"{opened}><summary>{escape(name)}</summary>{copy}{shown}{cut}</details>'


def _target(name: str) -> ExportTarget:
    for target in export_targets():
        if target.name == name:
            return target
    raise InputError(
        f"target {name[:30]!r} is not known: choose one of {', '.join(one.name for one in export_targets())}."
    )
