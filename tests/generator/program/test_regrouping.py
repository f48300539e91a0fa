"""Common parts of sums and products, compared with those that SymPy finds."""

import random

import sympy as sp
from kintrafo.generator.program.regrouping import regrouped
from support.random_expressions import random_expression
from sympy.simplify.cse_main import opt_cse


def test_the_same_is_regrouped_as_by_sympy():
    """The names of common parts, and the order of all operations, depend on it."""
    random_ = random.Random(1)
    for _ in range(60):
        expressions = [random_expression(random_, 3) for _ in range(8)]
        expressions = [e for e in expressions if not e.has(sp.zoo, sp.nan)]
        expected, found = opt_cse(expressions), regrouped(expressions)
        assert {e: (new.func, tuple(map(str, new.args))) for e, new in found.items()} == {
            e: (new.func, tuple(map(str, new.args))) for e, new in expected.items()
        }
