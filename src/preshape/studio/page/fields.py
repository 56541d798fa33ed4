"""Fields as HTML: a label, the control, a place for what is wrong with it. Whatever comes from outside is escaped."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

__all__ = ["bare_number", "choice", "flag", "identity", "number", "sentence", "text", "trouble_place"]


def identity(field: str) -> str:
    """The id of a field's control."""
    return "f-" + field.replace(".", "-")


def sentence(text: str) -> str:
    """What is wrong, as it stands alone: with a capital."""
    return text[:1].upper() + text[1:]


def button(
    identity: str, deed: str, words: str, *, enabled: bool = True, kind: str = "", title: str = "", label: str = ""
) -> str:
    """A button and the event it sends; one that can do nothing now keeps its place and the focus."""
    more = f' class="{kind}"' * bool(kind) + f' title="{escape(title)}"' * bool(title)
    more += f' aria-label="{escape(label)}"' * bool(label)
    more += f' aria-disabled="{str(not enabled).lower()}"'
    return f'<button type="button" id="{identity}" data-do="{escape(deed)}"{more}>{escape(words)}</button>'


def for_reader(words: str) -> str:
    """Words that a screen reader needs and the eye does not."""
    return f'<span class="for-reader">{escape(words)}</span>'


def scrolled(label: str, inside: str) -> str:
    """A region that scrolls, by keyboard too."""
    return f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(label)}">{inside}</div>'


def trouble_place(field: str) -> str:
    """Where the sentence about a field appears; it is read out when it does."""
    return f'<p class="trouble" role="alert" id="{identity(field)}-trouble" data-error="{escape(field)}"></p>'


def bare_number(field: str, value: str, label: str, step: str = "number") -> str:
    """A number whose label is its column's head; `step` is "number", "ratio" or "whole": what an arrow key adds."""
    return (
        f'<input type="text" inputmode="decimal" autocomplete="off" id="{identity(field)}" '
        f'data-field="{escape(field)}" data-step="{step}" aria-label="{escape(label)}" '
        f'aria-describedby="{identity(field)}-trouble" value="{escape(value)}">{trouble_place(field)}'
    )


def number(
    field: str, value: str, label: str, *, hint: str = "", step: str = "number", none: str = "", tall: bool = False
) -> str:
    """A number with its label; `none` is what stands in the empty field."""
    return _field(
        field,
        label,
        f'<input type="text" inputmode="{"numeric" if step == "whole" else "decimal"}" autocomplete="off" '
        f'data-step="{step}" placeholder="{escape(none)}" value="{escape(value)}"',
        hint,
        tall=tall,
    )


def text(field: str, value: str, label: str, *, hint: str = "", none: str = "") -> str:
    """A line of text with its label."""
    control = f'<input type="text" autocomplete="off" placeholder="{escape(none)}" value="{escape(value)}"'
    return _field(field, label, control, hint, tall=True)


def flag(field: str, value: str, label: str, *, hint: str = "") -> str:
    """Yes or no."""
    return _field(field, label, f'<input type="checkbox"{" checked" * (value == "true")}', hint)


def choice(
    field: str, value: str, label: str, choices: Iterable[tuple[str, str]], *, hint: str = "", tall: bool = False
) -> str:
    """One of several, each with its value and the words for it."""
    options = "".join(
        f'<option value="{escape(one)}"{" selected" * (one == value)}>{escape(words)}</option>'
        for one, words in choices
    )
    return _field(field, label, "<select", hint, inside=options + "</select>", tall=tall)


def _field(field: str, label: str, control: str, hint: str, inside: str = "", tall: bool = False) -> str:
    name = identity(field)
    described = f"{name}-trouble" + (f" {name}-hint" if hint else "")
    below = f'<p class="hint" id="{name}-hint">{escape(hint)}</p>' if hint else ""
    return (
        f'<div class="field{" tall" * tall}"><label for="{name}">{escape(label)}</label>'
        f'{control} id="{name}" data-field="{escape(field)}" aria-describedby="{described}">{inside}'
        f"{below}{trouble_place(field)}</div>"
    )
