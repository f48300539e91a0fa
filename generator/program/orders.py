"""The orders of SymPy for parts of expressions, in a fraction of its time."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Any

import sympy as sp
from sympy.core.basic import ordering_of_classes
from sympy.core.exprtools import decompose_power

from ..memory import remembered
from .symbols import symbols_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

_CLASSES = {name: place for place, name in enumerate(ordering_of_classes)}


@remembered
def by_class(expression: sp.Basic) -> tuple[Any, ...]:
    """Return a key of the order of SymPy's ``compare``, in which it writes terms and factors."""
    name = type(expression).__name__
    known = _CLASSES.get(name)
    content = expression._hashable_content()  # noqa: SLF001 (SymPy's `compare` compares this content, which has no public name)
    return (
        *((len(_CLASSES) + 1, name) if known is None else (known, "")),
        len(content),
        *[by_class(part) if isinstance(part, sp.Basic) else part for part in content],
    )


def by_size(expressions: Iterable[sp.Expr]) -> Iterator[sp.Expr]:
    """Yield expressions in the order of SymPy's ``ordered``: small ones first."""
    for _, group in groupby(sorted(expressions, key=_size), _size):
        alike = list(group)
        yield from sorted(alike, key=_by_terms) if len(alike) > 1 else alike


@remembered
def _size(expression: sp.Basic) -> float:
    return 0.5 if expression.is_Float else 1 + sum(map(_size, expression.args))


@remembered
def _by_terms(expression: sp.Expr) -> Any:
    """Return the ``sort_key`` of SymPy."""
    coefficient, rest = expression.as_coeff_Mul()
    base, exponent = rest.as_base_exp() if rest.is_Pow else (rest, sp.S.One)
    if base.is_Add:
        parts = _terms_in_order(base)
    elif base.is_Mul:
        parts = sorted(base.args, key=_by_terms)
    else:
        parts = None if base.is_Atom else base.args
    if parts is None:
        return expression.sort_key()
    keys = tuple(map(_by_terms, parts))
    return base.class_key(), (len(keys), keys), _by_terms(exponent), coefficient


def first_term(total: sp.Expr) -> sp.Expr | None:
    """Return the term of a sum that SymPy prints first; None if that depends on numbers."""
    terms = _terms_in_order(total)
    return terms[0] if terms else None


@remembered
def _terms_in_order(total: sp.Expr) -> Sequence[sp.Expr] | None:
    """Return ``as_ordered_terms`` of SymPy; None if it depends on numbers."""
    powers = []
    for term in total.args:
        factors = term.args if term.is_Mul else (term,)
        if factors[0].is_Number:
            factors = factors[1:]
        if not all(map(symbols_of, factors)) or (not factors and len(total.args) == 2):
            return None
        powers.append(dict([(f, 1) if f.is_Symbol else decompose_power(f) for f in factors]))
    bases = sorted({base for found in powers for base in found}, key=_by_terms)
    keys = [tuple([-found.get(base, 0) for base in bases]) for found in powers]
    if len(set(keys)) < len(keys):
        return None
    terms = dict(zip(keys, total.args, strict=True))
    return [terms[key] for key in sorted(keys)]
