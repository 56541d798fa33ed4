"""What the papers print, recomputed; one paper a file or folder."""

from preshape.papers.page import reproduction_page, summary
from preshape.papers.paper_list import PAPERS, papers_named
from preshape.papers.reproduction import Figure, Paper, Reproduction, Row
from preshape.papers.rows import Because, beyond, claim, number
from preshape.papers.save import save_reproductions

__all__ = [
    "PAPERS",
    "Because",
    "Figure",
    "Paper",
    "Reproduction",
    "Row",
    "beyond",
    "claim",
    "number",
    "papers_named",
    "reproduction_page",
    "save_reproductions",
    "summary",
]
