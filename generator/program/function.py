"""What is emitted: a function, and the iterations that it calls."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from sympy.core.symbol import Str

from .symbols import symbols_of

if TYPE_CHECKING:
    import sympy as sp

    from .steps import Guard, Step

LOST = "lost"
"""Result of a block: one where it has not arrived, else zero."""


@dataclass(frozen=True, eq=False)
class Function:
    """An emitted function: the pruned program of some results, in no language.

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
    blocks: tuple[IterationBlock, ...] = ()

    @property
    def members(self) -> tuple[Function, ...]:
        """The function itself, as of a stage that has no other."""
        return (self,)

    @property
    def size(self) -> int:
        """Number of results."""
        return len(self.results)

    @cached_property
    def free_symbols(self) -> frozenset[sp.Symbol]:
        """Symbols that the function reads: state, inputs, constants."""
        expressions = [step.expression for step in self.steps]
        used = frozenset().union(*map(symbols_of, (*expressions, *self.results)))
        return used - {step.symbol for step in self.steps}


@dataclass(frozen=True, eq=False)
class Stage:
    """Functions that are computed together: what they share is computed once.

    The program of each is that which it has by itself, so that its results are the same to the last
    bit; who writes a stage carries out equal operations once.

    Attributes
    ----------
    name, doc
        As of a function.
    members
        The functions, whose results are returned one behind the other.
    """

    name: str
    doc: str
    members: tuple[Function, ...]

    @property
    def part(self) -> str:
        """What the file that it is printed in adds to the model's name."""
        return self.members[0].part

    @property
    def free_symbols(self) -> set[sp.Symbol]:
        """Symbols that the functions read: state, inputs, constants."""
        return set().union(*(member.free_symbols for member in self.members))

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The guards that act in one of the functions, in the order of the first that has each."""
        return tuple(dict.fromkeys(guard for member in self.members for guard in member.guards))

    @property
    def blocks(self) -> tuple[IterationBlock, ...]:
        """The iterations that are called."""
        return tuple({block.name: block for m in self.members for block in m.blocks}.values())

    @property
    def size(self) -> int:
        """Number of results of all functions."""
        return sum(member.size for member in self.members)


@dataclass(frozen=True)
class Driven:
    """A coordinate on the way of a block.

    Attributes
    ----------
    now
        Its name in the block, where it represents the coordinate of a stage.
    way
        The name of how far it goes in that stage.
    start, end
        At the design position, and in a call.
    unit
        What of it is as much as a radian.
    turns
        Whether it is an angle: a full turn changes nothing.
    """

    now: sp.Symbol
    way: sp.Symbol
    start: sp.Expr
    end: sp.Symbol
    unit: sp.Expr
    turns: bool


@dataclass(frozen=True)
class Estimate:
    """What one iteration is given, as symbols.

    Attributes
    ----------
    base, step
        The estimate is this base, and this step from it.
    held
        The inverse of J of the stage before: a row for each unknown.
    """

    base: tuple[sp.Symbol, ...]
    step: tuple[sp.Symbol, ...]
    held: tuple[tuple[sp.Symbol, ...], ...]


@dataclass(frozen=True)
class IterationBlock:
    """An iteration with a name.

    Attributes
    ----------
    name, doc
        Name of the function in C, and what it finds (behind a verb, without a full stop).
    unknowns
        Names of what it finds; at the design position they are zero.
    equations
        Number of residuals.
    constants
        What it reads of one parameter set.
    driven
        The coordinates that move it.
    estimate
        What `once` is given beside constants and coordinates.
    once
        One iteration. Its outputs are those of the block but for `LOST`, the square of how far it
        is from the design position, the correction, and the square of how much J has changed.
    """

    name: str
    doc: str
    unknowns: tuple[str, ...]
    equations: int
    constants: tuple[sp.Symbol, ...]
    driven: tuple[Driven, ...]
    estimate: Estimate
    once: Function

    @cached_property
    def symbol(self) -> sp.Basic:
        """The name, as an argument of `Iterated`."""
        return Str(self.name)

    @property
    def given(self) -> list[sp.Expr]:
        """What it is called with: constants, and start, end and unit of every coordinate."""
        along = [value for d in self.driven for value in (d.start, d.end, d.unit)]
        return [*self.constants, *along]

    @property
    def elements(self) -> list[str]:
        """Names of the elements of the inverse, row by row."""
        rows, columns = range(1, len(self.unknowns) + 1), range(1, self.equations + 1)
        return [f"inverse_{i}{j}" for i in rows for j in columns]

    @property
    def results(self) -> tuple[str, ...]:
        """Names of what it returns, in order.

        The unknowns; a matrix, row by row, that over the determinant is the inverse of J; that
        determinant, with the sign that makes it positive at the design position; whether it is
        lost.
        """
        return (*self.unknowns, *self.elements, "determinant", LOST)
