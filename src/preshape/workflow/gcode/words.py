"""One line of G-code: its words, its comment, or a line that is passed on as it stands."""

from __future__ import annotations

import re
from dataclasses import dataclass

from preshape.errors import InputError

__all__ = ["Line", "line_of"]

LONGEST_LINE = 1000
WORD = re.compile(r"\s*([A-Za-z])\s*([-+]?(?:\d{1,12}(?:\.\d{0,12})?|\.\d{1,12}))\s*")
COMMENT = re.compile(r"\(([^()]*)\)")
HOMING = re.compile(r"G\s*(?:2[789]|30)(?:[^0-9]|$)", re.IGNORECASE)
MACRO = re.compile(r"[A-Za-z_]{2,}")
BESIDE = re.compile(r"(?:[MTS]\s*[-+.0-9]+\s*)+G\s*[0-9]", re.IGNORECASE)
PASSED = "MT%$/"
"""What begins a line that is no move; behind M and T stand texts too, as in M117."""


@dataclass(frozen=True, slots=True)
class Line:
    """A line.

    Parameters
    ----------
    number : int
        From 1.
    text : str
        As it stands, without the line end.
    words : tuple of (str, float), or None
        Letters in upper case with their values; None for a line that is passed on unread.
    comment : str
        Without its marks.
    body : str
        What is left without comments and line number.
    """

    number: int
    text: str
    words: tuple[tuple[str, float], ...] | None
    comment: str
    body: str

    def value(self, letter: str) -> float | None:
        """What stands behind a letter, None where it is not there; InputError where it is there twice."""
        found = [value for name, value in self.words or () if name == letter]
        if len(found) > 1:
            raise InputError(f"line {self.number} has {letter} twice: {self.text.strip()!r}.")
        return found[0] if found else None

    @property
    def codes(self) -> tuple[float, ...]:
        """The numbers behind G."""
        return tuple(value for name, value in self.words or () if name == "G")


def line_of(number: int, text: str) -> Line:
    """A line read; nothing in it is evaluated.

    Raises
    ------
    InputError
        If it is too long, or neither words nor a command that can be passed on.

    Examples
    --------
    >>> line_of(7, "g1 X10 y-.5 F1500 ; outer wall").words
    (('G', 1.0), ('X', 10.0), ('Y', -0.5), ('F', 1500.0))
    """
    if len(text) > LONGEST_LINE:
        raise InputError(f"line {number} is longer than {LONGEST_LINE} characters: that is no G-code.")
    body, _, comment = text.partition(";")
    remarks = [*COMMENT.findall(body), comment]
    body = COMMENT.sub(" ", body).strip()
    comment = " ".join(remark.strip() for remark in remarks if remark.strip())
    numbered = re.match(r"[Nn]\d+\s*", body)
    rest = body[numbered.end() :] if numbered else body
    if rest[:1] and rest[0].upper() in PASSED:
        if BESIDE.match(rest):
            raise InputError(f"line {number} has G words behind others: put {rest[:40]!r} on lines of their own.")
        return Line(number, text, None, comment, rest)
    if "*" in rest:
        raise InputError(f"line {number} has a checksum, which a changed file cannot keep: save it without.")
    words, at = [], 0
    while at < len(rest):
        word = WORD.match(rest, at)
        if word is None:
            if MACRO.match(rest) or HOMING.match(rest):
                return Line(number, text, None, comment, rest)
            raise InputError(
                f"line {number} is no G-code that is understood, at {rest[at : at + 20]!r}: give letters with numbers; "
                "parameters, expressions and subroutines must be resolved before."
            )
        words.append((word[1].upper(), float(word[2])))
        at = word.end()
    return Line(number, text, tuple(words), comment, rest)
