"""The symbolic program of an emitted function, evaluated with any kind of number.

SymPy's own printer turns each step into Python, so nothing is shared with the project's printers.
The kinds of number are floats, mpmath's, and `Rounded`, which knows how far a computation in double
precision may be off.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import mpmath
import numpy as np
from kintrafo.generator.equations.dynamics import Dynamics
from kintrafo.generator.equations.in_motion import InMotion
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.program import ConstantStage, Program
from sympy import Symbol
from sympy.printing.pycode import MpmathPrinter

UNIT = mpmath.mpf(2) ** -53
"""Relative error of one operation in double precision."""

SINE_UNIT, ARC_UNIT = 2 * UNIT, 4 * UNIT
"""Relative errors of sine and cosine, and of arc tangent: 1 and 2 units in the last place."""


@dataclass(frozen=True)
class Rounded:
    """A number, and a bound on the error with which double precision computes it.

    The bound is that of the running error analysis (Wilkinson): every operation adds one rounding
    of its result to what it makes of the errors of its operands, to first order.
    """

    value: mpmath.mpf
    error: mpmath.mpf = mpmath.mpf()  # noqa: RUF009 (immutable)

    @staticmethod
    def of(number):
        """Take a number as exact."""
        return number if isinstance(number, Rounded) else Rounded(mpmath.mpf(number))

    def __add__(self, other):
        other = Rounded.of(other)
        return _rounded(self.value + other.value, self.error + other.error)

    def __mul__(self, other):
        other = Rounded.of(other)
        error = abs(self.value) * other.error + abs(other.value) * self.error
        return _rounded(self.value * other.value, error)

    def __truediv__(self, other):
        other = Rounded.of(other)
        ratio = self.value / other.value
        return _rounded(ratio, (self.error + abs(ratio) * other.error) / abs(other.value))

    def __pow__(self, exponent):
        if exponent < 0:
            return 1 / self**-exponent
        product = self
        for _ in range(exponent - 1):
            product = product * self
        return product

    def __neg__(self):
        return Rounded(-self.value, self.error)

    def __sub__(self, other):
        return self + -Rounded.of(other)

    def __rsub__(self, other):
        return Rounded.of(other) - self

    def __rtruediv__(self, other):
        return Rounded.of(other) / self

    __radd__ = __add__
    __rmul__ = __mul__


def _rounded(value, error, unit=UNIT):
    return Rounded(value, error + unit * abs(value))


def _root(x):
    if isinstance(x, Rounded):
        root = mpmath.sqrt(x.value)
        return _rounded(root, x.error / (2 * root))
    return mpmath.sqrt(x)


def _sine(x):
    if isinstance(x, Rounded):
        return _rounded(mpmath.sin(x.value), x.error * abs(mpmath.cos(x.value)), SINE_UNIT)
    return mpmath.sin(x)


def _cosine(x):
    if isinstance(x, Rounded):
        return _rounded(mpmath.cos(x.value), x.error * abs(mpmath.sin(x.value)), SINE_UNIT)
    return mpmath.cos(x)


def _exponential(x):
    if isinstance(x, Rounded):
        found = mpmath.exp(x.value)
        return _rounded(found, x.error * found, SINE_UNIT)
    return mpmath.exp(x)


def _logarithm(x):
    if isinstance(x, Rounded):
        return _rounded(mpmath.log(x.value), x.error / abs(x.value), SINE_UNIT)
    return mpmath.log(x)


def _angle(y, x):
    if isinstance(y, Rounded) or isinstance(x, Rounded):
        y, x = Rounded.of(y), Rounded.of(x)
        error = abs(x.value) * y.error + abs(y.value) * x.error
        square = x.value**2 + y.value**2
        return _rounded(mpmath.atan2(y.value, x.value), error / square, ARC_UNIT)
    return mpmath.atan2(y, x)


def _guarded(x):
    """Return the quantity itself: the states of the tests are admissible."""
    assert Rounded.of(x).value > 0
    return x


def _sign(x):
    return 1 if Rounded.of(x).value >= 0 else -1


def _positive(x):
    return x if Rounded.of(x).value > 0 else 0 * x


def _is_positive(x):
    """Return on which side of a kink an exact number is, or one that no rounding takes across."""
    x = Rounded.of(x)
    assert x.error == 0 or abs(x.value) > x.error
    return int(x.value > 0)


class _Printer(MpmathPrinter):
    """SymPy's printer, with the project's functions."""

    def _print_Guarded(self, call):
        return f"guarded({self._print(call.args[0])})"

    def _print_SignOf(self, call):
        return f"sign({self._print(call.args[0])})"

    def _print_Positive(self, call):
        return f"positive({self._print(call.args[0])})"

    def _print_IsPositive(self, call):
        return f"is_positive({self._print(call.args[0])})"

    def _print_Frozen(self, call):
        return f"({self._print(call.args[0])})"

    def _print_Iterated(self, call):
        return f"{call.args[0].name}({', '.join(map(self._print, call.args[1:]))})"

    def _print_Component(self, call):
        return f"{call.args[0].name}[{int(call.args[1])}]"


def _solved(block):
    """Return a function that finds the results of a block to mpmath's precision.

    The path is that of the emitted code, straight from the design position, but its stages are all
    alike and short for all equations.
    """
    once, n = python(block.once), len(block.unknowns)
    read = {s.name for s in block.once.free_symbols}
    names = [str(s) for s in (*block.estimate.base, *block.estimate.step)]
    place = n + len(block.elements)
    held = [s for line in block.estimate.held for s in line]
    zeros = {str(s): mpmath.mpf(0) for s in (*held, *(d.way for d in block.driven))}

    def run(*given):
        count = len(block.constants)
        values = dict(zip(map(str, block.constants), given[:count], strict=True)) | zeros
        along = [given[i : i + 3] for i in range(count, len(given), 3)]
        stages = 1 + max(
            (int(5 * abs(end - start) / unit) for start, end, unit in along), default=0
        )
        estimate, side = [mpmath.mpf(0)] * (2 * n), 0
        for stage in range(stages + 1):
            for driven, (start, end, _) in zip(block.driven, along, strict=True):
                values[str(driven.now)] = start + (end - start) * mpmath.mpf(stage) / stages
            tolerance = mpmath.mpf(10) ** (5 - mpmath.mp.dps if stage == stages else -3)
            for _ in range(100):
                values |= dict(zip(names, estimate, strict=True))
                results = once({k: v for k, v in values.items() if k in read})
                side = side or _sign(results[place])
                correction = results[place + 2 : place + 2 + n]
                estimate = [*results[:n], *correction]
                if max(map(abs, correction)) <= tolerance:
                    break
            else:
                message = f"{block.name} does not converge"
                raise AssertionError(message)
        return [*results[:n], *(side * e for e in results[n : place + 1]), mpmath.mpf(0)]

    return run


@cache
def python(function):
    """Return a Python function of the values by name: the program of an emitted function."""
    printer = _Printer({"fully_qualified_modules": False})
    lines = ["def run(values):"]
    lines += [f"    {s} = values['{s}']" for s in sorted(function.free_symbols, key=str)]
    lines += [f"    {s.symbol} = {printer.doprint(s.expression)}" for s in function.steps]
    results = ", ".join(map(printer.doprint, function.results))
    lines.append(f"    return [{results}]")
    names = {
        "mpf": mpmath.mpf,
        "sqrt": _root,
        "sin": _sine,
        "cos": _cosine,
        "atan2": _angle,
        "exp": _exponential,
        "log": _logarithm,
        "guarded": _guarded,
        "sign": _sign,
        "positive": _positive,
        "is_positive": _is_positive,
        **{block.name: _solved(block) for block in function.blocks},
    }
    exec("\n".join(lines), names)
    return names["run"]


def derivatives_of(function, values, names):
    """Return the derivatives of the results of a function, a column for each name.

    Differences in 50 digits, forward ones: as the step is 1e-22, so is their error, and so is that
    of the roundings over the step. An iteration is repeated for each of them.
    """
    with mpmath.workdps(50):
        run, step = python(function), mpmath.mpf("1e-22")
        here = run(values)
        moved = (run({**values, name: values[name] + step}) for name in names)
        columns = [[float((a - b) / step) for a, b in zip(m, here, strict=True)] for m in moved]
    return np.transpose(columns)


def constants_of(model, parameters):
    """Return the constants of a parameter set by name, in mpmath's precision."""
    values = {name: mpmath.mpf(value) for name, value in parameters.items()}
    return dict(zip(model.prepare.labels, python(model.prepare)(values), strict=True))


def accelerations(model, parameters, moving):
    """Derive the accelerations of a model alone, and evaluate them in mpmath's precision.

    Parameters
    ----------
    parameters
        Value of every parameter that is not derived from others, SI units.
    moving
        State and inputs by name, SI units.
    """
    mechanism = model.mechanism
    constants = ConstantStage(
        tuple(Symbol(p.name) for p in mechanism.parameters),
        derived={Symbol(name): value for name, value in mechanism.derived.items()},
    )
    program = Program(constants)
    dynamics = Dynamics(InMotion.of(program, CataloguePlan.of(model)))
    function = program.function("rhs", "", dict(dynamics.accelerations))
    prepare = constants.function([function])
    given, now = (
        {name: mpmath.mpf(value) for name, value in values.items()}
        for values in (parameters, moving)
    )
    known = dict(zip(prepare.labels, python(prepare)(given), strict=True))
    return [float(a) for a in python(function)(known | now)]
