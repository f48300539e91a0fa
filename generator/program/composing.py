"""Sums and products whose parts do not combine, without SymPy's search for those that do.

SymPy collects the equal terms of each sum and the equal bases of each product, for a third of the
time of a derivation; here, most sums and products have none.
"""

from __future__ import annotations

from functools import cmp_to_key
from typing import TYPE_CHECKING

import sympy as sp

from ..memory import remembered

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

_in_order = cmp_to_key(sp.Basic.compare)


def composed(kind: Callable[..., sp.Expr], parts: Iterable[sp.Expr]) -> sp.Expr:
    """Return ``kind(*parts)``, in the form of SymPy.

    Parameters
    ----------
    kind
        ``sp.Add``, ``sp.Mul``, or another function.
    parts
        Its operands.
    """
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
    """Return a product of different bases and at most one number; None if it is another one."""
    factors = [factor for part in parts for factor in (part.args if part.is_Mul else (part,))]
    numbers = [factor for factor in factors if factor.is_Number]
    others = [factor for factor in factors if not factor.is_Number]
    bases = {factor.base if _is_power(factor) else factor for factor in others}
    alike = len(bases) < len(others) or not all(base.is_Symbol or base.is_Add for base in bases)
    if alike or len(others) < 2 or len(numbers) > 1 or not all(map(_is_factor, numbers)):
        return None
    return _in_form(sp.Mul, numbers, others)


def _sum(terms: Sequence[sp.Expr]) -> sp.Expr | None:
    """Return a sum of different symbols and products; None if it is another one."""
    apart = all(term.is_Symbol or term.is_Mul for term in terms)
    if len(terms) < 2 or not apart or len(set(map(_without_number, terms))) < len(terms):
        return None
    return _in_form(sp.Add, (), terms)


def _in_form(kind: type[sp.Expr], numbers: Sequence[sp.Expr], others: Sequence[sp.Expr]) -> sp.Expr:
    """Return a sum or a product of parts in the order of SymPy."""
    parts = [*numbers, *sorted(others, key=_in_order)]
    return kind._from_args(parts, is_commutative=True)  # noqa: SLF001 (others search, too)


def _is_power(factor: sp.Expr) -> bool:
    return bool(factor.is_Pow and factor.exp.is_Number)


def _is_factor(number: sp.Expr) -> bool:
    """Return whether a number stays in a product: zero and one do not."""
    return bool(number.is_Rational and number not in (0, 1))


def _without_number(term: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return the factors of a term but for its number, which SymPy writes first."""
    factors: tuple[sp.Expr, ...] = term.args if term.is_Mul else (term,)
    return factors[1:] if factors[0].is_Number else factors
