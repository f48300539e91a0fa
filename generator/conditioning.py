"""How near to a singular set a closed form may come: floors relative to what a loop is made of.

A direction is a difference of positions over its length. The positions have the extent L of the
loop, the greatest distances in it, and are rounded to u L, u = 1.1e-16; so the direction of a
length l is off by some u L / l, and so are the distances of all that is placed by it. With some ten
roundings on the way, l > 1e-5 L leaves 1e-10 of them, ten times less than anybody is promised.
Guarded quantities are squares: `DIRECTION`.

Where the normal of two vectors is divided by its square, the same happens to the square of their
sine: `NORMAL`. A root that vanishes at a dead point spoils nothing: the equations that keep the
distances hold with whatever it is. It must only be positive: `ROOT`.

An extent is a constant: the root of the sum of squares of the ways from one joint of a loop to the
others, at the design position. Far from the origin of the axes in which positions are computed,
they are rounded to more than u L; a tenth of that distance counts, which leaves 1e-9 at worst.
What is constant itself, at the design position, is checked once, by `prepare`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from .joints import Revolute

if TYPE_CHECKING:
    from .actions import Action, HeldByRod, PinnedTelescope
    from .kinematics import Kinematics

DIRECTION = sp.Float("1e-10")
"""A length whose direction counts: least square, as a part of that of the extent."""

LENGTH = sp.Float("1e-5")
"""The same for the length itself, and for a sine."""

NORMAL = sp.Float("1e-6")
"""The normal of two vectors, by whose square is divided: least square, of the extent^4."""

ROOT = sp.Float("1e-16")
"""What only has to be positive: rounding, as a part of the square of the extent."""

BRANCH = sp.Float("1e-9")
"""How far a design position must be from its dead point, so that it is clear on which side."""

FAR = sp.Float("0.01")
"""How much the square of the distance from the origin counts to that of the extent."""

SMALLEST = sp.Float("1e-24")
"""A pure number that only has to be positive."""

POSITIVE = sp.Float("1e-280")
"""What only has to be positive, in whatever unit: its reciprocal is finite."""


@dataclass(frozen=True)
class Condition:
    """A constant that must not vanish.

    Attributes
    ----------
    quantity
        A distance (unit ``m``), or the sine of an angle (``1``); its sign does not matter.
    least
        What its amount must exceed.
    meaning, remedy
        What it means that it does not, and what to do then.
    """

    quantity: sp.Expr
    least: sp.Expr
    unit: str
    meaning: str
    remedy: str


def extent_squared(kin: Kinematics, action: Action | HeldByRod | PinnedTelescope) -> sp.Expr:
    """Append the square of the extent of the loop that an action solves, a constant [m^2].

    Of an action that solves none, it is that of all joints.
    """
    transformer = next((t for t in kin.plan.transformers if t.action == action), None)
    joints = transformer.cycle.joints if transformer else kin.mechanism.joints
    label = f"loop_{transformer.number}" if transformer else "mechanism"
    found = [getattr(action, name, None) for name in ("anchor", "end", "axis_point")]
    found += [joint.center for joint in joints]
    found += [joint.axis.through for joint in joints if isinstance(joint, Revolute)]
    first, *others = (kin.design(point) for point in dict.fromkeys(found) if point is not None)
    ways = (point - first for point in others)
    squares = sum((way.dot(way) for way in ways), first.dot(first) * FAR)
    return kin.program.define(f"{label}_extent_squared", squares)


def require(
    kin: Kinematics,
    name: str,
    quantity: Any,
    least: Any,
    unit: str,
    meaning: str,
    remedy: str,
) -> None:
    """Have `prepare` refuse parameters for which a constant vanishes."""
    program = kin.program
    value = program.define(name, quantity)
    if not value.is_number:
        symbol = -value if value.could_extract_minus_sign() else value
        floor = program.define(f"{name}_least", least)
        program.constants.conditions.setdefault(
            symbol, Condition(symbol, floor, unit, meaning, remedy)
        )
