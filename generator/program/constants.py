"""The stage of a parameter set: steps that depend on parameters only."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import sympy as sp

from .function import Function, IterationBlock
from .functions import SignOf
from .steps import Step, ancestors, first_free
from .symbols import symbols_of, with_symbols

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from .conditions import Assumption, Condition


@dataclass
class ConstantStage:
    """Steps that depend on parameters only, shared by all programs of a model."""

    parameters: tuple[sp.Symbol, ...]  # symbols that are fixed for one parameter set
    reserved: frozenset[str] = frozenset()  # names of states and inputs, which no step may have
    # expressions in parameters, by the symbols that represent them in equations
    derived: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    steps: dict[sp.Symbol, Step] = field(default_factory=dict)  # steps, in order
    # iterations of all programs, by their names
    blocks: dict[str, IterationBlock] = field(default_factory=dict)
    # constants that must not vanish
    conditions: dict[sp.Expr, Condition] = field(default_factory=dict)
    _known: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    _varying: set[str] = field(default_factory=set)  # names of steps of the programs
    _collected: int = 0

    def contains(self, expression: sp.Expr) -> bool:
        """Return whether an expression depends on parameters only."""
        return self._fixed.issuperset(symbols_of(expression))

    @cached_property
    def _fixed(self) -> set[sp.Symbol]:
        """Parameters, and the symbols of all steps."""
        return {*self.parameters, *self.steps}

    def insert_derived(self, expression: sp.Expr) -> sp.Expr:
        """Write an expression without derived symbols."""
        return with_symbols(expression, self.derived)

    def has(self, name: str) -> bool:
        """Return whether a name is that of a constant, a parameter, a state or an input.

        Parameters of a copy count, since they are replaced wherever their names are read.
        """
        symbol = sp.Symbol(name)
        known = (self._fixed, self.derived)
        return any(symbol in names for names in known) or name in self.reserved

    def note(self, name: str) -> None:
        """Reserve the name of a program's step, so that no constant gets it."""
        self._varying.add(name)

    def define(self, name: str, expression: sp.Expr, section: str) -> sp.Expr:
        """Append a step of a section; return its symbol, or that of an equal step defined before.

        A number is added to the name where it is taken already.
        """
        form = self._form(expression)
        if form in self._known:
            return self._known[form]
        negative = SignOf(-form.args[0]) if isinstance(form, SignOf) else -form
        if negative in self._known:
            return -self._known[negative]
        symbol = first_free(name, lambda n: self.has(n) or n in self._varying)
        self.steps[symbol] = Step(symbol, expression, section)
        self._fixed.add(symbol)
        self._known[form] = symbol
        return symbol

    def _form(self, expression: sp.Expr) -> sp.Expr:
        """Return the form by which an equal step is found.

        In a mirror image, equal expressions often have their brackets and signs in other places:
        where there are copies, steps are compared in expanded form.
        """
        return sp.expand(expression) if self.derived else expression

    def collect(self, expression: sp.Expr) -> sp.Expr:
        """Return a name for a constant part of an equation."""
        if expression.is_Atom or (expression.is_Mul and (-expression).is_Symbol):
            return expression
        if expression.could_extract_minus_sign():
            return -self.collect(-expression)
        if self._form(expression) not in self._known:
            self._collected += 1
        return self.define(
            f"constant_{self._collected}", expression, "constants collected from the equations"
        )

    def function(
        self, functions: Iterable[Function], assumptions: Iterable[Assumption] = ()
    ) -> Function:
        """Return the parameter stage: all constants that functions read or that are checked.

        A quantity that is checked is a constant too, so that an error can contain its value;
        `assumptions` are quantities to check, beside those of the conditions.
        """
        used = set().union(*(f.free_symbols for f in functions))
        used = used.union(*(symbols_of(a.quantity) | symbols_of(a.scale) for a in assumptions))
        kept = self.conditions.values()
        used = used.union(*(symbols_of(c.quantity) | symbols_of(c.least) for c in kept))
        results = [s for s in (*self.parameters, *self.steps) if s in used]
        needed = ancestors(self.steps, results)
        return Function(
            "prepare",
            "Constants of one parameter set.",
            tuple(step for step in self.steps.values() if step.symbol in needed),
            tuple(results),
            tuple(map(str, results)),
            (len(results),),
            (),
        )
