"""Refuses a build whose pages load anything from another machine: scripts, styles, fonts, pictures, frames."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import SphinxError

__all__ = ["loaded_by_page", "loaded_by_style"]

LOADING = {
    "script": "src", "img": "src", "iframe": "src", "source": "src", "video": "src", "audio": "src", "embed": "src",
    "object": "data", "input": "src", "track": "src",
}  # fmt: skip
"""Elements that load by themselves, and the attribute that says what; an <a> loads only when somebody follows it."""

LINKS_THAT_LOAD = set("stylesheet icon preload prefetch preconnect dns-prefetch manifest modulepreload".split())

OUTSIDE = re.compile(r"(?:[a-z]+:)?//", re.IGNORECASE)

IN_STYLE = re.compile(r"""url\(\s*["']?([^"')]+)|@import\s+["']([^"']+)""", re.IGNORECASE)


def loaded_by_style(text: str) -> list[str]:
    """What a style sheet loads from other machines."""
    return [one for pair in IN_STYLE.findall(text) for one in pair if one and OUTSIDE.match(one)]


class _Page(HTMLParser):
    """Collects what a browser would fetch for a page by itself."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self._inside = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self._inside = tag
        fetched = [values.get(LOADING.get(tag, ""), ""), values.get("poster", "")]
        fetched += [part.split()[0] for part in values.get("srcset", "").split(",") if part.strip()]
        if tag == "link" and LINKS_THAT_LOAD & set(values.get("rel", "").lower().split()):
            fetched.append(values.get("href", ""))
        if tag in {"image", "use"}:  # of SVG
            fetched += [values.get("href", ""), values.get("xlink:href", "")]
        self.found += [one for one in fetched if OUTSIDE.match(one)]
        self.found += loaded_by_style(values.get("style", ""))

    def handle_endtag(self, tag: str) -> None:
        self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside == "style":
            self.found += loaded_by_style(data)
        if self._inside == "script":  # a script that names an address is taken to load it
            self.found += re.findall(r"""["'](https?://[^"']+)""", data)


def loaded_by_page(text: str) -> list[str]:
    """What a page loads from other machines; links to follow do not count."""
    page = _Page()
    page.feed(text)
    return page.found


def _check(app: Sphinx, problem: Exception | None) -> None:
    if problem is not None or app.builder.format != "html":
        return
    folder = Path(app.outdir)
    found = {path: loaded_by_page(path.read_text("utf-8")) for path in sorted(folder.rglob("*.html"))}
    found |= {path: loaded_by_style(path.read_text("utf-8")) for path in sorted(folder.rglob("*.css"))}
    found |= {path: loaded_by_page(path.read_text("utf-8")) for path in sorted(folder.rglob("*.svg"))}
    lines = [f"{path.relative_to(folder)}: {', '.join(sorted(set(some)))}" for path, some in found.items() if some]
    if lines:
        raise SphinxError("These pages load from other machines:\n" + "\n".join(lines))


def setup(app: Sphinx) -> dict[str, bool]:
    """Check when everything is written."""
    app.connect("build-finished", _check)
    return {"parallel_read_safe": True}
