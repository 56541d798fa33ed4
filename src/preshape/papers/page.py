"""The page of a reproduction: table and figures of one or several papers; the figures lie beside it as files."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from preshape.papers.reproduction import VERDICTS, Reproduction, Row

__all__ = ["reproduction_page", "summary"]

STYLE = """
:root { --ink: #1a1a1a; --soft: #5b5b5b; --line: #dcdcdc; --accent: #0b5fa5; --warn: #9a3b00; }
* { box-sizing: border-box; }
body { font: 15px/1.45 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif; color: var(--ink);
  max-width: 74rem; margin: 1.5rem auto; padding: 0 1rem; background: #fff; }
h1 { font-size: 1.45rem; margin: 0 0 .2rem; color: var(--accent); }
h2 { font-size: 1.15rem; margin: 2rem 0 .3rem; color: var(--accent); }
h3 { font-size: 1.02rem; margin: 1.3rem 0 .4rem; }
p { margin: .3rem 0; }
a { color: var(--accent); }
.tables { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .6rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { font-weight: 600; color: var(--soft); }
td:first-child { white-space: nowrap; }
td small { display: block; color: var(--soft); max-width: 60ch; }
.differs td:last-child { color: var(--warn); font-weight: 700; }
.differs small { color: var(--warn); }
.unexplained td { background: #ffe3e3; }
.beyond td:last-child { color: var(--accent); }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(21rem, 1fr)); gap: 1.2rem; }
figure { margin: 0; break-inside: avoid; }
figure img { width: 100%; height: auto; }
figcaption { font-size: .88rem; color: var(--soft); }
footer { color: var(--soft); font-size: .85rem; margin-top: 2rem; border-top: 1px solid var(--line);
  padding-top: .5rem; }
@media print { body { margin: 0; max-width: none; font-size: 11px; } }
"""

PLURALS = {"reproduced": "reproduced", "differs": "differ", "beyond the paper": "beyond the paper"}

EXPLAINED = (
    "Printed is what the paper says, computed what preshape finds. A verdict is the comparison of the two, to the last "
    "printed digit unless the row says otherwise. Beyond the paper: what it does not say, checked in another way. "
    "The figures are drawn anew from captions and text; what we chose because neither says it is in square brackets."
)


def summary(reproduction: Reproduction) -> str:
    """One sentence: how many rows of each verdict."""
    counts = ", ".join(f"{reproduction.count(verdict)} {PLURALS[verdict]}" for verdict in VERDICTS)
    unexplained = sum(not row.explained for row in reproduction.rows)
    end = "every difference explained" if not unexplained else f"{unexplained} NOT explained"
    return f"{len(reproduction.rows)} statements: {counts}; {end}."


def reproduction_page(reproductions: Sequence[Reproduction], version: str) -> str:
    """The page as HTML text, for a file in the folder of the figures.

    Parameters
    ----------
    reproductions : sequence of Reproduction
        The papers, in order.
    version : str
        Of preshape, for the foot of the page.
    """
    names = ", ".join(one.paper for one in reproductions)
    parts = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>preshape: {escape(names)} recomputed</title>",
        f"<style>{STYLE}</style></head><body>",
        f"<h1>{'The paper' if len(reproductions) == 1 else 'The papers'} recomputed</h1>",
        f"<p>{escape(EXPLAINED)}</p>",
        *(_paper(one) for one in reproductions),
        f"<footer>Made by preshape {escape(version)}, command: preshape reproduce.</footer>",
        "</body></html>",
    ]
    return "\n".join(parts) + "\n"


def _paper(one: Reproduction) -> str:
    head = "".join(f"<th>{title}</th>" for title in ("where", "what", "printed", "computed", "verdict"))
    return "\n".join(
        [
            f'<section id="{escape(one.paper, quote=True)}"><h2>{escape(one.title)}</h2>',
            f"<p>{escape(summary(one))}</p>",
            f'<div class="tables"><table><thead><tr>{head}</tr></thead><tbody>',
            *(_row(row) for row in one.rows),
            "</tbody></table></div>",
            f'<h3>Figures</h3><div class="figures">{"".join(_figures(one))}</div></section>',
        ]
    )


def _row(row: Row) -> str:
    kind = {"reproduced": "reproduced", "differs": "differs", "beyond the paper": "beyond"}[row.verdict]
    kind += "" if row.explained else " unexplained"
    why = f"<small>{escape(row.explanation)}</small>" if row.explanation else ""
    if not row.explained:
        why = "<small>Not explained.</small>"
    cells = [escape(row.source), escape(row.what) + why, escape(row.printed), escape(row.computed), escape(row.verdict)]
    return f'<tr class="{kind}">' + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def _figures(one: Reproduction) -> list[str]:
    found = []
    for figure in one.figures:
        caption = escape(f"Figure {figure.number}: {figure.caption}", quote=True)
        name = escape(one.file_name(figure), quote=True)
        found.append(
            f'<figure><a href="{name}"><img src="{name}" alt="{caption}" loading="lazy"></a>'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    return found
