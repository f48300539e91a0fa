"""Expressions as text: what is written means the expression, and has the operations counted."""

import ast
import re
from collections import Counter
from typing import ClassVar

import mpmath
import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from kintrafo.generator.backends.counting import counted
from kintrafo.generator.backends.numpy.dialect import NUMPY
from kintrafo.generator.backends.schedule import schedule
from kintrafo.generator.backends.text import text_of
from kintrafo.generator.backends.words import FORMULA
from kintrafo.generator.program.functions import Guarded, IsPositive, Positive, SignOf
from support.c_text import count, tokens

SYMBOLS = sp.symbols("x y z")


def write(expression, dialect=FORMULA):
    """Write a single expression."""
    return text_of(schedule(expression), dialect)


VALUES = dict(zip(SYMBOLS, (1.37, -0.58, 2.91), strict=True))

EXACT = {symbol: sp.Float(value, 60) for symbol, value in VALUES.items()}

calm = settings(deadline=None, max_examples=150)


FLOOR = sp.Float("1e-24")


def positive(expression):
    """Return an expression that is positive for all values of the symbols."""
    return 1 + expression**2


def compound(parts):
    """Return what the derivations build from smaller expressions."""
    several = st.lists(parts, min_size=2, max_size=4)
    pairs = st.tuples(parts, parts)
    halves = st.sampled_from([sp.Rational(n, 2) for n in (-5, -3, -1, 1, 3)])
    return st.one_of(
        several.map(lambda terms: sp.Add(*terms)),
        several.map(lambda factors: sp.Mul(*factors)),
        parts.map(lambda part: -part),
        pairs.map(lambda pair: pair[0] / positive(pair[1])),
        st.tuples(parts, st.integers(2, 4)).map(lambda pair: pair[0] ** pair[1]),
        st.tuples(parts, halves).map(lambda pair: positive(pair[0]) ** pair[1]),
        parts.map(sp.sin),
        parts.map(sp.cos),
        pairs.map(lambda pair: sp.atan2(pair[0], positive(pair[1]))),
        parts.map(lambda part: Guarded(positive(part), FLOOR)),
        parts.map(lambda part: SignOf(positive(part))),
        parts.map(Positive),
        parts.map(IsPositive),
    )


numbers = st.one_of(
    st.integers(-5, 5).map(sp.Integer),
    st.sampled_from([sp.Rational(1, 2), sp.Rational(-3, 4), sp.Rational(1, 3)]),
)


KNOWN = (sp.sin, sp.cos, sp.atan2, Guarded, SignOf, Positive, IsPositive)


def is_written(expression):
    """Return whether the expression, as SymPy has simplified it, is one that derivations have.

    SymPy turns angles between numbers into pi and arc tangents, and products into high powers.
    """
    powers = [power.exp for power in expression.atoms(sp.Pow)]
    low = all(exponent.is_Rational and abs(exponent) < 5 for exponent in powers)
    known = all(isinstance(call, KNOWN) for call in expression.atoms(sp.Function))
    return low and known and not expression.has(sp.pi)


expressions = st.recursive(
    st.one_of(st.sampled_from(SYMBOLS), numbers), compound, max_leaves=8
).filter(is_written)


class _Exact(ast.NodeTransformer):
    """Makes every number of a Python expression one of mpmath's."""

    def visit_Constant(self, node):
        return ast.Call(ast.Name("mpf", ast.Load()), [node], [])


class _Functions:
    """The functions of ``np`` that the emitted text calls, in the precision of mpmath."""

    sin, cos, arcsin, arctan2, sqrt = mpmath.sin, mpmath.cos, mpmath.asin, mpmath.atan2, mpmath.sqrt
    maximum = staticmethod(max)

    @staticmethod
    def copysign(size, sign):
        return size if sign >= 0 else -size


def evaluate(text):
    """Evaluate written text in mpmath's precision."""
    tree = ast.fix_missing_locations(_Exact().visit(ast.parse(text, mode="eval")))
    names = {symbol.name: mpmath.mpf(value) for symbol, value in VALUES.items()}
    known = {"np": _Functions, "mpf": mpmath.mpf, **names}
    return mpmath.mpf(eval(compile(tree, "text", "eval"), known))


