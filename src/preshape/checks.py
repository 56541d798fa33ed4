"""What every room asks of single numbers, and the sentences it answers with."""

from __future__ import annotations

import math
from numbers import Real

from preshape.errors import InputError

__all__ = ["nonzero", "not_negative", "positive", "tolerance_of", "whole_number"]


def positive(name: str, value: object, unit: str) -> float:
    """`value` as a float, if it is finite and above zero."""
    number = _finite(name, value, unit)
    if number <= 0.0:
        raise InputError(f"{name} is {number:g} {unit}: give a value above 0 {unit}.")
    return number


def not_negative(name: str, value: object, unit: str) -> float:
    """`value` as a float, if it is finite and not below zero."""
    number = _finite(name, value, unit)
    if number < 0.0:
        raise InputError(f"{name} is {number:g} {unit}: give 0 {unit} or more.")
    return number


def nonzero(name: str, value: object, unit: str) -> float:
    """`value` as a float, if it is finite and not zero; its sign is the direction."""
    number = _finite(name, value, unit)
    if number == 0.0:
        raise InputError(f"{name} is 0 {unit}, which commands nothing: give a value above or below 0 {unit}.")
    return number


def tolerance_of(value: object) -> float:
    """A tolerated residual vibration [-] as a float, if it is between 0 and 1."""
    number = math.nan if isinstance(value, bool) or not isinstance(value, Real) else float(value)
    if not 0.0 < number < 1.0:
        raise InputError(f"tolerance {value!r} is outside (0, 1): give 0.05 for 5 % of the unshaped vibration.")
    return number


def whole_number(name: str, value: object, low: int, high: int) -> int:
    """`value` as an int, if it is whole and within [low, high]."""
    number = math.nan if isinstance(value, bool) or not isinstance(value, Real) else float(value)
    if not (low <= number <= high and number.is_integer()):
        raise InputError(f"{name} is {value!r}: give a whole number from {low} to {high}.")
    return int(number)


def _finite(name: str, value: object, unit: str) -> float:
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} must be a number in {unit}, not {value!r}.")
    number = float(value)
    if not math.isfinite(number):
        raise InputError(f"{name} is {number:g}: give a finite number in {unit}.")
    return number
