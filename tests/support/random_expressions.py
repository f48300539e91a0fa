"""Expressions by chance, like those of a program."""

import sympy as sp
from kintrafo.generator.program.functions import Guarded

SYMBOLS = sp.symbols("a b c x y z")
NUMBERS = (-2, -1, 1, 2, sp.Rational(-1, 2), sp.Float("0.3"), sp.sqrt(2), -sp.pi)


def random_expression(random_, depth):
    """Return some expression, with signs and shared factors as those of a program."""
    if depth == 0:
        return random_.choice((*SYMBOLS, *SYMBOLS, *NUMBERS))
    parts = [
        random_expression(random_, random_.randrange(depth)) for _ in range(random_.randint(2, 4))
    ]
    kinds = (
        lambda: sp.Add(*(random_.choice((-1, 1)) * part for part in parts)),
        lambda: sp.Mul(*parts),
        lambda: sp.Pow(parts[0], random_.choice((-2, -1, 2, sp.Rational(1, 2)))),
        lambda: Guarded(parts[0], parts[1]),
    )
    return random_.choice((*kinds[:2], *kinds))()
