"""Syntax of CasADi."""

import sympy as sp

from ...program.functions import Guarded, IsPositive, Positive, SignOf
from ..text import Dialect

CASADI = Dialect(
    {
        sp.sin: "casadi.sin({})",
        sp.cos: "casadi.cos({})",
        sp.asin: "casadi.asin({})",
        sp.atan2: "casadi.atan2({}, {})",
        sp.exp: "casadi.exp({})",
        sp.log: "casadi.log({})",
        Guarded: "casadi.fmax({}, {})",
        SignOf: "casadi.copysign(1.0, {})",
        # the derivative of fmax would be another one where the argument is zero
        Positive: "casadi.if_else({0} > 0.0, {0}, 0.0)",
        IsPositive: "1.0*({} > 0.0)",
    },
    root="casadi.sqrt({})",
    component="{}[{}]",
    element="{}[{}]",
    negation="casadi.logic_not({})",
    magnitude="casadi.fabs({})",  # abs(...) only since CasADi 3.8
)
