"""Structured text executed from blark's syntax tree: what the export uses, by IEC 61131-3; nothing of the generator.

DINT is 32 bits and must not overflow, an index must lie in its array, REAL is rounded to single after every operation,
VAR CONSTANT is not assigned to, a FOR loop takes its end once and may run no time at all.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from blark import transform as tree
from blark.parse import parse_source_code

TYPES: dict[str, Callable[[Any], Any]] = {"LREAL": np.float64, "REAL": np.float32, "BOOL": bool}
RANGES = {"DINT": (-(2**31), 2**31 - 1), "UINT": (0, 2**16 - 1)}
OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "=": operator.eq, "<>": operator.ne, "<": operator.lt,
    "<=": operator.le, ">": operator.gt, ">=": operator.ge, "OR": lambda a, b: a or b, "AND": lambda a, b: a and b,
    "MOD": lambda a, b: int(np.fmod(a, b)),
}  # fmt: skip


@cache
def parsed(source: str) -> tuple[Any, ...]:
    """The units of a source file, which blark must accept; a second or so."""
    result = parse_source_code(source)
    assert result.exception is None, result.exception
    units = tuple(result.transform().items)
    assert all(isinstance(unit, tree.FunctionBlock | tree.Program) for unit in units)
    return units


class Array:
    """A one-dimensional array with its bounds."""

    def __init__(self, kind: str, low: int, high: int, values: list[Any]) -> None:
        assert not values or len(values) == high - low + 1, "as many initial values as elements"
        self.kind, self.low, self.high = kind, low, high
        self.values = [converted(kind, value) for value in values or [0] * (high - low + 1)]

    def at(self, index: int) -> int:
        assert isinstance(index, int) and self.low <= index <= self.high, f"index {index} is outside the array"
        return index - self.low


class Machine:
    """The units of some source files; `instance("FB_Name")` makes one, `call` runs it once."""

    def __init__(self, *sources: str) -> None:
        self.units: dict[str, Any] = {}
        for source in sources:
            for unit in parsed(source):
                self.units[str(unit.name).upper()] = unit

    def instance(self, name: str) -> Instance:
        return Instance(self, self.units[name.upper()])


class Instance:
    """The memory of a function block or program."""

    def __init__(self, machine: Machine, unit: Any) -> None:
        self.machine, self.unit = machine, unit
        self.types: dict[str, str] = {}
        self.values: dict[str, Any] = {}
        self.constants: set[str] = set()
        self.inputs: set[str] = set()
        for section in unit.declarations:
            for item in section.items:
                for declared in item.variables:
                    name = str(declared.variable.name).upper()
                    assert name not in self.values, f"{name} is declared twice"
                    self.types[name], self.values[name] = self.declared(item.init)
                    if "constant" in str(getattr(section, "attrs", "")):
                        self.constants.add(name)
                    if isinstance(section, tree.InputDeclarations):
                        self.inputs.add(name)

    def declared(self, init: Any) -> tuple[str, Any]:
        if isinstance(init, tree.ArrayTypeInitialization):
            (subrange,) = init.spec.subranges
            kind = str(init.spec.type.type_name).upper()
            values = [] if init.value is None else list(self.elements(init.value))
            return "ARRAY", Array(kind, self.value(subrange.start), self.value(subrange.stop), values)
        kind = str(init.spec.type).upper()
        if kind in self.machine.units:
            return kind, self.machine.instance(kind)
        return kind, converted(kind, 0 if init.value is None else self.value(init.value))

    def elements(self, initialisation: Any) -> Any:
        for element in initialisation.elements:
            if isinstance(element.element, tree.ArrayInitialization):
                yield from self.elements(element.element)
            else:
                yield self.value(element.element)

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["values"][name.upper()]
        except KeyError:
            raise AttributeError(name) from None

    def call(self, **inputs: Any) -> Instance:
        for name, value in inputs.items():
            assert name.upper() in self.inputs, f"{name} is no input"
            self.values[name.upper()] = converted(self.types[name.upper()], value)
        self.run(self.unit.body)
        return self

    def run(self, statements: Any) -> None:
        for statement in statements.statements if statements else []:
            match statement:
                case tree.AssignmentStatement():
                    (target,) = statement.variables
                    self.assign(target, self.value(statement.expression))
                case tree.IfStatement():
                    branches = [statement, *statement.else_ifs]
                    chosen = next((one for one in branches if self.truth(one.if_expression)), statement.else_clause)
                    if chosen is not None:
                        self.run(chosen.statements)
                case tree.ForStatement():
                    assert statement.step is None
                    counter, last = self.value(statement.from_), self.value(statement.to)
                    self.assign(statement.control, counter)
                    while self.value(statement.control) <= last:
                        self.run(statement.statements)
                        self.assign(statement.control, self.value(statement.control) + 1)
                case tree.FunctionCallStatement():
                    block = self.values[str(statement.name.name).upper()]
                    block.call(**{str(one.name.name): self.value(one.value) for one in statement.parameters})
                case _:
                    raise NotImplementedError(type(statement).__name__)

    def assign(self, target: Any, value: Any) -> None:
        if isinstance(target, tree.MultiElementVariable):
            array, index = self.element(target)
            array.values[array.at(index)] = converted(array.kind, value)
            return
        name = str(target.name).upper()
        assert name not in self.constants, f"{name} is a constant"
        self.values[name] = converted(self.types[name], value)

    def element(self, variable: Any) -> tuple[Array, int]:
        ((subscript,),) = (part.subscripts for part in variable.elements)
        return self.values[str(variable.name.name).upper()], self.value(subscript)

    def truth(self, expression: Any) -> bool:
        value = self.value(expression)
        assert isinstance(value, bool | np.bool_), "a condition is BOOL"
        return bool(value)

    def value(self, expression: Any) -> Any:
        match expression:
            case tree.Integer():
                return int(expression.value)
            case tree.Real():
                return Literal(str(expression.value))
            case tree.Boolean():
                return str(expression.value).upper() == "TRUE"
            case tree.ParenthesizedExpression():
                return self.value(expression.expr)
            case tree.UnaryOperation():
                value = self.value(expression.expr)
                return (not value) if str(expression.op).upper() == "NOT" else -value
            case tree.BinaryOperation():
                return combined(str(expression.op).upper(), self.value(expression.left), self.value(expression.right))
            case tree.FunctionCall():
                (parameter,) = expression.parameters
                return called(str(expression.name.name).upper(), self.value(parameter.value))
            case tree.SimpleVariable():
                return self.values[str(expression.name).upper()]
            case tree.MultiElementVariable() if isinstance(expression.elements[0], tree.SubscriptList):
                array, index = self.element(expression)
                return array.values[array.at(index)]
            case tree.MultiElementVariable():
                (field,) = expression.elements
                return getattr(self.values[str(expression.name.name).upper()], str(field.field.name))
        raise NotImplementedError(type(expression).__name__)


class Literal(float):
    """A number in the source, which takes the type of what it meets."""

    def __neg__(self) -> Literal:
        return Literal(-float(self))


def converted(kind: str, value: Any) -> Any:
    if kind in RANGES:
        low, high = RANGES[kind]
        assert isinstance(value, int) and not isinstance(value, bool) and low <= value <= high, f"{value} is no {kind}"
        return value
    if kind == "BOOL":
        assert isinstance(value, bool | np.bool_ | int)
        return bool(value)
    narrowed = kind == "REAL" and isinstance(value, np.float64)
    assert not narrowed, "LREAL into REAL loses digits: a compiler warns"
    return TYPES[kind](value)


def combined(symbol: str, left: Any, right: Any) -> Any:
    if isinstance(left, Literal) and isinstance(right, np.floating):
        left = type(right)(left)
    if isinstance(right, Literal) and isinstance(left, np.floating):
        right = type(left)(right)
    assert type(left) is type(right), f"{left!r} {symbol} {right!r} mixes types"
    value = OPERATORS[symbol](left, right)
    return bool(value) if isinstance(value, np.bool_) else value


def called(name: str, value: Any) -> Any:
    if name == "ABS":
        return abs(value)
    assert name in ("DINT_TO_LREAL", "DINT_TO_REAL") and isinstance(value, int)
    return TYPES[name.removeprefix("DINT_TO_")](value)
