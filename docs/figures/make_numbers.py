"""What the papers print and what preshape computes, as tables for the theory pages; run by `make figures`."""

from __future__ import annotations

import re
from pathlib import Path

from preshape.files import write_atomically
from preshape.papers import PAPERS, Reproduction, Row, summary

NUMBERS = Path(__file__).resolve().parent.parent / "theory" / "numbers"

MARKED = re.compile(r"([\\`*_{}\[\]<>#|$~])")
"""What Markdown would take for marks."""

PARTS = (
    ("differs", "What differs, and why", "why"),
    ("beyond the paper", "What the paper does not say", "note"),
    ("reproduced", "What is reproduced", "read as"),
)


def tables(done: Reproduction) -> str:
    """One paper: the summary and a table for each verdict."""
    lines = [f"`preshape reproduce {done.paper}` compares: {summary(done).removeprefix(f'{done.paper}: ')}"]
    for verdict, title, last in PARTS:
        rows = [row for row in done.rows if row.verdict == verdict]
        if rows:
            lines += ["", f"### {title}", "", *_table(rows, last)]
    return "\n".join(lines) + "\n"


def _table(rows: list[Row], last: str) -> list[str]:
    noted = any(row.explanation for row in rows)
    head = ["where", "what", "printed", "computed", *([last] if noted else [])]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for row in rows:
        cells = [row.source, row.what, row.printed, row.computed, *([row.explanation] if noted else [])]
        lines.append("| " + " | ".join(MARKED.sub(r"\\\1", cell) for cell in cells) + " |")
    return lines


def main() -> None:
    """Recompute all papers: about a minute."""
    NUMBERS.mkdir(exist_ok=True)
    for paper in PAPERS:
        print(write_atomically(NUMBERS / f"{paper.name}.md", tables(paper.reproduce())))


if __name__ == "__main__":
    main()
