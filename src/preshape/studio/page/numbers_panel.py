"""The numbers of the designs, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable
from html import escape

from preshape.studio.page.designs_panel import line_sample
from preshape.studio.page.fields import for_reader, scrolled, sentence
from preshape.studio.page.plots.chart import DUST, percent
from preshape.workflow.workbench import INSENSITIVITY_AT, DesignView, Drawn, ModeView, View

__all__ = ["numbers_panel", "proof"]


def numbers_panel(view: View) -> str:
    """A table: a column a design, a row a number."""
    heads = "".join(
        f'<th scope="col">{line_sample(design.asked.name)} {design.asked.name}: {escape(design.asked.family)}</th>'
        for design in view.designs
    )
    rows: list[tuple[str, Callable[[Drawn], str]]] = [
        ("Duration [s]", lambda drawn: f"{drawn.shaper.duration:.5g}"),
        ("Impulses", _impulses),
        ("Shortest there is", proof),
    ]
    for index, mode in enumerate(view.workbench.modes):
        rows.append((f"Left at mode {index + 1}, {mode.frequency:.4g} Hz [%]", _left(index)))
        rows.append((f"Stays within {100 * INSENSITIVITY_AT:g} % about mode {index + 1} [Hz]", _band(index)))
    rows.append(("Move ends [s]", lambda drawn: f"{drawn.move.end_time:.5g}"))
    dust = DUST * abs(view.workbench.move.distance)
    rows.append(("Vibration after the move [mm]", lambda drawn: _millimetres(drawn.move.residual, dust)))
    rows.append(("Peak deflection in the move [mm]", lambda drawn: _millimetres(drawn.move.peak_deflection, dust)))
    body = "".join(
        f'<tr><th scope="row">{escape(name)}</th>' + "".join(_cell(design, value) for design in view.designs) + "</tr>"
        for name, value in rows
    )
    table = (
        f'<table class="numbers" id="numbers"><thead><tr><th scope="col">{for_reader("Number")}</th>{heads}</tr>'
        f"</thead><tbody>{_troubles(view)}{body}</tbody></table>"
    )
    return f"<h2>Numbers</h2>{scrolled('Numbers of the designs', table)}"


def _millimetres(length: float, dust: float) -> str:
    return "0" if length < dust else f"{1e3 * length:.3g}"


def proof(drawn: Drawn) -> str:
    """Whether a shorter one can exist, in a word or two."""
    if drawn.proved:
        return "proved"
    return {"exact": "not asked", "feasible": "not proved"}.get(drawn.status, drawn.status)


def _cell(design: DesignView, value: Callable[[Drawn], str]) -> str:
    return f"<td>{escape(value(design.drawn)) if design.drawn is not None else '–'}</td>"


def _troubles(view: View) -> str:
    """A row of what is wrong, where something is."""
    said = [design.trouble or (design.drawn.misfit if design.drawn else "") for design in view.designs]
    if not any(said):
        return ""
    cells = "".join(f'<td><span class="trouble">{escape(sentence(one))}</span></td>' for one in said)
    return f'<tr><th scope="row">What is wrong</th>{cells}</tr>'


def _impulses(drawn: Drawn) -> str:
    boxes = len(drawn.shaper.boxes)
    return f"{len(drawn.shaper)}" + (f" and {boxes} boxes" if boxes else "")


def _left(index: int) -> Callable[[Drawn], str]:
    return lambda drawn: percent(drawn.modes[index].residual)


def _band(index: int) -> Callable[[Drawn], str]:
    return lambda drawn: _edges(drawn.modes[index])


def _edges(mode: ModeView) -> str:
    if mode.high <= mode.low:
        return "nowhere"
    high = "beyond" if math.isinf(mode.high) else f"{mode.high:.4g}"
    return f"{mode.low:.4g} to {high}"
