"""Sections of a Klipper configuration: settings of one section, numbers and lists among them."""

from __future__ import annotations

import configparser
import math
import re
from collections.abc import Mapping

from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["impulse_lines", "number_of", "numbers_of", "section_of"]

SAVED = re.compile(r"^#\*# (?=\[|\w+\s*[=:]| )", re.MULTILINE)
"""Begins a section, a setting or its continuation that SAVE_CONFIG has written; those count, and come last."""

LARGEST_TEXT = 1_000_000
MOST_NUMBERS = 1000


def section_of(text: str, name: str) -> Mapping[str, str]:
    """Settings of section `name`, keys in lower case; lines without any section count as it.

    Raises
    ------
    InputError
        If the text is no configuration or has no such section.
    """
    if len(text) > LARGEST_TEXT:
        raise InputError(f"the text is longer than {LARGEST_TEXT} characters: give the section [{name}].")
    text = SAVED.sub("", text)
    if not re.search(r"^\[", text, re.MULTILINE):
        text = f"[{name}]\n{text}"
    parser = configparser.ConfigParser(
        strict=False, interpolation=None, inline_comment_prefixes=("#", ";"), delimiters=(":", "=")
    )
    try:
        parser.read_string(text)
    except configparser.Error as error:
        line = str(error).splitlines()[0]
        raise InputError(f"this is no Klipper configuration ({line}): give the section [{name}].") from None
    if not parser.has_section(name):
        raise InputError(f"there is no section [{name}]: give the part of printer.cfg that holds it.")
    return dict(parser.items(name))


def impulse_lines(shaper: Shaper, axis: str, amplitudes: str, times: str, digits: str) -> list[str]:
    """The impulses as two settings of an axis, called `amplitudes` and `times`, each number with these digits."""
    lists = [(amplitudes, shaper.amplitudes.tolist()), (times, shaper.times.tolist())]
    return [f"{key}_{axis}: {','.join(format(value, digits) for value in values)}" for key, values in lists]


def number_of(settings: Mapping[str, str], keys: tuple[str, ...], default: float) -> float:
    """The first of `keys` that is set, as a finite number; InputError when it is none."""
    for key in keys:
        if key in settings:
            return _number(key, settings[key])
    return default


def numbers_of(settings: Mapping[str, str], key: str) -> list[float]:
    """The numbers, with commas between, that `key` holds; InputError when it holds none."""
    if key not in settings:
        raise InputError(f"{key} is not set: give numbers with commas between.")
    words = settings[key].replace("\n", ",").split(",")
    if len(words) > MOST_NUMBERS:
        raise InputError(f"{key} holds {len(words)} numbers: no shaper has so many.")
    return [_number(key, word) for word in words if word.strip()]


def _number(key: str, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{key} holds {word.strip()[:40]!r}: give a number.")
    return value
