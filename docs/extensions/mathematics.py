"""Mathematics as MathML, which browsers draw themselves, by the translator that comes with docutils."""

from __future__ import annotations

from typing import Any

from docutils import nodes
from docutils.utils.math import MathError, latex2mathml
from sphinx.application import Sphinx
from sphinx.util import logging


def _mathml(node: nodes.math | nodes.math_block, *, block: bool) -> str:
    """The formula; one that cannot be translated is a warning with its place, and shown as it was written."""
    try:
        return latex2mathml.tex2mathml(node.astext(), as_block=block)
    except MathError as problem:
        logging.getLogger(__name__).warning("%s in %r", problem, node.astext(), location=node.parent)
        return f"<code>{node.astext()}</code>"


def _visit_inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(_mathml(node, block=False))
    raise nodes.SkipNode


def _visit_block(writer: Any, node: nodes.math_block) -> None:
    writer.body.append(f'<div class="formula">{_mathml(node, block=True)}</div>')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer; the style sheet lets a formula that is wider than a phone scroll by itself."""
    app.add_html_math_renderer("mathml", (_visit_inline, None), (_visit_block, None))
    return {"parallel_read_safe": True}