def meaning(expression):
    """Return the expression with the project's functions replaced by what they mean here."""
    if not expression.args:
        return expression
    parts = [meaning(part) for part in expression.args]
    if isinstance(expression, Guarded):
        return parts[0]
    if isinstance(expression, SignOf):
        return sp.Integer(1)
    if isinstance(expression, Positive | IsPositive):
        value = parts[0].evalf(30, subs=EXACT)
        assume(value == 0 or abs(value) > 1e-12)  # not where a rounded number decides the side
        acting = parts[0] if isinstance(expression, Positive) else sp.Integer(1)
        return acting if value > 0 else sp.Integer(0)
    return expression.func(*parts)


@given(expressions)
@calm
def test_text_means_the_expression(expression):
    plain = meaning(expression)
    sizes = [abs(part.evalf(20, subs=EXACT)) for part in sp.preorder_traversal(plain)]
    with mpmath.workdps(50):
        found = evaluate(write(expression, NUMPY))
        exact = mpmath.mpf(str(plain.evalf(40, subs=EXACT)))
        # Nothing is rounded but numbers, which are written with the digits of a double: a few
        # roundings of 1e-16, times what the operations behind them make of those.
        assert abs(found - exact) <= 1e-13 * mpmath.mpf(str(max([1, *sizes])))


class _Counting(ast.NodeVisitor):
    """Counts operations by the syntax tree, in the words of the project."""

    kinds: ClassVar = {ast.Add: "add", ast.Sub: "add", ast.Mult: "multiply", ast.Div: "divide"}
    calls: ClassVar = {
        "sqrt": "root",
        "sin": "trigonometric",
        "cos": "trigonometric",
        "arcsin": "trigonometric",
        "arctan2": "trigonometric",
    }

    def __init__(self):
        self.total = Counter()

    @staticmethod
    def is_number(node):
        signed = isinstance(node, ast.UnaryOp) and isinstance(node.operand, ast.Constant)
        return signed or isinstance(node, ast.Constant)

    def visit_alone(self, node):
        """Count what is the whole of the text or of an argument: not the sign of a number."""
        if not self.is_number(node):
            self.visit(node)

    def visit_Expression(self, node):
        self.visit_alone(node.body)

    def visit_BinOp(self, node):
        operands = node.left, node.right
        if isinstance(node.op, ast.Div) and all(map(self.is_number, operands)):
            return  # a fraction
        self.total[self.kinds[type(node.op)]] += 1
        self.generic_visit(node)

    def visit_UnaryOp(self, node):
        self.total["add"] += 1
        self.generic_visit(node)

    def visit_Compare(self, node):
        self.visit_alone(node.left)

    def visit_Call(self, node):
        assert isinstance(node.func, ast.Attribute)
        if node.func.attr in self.calls:
            self.total[self.calls[node.func.attr]] += 1
        for argument in node.args:
            self.visit_alone(argument)


# how NumPy makes a number of a comparison, which is no operation
SELECTION = re.compile(r"(?<![\d.])1\.0\*\((?=.* > 0\.0\))")


def operations_by_ast(text):
    """Count the operations of Python text."""
    counting = _Counting()
    counting.visit(ast.parse(SELECTION.sub("np.number(", text), mode="eval"))
    return counting.total


@given(expressions)
@calm
def test_count_is_that_of_the_text(expression):
    found = counted([schedule(expression)])
    assert found == operations_by_ast(write(expression, NUMPY))


@given(expressions)
@calm
def test_c_is_the_same_arithmetic(expression):
    """The dialects differ in the names of functions only, so what holds for one holds for C."""
    in_c, in_numpy = write(expression), write(expression, NUMPY)
    renamed = in_numpy.replace("np.arc", "a").replace("np.maximum", "at_least")
    renamed = SELECTION.sub("is_positive(", renamed.replace("np.", "")).replace(" > 0.0)", ")")
    assert in_c == renamed


