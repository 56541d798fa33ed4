"""Up to four designs as tabs: each with its family and what the family takes."""

from __future__ import annotations

import re
from html import escape

from preshape.design import ASKED_FAMILIES, OPTIONS, needed_by, taken_by
from preshape.studio.page import fields
from preshape.studio.page.edits import fields_of
from preshape.workflow.workbench import DESIGN_NAMES, AskedDesign, Workbench

__all__ = ["design_shape", "designs_panel", "legend", "line_sample"]

FAMILY_WORDS = {
    "zv": "ZV: zero vibration",
    "zvd": "ZVD: and its derivative",
    "zvdd": "ZVDD: and its second derivative",
    "zvdk": "ZVD of order k",
    "mzv": "MZV: modified ZV (Klipper)",
    "ei": "EI: extra insensitive",
    "two_hump_ei": "EI with two humps",
    "three_hump_ei": "EI with three humps",
    "k_hump_ei": "EI with k humps",
    "um_zv": "UM-ZV: unit magnitude, negative",
    "um_zvd": "UM-ZVD: unit magnitude, negative",
    "um_ei": "UM-EI: unit magnitude, negative",
    "ps_zv": "PS-ZV: partial sums, negative",
    "ps_zvd": "PS-ZVD: partial sums, negative",
    "sna_zv": "SNA-ZV: small negative impulse",
    "sd_zv": "SD-ZV: less deflection",
    "direct": "Direct: shortest for all modes",
    "convolved": "Convolved: one shaper a mode",
    "antiperiod": "Antiperiod: harmonic modes",
    "mesh": "Mesh: on the servo's grid",
    "si": "SI: bounded over bands",
}

OPTION_WORDS = {
    "dt": "Sample time [s]",
    "duration": "Longest duration [s]",
    "tolerance": "Vibration tolerated [-]",
    "damping": "Damping ratio [-]",
    "deflection_ratio": "Deflection ratio [-]",
    "at_most": "Most impulses",
    "fewest": "Fewest impulses",
}

OTHER_FAMILIES = re.compile(r" \((?:(?:[a-z_]+|EI)(?:, )?)+\)")
"""Where an option's summary says which families take it: here it stands at one of them."""

DEFAULT = re.compile(r"\s*\[default: ([^\]]+)\]")

DASHES = {"A": "", "B": "7 3", "C": "2 3", "D": "9 3 2 3", "unshaped": ""}


def line_sample(name: str) -> str:
    """How a design is drawn: colour and dashes."""
    colour, width = name.lower(), 1.4 if name == "unshaped" else 2.4
    return (
        f'<svg class="line-sample" viewBox="0 0 30 10" aria-hidden="true"><line x1="0" y1="5" x2="30" y2="5" '
        f'style="stroke:var(--{colour})" stroke-width="{width}" stroke-dasharray="{DASHES[name]}"/></svg>'
    )


def legend(workbench: Workbench) -> str:
    """One for all charts."""
    rows = [("unshaped", "unshaped")]
    rows += [(design.name, f"{design.name}: {design.family}") for design in workbench.designs]
    return "".join(f"<span>{line_sample(name)}{escape(words)}</span>" for name, words in rows)


def design_shape(workbench: Workbench, active: str) -> tuple[object, ...]:
    """What the panel's form depends on; the values in the fields do not count."""
    design = _active(workbench, active)
    names = tuple((one.name, one.family) for one in workbench.designs)
    return active, names, dict(design.options).get("base"), bool(design.bands)


def designs_panel(workbench: Workbench, active: str) -> str:
    """The tabs, and the fields of the active design."""
    design = _active(workbench, active)
    tabs = "".join(
        f'<button type="button" role="tab" id="tab-{one.name}" aria-selected="{str(one is design).lower()}" '
        f'aria-controls="design-fields" tabindex="{0 if one is design else -1}" data-do="show-design {one.name}">'
        f"{one.name} {line_sample(one.name)}</button>"
        for one in workbench.designs
    )
    more = fields.button("add-design", "add-design", "+ design", enabled=len(workbench.designs) < len(DESIGN_NAMES))
    less = fields.button("remove-design", "remove-design", f"Remove {design.name}", enabled=len(workbench.designs) > 1)
    return (
        f'<div class="row"><h2>Designs</h2>{more}{less}</div>'
        f'<div class="tabs" role="tablist" aria-label="Designs">{tabs}</div>'
        f'<div role="tabpanel" id="design-fields" aria-labelledby="tab-{design.name}">'
        f'<p class="trouble" role="status" data-error="design.{design.name}"></p>{_fields(workbench, design)}</div>'
    )


def _fields(workbench: Workbench, design: AskedDesign) -> str:
    texts, start = fields_of(workbench), f"design.{design.name}"
    words = [(name, FAMILY_WORDS.get(name, name)) for name in ASKED_FAMILIES]
    shown = [fields.choice(f"{start}.family", design.family, "Family", words, tall=True)]
    wishes = dict(design.options)
    taken, needed = taken_by(design.family, wishes), needed_by(design.family, wishes)
    if design.family == "si":
        shown.append(
            fields.text(
                f"{start}.bands",
                texts[f"{start}.bands"],
                "Bands [Hz]",
                none="8:12, 30:34",
                hint="Empty: one around each mode, as wide as the next field says.",
            )
        )
        if not design.bands:
            shown.append(
                fields.number(f"{start}.band_width", texts[f"{start}.band_width"], "Width of a band / frequency")
            )
    for name in sorted(taken, key=list(OPTIONS).index):
        shown.append(_option(f"{start}.option.{name}", texts[f"{start}.option.{name}"], name, name in needed))
    return "".join(shown)


def _option(field: str, value: str, name: str, needed: bool) -> str:
    option = OPTIONS[name]
    label, hint = OPTION_WORDS.get(name, name.replace("_", " ").capitalize()), OTHER_FAMILIES.sub("", option.summary)
    default = DEFAULT.search(hint)
    none = "needed" if needed else default[1] if default else "default"
    hint = DEFAULT.sub("", hint)
    if option.kind == "flag":
        return fields.flag(field, value, label, hint=hint)
    if option.kind == "choice":
        chosen = [("", none.replace("_", " ")), *((one, one.replace("_", " ")) for one in option.choices)]
        return fields.choice(field, value, label, chosen, hint=hint)
    step = "whole" if option.kind == "whole" else "number"
    return fields.number(field, value, label, hint=hint, step=step, none=none)


def _active(workbench: Workbench, name: str) -> AskedDesign:
    return next((design for design in workbench.designs if design.name == name), workbench.designs[0])
