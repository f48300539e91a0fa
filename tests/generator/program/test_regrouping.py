"""Common parts of sums and products, compared with those that SymPy finds."""

import random

import sympy as sp
from kintrafo.generator.program.functions import Guarded
from kintrafo.generator.program.regrouping import regrouped
from sympy.simplify.cse_main import opt_cse

SYMBOLS = sp.symbols("a b c x y z")
NUMBERS = (-2, -1, 1, 2, sp.Rational(-1, 2), sp.Float("0.3"), sp.sqrt(2), -sp.pi)


def _made(random_: random.Random, depth: int) -> sp.Expr:
    """Return some expression, with signs and shared factors as those of a program."""
    if depth == 0:
        return random_.choice((*SYMBOLS, *SYMBOLS, *NUMBERS))
    parts = [_made(random_, random_.randrange(depth)) for _ in range(random_.randint(2, 4))]
    kinds = (
        lambda: sp.Add(*(random_.choice((-1, 1)) * part for part in parts)),
        lambda: sp.Mul(*parts),
        lambda: sp.Pow(parts[0], random_.choice((-2, -1, 2, sp.Rational(1, 2)))),
        lambda: Guarded(parts[0], parts[1]),
    )
    return random_.choice((*kinds[:2], *kinds))()


def test_the_same_is_regrouped_as_by_sympy() -> None:
    """The names of common parts, and the order of all operations, depend on it."""
    random_ = random.Random(1)
    for _ in range(60):
        expressions = [_made(random_, 3) for _ in range(8)]
        expressions = [e for e in expressions if not e.has(sp.zoo, sp.nan)]
        expected, found = opt_cse(expressions), regrouped(expressions)
        assert {e: (new.func, tuple(map(str, new.args))) for e, new in found.items()} == {
            e: (new.func, tuple(map(str, new.args))) for e, new in expected.items()
        }