x, y, z = SYMBOLS


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (x**2, "x*x"),
        (x**3, "x*x*x"),
        (sp.sqrt(x), "sqrt(x)"),
        (x ** sp.Rational(3, 2), "x*sqrt(x)"),
        (1 / x, "1.0/x"),
        (1 / sp.sqrt(x), "1.0/sqrt(x)"),
        (y / x**2, "y/(x*x)"),
        (y - x, "y - x"),
        (-x - y, "-x - y"),
        (x + y + z + sp.Integer(1), "1.0 + x + (y + z)"),
        (-x * y, "-x*y"),
        (x - (y + z) * 2, "x - 2.0*y - 2.0*z"),
        (z * (x - y), "z*(x - y)"),
        (sp.Rational(1, 3) * x, "(1.0/3.0)*x"),
        (x / 2, "0.5*x"),
        (Guarded(x, y), "at_least(x, y)"),
        (Guarded(x, FLOOR), "at_least(x, 1e-24)"),
        (Positive(x - y), "at_least(x - y, 0.0)"),
        (IsPositive(x - y), "is_positive(x - y)"),
        (x * Positive(y) ** 2, "at_least(y, 0.0)*at_least(y, 0.0)*x"),
        (z * IsPositive(x) * y, "y*z*is_positive(x)"),
        (SignOf(x - y), "copysign(1.0, x - y)"),
        (sp.atan2(y, x), "atan2(y, x)"),
        (sp.asin(x), "asin(x)"),
    ],
    ids=str,
)
def test_written_examples(expression, text):
    assert write(expression) == text
    assert count(tokens(f"out[0] = {text};")) == counted([schedule(expression)])


@pytest.mark.parametrize("exponent", [5, sp.Rational(1, 3), y, -7], ids=str)
def test_powers_without_products_are_refused(exponent):
    """There is no pow in the emitted code, and no long product in its place."""
    with pytest.raises((ValueError, TypeError)):
        write(x**exponent)


def test_pi():
    assert write(sp.pi * x) == "3.14159265358979323846*x"


def test_guard_is_differentiated_as_the_identity():
    assert Guarded(x**2, FLOOR).diff(x) == 2 * x


def test_kinks_are_differentiated_on_their_sides():
    assert Positive(x**3).diff(x) == 3 * x**2 * IsPositive(x**3)
    assert Positive(x - y).diff(y) == -IsPositive(x - y)
    assert Positive(x).diff(y) == 0
    assert IsPositive(x**3).diff(x) == 0
    assert (y * IsPositive(x)).diff(y) == IsPositive(x)


@pytest.mark.parametrize("value", [-2.0, -1e-300, -0.0, 0.0, 1e-300, 3.0, np.inf, -np.inf])
def test_kinks_in_numpy(value):
    """At zero itself the derivative is that of the side where nothing acts."""
    names = {"np": np, "x": np.array([value])}
    (positive_part,) = eval(write(Positive(x), NUMPY), names)
    (side,) = eval(write(IsPositive(x), NUMPY), names)
    assert positive_part == max(value, 0.0)
    assert side == float(value > 0.0)


def test_no_number_goes_through_a_kink_unseen():
    names = {"np": np, "x": np.array([np.nan])}
    for kink in (Positive(x), Guarded(x, FLOOR), Positive(x) * IsPositive(x)):
        assert np.isnan(eval(write(kink, NUMPY), names)).all()


def test_what_is_there_first_is_put_together_first():
    late = schedule(x + y + z * x, {y: 40})
    assert text_of(late, FORMULA) == "x + x*z + y"
    assert late.ready == 44  # y waits for nothing but its own addition
    product = schedule(x * y * z, {x: 40})
    assert text_of(product, FORMULA) == "y*z*x"
    # y, and then x*y, wait for one addition each; in any order of terms, whatever is printed first
    assert schedule(x + y + z + x * y, {y: 100}).ready == 100 + 4 + 4
    assert schedule(1 / sp.sqrt(x), {x: 10}).ready > schedule(sp.sqrt(x), {x: 10}).ready > 10
