"""Write an expression as C (or NumPy) arithmetic, and count the operations of what was written.

Text and count come from the same traversal, so the count is that of the emitted code. There is no
``pow``: integer powers are products, half-integer ones are roots.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

OPERATIONS = ("add", "multiply", "divide", "root", "trigonometric")


class Guarded(sp.Function):  # type: ignore[misc]  # SymPy has no types
    """The argument itself where it is positive enough, a tiny positive number where it is not.

    It stands where a closed form has a root or a divisor that vanishes when a loop cannot close.
    The arithmetic stays free of branches and of NaN; the status word says that the guard acted.
    """

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Differentiate as the identity: where the guard acts, the result is discarded anyway."""
        del argindex
        return sp.Integer(1)


class SignOf(sp.Function):  # type: ignore[misc]  # SymPy has no types
    """Plus one or minus one, the sign of the argument. Used for constants only (branch choice)."""

    nargs = 1


class Positive(sp.Function):  # type: ignore[misc]
    """The argument where it is positive, zero elsewhere."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Differentiate: one where the argument is positive, zero elsewhere."""
        del argindex
        return IsPositive(self.args[0])


class IsPositive(sp.Function):  # type: ignore[misc]
    """One where the argument is positive, zero elsewhere."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Differentiate: zero, but for the jump, which no derivative can show."""
        del argindex
        return sp.Integer(0)


# Comparisons, not arithmetic: they are not counted as operations.
_SELECTIONS = (Guarded, SignOf, Positive, IsPositive)


@dataclass(frozen=True)
class Dialect:
    """How a target language spells functions."""

    functions: Mapping[type, str]
    root: str


C = Dialect(
    {
        sp.sin: "sin({})",
        sp.cos: "cos({})",
        sp.asin: "asin({})",
        sp.atan2: "atan2({})",
        Guarded: "fmax({}, GUARD_FLOOR)",
        SignOf: "copysign(1.0, {})",
        Positive: "fmax({}, 0.0)",
        IsPositive: "(double)({} > 0.0)",
    },
    root="sqrt({})",
)
NUMPY = Dialect(
    {
        sp.sin: "np.sin({})",
        sp.cos: "np.cos({})",
        sp.asin: "np.arcsin({})",
        sp.atan2: "np.arctan2({})",
        Guarded: "np.fmax({}, GUARD_FLOOR)",
        SignOf: "np.copysign(1.0, {})",
        Positive: "np.fmax({}, 0.0)",
        IsPositive: "1.0*({} > 0.0)",
    },
    root="np.sqrt({})",
)

# binding strength of a written expression, loosest first
_SUM, _NEGATIVE, _PRODUCT, _ATOM = range(4)


@dataclass(frozen=True)
class Written:
    """An expression as text, with the operations in it.

    A sign in front counts as an addition; guards, limits and the choice of a branch are comparisons
    and do not count.
    """

    text: str
    strength: int
    operations: Counter[str]

    def inside(self, strength: int) -> str:
        """Return the text, in parentheses where its surroundings bind more strongly."""
        return self.text if self.strength >= strength else f"({self.text})"


def write(expression: sp.Expr, dialect: Dialect = C) -> Written:
    """Write an expression and count its operations."""
    if expression.is_Symbol:
        return Written(expression.name, _ATOM, Counter())
    if expression.is_Number or expression is sp.pi:
        return _write_number(expression)
    if expression.is_Add:
        return _write_sum(expression, dialect)
    if expression.is_Mul:
        return _write_product(expression, dialect)
    if expression.is_Pow:
        return _write_power(expression, dialect)
    if type(expression) not in dialect.functions:
        message = f"{expression} cannot be written: {type(expression).__name__} has no spelling"
        raise ValueError(message)
    arguments = [write(a, dialect) for a in expression.args]
    trigonometric = not isinstance(expression, _SELECTIONS)
    text = dialect.functions[type(expression)].format(", ".join(a.text for a in arguments))
    return Written(text, _ATOM, _total(arguments, trigonometric=int(trigonometric)))


def _total(parts: Sequence[Written], **own: int) -> Counter[str]:
    total = Counter({name: number for name, number in own.items() if number})
    for part in parts:
        total.update(part.operations)
    return total


def _write_number(number: sp.Expr) -> Written:
    if number == sp.pi:
        return Written("3.14159265358979323846", _ATOM, Counter())
    value = sp.Rational(number)
    if value.q & (value.q - 1):  # not exact in binary: let the compiler divide
        return Written(f"({value.p}.0/{value.q}.0)", _ATOM, Counter())
    return Written(repr(float(value)), _ATOM if value >= 0 else _NEGATIVE, Counter())


def _write_sum(expression: sp.Expr, dialect: Dialect) -> Written:
    """Write positive terms first, so that a leading sign is rarely needed."""
    terms = [_signed(term) for term in expression.args]
    terms.sort(key=lambda term: term[0])
    negative, first = terms[0]
    written = [write(first, dialect)]
    text = "-" * negative + written[0].inside(_PRODUCT if negative else _SUM)
    for minus, term in terms[1:]:
        written.append(write(term, dialect))
        text += " - " if minus else " + "
        text += written[-1].inside(_PRODUCT if minus else _NEGATIVE)
    return Written(text, _SUM, _total(written, add=len(terms) - 1 + negative))


def _signed(term: sp.Expr) -> tuple[bool, sp.Expr]:
    """Split a term into (is negative, magnitude)."""
    negative = bool(term.as_coeff_Mul()[0].is_negative)
    return negative, -term if negative else term


def _write_product(expression: sp.Expr, dialect: Dialect) -> Written:
    negative, magnitude = _signed(expression)
    if negative:
        inner = write(magnitude, dialect)
        return Written(f"-{inner.inside(_PRODUCT)}", _NEGATIVE, _total([inner], add=1))
    coefficient, factors = magnitude.as_coeff_mul()
    above = [write(f, dialect) for f in factors if not _is_reciprocal(f)]
    below = [write(1 / f, dialect) for f in factors if _is_reciprocal(f)]
    if coefficient != 1:
        above.insert(0, write(coefficient, dialect))
    text = "*".join(f.inside(_PRODUCT) for f in above) or "1.0"
    if below:
        divisor = "*".join(f.inside(_PRODUCT) for f in below)
        simple = len(below) == 1 and below[0].strength == _ATOM
        text += "/" + (divisor if simple else f"({divisor})")
    products = max(len(above) - 1, 0) + max(len(below) - 1, 0)
    operations = _total(above + below, multiply=products, divide=int(bool(below)))
    return Written(text, _PRODUCT, operations)


def _is_reciprocal(factor: sp.Expr) -> bool:
    return bool(factor.is_Pow and factor.exp.is_negative)


def _write_power(expression: sp.Expr, dialect: Dialect) -> Written:
    base, exponent = expression.base, expression.exp
    if exponent.is_negative:
        below = write(1 / expression, dialect)
        text = "1.0/" + below.inside(_ATOM)
        return Written(text, _PRODUCT, _total([below], divide=1))
    whole, half = divmod(exponent, 1)
    if half not in (0, sp.Rational(1, 2)) or whole > 4:
        message = f"the power {expression} has no product of roots and factors"
        raise ValueError(message)
    written = write(base, dialect)
    factors = [written.inside(_PRODUCT)] * int(whole)
    if half:
        factors.append(dialect.root.format(written.text))
    operations = Counter(multiply=len(factors) - 1, root=int(half != 0))
    operations.update(_total([written] * len(factors)))
    strength = _PRODUCT if len(factors) > 1 else _ATOM
    return Written("*".join(factors), strength, +operations)
