"""The orders of expressions, compared with those of SymPy."""

import random
from functools import cmp_to_key

import sympy as sp
from kintrafo.generator.program.orders import by_class, by_size, first_term
from support.random_expressions import random_expression


def _samples():
    random_ = random.Random(2)
    found = dict.fromkeys(random_expression(random_, 3) for _ in range(400))
    return [e for e in found if not e.has(sp.zoo, sp.nan)]


def test_parts_are_in_the_order_of_sympy():
    """Terms and factors are written in one of these orders, common parts named in the other."""
    samples = _samples()
    assert sorted(samples, key=by_class) == sorted(samples, key=cmp_to_key(sp.Basic.compare))
    assert list(by_size(samples)) == list(sp.ordered(samples))


def test_the_first_term_is_that_of_sympy():
    sums = [part for sample in _samples() for part in sample.atoms(sp.Add)]
    found = {total: first_term(total) for total in sums}
    first = {total: total.as_ordered_terms()[0] for total, term in found.items() if term}
    assert len(first) > len(found) / 3  # the others have numbers as factors
    assert first == {total: term for total, term in found.items() if term}
