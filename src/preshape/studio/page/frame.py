"""The page's HTML that does not change: head, bar, chart boxes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from html import escape
from typing import Any

from preshape.studio.page.fields import button, for_reader, scrolled

__all__ = ["CONTROLS", "ICON", "SAYING", "STATUS", "chart_foot", "chart_over", "chart_title", "first", "head", "top"]

CONTROLS = ("drop", "modes", "designs", "trial")
"""Panels on the left, in order."""

ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32"><rect width="32" height="32" rx="6" fill="#0b5fa5"/>'
    '<path d="M4 22h6V12h7v-4h11" fill="none" stroke="#fff" stroke-width="3"/></svg>'
)

STATUS = '<span id="status" role="status"></span>'
SAYING = '<div class="saying" id="saying" role="status"></div><p class="for-reader" id="summary" role="status"></p>'


def head(static: str) -> str:
    """Styles, and the place where messages wait until the scripts are there."""
    early = (
        "window.preshapeStudio = {queue: [], receive(message) { this.queue.push(message); }};"
        "try { const kept = localStorage.getItem('preshape-studio-theme') ?? 'auto';"
        "document.documentElement.dataset.theme = kept === 'dark' || (kept === 'auto' && "
        "matchMedia('(prefers-color-scheme: dark)').matches) ? 'dark' : 'light'; } catch {}"
        "document.documentElement.lang = 'en';"
    )
    return (
        f'<link rel="stylesheet" href="{static}/studio.css"><link rel="stylesheet" href="{static}/layouts.css">'
        f"<script>{early}</script>"
        f'<script type="module" src="{static}/studio.js"></script>'
    )


def top(trouble: str) -> str:
    """The bar: what the page is, and what concerns all of it."""
    buttons = (
        ("undo", "undo", "Undo", "Undo (Ctrl+Z)"),
        ("redo", "redo", "Redo", "Redo (Ctrl+Shift+Z)"),
        ("copy-link", "copy-link", "Copy link", "The link holds the whole state"),
        ("report-html", "report html", "Report", "Report of the design in front, as one HTML file"),
        ("report-pdf", "report pdf", "PDF", "Report of the design in front, as PDF"),
    )
    made = "".join(button(name, deed, label, title=title) for name, deed, label, title in buttons)
    banner = ""
    if trouble:
        banner = f'<p class="trouble banner" role="alert">{escape(trouble)} The page shows its first state instead.</p>'
    return (
        '<a class="skip" href="#results">Skip to the charts</a>'
        "<h1>preshape studio<small>commands that do not shake machines</small></h1>"
        f'<div class="row">{made}<button type="button" id="theme" aria-label="Theme: automatic">◐</button></div>'
        f"{banner}"
    )


def chart_title(title: str) -> str:
    """Above a chart."""
    return f"<h2>{escape(title)}<small></small></h2>"


def chart_over(name: str) -> str:
    """Over a chart: handles, and a note when there is nothing to see yet."""
    handles = '<div id="handles"></div>' if name == "spectrum" else ""
    return f'{handles}<p class="note" role="status"></p>'


def chart_foot(title: str) -> str:
    """Below a chart: what is wrong, and its numbers as a table."""
    return (
        '<p class="trouble"></p>'
        f"<details><summary>Numbers{for_reader(f' of the chart {title}')}</summary>"
        f"{scrolled(f'Numbers of the chart {title}', '')}</details>"
    )


def first(charts: Mapping[str, int], message: Mapping[str, Any]) -> str:
    """The first message in the page itself: its picture needs no round trip."""
    return (
        f'<script type="application/json" id="first-charts">{json.dumps(charts)}</script>'
        f"<script>preshapeStudio.receive({_in_script(message)})</script>"
    )


def _in_script(value: object) -> str:
    """JSON that cannot end the script it stands in."""
    return (
        json.dumps(value, allow_nan=False)
        .replace("<", "\\u003c")
        .replace("\u2028", "\\u2028")
        .replace("\u2029", "\\u2029")
    )
