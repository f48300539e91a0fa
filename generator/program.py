"""The straight-line program: named steps, no branch, and no iteration but where one is allowed.

A *step* is a name and a small expression in earlier names. Everything the generator derives is a
step of one `Program`; an emitted `Function` is the part of the program that its results need.

Two stages are told apart by what a step depends on, not by who wrote it: steps (and parts of
steps) that depend on parameters only are *constants*, computed once per parameter set; all others
belong to the right-hand side.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain, count
from typing import TYPE_CHECKING, Any

import sympy as sp

from .arithmetic import Component, Guarded, Iterated, SignOf, Written, write
from .conditioning import SMALLEST
from .vectors import Vector

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from .assumptions import Assumption
    from .conditioning import Condition
    from .iteration import Block


@dataclass(frozen=True)
class Guard:
    """A quantity that must be over a floor, its unit, and what it means when it is not.

    The floor is a constant, or a number; see `conditioning`.
    """

    quantity: sp.Symbol
    name: str
    meaning: str
    unit: str
    floor: sp.Expr

    @property
    def margin(self) -> sp.Expr:
        """How far the quantity is over its floor: positive where the model is valid."""
        return self.quantity - self.floor


@dataclass(frozen=True)
class Step:
    """One assignment of the program."""

    symbol: sp.Symbol
    expression: sp.Expr
    section: str


@dataclass(frozen=True)
class WrittenFunction:
    """The steps and the results of a function as text."""

    steps: tuple[Written, ...]
    results: tuple[Written, ...]


@dataclass(frozen=True)
class Function:
    """An emitted function: the pruned program of some results.

    Attributes
    ----------
    name, doc
        C name without the model's prefix, and one line that says what it returns.
    steps
        The assignments, in order.
    results
        Expressions of the outputs in the names of the steps, row-major.
    labels
        One label for each output.
    shape
        Shape of the output array.
    guards
        The guards that act in this function.
    part
        What the file that it is printed in adds to the model's name; empty: nothing.
    blocks
        The iterations that it calls; none in a model whose loops all have a closed form.
    """

    name: str
    doc: str
    steps: tuple[Step, ...]
    results: tuple[sp.Expr, ...]
    labels: tuple[str, ...]
    shape: tuple[int, ...]
    guards: tuple[Guard, ...]
    part: str = ""
    blocks: tuple[Block, ...] = ()

    @property
    def free_symbols(self) -> set[sp.Symbol]:
        """Symbols that the function reads: state, inputs, constants."""
        expressions = [step.expression for step in self.steps]
        used = set().union(*(e.free_symbols for e in (*expressions, *self.results)))
        return used - {step.symbol for step in self.steps}

    def operations(self) -> Counter[str]:
        """Count the arithmetic operations of one call, exactly as they are printed.

        Of a block that iterates, those of one iteration.
        """
        total: Counter[str] = Counter()
        for written in (*self.written.steps, *self.written.results):
            total.update(written.operations)
        blocks = {block.name: block for block in self.blocks}
        for step in self.steps:
            if isinstance(step.expression, Iterated):
                total.update(blocks[step.expression.args[0].name].once.operations())
        return total

    @cached_property
    def written(self) -> WrittenFunction:
        """The text of every step and result in C."""
        ready: dict[sp.Symbol, int] = {}
        steps = []
        for step in self.steps:
            steps.append(write(step.expression, ready=ready))
            ready[step.symbol] = steps[-1].ready
        return WrittenFunction(tuple(steps), tuple(write(r, ready=ready) for r in self.results))


@dataclass
class ConstantStage:
    """Steps that depend on parameters only, shared by all programs of a model.

    Attributes
    ----------
    parameters
        Symbols that are fixed for one parameter set.
    reserved
        Names that no step may have: those of states and inputs.
    derived
        What stands for other symbols that the equations name like parameters.
    steps
        The steps, in order.
    blocks
        The iterations of all programs, by their names.
    conditions
        Constants that must not vanish.
    """

    parameters: tuple[sp.Symbol, ...]
    reserved: frozenset[str] = frozenset()
    derived: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    steps: dict[sp.Symbol, Step] = field(default_factory=dict)
    blocks: dict[str, Block] = field(default_factory=dict)
    conditions: dict[sp.Expr, Condition] = field(default_factory=dict)
    _known: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    _varying: set[str] = field(default_factory=set)  # names of steps of the programs
    _collected: int = 0

    def contains(self, expression: sp.Expr) -> bool:
        """Tell whether an expression depends on parameters only."""
        return all(s in self.steps or s in self._given for s in expression.free_symbols)

    @cached_property
    def _given(self) -> frozenset[sp.Symbol]:
        return frozenset(self.parameters)

    def insert_derived(self, expression: sp.Expr) -> sp.Expr:
        """Write an expression without derived symbols."""
        if self.derived.keys().isdisjoint(expression.free_symbols):
            return expression
        return expression.xreplace(self.derived)

    def has(self, name: str) -> bool:
        """Tell whether a name is that of a constant, a parameter, a state or an input.

        Parameters of a copy count, since they are replaced wherever their names are read.
        """
        symbol = sp.Symbol(name)
        known = (self.steps, self._given, self.derived)
        return any(symbol in names for names in known) or name in self.reserved

    def note(self, name: str) -> None:
        """Keep the name of a program's step from being used for a constant."""
        self._varying.add(name)

    def define(self, name: str, expression: sp.Expr, section: str) -> sp.Expr:
        """Append a step and return its symbol, or that of the same step defined before.

        The symbol has a number behind its name where something else has that name already.
        """
        form = self._form(expression)
        if form in self._known:
            return self._known[form]
        negative = SignOf(-form.args[0]) if isinstance(form, SignOf) else -form
        if negative in self._known:
            return -self._known[negative]
        symbol = _first_free(name, lambda n: self.has(n) or n in self._varying)
        self.steps[symbol] = Step(symbol, expression, section)
        self._known[form] = symbol
        return symbol

    def _form(self, expression: sp.Expr) -> sp.Expr:
        """Return the form by which a step is found again.

        What a mirror image has alike, up to the sign, is often written with its brackets and signs
        in other places; where there are copies, steps are compared when multiplied out.
        """
        return sp.expand(expression) if self.derived else expression

    def collect(self, expression: sp.Expr) -> sp.Expr:
        """Return a name for a constant part of an equation."""
        if expression.is_Atom or (-expression).is_Symbol:
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
        """Return the parameter stage: all constants that some functions read or that are checked.

        What must be zero, or must not, is computed like any constant, so that an error can say by
        how much it is off.
        """
        used = set().union(*(f.free_symbols for f in functions))
        used = used.union(*(a.quantity.free_symbols | a.scale.free_symbols for a in assumptions))
        kept = self.conditions.values()
        used = used.union(*(c.quantity.free_symbols | c.least.free_symbols for c in kept))
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

    def section(self, title: str) -> None:
        """Name the part of the derivation that the next steps belong to."""
        self._section = title

    def define(self, name: str, expression: Any) -> sp.Expr:
        """Append a step and return its symbol.

        Numbers, symbols and their negatives are returned as they are, and an expression that is
        already a step is not repeated, so that zeros and shared values disappear on the way. The
        symbol has a number behind its name where something else has that name already.
        """
        expression = self.constants.insert_derived(sp.sympify(expression))
        if expression.is_Atom or (-expression).is_Symbol:
            return expression
        if self.constants.contains(expression):
            return self.constants.define(name, expression, self._section)
        if expression in self._known:
            return self._known[expression]
        if -expression in self._known:
            return -self._known[-expression]
        symbol = _first_free(name, self._has)
        self.constants.note(symbol.name)
        self.steps[symbol] = Step(symbol, expression, self._section)
        self._known[expression] = symbol
        return symbol

    def _has(self, name: str) -> bool:
        return sp.Symbol(name) in self.steps or self.constants.has(name)

    def vector(self, name: str, vector: Vector, suffixes: str = "xyz") -> Vector:
        """Append a step for each component of a vector."""
        return Vector(
            *(self.define(f"{name}_{s}", c) for s, c in zip(suffixes, vector, strict=True))
        )

    def axes(
        self, names: tuple[str, str, str], vectors: Iterable[Vector], suffixes: str = "xyz"
    ) -> tuple[Vector, Vector, Vector]:
        """Append a step for each component of three vectors."""
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

    def iterated(self, name: str, block: Block) -> dict[str, sp.Expr]:
        """Append the call of a block that iterates, and return its results by name."""
        results = self.define(name, Iterated(block.symbol, *block.given))
        return {
            label: self.define(f"{name}_{label}", Component(results, place))
            for place, label in enumerate(block.results)
        }

    # -- differentiation ------------------------------------------------------------------------

    def tangents(self, along: sp.Symbol, targets: Iterable[sp.Expr], label: str) -> list[sp.Expr]:
        """Differentiate expressions along one symbol, step by step (forward mode).

        Parameters
        ----------
        along
            The symbol to differentiate by.
        targets
            Expressions in the names of the program.
        label
            Ends the names of the new steps: ``name__label``.

        Raises
        ------
        ValueError
            If the symbol is a parameter: the constant stage is not differentiated.
        """
        if self.constants.contains(along):
            message = f"{along} is a parameter; only what varies in time is differentiated by"
            raise ValueError(message)
        targets = list(targets)
        needed = ancestors(self.steps, targets)
        tangent: dict[sp.Symbol, sp.Expr] = {along: sp.Integer(1)}
        for step in [s for s in self.steps.values() if s.symbol in needed]:
            derivative = _chain_rule(step.expression, tangent, step.symbol)
            if derivative != 0:
                tangent[step.symbol] = self.define(f"{step.symbol}__{label}", derivative)
        return [_chain_rule(target, tangent) for target in targets]

    def substitute(
        self, replacements: Mapping[sp.Symbol, sp.Expr], targets: Iterable[sp.Expr], label: str
    ) -> list[sp.Expr]:
        """Repeat the steps of some expressions with other symbols in place of given ones.

        Parameters
        ----------
        replacements
            Symbols of the program and what stands in for them.
        targets
            Expressions in the names of the program.
        label
            Ends the names of the new steps: ``name__label``.
        """
        targets = list(targets)
        needed = ancestors(self.steps, targets)
        replaced = dict(replacements)
        for step in [s for s in self.steps.values() if s.symbol in needed]:
            if step.symbol in self.guards and step.expression.free_symbols & replaced.keys():
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
        """Prune the program to some results and share their common subexpressions."""
        written = (self.constants.insert_derived(sp.sympify(e)) for e in results.values())
        expressions = [self._hoist(e) for e in written]
        needed = ancestors(self.steps, expressions)
        steps = [
            Step(s.symbol, self._hoist(s.expression), s.section)
            for s in self.steps.values()
            if s.symbol in needed
        ]
        steps, expressions = _drop_dead(steps, expressions)
        names = (sp.Symbol(f"shared_{i}") for i in count(1) if not self._has(f"shared_{i}"))
        steps, expressions = _share(steps, expressions, names)
        acting = set().union(*(e.atoms(Guarded) for e in [s.expression for s in steps]), set())
        acting |= set().union(*(e.atoms(Guarded) for e in expressions), set())
        quantities = {g.args[0] for g in acting}
        guards = tuple(g for q, g in self.guards.items() if q in quantities)
        called = {s.expression.args[0].name for s in steps if isinstance(s.expression, Iterated)}
        return Function(
            name,
            doc,
            tuple(steps),
            tuple(expressions),
            tuple(results),
            tuple(shape) if shape is not None else (len(expressions),),
            guards,
            blocks=tuple(block for n, block in self.constants.blocks.items() if n in called),
        )

    # -- constants ------------------------------------------------------------------------------

    def _hoist(self, expression: sp.Expr) -> sp.Expr:
        """Move the parts that depend on parameters only into the constant stage."""
        if expression.is_Atom:
            return expression
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


