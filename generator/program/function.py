"""Emitted functions, and the iterations that they call."""

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
"""Result of a block: one where it did not converge, else zero."""


@dataclass(frozen=True, eq=False)
class Function:
    """An emitted function: the pruned program of some results, in no language."""

    # C name without the model's prefix, and docstring of one line
    name: str
    doc: str
    steps: tuple[Step, ...]  # assignments, in order
    results: tuple[sp.Expr, ...]  # expressions of the outputs in the names of the steps, row-major
    labels: tuple[str, ...]  # one label for each output
    shape: tuple[int, ...]  # shape of the output array
    guards: tuple[Guard, ...]  # guards that act in this function
    part: str = ""  # end of the name of its file, behind the model's name
    # iterations that it calls; none in a model whose loops all have a closed form
    blocks: tuple[IterationBlock, ...] = ()

    @property
    def members(self) -> tuple[Function, ...]:
        """The function itself, as a stage of one member."""
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
    """Functions that are computed together, with their common steps computed once.

    Each has the program that it has alone, so that its results are the same to the last bit; the
    printer of a stage emits equal operations once.
    """

    # as of a function
    name: str
    doc: str
    members: tuple[Function, ...]  # functions; their results are concatenated

    @property
    def part(self) -> str:
        """End of the name of its file, behind the model's name."""
        return self.members[0].part

    @property
    def free_symbols(self) -> set[sp.Symbol]:
        """Symbols that the functions read: state, inputs, constants."""
        return set().union(*(member.free_symbols for member in self.members))

    @property
    def guards(self) -> tuple[Guard, ...]:
        """The guards of all functions, each once, in the order of the functions."""
        return tuple(dict.fromkeys(guard for member in self.members for guard in member.guards))

    @property
    def blocks(self) -> tuple[IterationBlock, ...]:
        """The iterations that the functions call."""
        return tuple({block.name: block for m in self.members for block in m.blocks}.values())

    @property
    def size(self) -> int:
        """Number of results of all functions."""
        return sum(member.size for member in self.members)


@dataclass(frozen=True)
class Driven:
    """A driven coordinate along the path of a block."""

    now: sp.Symbol  # symbol in the block, at a stage of the path
    way: sp.Symbol  # symbol of its change within the stage
    # values at the design position, and in a call
    start: sp.Expr
    end: sp.Symbol
    unit: sp.Expr  # change of it that counts like a radian
    turns: bool  # whether it is an angle: a full turn changes nothing


@dataclass(frozen=True)
class Estimate:
    """Symbols of the start of one iteration."""

    # estimate is the sum of both
    base: tuple[sp.Symbol, ...]
    step: tuple[sp.Symbol, ...]
    # inverse of J of the stage before: a row for each unknown
    held: tuple[tuple[sp.Symbol, ...], ...]


@dataclass(frozen=True)
class IterationBlock:
    """An iteration with a name."""

    # name of the function in C, and its result (behind a verb, without a full stop)
    name: str
    doc: str
    unknowns: tuple[str, ...]  # names of the unknowns; at the design position they are zero
    equations: int  # number of residuals
    constants: tuple[sp.Symbol, ...]  # constants of one parameter set that it reads
    driven: tuple[Driven, ...]  # coordinates on which it depends
    estimate: Estimate  # inputs of `once` beside constants and coordinates
    # one iteration. Its outputs are those of the block but for `LOST`, the squared distance from
    # the design position, the correction, and the square of the relative change of J.
    once: Function

    @cached_property
    def symbol(self) -> sp.Basic:
        """The name, as an argument of `Iterated`."""
        return Str(self.name)

    @property
    def given(self) -> list[sp.Expr]:
        """Arguments of a call: constants, and start, end and unit of every coordinate."""
        along = [value for d in self.driven for value in (d.start, d.end, d.unit)]
        return [*self.constants, *along]

    @property
    def elements(self) -> list[str]:
        """Names of the elements of the inverse, row by row."""
        rows, columns = range(1, len(self.unknowns) + 1), range(1, self.equations + 1)
        return [f"inverse_{i}{j}" for i in rows for j in columns]

    @property
    def results(self) -> tuple[str, ...]:
        """Names of its results, in order.

        The unknowns; a matrix, row by row, that divided by the determinant is the inverse of J;
        that determinant, with the sign that makes it positive at the design position; whether it is
        lost.
        """
        return (*self.unknowns, *self.elements, "determinant", LOST)
