"""Sums and products whose parts do not combine, without SymPy's search for those that do.

SymPy collects the equal terms of each sum and the equal bases of each product, for a third of the
time of a derivation; here, most sums and products have none.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..memory import remembered
from .orders import by_class

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence


def composed(kind: Callable[..., sp.Expr], parts: Iterable[sp.Expr]) -> sp.Expr:
    """Return ``kind(*parts)``, in the form of SymPy, such as a sum or product."""
    return _composed(kind, tuple(parts))


@remembered
def _composed(kind: Callable[..., sp.Expr], parts: tuple[sp.Expr, ...]) -> sp.Expr:
    found = None
    if kind is sp.Mul:
        found = _product(parts)
    elif kind is sp.Add:
        found = _sum(parts)
    return kind(*parts) if found is None else found


def _product(parts: Sequence[sp.Expr]) -> sp.Expr | None:
    """Return a product of different bases and a number; None if it is another one."""
    number, others = sp.S.One, []
    for factor in [f for part in parts for f in (part.args if part.is_Mul else (part,))]:
        if not factor.is_Number:
            others.append(factor)
        elif factor is not sp.S.One:
            number = factor if number is sp.S.One else number * factor
    if len(others) == 1 and number is sp.S.One:
        return others[0]
    bases = {f.base if f.is_Pow and f.exp.is_Number else f for f in others}
    apart = len(bases) == len(others) > 1 and all(b.is_Symbol or b.is_Add for b in bases)
    if not apart or not number.is_Rational or number is sp.S.Zero:
        return None
    return _in_form(sp.Mul, [] if number is sp.S.One else [number], others)


def _sum(terms: Sequence[sp.Expr]) -> sp.Expr | None:
    """Return a sum of different symbols and products; None if it is another one."""
    if len(terms) == 1:
        return terms[0]
    apart = all(term.is_Symbol or term.is_Mul for term in terms)
    if not terms or not apart or len(set(map(_without_number, terms))) < len(terms):
        return None
    return _in_form(sp.Add, [], terms)


def _in_form(kind: type[sp.Expr], numbers: list[sp.Expr], others: Sequence[sp.Expr]) -> sp.Expr:
    """Return a sum or a product of parts in the order of SymPy."""
    parts = [*numbers, *sorted(others, key=by_class)]
    return kind._from_args(parts, is_commutative=True)  # noqa: SLF001 (others search, too)


def _without_number(term: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return the factors of a term but for its number, which SymPy writes first."""
    factors: tuple[sp.Expr, ...] = term.args if term.is_Mul else (term,)
    return factors[1:] if factors[0].is_Number else factors
