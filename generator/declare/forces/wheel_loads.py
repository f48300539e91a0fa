"""External loads on a wheel, of a road and a drive shaft."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ...program.vectors import Vector, from_axes
from ..declared import DeclarationError, declared
from ..inputs import Input
from ..joints import Revolute
from ..parameters import Length
from ..wheel import Wheel
from .force import Action, Description, Force

if TYPE_CHECKING:
    from ..surroundings import Surroundings

Components = tuple[Input, Input, Input]
"""Along the axes of the tyre: forward, to the left, up."""


@declared
@dataclass(frozen=True, kw_only=True)
class WheelLoads(Force):
    """Forces and moments on a wheel that may spin, in the axes of the tyre (ISO 8855).

    With the unit vectors ``a`` along the spin axis, which points to the left, and ``e_z`` up, x is
    along ``a x e_z``, forward, horizontal and in the plane of the wheel; y is horizontal, to the
    left; z is up. The vector from the centre of the wheel, a thin disc, to its lowest point is
    ``-radius (e_z - a a_z) / sqrt(1 - a_z^2)``.

    Parameters
    ----------
    wheel
        The wheel; its carrier takes all loads that do not turn it about its axis.
    bearing
        The driven hinge about which it turns on its carrier, along its spin axis.
    radius
        Radius of the disc [m].
    contact
        Components x, y, z of the force on the wheel at its lowest point [N].
    moment
        Components x, y, z of the moment on the wheel [N m].
    center
        Components x, y, z of the force on the wheel at its centre [N].
    shaft
        Torque on the wheel about its spin axis by a drive shaft, whose reaction is not on the
        carrier [N m].
    hub
        Torque on the wheel about its spin axis by its carrier, as of a brake [N m].
    """

    wheel: Wheel
    bearing: Revolute
    radius: Length
    contact: Components
    moment: Components
    center: Components
    shaft: Input
    hub: Input

    def __post_init__(self) -> None:
        problems = [
            f"input {given.name!r} is in {given.unit}; {unit} is needed"
            for unit, inputs in (
                ("N", (*self.contact, *self.center)),
                ("N m", (*self.moment, self.shaft, self.hub)),
            )
            for given in inputs
            if given.unit != unit
        ]
        problems += self.wheel.bearing_problems(self.bearing)
        if problems:
            raise DeclarationError(f"WheelLoads by {self.bearing.name!r}", problems)

    @property
    def identity(self) -> tuple[str, str]:
        return "WheelLoads by", self.bearing.name

    @property
    def along(self) -> Revolute:
        return self.bearing

    def describe(self) -> Description:
        named = ", ".join(f"`{i.name}`" for i in (*self.contact, *self.center, *self.moment))
        torques = f"torques `{self.shaft.name}` and `{self.hub.name}` about the spin axis"
        return Description(
            f"loads on the wheel of {self.bearing.name}",
            f"F at the lowest point and at the centre, M: {named}; {torques}",
            r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T\mathbf{F} + "
            r"\mathbf{W}_b^T\mathbf{M}`$",
        )

    def act(self, at: Surroundings) -> Action:
        """Append its power on the motion of the carrier, and on the spin."""
        carrier, name = self.wheel.carrier.name, self.bearing.name
        upright = self.wheel.upright(at, f"{name}_")
        cosine, axis = sp.sqrt(upright.squared), upright.axis
        forward = at.program.vector(f"{name}_forward", axis.cross(upright.up) * (1 / cosine), "123")
        axes = forward, upright.up.cross(forward), upright.up
        contact, moment, center = (
            from_axes(axes, Vector(*(sp.Symbol(part.name) for part in given)))
            for given in (self.contact, self.moment, self.center)
        )
        arm = upright.pull * (-self.radius.symbol / cosine)
        moment += arm.cross(contact) + axis * sp.Symbol(self.shaft.name)
        force = at.program.vector(f"{name}_force", contact + center, "123")
        moment = at.program.vector(f"{name}_moment", moment, "123")
        forces = {
            k: force.dot(self.wheel.velocity(at, k)) + moment.dot(twist.angular)
            for k, twist in at.twists(carrier).items()
            if k in at.independent
        }
        forces[at.coordinate(name)] = moment.dot(axis) + sp.Symbol(self.hub.name)
        return Action(forces)
