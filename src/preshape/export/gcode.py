"""G-code settings: words of a letter and a value, gathered over lines as a firmware gathers them."""

from __future__ import annotations

import math
import re

from preshape.errors import InputError

__all__ = ["Words", "commands", "number_in", "numbers_in"]

Words = dict[str, str]
"""Letters in upper case, and what stands behind them: digits, a text without its quotes, or nothing."""

LARGEST_TEXT = 1_000_000
WORD = re.compile(r'\s*([A-Za-z])\s*("(?:[^"]|"")*"|[-+0-9.:eE]*)')


def commands(text: str, name: str) -> list[Words]:
    """The words of every line of command `name`, such as M593, in their order.

    Raises
    ------
    InputError
        If there is none, or a line is not made of words.
    """
    if len(text) > LARGEST_TEXT:
        raise InputError(f"the text is longer than {LARGEST_TEXT} characters: give the lines with {name}.")
    found = []
    for line in text.splitlines():
        rest = _without_comment(line).strip()
        begin = re.match(rf"(?:N\d+\s*)?{name}(?![0-9.])", rest, re.IGNORECASE)
        if begin is not None:
            found.append(_words(rest[begin.end() :], name))
    if not found:
        raise InputError(f"there is no line with {name}: give the settings as they stand in the G-code.")
    return found


def number_in(words: Words, letter: str) -> float | None:
    """The number behind `letter`, None where it is not there; InputError when it is no number."""
    return None if letter not in words else _number(letter, words[letter])


def numbers_in(words: Words, letter: str) -> list[float]:
    """The numbers behind `letter`, colons between; InputError when one is none."""
    return [_number(letter, word) for word in words[letter].split(":")]


def _without_comment(line: str) -> str:
    """A line up to its comment; a semicolon within quotes is none."""
    parts = re.split(r'("(?:[^"]|"")*")', line)
    for index, part in enumerate(parts):
        if not part.startswith('"') and ";" in part:
            return "".join(parts[:index]) + part.split(";")[0]
    return line


def _words(text: str, name: str) -> Words:
    words: Words = {}
    at = 0
    text = text.split("*")[0].rstrip()  # a checksum ends the line
    while at < len(text):
        word = WORD.match(text, at)
        if word is None:
            raise InputError(
                f"{name} is followed by {text[at : at + 20].strip()!r}: give letters with values, such as F40."
            )
        letter, value = word[1].upper(), word[2]
        words[letter] = value[1:-1].replace('""', '"') if value.startswith('"') else value
        at = word.end()
    return words


def _number(letter: str, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{letter} is followed by {word[:20]!r}: give a number.")
    return value
