"""Numbers in C source: written with every bit as hexadecimal constants, read back without evaluating anything."""

from __future__ import annotations

import re
from importlib.resources import files as resources

from preshape.errors import InputError
from preshape.export.read_back import MOST_TAPS, taps_in
from preshape.export.target import Placed, Taps

__all__ = [
    "delay_rows",
    "filled",
    "modes_left",
    "real",
    "taps_of_source",
    "title",
    "weight_rows",
]

WIDTH = 112
"""Columns of a row of delays."""

REAL = r"-?0x[01](?:\.[0-9a-f]{1,13})?p[-+][0-9]{1,4}"
SAMPLE_TIME = re.compile(rf"SAMPLE_TIME (?:\(\(preshape_real\))?({REAL})")
DELAYS = re.compile(r" [a-z0-9_]*DELAYS\[[0-9]+\] = \{([^{}]*)\}", re.IGNORECASE)
WEIGHTS = re.compile(r" [a-z0-9_]*WEIGHTS\[[0-9]+\] = \{([^{}]*)\}", re.IGNORECASE)
COMMENT = re.compile(r"/\*[^*]*\*/")


def real(value: float, precision: str) -> str:
    """A constant of every bit: hexadecimal, with the suffix of its type."""
    return value.hex() + ("f" if precision == "single" else "")


def delay_rows(placed: Placed) -> str:
    """The delays [samples] between the braces of an array."""
    rows, row = [], "   "
    for delay in placed.delays.tolist():
        if len(row) > WIDTH:
            rows.append(row)
            row = "   "
        row += f" {delay}u,"
    return "\n".join([*rows, row])


def weight_rows(placed: Placed) -> str:
    """The weights between the braces of an array, each with what it is in decimals."""
    taps = zip(placed.delays.tolist(), placed.weights.tolist(), strict=True)
    return "\n".join(
        f"    {real(weight, placed.precision)}, /* {weight:+.9f} at {1e3 * delay * placed.dt:.6g} ms */"
        for delay, weight in taps
    )


def title(placed: Placed) -> str:
    """Name, family and sample rate; whatever else a family's name holds does not get into a comment."""
    family = re.sub(r"[^A-Za-z0-9_ .,%+^-]", "?", placed.shaper.design.family)[:60]
    return f"{placed.name}: {family} shaper on samples of {placed.dt:.9g} s"


def modes_left(placed: Placed) -> list[str]:
    """For each design mode, what the shaper on the grid leaves of its vibration, in a line."""
    design = placed.shaper.design
    if design.modes is None:
        return ["The modes it is for are not recorded."]
    rows = zip(design.modes, design.settings["residuals"], design.settings["samples_per_period"], strict=True)
    return [
        f"{mode}: {100.0 * left:.2g} % of the vibration is left, {each:.4g} samples a period"
        for mode, left, each in rows
    ]


def filled(package: str, template: str, **values: object) -> str:
    """A template of `package`, every @name@ replaced."""
    text = resources(package).joinpath(template).read_text(encoding="utf-8")
    return re.sub(r"@(\w+)@", lambda match: str(values[match[1]]), text)


def taps_of_source(text: str, precision: str) -> Taps:
    """The sample time, delays and weights that stand in C source, with every bit.

    Raises
    ------
    InputError
        If one of them is not there as :func:`preshape.export.render` writes it, or they are no shaper's.
    """
    dt = _real(_found(SAMPLE_TIME, text, "sample time"))
    delays = [_whole(word) for word in _words(_found(DELAYS, text, "delays"))]
    suffix = "f" if precision == "single" else ""
    weights = [_real(word.removesuffix(suffix)) for word in _words(_found(WEIGHTS, text, "weights"))]
    return taps_in(dt, delays, weights, precision)


def _found(pattern: re.Pattern[str], text: str, what: str) -> str:
    found = pattern.findall(text)
    if len(found) != 1:
        raise InputError(f"the file holds {len(found)} tables of {what}: it is not one that preshape export wrote.")
    return str(found[0])


def _words(text: str) -> list[str]:
    words = [word.strip() for word in COMMENT.sub("", text).split(",")]
    if words[-1] == "":
        words.pop()
    if len(words) > MOST_TAPS:
        raise InputError(f"the table has {len(words)} entries: up to {MOST_TAPS} are allowed.")
    return words


def _real(word: str) -> float:
    if not re.fullmatch(REAL, word):
        raise InputError(f"{word[:40]!r} is not a hexadecimal constant as preshape export writes it.")
    try:
        return float.fromhex(word)
    except OverflowError:
        raise InputError(f"{word[:40]!r} is beyond the range of numbers.") from None


def _whole(word: str) -> int:
    if not re.fullmatch(r"[0-9]{1,8}u", word):
        raise InputError(f"{word[:40]!r} is not a delay in samples as preshape export writes it.")
    return int(word[:-1])
