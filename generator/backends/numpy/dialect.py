"""Syntax of NumPy."""

import sympy as sp

from ...program.functions import Guarded, IsPositive, Positive, SignOf
from ..text import Dialect

NUMPY = Dialect(
    {
        sp.sin: "np.sin({})",
        sp.cos: "np.cos({})",
        sp.asin: "np.arcsin({})",
        sp.atan2: "np.arctan2({}, {})",
        sp.exp: "np.exp({})",
        sp.log: "np.log({})",
        Guarded: "np.maximum({}, {})",
        SignOf: "np.copysign(1.0, {})",
        Positive: "np.maximum({}, 0.0)",
        IsPositive: "1.0*({} > 0.0)",
    },
    root="np.sqrt({})",
    component="{}[{}]",
)
