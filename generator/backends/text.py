"""Operations as text, in the syntax of a target language."""

from __future__ import annotations

from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import sympy as sp

from .schedule import schedule
from .sharing import scheduled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from ..program.function import Function, Stage
    from .schedule import Assignment, Operation

# Precedence of a written operation, lowest first.
_SUM, _NEGATIVE, _PRODUCT, _ATOM = range(4)


@dataclass(frozen=True)
class Dialect:
    """Syntax of a target language, where languages differ."""

    functions: Mapping[type, str]  # by class of SymPy, with a brace for each argument
    # square root, and one of several results
    root: str
    component: str
    argument: str = "{}"  # number as an argument of a block that iterates
    # of an array of states, inputs, constants or parameters, by its index
    element: str = "{}[..., {}]"
    negation: str = "not {}"  # comparison that must not hold
    magnitude: str = "abs({})"


def text_of(
    operation: Operation, dialect: Dialect, name: Callable[[sp.Symbol], str] | None = None
) -> str:
    """Return an operation as text, with names of its symbols other than their own, if given.

    Raises `ValueError` if the dialect has no spelling for a function.
    """
    return _Writer(dialect, name or attrgetter("name")).write(operation)[0]


@dataclass(frozen=True)
class StepText:
    """A step as text: name and value, its section of the derivation, and the kind of operation."""

    name: str
    text: str
    section: str
    kind: str
    of: Any


def written(
    emitted: Function | Stage, dialect: Dialect, names: Mapping[str, str] | None = None
) -> tuple[list[StepText], list[str]]:
    """Return the steps and the results of a function as text, with other names for some symbols."""
    order = scheduled(emitted)
    return written_steps(order.steps, dialect, names), written_values(order.results, dialect, names)


def written_steps(
    steps: Sequence[Assignment], dialect: Dialect, names: Mapping[str, str] | None = None
) -> list[StepText]:
    """Return steps as text, with other names for some symbols."""
    texts = written_values((step.value for step in steps), dialect, names)
    return [
        StepText((names or {}).get(s.name, s.name), text, s.section, s.value.kind, s.value.of)
        for s, text in zip(steps, texts, strict=True)
    ]


def written_values(
    values: Iterable[Operation], dialect: Dialect, names: Mapping[str, str] | None = None
) -> list[str]:
    """Return values as text, with other names for some symbols."""
    others = names or {}
    return [text_of(value, dialect, lambda s: others.get(s.name, s.name)) for value in values]


def formula(expression: sp.Expr, dialect: Dialect) -> str:
    """Return a single expression as text."""
    return text_of(schedule(expression), dialect)


@dataclass(frozen=True)
class _Writer:
    dialect: Dialect
    name: Callable[[sp.Symbol], str]

    def write(self, operation: Operation) -> tuple[str, int]:
        """Return the text, and its precedence."""
        kind, of = operation.kind, operation.of
        if kind == "symbol":
            return self.name(of), _ATOM
        if kind == "number":
            return number_text(of)
        parts = [self.write(operand) for operand in operation.operands]
        if kind in _OPERATORS:
            return _OPERATORS[kind](*parts)
        return self._call(operation, [text for text, _ in parts]), _ATOM

    def _call(self, operation: Operation, arguments: list[str]) -> str:
        kind, of = operation.kind, operation.of
        if kind == "iterate":
            spelled = (
                self.dialect.argument.format(text) if given.kind == "number" else text
                for given, text in zip(operation.operands, arguments, strict=True)
            )
            return f"{of}({', '.join(spelled)})"
        if kind == "component":
            return self.dialect.component.format(*arguments, of)
        if kind == "root":
            return self.dialect.root.format(*arguments)
        if of not in self.dialect.functions:
            message = f"{of.__name__} of {', '.join(arguments)} has no spelling"
            raise ValueError(message)
        return self.dialect.functions[of].format(*arguments)


def _inside(part: tuple[str, int], strength: int) -> str:
    """Return a text, in parentheses where its surroundings have a higher precedence."""
    text, own = part
    return text if own >= strength else f"({text})"


def _sum(first: tuple[str, int], second: tuple[str, int]) -> tuple[str, int]:
    """Write a sum; a term with no sign and no parentheses of its own follows."""
    if second[1] < _PRODUCT <= first[1]:
        first, second = second, first
    return f"{first[0]} + {_inside(second, _PRODUCT)}", _SUM


def _product(one: tuple[str, int], two: tuple[str, int]) -> tuple[str, int]:
    """Write a product; of two factors, one that is a product itself is in front."""
    if two[1] == _PRODUCT and one[1] != _PRODUCT:
        one, two = two, one
    return f"{_inside(one, _PRODUCT)}*{_inside(two, _ATOM)}", _PRODUCT


_OPERATORS: dict[str, Callable[..., tuple[str, int]]] = {
    "add": _sum,
    "subtract": lambda one, two: (f"{one[0]} - {_inside(two, _PRODUCT)}", _SUM),
    "negate": lambda part: (f"-{_inside(part, _PRODUCT)}", _NEGATIVE),
    "multiply": _product,
    "divide": lambda one, two: (f"{_inside(one, _PRODUCT)}/{_inside(two, _ATOM)}", _PRODUCT),
}


def number_text(number: sp.Expr) -> tuple[str, int]:
    """Return a number in double precision, and its precedence."""
    if number == sp.pi:
        return "3.14159265358979323846", _ATOM
    value = sp.Rational(number)
    if value.q & (value.q - 1):  # not exact in binary: let the compiler divide
        return f"({value.p}.0/{value.q}.0)", _ATOM
    return repr(float(value)), _ATOM if value >= 0 else _NEGATIVE
