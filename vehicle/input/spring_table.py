"""The curve of a spring, from the parameters of the equations."""

from collections.abc import Mapping

import numpy as np

from ...core.named_types import Array
from .curve import SEGMENTS
from .spring import TABLE


def force_and_rate(parameters: Mapping[str, float], length: Array) -> tuple[Array, Array]:
    """Return the force [N] of a spring's curve and its rate [N/m]; zero without a curve.

    `parameters` are those of the equations, `length` the distance of the spring's ends [m].
    """
    if ends_of_table(parameters) is None:
        return np.zeros_like(length), np.zeros_like(length)
    knots, inverse, a, b, c = (
        np.array([parameters[f"{TABLE}_{what}_{i}"] for i in range(SEGMENTS + more)])
        for what, more in (
            ("knot", 1),
            ("inverse_width", 0),
            ("linear", 0),
            ("quadratic", 0),
            ("cubic", 0),
        )
    )
    first, last = (parameters[f"{TABLE}_{end}_slope"] for end in ("first", "last"))
    beyond = knots - length[..., None]
    passed = np.maximum(beyond, 0.0)
    part = (passed[..., :-1] - passed[..., 1:]) * inverse
    inside = (beyond[..., :-1] > 0.0) & (beyond[..., 1:] <= 0.0)
    force = parameters[f"{TABLE}_first_force"] + first * np.minimum(beyond[..., 0], 0.0)
    force = force + last * passed[..., -1] + (part * (a + part * (b + part * c))).sum(-1)
    slopes = np.where(inside, (a + part * (2.0 * b + 3.0 * part * c)) * inverse, 0.0)
    ends = first * (beyond[..., 0] <= 0.0) + last * (beyond[..., -1] > 0.0)
    return force, slopes.sum(-1) + ends


def rate_at(parameters: Mapping[str, float], length: Array) -> Array:
    """Return the rate of a spring at some lengths [N/m]."""
    _, of_curve = force_and_rate(parameters, length)
    return parameters["spring_rate"] + of_curve


def ends_of_table(parameters: Mapping[str, float]) -> tuple[float, float] | None:
    """Return the shortest and the longest length of a curve [m], if there is one."""
    if f"{TABLE}_first_force" not in parameters:
        return None
    shortest, longest = (parameters[f"{TABLE}_knot_{i}"] for i in (SEGMENTS, 0))
    return (shortest, longest) if shortest < longest else None
