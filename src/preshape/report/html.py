"""A report as one HTML file: no external resource, nothing that runs, prints well."""

from __future__ import annotations

from html import escape
from typing import assert_never

from preshape.report.document import Document, Heading, Paragraph, Part, Picture, Table, Verbatim, printable

__all__ = ["RECORD_TYPE", "as_html"]

RECORD_TYPE = "application/vnd.preshape.report+json"
"""Type of the data block that holds the record; no browser runs it."""

STYLE = """
:root { --ink: #1a1a1a; --soft: #5b5b5b; --line: #dcdcdc; --accent: #0b5fa5; --warn: #9a3b00; }
* { box-sizing: border-box; }
body { font: 15px/1.45 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; color: var(--ink);
  max-width: 62rem; margin: 1.5rem auto; padding: 0 1rem; background: #fff; overflow-wrap: anywhere; }
h1 { font-size: 1.45em; margin: 0 0 .2rem; color: var(--accent); }
h2 { font-size: 1.05em; margin: 1.6rem 0 .4rem; }
p { margin: .3rem 0; }
.lead { font-size: 1.07em; }
.label { font-weight: 600; margin-top: .7rem; }
.warning { border-left: 5px solid var(--warn); background: #fff4ec; padding: .5rem .8rem; margin: .4rem 0; }
.tables { overflow-x: auto; margin: .3rem 0; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
th, td { padding: .28rem .6rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th.left, td.left { text-align: left; }
th { font-weight: 600; color: var(--soft); vertical-align: bottom; }
tr.chosen td { font-weight: 700; color: var(--accent); }
tr.excluded td { color: #767676; }
tr.fragile td:last-child { color: var(--warn); font-weight: 700; }
figure { margin: .5rem 0; overflow-x: auto; }
svg { width: 100%; height: auto; }
pre { background: #f5f5f5; padding: .4rem .7rem; margin: .2rem 0 .6rem; overflow-x: auto; font-size: .85em;
  overflow-wrap: normal; }
footer { color: var(--soft); font-size: .85em; margin-top: 1.4rem; border-top: 1px solid var(--line);
  padding-top: .5rem; }
@media (max-width: 40rem) { figure svg { min-width: 40rem; } }
@media print { body { margin: 0; max-width: none; font-size: 11px; } h2 { margin-top: .8rem; break-after: avoid; }
  figure, tr, pre { break-inside: avoid; } pre { white-space: pre-wrap; } }
"""


def as_html(document: Document) -> str:
    """The report as HTML text, the same for the same document.

    Parameters
    ----------
    document : Document
        From :func:`preshape.workflow.design_report` or :func:`preshape.report.calibration_document`.

    Returns
    -------
    str
        One file; the record stands in it as a block of data.
    """
    lines = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{_text(document.subject)}</title>",
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{_text(document.title)}</h1>",
        *[_part(part) for part in document.parts],
        f"<footer>{_text(document.foot)}</footer>",
        f'<script type="{RECORD_TYPE}">{_data(document.record.json())}</script>',
        "</body></html>",
    ]
    return "\n".join(lines) + "\n"


def _text(text: str) -> str:
    return escape(printable(text), quote=True)


def _data(json: str) -> str:
    """JSON that no text in it can end: a `<` stands only in strings, where its number means the same."""
    return json.replace("<", "\\u003c")


def _part(part: Part) -> str:
    match part:
        case Heading(text):
            return f"<h2>{_text(text)}</h2>"
        case Paragraph(text, "plain"):
            return f"<p>{_text(text)}</p>"
        case Paragraph(text, role):
            return f'<p class="{role}">{_text(text)}</p>'
        case Table():
            return _table(part)
        case Picture(svg, description):
            return f'<figure role="img" aria-label="{_text(description)}">{svg}</figure>'
        case Verbatim(text):
            return f"<pre>{_text(text)}</pre>"
    assert_never(part)


def _table(part: Table) -> str:
    head = "".join(
        f"<th{_side(part, column)}>{'<br>'.join(_text(line) for line in title)}</th>"
        for column, title in enumerate(part.table.titles)
    )
    rows = "".join(
        (f'<tr class="{kind}">' if kind else "<tr>")
        + "".join(f"<td{_side(part, column)}>{_text(cell)}</td>" for column, cell in enumerate(cells))
        + "</tr>"
        for kind, cells in part.rows()
    )
    return f'<div class="tables"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>'


def _side(part: Table, column: int) -> str:
    return ' class="left"' if column < part.left else ""
