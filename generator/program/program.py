"""The straight-line program: named steps, no branch, and no iteration but where one is allowed.

A *step* is a name and a small expression in earlier names. Every derived quantity is a step of one
`Program`; an emitted `Function` is the part of the program that its results need.

Two stages are distinguished by the symbols that a step depends on: steps (and parts of steps) that
depend on parameters only are *constants*, computed once per parameter set; all others belong to the
right-hand side.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from operator import attrgetter, is_
from typing import TYPE_CHECKING, Any

import sympy as sp

from .composing import composed
from .dependencies import Dependencies
from .derivatives import chain_rule
from .floors import SMALLEST
from .functions import Component, Frozen, Guarded, Iterated
from .narrow import function_of
from .spelling import SpellingError, spelled
from .steps import Guard, Step, ancestors, first_free
from .symbols import symbols_of, with_symbols
from .together import share_together
from .vectors import Vector

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from .constants import ConstantStage
    from .function import Function, IterationBlock


_SIGNS = (sp.S.NegativeOne, sp.S.One)


@dataclass
class Program:
    """The steps of one variant of a model, and the means to extend, differentiate, prune them.

    `constants` receives the steps that depend on parameters only.
    """

    constants: ConstantStage
    steps: dict[sp.Symbol, Step] = field(default_factory=dict)
    guards: dict[sp.Symbol, Guard] = field(default_factory=dict)
    _section: str = ""
    _known: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    # symbols of each of these
    _read: set[frozenset[sp.Symbol]] = field(default_factory=set)
    _varying: set[sp.Expr] = field(default_factory=set)  # without parts to hoist
    _spells: bool = False
    # outputs of narrow parts with their inputs, and the derivatives with respect to these
    _narrow: dict[sp.Symbol, tuple[sp.Symbol, ...]] = field(default_factory=dict)
    _partials: dict[tuple[sp.Symbol, sp.Symbol], sp.Expr] = field(default_factory=dict)
    # for derivatives: estimates that are corrected afterwards depend on nothing
    _dependencies: Dependencies = field(default_factory=Dependencies)

    def section(self, title: str) -> None:
        """Begin a section of the derivation, to which the next steps belong."""
        self._section = title

    def define(self, name: str, expression: Any) -> sp.Expr:
        """Append a step and return its symbol.

        Numbers, symbols and their negatives are returned unchanged, and an expression that is
        already a step is not repeated, so that zeros and shared values disappear on the way. A
        number is added to the name where it is taken already. The expression is in names of the
        program.
        """
        if self._spells:
            expression = self._spelled(name, expression)
        expression = self.constants.insert_derived(sp.sympify(expression))
        if expression.is_Atom or (expression.is_Mul and (-expression).is_Symbol):
            return expression
        if self.constants.contains(expression):
            return self.constants.define(name, expression, self._section)
        if expression in self._known:
            return self._known[expression]
        reads = symbols_of(expression)
        if reads in self._read and (opposite := -expression) in self._known:
            return -self._known[opposite]
        symbol = first_free(name, self._has)
        self.constants.note(symbol.name)
        self.steps[symbol] = Step(symbol, expression, self._section)
        self._dependencies.add(symbol, () if isinstance(expression, Frozen) else reads)
        self._known[expression] = symbol
        self._read.add(reads)
        return symbol

    @contextmanager
    def spelling(self) -> Iterator[None]:
        """Allow steps to have formulas in any form, see `spelled`.

        Then `define` raises `SpellingError` where one cannot be emitted.
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
        """Append a step for each component of a vector; its name ends with the suffix."""
        return Vector(
            *(self.define(f"{name}_{s}", c) for s, c in zip(suffixes, vector, strict=True))
        )

    def axes(
        self, names: tuple[str, str, str], vectors: Iterable[Vector], suffixes: str = "xyz"
    ) -> tuple[Vector, Vector, Vector]:
        """Append a step for each component of three vectors; their names end with the suffixes."""
        x, y, z = (self.vector(n, v, suffixes) for n, v in zip(names, vectors, strict=True))
        return x, y, z

    def guarded(
        self, name: str, expression: Any, meaning: str, unit: str, floor: Any = SMALLEST
    ) -> sp.Expr:
        """Append a step whose value must exceed a floor, and return its guarded form.

        Constants are not guarded: the parameter stage checks them all at once. `meaning` is the
        cause of a value below the floor, for the message; the floor is in parameters and constants,
        or a number, see `floors`.
        """
        symbol = self.define(name, expression)
        if self.constants.contains(symbol):
            return symbol
        if symbol not in self.guards:
            least = self.define(f"{name}_floor", floor)
            self.guards[symbol] = Guard(symbol, name, meaning, unit, least)
        return Guarded(symbol, self.guards[symbol].floor)

    def iterated(self, name: str, block: IterationBlock) -> dict[str, sp.Expr]:
        """Append the call of a block that iterates; return its results by name."""
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
        """Differentiate expressions with respect to one symbol, step by step (forward mode).

        Other arguments are as in `along`. Raises `ValueError` if the symbol is a parameter:
        derivatives with respect to parameters are those of whole functions, and of `prepare`
        (`directions`).
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

        `direction` has the rate of each symbol that changes. `label` ends the names of the new
        steps: ``name__label``. `instead` are expressions of the same value as some steps, to be
        differentiated instead of these.
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

    def narrow(self, inputs: Iterable[sp.Expr], outputs: Iterable[sp.Expr]) -> None:
        """Differentiate steps along a few others that they depend on, once for all directions.

        A direction then takes one product for each pair of them, and not all steps in between.
        `inputs` are the few steps, `outputs` those that depend on them, and on states and inputs.
        """
        given = {symbol for e in inputs for symbol in symbols_of(e)}
        ends = [s for e in outputs for s in symbols_of(e) if s in self.steps and s not in given]
        between = {symbol: step for symbol, step in self.steps.items() if symbol not in given}
        inner = ancestors(between, ends)
        read = {s for symbol in inner for s in symbols_of(self.steps[symbol].expression)}
        found = [s for s in read - inner if not self.constants.contains(s)]
        ordered = tuple(sorted(found, key=attrgetter("name")))
        self._narrow |= dict.fromkeys(ends, ordered)

    def _by_inputs(self, output: sp.Symbol, tangent: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
        """Return the derivative of an output of a narrow part, from those along its inputs."""
        inputs = self._narrow[output]
        total = sp.Integer(0)
        for symbol in inputs:
            if tangent.get(symbol, 0) != 0:
                total += self._partial(output, symbol) * tangent[symbol]
        return total

    def _partial(self, output: sp.Symbol, by: sp.Symbol) -> sp.Expr:
        """Return the derivative of an output of a narrow part with respect to one of its inputs."""
        if (output, by) not in self._partials:
            inputs = self._narrow[output]
            together = [s for s, others in self._narrow.items() if others == inputs]
            tangent = dict.fromkeys(inputs, sp.Integer(0)) | {by: sp.Integer(1)}
            self._extend(tangent, together, f"by_{by}", frozenset(together))
            self._partials |= {(s, by): tangent.get(s, sp.Integer(0)) for s in together}
        return self._partials[output, by]

    def _extend(
        self,
        tangent: dict[sp.Symbol, sp.Expr],
        targets: Iterable[sp.Expr],
        label: str,
        through: frozenset[sp.Symbol] = frozenset(),
    ) -> None:
        """Add to `tangent` the nonzero derivatives of all steps that some targets need.

        Outputs of a narrow part are differentiated with respect to its inputs, but for those in
        `through`.
        """
        narrow = {s: inputs for s, inputs in self._narrow.items() if s not in through}
        ends = {s for target in targets for s in symbols_of(target)}
        for symbol in self._dependencies.changing(tangent, ends, narrow):
            if symbol in narrow:
                derivative = self._by_inputs(symbol, tangent)
            else:
                derivative = chain_rule(self.steps[symbol].expression, tangent, symbol)
            if derivative != 0:
                tangent[symbol] = self.define(f"{symbol}__{label}", derivative)

    def substitute(
        self, replacements: Mapping[sp.Symbol, sp.Expr], targets: Iterable[sp.Expr], label: str
    ) -> list[sp.Expr]:
        """Repeat the steps of some targets with symbols replaced; new names are ``name__label``."""
        targets = list(targets)
        needed = ancestors(self.steps, targets)
        replaced = dict(replacements)
        for step in [s for s in self.steps.values() if s.symbol in needed]:
            if step.symbol in self.guards and symbols_of(step.expression) & replaced.keys():
                guard = self.guards[step.symbol]
                new = self.guarded(
                    f"{step.symbol}__{label}",
                    with_symbols(step.expression, replaced),
                    guard.meaning,
                    guard.unit,
                    guard.floor,
                ).args[0]
                original = guard.original or step.symbol
                self.guards[new] = replace(self.guards[new], original=original)
            else:
                same = with_symbols(step.expression, replaced)
                new = self.define(f"{step.symbol}__{label}", same)
            if new != step.symbol:
                replaced[step.symbol] = new
        return [with_symbols(target, replaced) for target in targets]

    # -- pruning --------------------------------------------------------------------------------

    def function(
        self,
        name: str,
        doc: str,
        results: Mapping[str, sp.Expr],
        shape: Sequence[int] | None = None,
    ) -> Function:
        """Prune the program to some results and share their common subexpressions.

        Results are by their labels; without a shape the array is a row.
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
        """Prune the program to some results; `share_together` makes a function of it."""
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
        if hoisted is expression:
            self._varying.add(expression)
        return hoisted

    def _without_constant_parts(self, expression: sp.Expr) -> sp.Expr:
        if self.constants.contains(expression):
            return self.constants.collect(expression)
        arguments = [self._hoist(a) for a in expression.args]
        if isinstance(expression, sp.Add | sp.Mul):
            constant = [a for a in arguments if self.constants.contains(a) and a not in _SIGNS]
            if len(constant) > 1:
                rest = [a for a in arguments if a not in constant]
                group = self.constants.collect(expression.func(*constant))
                return expression.func(group, *rest)
        unchanged = all(map(is_, arguments, expression.args))
        return expression if unchanged else composed(expression.func, arguments)
