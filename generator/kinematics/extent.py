"""The extent of a loop, and constants of the design position that must not vanish."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from ..declare.joints import Revolute
from ..program.conditions import Condition
from ..program.floors import FAR

if TYPE_CHECKING:
    import sympy as sp

    from ..declare.geometry import Point
    from .kinematics import Kinematics


class Spanning(Protocol):
    """A step of a plan, or a leg, with points."""

    @property
    def points(self) -> tuple[Point, ...]:
        """The points between which it reaches."""


def extent_squared(kin: Kinematics, step: Spanning) -> sp.Expr:
    """Append the square of the extent of the loop that a step closes, a constant [m^2].

    It is that of all joints for a step that closes no loop.
    """
    loop = kin.closed_by(step)
    joints = loop.joints if loop else kin.mechanism.joints
    label = f"loop_{loop.number}" if loop else "mechanism"
    found = [*step.points, *(joint.center for joint in joints)]
    found += [joint.axis.through for joint in joints if isinstance(joint, Revolute)]
    first, *others = (kin.design(point) for point in dict.fromkeys(found) if point is not None)
    ways = (point - first for point in others)
    squares = sum((way.dot(way) for way in ways), first.dot(first) * FAR)
    return kin.program.define(f"{label}_extent_squared", squares)


def require(
    kin: Kinematics, name: str, quantity: Any, least: Any, unit: str, meaning: str, remedy: str
) -> None:
    """Have `prepare` refuse parameters for which a constant vanishes.

    `least` is the lower bound of its absolute value; `meaning` and `remedy` are the cause of a
    smaller value, and its remedy, for the message.
    """
    program = kin.program
    value = program.define(name, quantity)
    if not value.is_number:
        symbol = -value if value.could_extract_minus_sign() else value
        floor = program.define(f"{name}_least", least)
        program.constants.conditions.setdefault(
            symbol, Condition(symbol, floor, unit, meaning, remedy)
        )
