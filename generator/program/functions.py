"""Functions of a step that SymPy does not have: guards, choices, results of iterations."""

from __future__ import annotations

import sympy as sp


class Guarded(sp.Function):
    """The first argument where it exceeds its floor, the second; elsewhere that floor.

    Guards a root or a divisor of a closed form that vanishes when a loop cannot close. The
    arithmetic has no branch and no NaN; the status word shows that the guard acted.
    """

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Differentiate as the identity: where the guard acts, the result is discarded anyway."""
        return sp.Integer(int(argindex == 1))


class Positive(sp.Function):
    """The argument where it is positive, zero elsewhere."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Differentiate: one where the argument is positive, zero elsewhere."""
        return IsPositive(self.args[0])


class _Constant(sp.Function):
    """A function whose derivative is zero, or zero by definition."""

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Differentiate: zero."""
        return sp.Integer(0)


class SignOf(_Constant):
    """Plus one or minus one, the sign of the argument. Used for constants only (branch choice).

    No branch is left without passing a dead point.
    """

    nargs = 1


class IsPositive(_Constant):
    """One where the argument is positive, zero elsewhere, with a jump between."""

    nargs = 1


class Iterated(_Constant):
    """All results of an iteration (`IterationBlock`) together, as one value.

    The first argument is the name of the block, the others are the arguments of the call. The
    derivative is zero by definition: straight-line code behind the iteration corrects its result
    once more, and the derivative of that correction is the exact one.
    """


class Component(_Constant):
    """One result of an iteration, by its index; the derivative is zero by definition."""

    nargs = 2


class Frozen(_Constant):
    """The argument itself, with a derivative of zero: an estimate that is corrected afterwards."""

    nargs = 1