def _first_free(name: str, taken: Callable[[str], bool]) -> sp.Symbol:
    """Return the symbol of a name, with a number behind it if the name is taken."""
    names = chain([name], (f"{name}_{i}" for i in count(2)))
    return sp.Symbol(next(n for n in names if not taken(n)))


def ancestors(steps: Mapping[sp.Symbol, Step], expressions: Iterable[sp.Expr]) -> set[sp.Symbol]:
    """Return the steps that some expressions depend on."""
    waiting = [s for e in expressions for s in e.free_symbols if s in steps]
    found: set[sp.Symbol] = set()
    while waiting:
        symbol = waiting.pop()
        if symbol not in found:
            found.add(symbol)
            waiting += [s for s in steps[symbol].expression.free_symbols if s in steps]
    return found


def _chain_rule(
    expression: sp.Expr, tangent: Mapping[sp.Symbol, sp.Expr], symbol: sp.Symbol | None = None
) -> sp.Expr:
    """Return the sum of partial derivatives times tangents.

    A root or a reciprocal that is a step of its own is differentiated in terms of its own symbol,
    so that it is not computed again.
    """
    own = expression.is_Pow and expression.exp in (sp.Rational(1, 2), -1)
    if symbol is None or not own:
        return sp.Add(*(partial * tangent[s] for s, partial in _partials(expression, tangent)))
    factor = 1 / (2 * symbol) if expression.exp > 0 else -symbol * symbol
    inner = _partials(expression.base, tangent)
    return sp.Add(*(partial * factor * tangent[s] for s, partial in inner))


