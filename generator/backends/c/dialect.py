"""How C spells functions."""

import sympy as sp

from ...program.functions import Guarded, IsPositive, Positive, SignOf
from ..text import Dialect

C = Dialect(
    {
        sp.sin: "sin({})",
        sp.cos: "cos({})",
        sp.asin: "asin({})",
        sp.atan2: "atan2({}, {})",
        Guarded: "at_least({}, {})",
        SignOf: "copysign(1.0, {})",
        Positive: "at_least({}, 0.0)",
        IsPositive: "(double)({} > 0.0)",
    },
    root="sqrt({})",
    component="{}.at[{}]",
)
