"""Sums and products are those of SymPy, whether their parts combine or not."""

import random

import pytest
import sympy as sp
from kintrafo.generator.program.composing import composed
from kintrafo.generator.program.functions import Guarded

A, B, C, D = sp.symbols("a b c d")
PARTS = (
    *(A, B, C, D, -A, -B, 2 * C, A * B, -C * D, 3 * A * B, sp.pi * C, sp.sqrt(2) * A),
    *(A + B, C - D, -A - B, sp.Mul(2, A + B, evaluate=False), A**2, 1 / B, sp.sqrt(C + D)),
    *((A + B) ** -1, (A * B) ** -1, sp.exp(A), sp.sin(A), Guarded(A, B), sp.sqrt(2), sp.pi),
    *map(sp.sympify, (0, 1, -1, 2, 0.5, 1.0, sp.Rational(1, 2), -0.25)),
)


@pytest.mark.parametrize("kind", [sp.Add, sp.Mul])
def test_is_that_of_sympy(kind):
    random_ = random.Random(3)
    for _ in range(1500):
        parts = random_.choices(PARTS, k=random_.randint(1, 5))
        made = kind(*parts)
        found = composed(kind, parts)
        assert sp.srepr(found) == sp.srepr(made), parts
        assert found.is_commutative is made.is_commutative