def _partials(
    expression: sp.Expr, moving: Mapping[sp.Symbol, sp.Expr]
) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    """Yield each moving symbol of an expression with the derivative by it.

    Of a sum, only the terms with the symbol are looked at: the equation of motion of a long chain
    is one sum over all of its bodies.
    """
    having: dict[sp.Symbol, list[sp.Expr]] = {}
    for term in sp.Add.make_args(expression):
        for s in term.free_symbols & moving.keys():
            having.setdefault(s, []).append(term)
    for s in sorted(having, key=str):
        yield s, sp.Add(*(term.diff(s) for term in having[s]))


def _drop_dead(steps: list[Step], results: list[sp.Expr]) -> tuple[list[Step], list[sp.Expr]]:
    """Remove the steps that no result depends on."""
    wanted = set().union(*(r.free_symbols for r in results), set())
    alive = []
    for step in reversed(steps):
        if step.symbol in wanted:
            alive.append(step)
            wanted |= step.expression.free_symbols
    return alive[::-1], results


def _share(
    steps: list[Step], results: list[sp.Expr], names: Iterator[sp.Symbol]
) -> tuple[list[Step], list[sp.Expr]]:
    """Name the common subexpressions of the whole program (SymPy's ``cse``)."""
    replacements, reduced = sp.cse(
        [*(s.expression for s in steps), *results],
        symbols=names,
        order="canonical",
        list=True,
    )
    waiting = dict(replacements)
    owner: dict[sp.Symbol, sp.Symbol] = {}
    shared: list[Step] = []

    def place(expression: sp.Expr, section: str) -> None:
        for symbol in sorted(expression.free_symbols & waiting.keys(), key=str):
            if symbol in waiting:  # not placed meanwhile, with one that comes before it
                definition = waiting.pop(symbol)
                place(definition, section)
                shared.append(Step(symbol, definition, section))

    for step, expression in zip(steps, reduced, strict=False):
        if expression in waiting:  # a whole step is shared: it keeps its own name
            definition = waiting.pop(expression)
            place(definition, step.section)
            owner[expression] = step.symbol
            shared.append(Step(step.symbol, definition, step.section))
        else:
            place(expression, step.section)
            shared.append(Step(step.symbol, expression, step.section))
    results = list(reduced[len(steps) :])
    for result in results:
        place(result, "results")
    renamed = [Step(s.symbol, s.expression.xreplace(owner), s.section) for s in shared]
    return renamed, [r.xreplace(owner) for r in results]
