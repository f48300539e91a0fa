"""Syntax of JAX."""

import sympy as sp

from ...program.functions import Guarded, IsPositive, Positive, SignOf
from ..text import Dialect

JAX = Dialect(
    {
        sp.sin: "jnp.sin({})",
        sp.cos: "jnp.cos({})",
        sp.asin: "jnp.arcsin({})",
        sp.atan2: "jnp.arctan2({}, {})",
        sp.exp: "jnp.exp({})",
        sp.log: "jnp.log({})",
        Guarded: "jnp.maximum({}, {})",
        SignOf: "jnp.copysign(1.0, {})",
        # the derivative of maximum would be another one where the argument is zero
        Positive: "jnp.where({0} > 0.0, {0}, 0.0)",
        IsPositive: "1.0*({} > 0.0)",
    },
    root="jnp.sqrt({})",
    component="{}[{}]",
    negation="jnp.logical_not({})",
)
