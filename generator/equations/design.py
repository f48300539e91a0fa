"""The independent coordinates at the design position, in terms of the parameters.

Slides are zero there, and so are angles, except for those that a hinge measures from a direction
to a point.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..declare.joints import Revolute
from ..program.function import Function
from ..program.functions import SignOf
from ..program.steps import Step
from ..program.vectors import Vector

if TYPE_CHECKING:
    from ..declare.formulation import Formulation

Steps = list[tuple[sp.Symbol, sp.Expr]]


def design_state(formulation: Formulation) -> Function:
    """Return the function from the parameters to the state at the design position, at rest."""
    coordinates, entries = design_coordinates(formulation), formulation.states.entries
    steps = [Step(s, e, "design position") for found in coordinates.values() for s, e in found]
    values = tuple(
        sp.Symbol(e.name) if e.name in coordinates else sp.Integer(e.at_design) for e in entries
    )
    doc = "State at the design position, at rest."
    names = tuple(entry.name for entry in entries)
    return Function("design_state", doc, tuple(steps), values, names, (len(values),), guards=())


def design_coordinates(formulation: Formulation) -> dict[str, Steps]:
    """Return the steps to each coordinate that is not zero at design, by its name.

    The last step of each is the coordinate itself [rad].
    """
    found = {}
    derived = {sp.Symbol(n): value for n, value in formulation.mechanism.derived.items()}
    for joint in formulation.independent:
        if isinstance(joint, Revolute) and joint.angle_to is not None:
            entries = formulation.mechanism.coordinates
            coordinate = next(c.name for c in entries if c.joint == joint)
            steps = _angle(coordinate, joint)
            found[coordinate] = [(s, e.xreplace(derived)) for s, e in steps]
    return found


def _angle(coordinate: str, joint: Revolute) -> Steps:
    """Return the angle between the parts of two vectors across an axis, from 0 to pi.

    With ``a`` the axis, not normalised: the vectors' parts across it have the scalar product
    ``(u . v) - (a . u) (a . v) / a^2`` and the vector product ``a (a . (u x v)) / a^2``.
    """
    assert joint.angle_to is not None
    steps: Steps = []

    def define(name: str, expression: sp.Expr) -> sp.Symbol:
        steps.append((sp.Symbol(f"{coordinate}_{name}"), expression))
        return steps[-1][0]

    def vector(name: str, components: Vector) -> Vector:
        return Vector(*(define(f"{name}_{a}", c) for a, c in zip("xyz", components, strict=True)))

    axis = vector("axis", joint.axis.vector)
    arm = vector("arm", joint.angle_to.position - joint.axis.through.position)
    reference = joint.angle_from.components
    across = define("across", axis.dot(reference.cross(arm)))
    size = define("axis_squared", axis.dot(axis))
    along = define("along", reference.dot(arm) * size - axis.dot(reference) * axis.dot(arm))
    steps.append((sp.Symbol(coordinate), sp.atan2(SignOf(across) * across * sp.sqrt(size), along)))
    return steps
