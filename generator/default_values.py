"""Defaults that no mechanism could have: what is not a number, and inertia that no body has."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, SupportsFloat

import numpy as np

from .evaluation import AtDefaults
from .joints import Revolute
from .vectors import ELEMENTS

if TYPE_CHECKING:
    from .mechanism import Body, Mechanism

# What rounding may do to a principal moment of inertia, relative to the largest element.
_ROUNDING = 1e-9


def value_problems(mechanism: Mechanism) -> list[str]:
    """Find defaults that are no finite numbers, negative masses and impossible inertia.

    Of a body whose mass or inertia is derived from other parameters, nothing is said.
    """
    problems = [
        f"parameter {p.name!r} has the default {p.default!r} {p.unit}; give a finite number"
        for p in mechanism.parameters
        if not _is_finite(p.default)
    ]
    if problems:
        return problems
    values = {p.name: p.default for p in mechanism.parameters}
    problems = [p for body in mechanism.bodies for p in _body_problems(body, values)]
    return problems + _angle_problems(mechanism)


def _angle_problems(mechanism: Mechanism) -> list[str]:
    """Find hinges whose angle counts from, or to, what lies along the hinge."""
    value, problems = AtDefaults(mechanism), []
    for joint in mechanism.joints:
        if not isinstance(joint, Revolute) or joint.angle_to is None:
            continue
        axis = np.array([value(c) for c in joint.axis.vector])
        to = joint.angle_to.position - joint.axis.through.position
        for what, name, along in (
            ("angle_from", joint.angle_from.name, joint.angle_from.components),
            ("angle_to", joint.angle_to.name, to),
        ):
            other = np.array([value(c) for c in along])
            if np.linalg.norm(np.cross(axis, other)) <= _ROUNDING * np.linalg.norm(axis):
                problems.append(
                    f"joint {joint.name!r}: {what}, which is {name}, lies along the hinge, so that "
                    "its angle has no beginning or no end; take one beside the hinge, or leave "
                    "angle_to out, and the angle counts from the design position"
                )
    return problems


def _is_finite(value: object) -> bool:
    return isinstance(value, SupportsFloat) and isfinite(value)


def _body_problems(body: Body, values: dict[str, float]) -> list[str]:
    names = [f"{body.name}_mass", f"{body.name}_inertia_spin", f"{body.name}_inertia_diametral"]
    names += [f"{body.name}_inertia_{element}" for element in ELEMENTS[:3]]
    units = ["kg", *["kg m^2"] * 5]
    problems = [
        f"parameter {name!r} = {values[name]} {unit} is negative; give 0 or more"
        for name, unit in zip(names, units, strict=True)
        if values.get(name, 0.0) < 0.0
    ]
    return problems or _tensor_problems(body, values) or _rotor_problems(body, values)


def _tensor_problems(body: Body, values: dict[str, float]) -> list[str]:
    """See that the principal moments are those of some body: none above the sum of the others."""
    names = [f"{body.name}_inertia_{element}" for element in ELEMENTS]
    if not values.keys() >= set(names):
        return []
    xx, yy, zz, xy, xz, yz = (values[name] for name in names)
    moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    small, middle, large = map(float, moments)
    if min(small, small + middle - large) >= -_ROUNDING * large:
        return []
    problem = (
        f"inertia of {body.name!r}: the principal moments {small:.4g}, {middle:.4g} and "
        f"{large:.4g} kg m^2 are those of no body, since the largest is at most the sum of the "
        "others and none is negative. Check the diagonal and the signs of xy, xz and yz (elements "
        "of the tensor: minus the products of inertia). In a plane, where only the moment about "
        "the normal counts, give each of the others half of it"
    )
    return [problem]


def _rotor_problems(body: Body, values: dict[str, float]) -> list[str]:
    spin = values.get(f"{body.name}_inertia_spin")
    across = values.get(f"{body.name}_inertia_diametral")
    if spin is None or across is None or spin <= 2.0 * across * (1.0 + _ROUNDING):
        return []
    problem = (
        f"parameter '{body.name}_inertia_spin' = {spin} kg m^2 is more than twice "
        f"'{body.name}_inertia_diametral' = {across} kg m^2, the most that a body of revolution "
        "can have (a flat disc)"
    )
    return [problem]
