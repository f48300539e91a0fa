"""The straight-line program: named steps, no branch, and no iteration but where one is allowed.

A *step* is a name and a small expression in earlier names. Everything the generator derives is a
step of one `Program`; an emitted `Function` is the part of the program that its results need.

Two stages are distinguished by what a step depends on, not by who wrote it: steps (and parts of
steps) that depend on parameters only are *constants*, computed once per parameter set; all others
belong to the right-hand side.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import sympy as sp

from .derivatives import chain_rule
from .floors import SMALLEST
from .functions import Component, Frozen, Guarded, Iterated
from .narrow import function_of
from .spelling import SpellingError, spelled
from .steps import Guard, Step, ancestors, first_free
from .symbols import symbols_of
from .together import share_together
from .vectors import Vector

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from .constants import ConstantStage
    from .function import Function, IterationBlock


@dataclass
class Program:
    """The steps of one variant of a model, and the means to extend, differentiate, prune them.

    Parameters
    ----------
    constants
        Where steps go that depend on parameters only.
    """

    constants: ConstantStage
    steps: dict[sp.Symbol, Step] = field(default_factory=dict)
    guards: dict[sp.Symbol, Guard] = field(default_factory=dict)
    _section: str = ""
    _known: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    _varying: set[sp.Expr] = field(default_factory=set)  # nothing in them can be hoisted
    _spells: bool = False

    def section(self, title: str) -> None:
        """Name the part of the derivation that the next steps belong to."""
        self._section = title

    def define(self, name: str, expression: Any) -> sp.Expr:
        """Append a step and return its symbol.

        Numbers, symbols and their negatives are returned as they are, and an expression that is
        already a step is not repeated, so that zeros and shared values disappear on the way. The
        symbol has a number behind its name where something else has that name already.

        Parameters
        ----------
        name
            Of the step.
        expression
            In names of the program.
        """
        if self._spells:
            expression = self._spelled(name, expression)
        expression = self.constants.insert_derived(sp.sympify(expression))
        if expression.is_Atom or (-expression).is_Symbol:
            return expression
        if self.constants.contains(expression):
            return self.constants.define(name, expression, self._section)
        if expression in self._known:
            return self._known[expression]
        if -expression in self._known:
            return -self._known[-expression]
        symbol = first_free(name, self._has)
        self.constants.note(symbol.name)
        self.steps[symbol] = Step(symbol, expression, self._section)
        self._known[expression] = symbol
        return symbol

    @contextmanager
    def spelling(self) -> Iterator[None]:
        """Let steps have formulas as anybody writes them; see `spelled`.

        Raises
        ------
        SpellingError
            By `define`, where one cannot be emitted.
        """
        self._spells = True
        try:
            yield
        finally:
            self._spells = False

    def _spelled(self, name: str, formula: Any) -> sp.Expr:
        if not re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name):
            message = f"the step {name!r} has a name that cannot be written in C"
            raise SpellingError(message)
        return spelled(self.define, formula)

    def _has(self, name: str) -> bool:
        return sp.Symbol(name) in self.steps or self.constants.has(name)

    def vector(self, name: str, vector: Vector, suffixes: str = "xyz") -> Vector:
        """Append a step for each component of a vector.

        Parameters
        ----------
        name, vector
            What begins the names of the steps, and the vector.
        suffixes
            What ends them.
        """
        return Vector(
            *(self.define(f"{name}_{s}", c) for s, c in zip(suffixes, vector, strict=True))
        )

    def axes(
        self, names: tuple[str, str, str], vectors: Iterable[Vector], suffixes: str = "xyz"
    ) -> tuple[Vector, Vector, Vector]:
        """Append a step for each component of three vectors.

        Parameters
        ----------
        names, vectors
            What begins the names of the steps, and the vectors.
        suffixes
            What ends them.
        """
        x, y, z = (self.vector(n, v, suffixes) for n, v in zip(names, vectors, strict=True))
        return x, y, z

    def guarded(
        self, name: str, expression: Any, meaning: str, unit: str, floor: Any = SMALLEST
    ) -> sp.Expr:
        """Append a step whose value must be over a floor, and return its guarded form.

        Constants are not guarded: the parameter stage checks them all at once.

        Parameters
        ----------
        name, meaning, unit
            Of the quantity, and what it means that it is not over the floor.
        expression
            The quantity.
        floor
            In parameters and constants, or a number; see `conditioning`.
        """
        symbol = self.define(name, expression)
        if self.constants.contains(symbol):
            return symbol
        if symbol not in self.guards:
            least = self.define(f"{name}_floor", floor)
            self.guards[symbol] = Guard(symbol, name, meaning, unit, least)
        return Guarded(symbol, self.guards[symbol].floor)

    def iterated(self, name: str, block: IterationBlock) -> dict[str, sp.Expr]:
        """Append the call of a block that iterates, and return its results by name.

        Parameters
        ----------
        name, block
            What begins the names of the steps, and the block.
        """
        results = self.define(name, Iterated(block.symbol, *block.given))
        return {
            label: self.define(f"{name}_{label}", Component(results, place))
            for place, label in enumerate(block.results)
        }

    # -- differentiation ------------------------------------------------------------------------

    def tangents(
        self,
        along: sp.Symbol,
        targets: Iterable[sp.Expr],
        label: str,
        instead: Mapping[sp.Symbol, sp.Expr] | None = None,
    ) -> list[sp.Expr]:
        """Differentiate expressions along one symbol, step by step (forward mode).

        Parameters
        ----------
        along
            The symbol to differentiate by.
        targets
            Expressions in the names of the program.
        label
            Ends the names of the new steps: ``name__label``.
        instead
            As in `along`.

        Raises
        ------
        ValueError
            If the symbol is a parameter: derivatives by those are of whole functions, and of
            `prepare` (`directions`).
        """
        if self.constants.contains(along):
            message = f"{along} is a parameter; see `directions` for derivatives by parameters"
            raise ValueError(message)
        return self.along({along: sp.Integer(1)}, targets, label, instead)

    def along(
        self,
        direction: Mapping[sp.Symbol, sp.Expr],
        targets: Iterable[sp.Expr],
        label: str,
        instead: Mapping[sp.Symbol, sp.Expr] | None = None,
    ) -> list[sp.Expr]:
        """Differentiate expressions along a direction, step by step (forward mode).

        Parameters
        ----------
        direction
            Of each symbol that changes, by how much.
        targets
            Expressions in the names of the program.
        label
            Ends the names of the new steps: ``name__label``.
        instead
            Of steps, expressions of the same value that are differentiated in their place.
        """
        tangent: dict[sp.Symbol, sp.Expr] = dict(direction)
        if instead:
            self._extend(tangent, instead.values(), label)
            for symbol, same in instead.items():
                derivative = chain_rule(same, tangent)
                tangent[symbol] = self.define(f"{symbol}__{label}", derivative)
        targets = list(targets)
        self._extend(tangent, targets, label)
        return [chain_rule(target, tangent) for target in targets]

    def _extend(
        self, tangent: dict[sp.Symbol, sp.Expr], targets: Iterable[sp.Expr], label: str
    ) -> None:
        """Add the derivatives of all steps that some expressions need, where they are not zero."""
        moving = {
            symbol: step
            for symbol, step in self.steps.items()
            if symbol not in tangent and not isinstance(step.expression, Frozen)
        }
        needed = ancestors(moving, targets)
        for step in [s for s in moving.values() if s.symbol in needed]:
            derivative = chain_rule(step.expression, tangent, step.symbol)
            if derivative != 0:
                tangent[step.symbol] = self.define(f"{step.symbol}__{label}", derivative)

    def substitute(
        self, replacements: Mapping[sp.Symbol, sp.Expr], targets: Iterable[sp.Expr], label: str
    ) -> list[sp.Expr]:
        """Repeat the steps of some expressions with other symbols in place of given ones.

        Parameters
        ----------
        replacements
            Symbols of the program and what replaces them.
        targets
            Expressions in the names of the program.
        label
            Ends the names of the new steps: ``name__label``.
        """
        targets = list(targets)
        needed = ancestors(self.steps, targets)
        replaced = dict(replacements)
        for step in [s for s in self.steps.values() if s.symbol in needed]:
            if step.symbol in self.guards and symbols_of(step.expression) & replaced.keys():
                guard = self.guards[step.symbol]
                new = self.guarded(
                    f"{step.symbol}__{label}",
                    step.expression.xreplace(replaced),
                    guard.meaning,
                    guard.unit,
                    guard.floor,
                ).args[0]
            else:
                new = self.define(f"{step.symbol}__{label}", step.expression.xreplace(replaced))
            if new != step.symbol:
                replaced[step.symbol] = new
        return [target.xreplace(replaced) for target in targets]

    # -- pruning --------------------------------------------------------------------------------

    def function(
        self,
        name: str,
        doc: str,
        results: Mapping[str, sp.Expr],
        shape: Sequence[int] | None = None,
    ) -> Function:
        """Prune the program to some results and share their common subexpressions.

        Parameters
        ----------
        name, doc
            Of the function.
        results
            By their labels.
        shape
            Of the array; none: a row.
        """
        pruned = self.pruned(name, doc, results, shape)
        (function,), _ = share_together({"": [pruned]}, self.steps, self.constants.has)
        return function

    def pruned(
        self,
        name: str,
        doc: str,
        results: Mapping[str, sp.Expr],
        shape: Sequence[int] | None = None,
    ) -> Function:
        """Prune the program to some results; `share_together` makes a function of it.

        Parameters
        ----------
        name, doc
            Of the function.
        results
            By their labels.
        shape
            Of the array; none: a row.
        """
        written = (self.constants.insert_derived(sp.sympify(e)) for e in results.values())
        expressions = [self._hoist(e) for e in written]
        needed = ancestors(self.steps, expressions)
        steps = [
            Step(s.symbol, self._hoist(s.expression), s.section)
            for s in self.steps.values()
            if s.symbol in needed
        ]
        return function_of(
            name,
            doc,
            dict(zip(results, expressions, strict=True)),
            steps,
            self.guards.values(),
            self.constants.blocks.values(),
            shape=shape,
        )

    # -- constants ------------------------------------------------------------------------------

    def _hoist(self, expression: sp.Expr) -> sp.Expr:
        """Move the parts that depend on parameters only into the constant stage."""
        if expression.is_Atom:
            return expression
        if expression in self._varying:
            return expression
        hoisted = self._without_constant_parts(expression)
        if hoisted == expression:
            self._varying.add(expression)
        return hoisted

    def _without_constant_parts(self, expression: sp.Expr) -> sp.Expr:
        if self.constants.contains(expression):
            return self.constants.collect(expression)
        arguments = [self._hoist(a) for a in expression.args]
        if isinstance(expression, sp.Add | sp.Mul):
            constant = [a for a in arguments if self.constants.contains(a) and a not in (-1, 1)]
            if len(constant) > 1:
                rest = [a for a in arguments if a not in constant]
                group = self.constants.collect(expression.func(*constant))
                return expression.func(group, *rest)
        return expression.func(*arguments)
