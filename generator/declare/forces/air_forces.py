"""Forces of still air on a body that moves through it: drag and lift."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp
from typing_extensions import override

from ...program.vectors import Vector
from ..bodies import Body
from ..declared import DeclarationError, Name, declared
from ..geometry import FORWARD, UP, Point
from ..parameters import Parameter
from ..shown import Shown
from .force import Action, Description, Force

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..surroundings import Surroundings

# Added to the radicand of a speed [m^2/s^2].
_SMALL = sp.Rational(1, 10**6)
_UNITS = {"density": "kg/m^3", "drag": "m^2", "lift": "m^2", "pitching": "m^3"}


@declared
@dataclass(frozen=True, kw_only=True)
class AirForces(Force):
    """Drag, lift and pitching moment of still air, at a point of a body.

    With the velocity V of the point in the world, its component V_x along x of the body, and the
    unit vectors e_y and e_z of the body's axes, which are those of the world at design::

        F = -density/2 drag |V| V + density/2 lift V_x^2 e_z,  M = density/2 pitching V_x^2 e_y

    Parameters
    ----------
    name
        Prefix of the names of its signals, ``<name>_drag`` and ``<name>_lift`` [N].
    body, point
        Body, and point of action at the design position.
    density
        Density of the air [kg/m^3].
    drag, lift
        Coefficients times reference area [m^2]; lift is positive upward in axes of the body.
    pitching
        Coefficient of the moment about y times area and reference length [m^3]; positive nose down.
    """

    name: Name
    body: Body
    point: Point
    density: Parameter
    drag: Parameter
    lift: Parameter
    pitching: Parameter

    def __post_init__(self) -> None:
        given = {what: getattr(self, what) for what in _UNITS}
        problems = [
            f"{what} {one.name!r} is in {one.unit}; {_UNITS[what]} is needed"
            for what, one in given.items()
            if one.unit != _UNITS[what]
        ]
        if problems:
            raise DeclarationError(f"AirForces {self.name!r}", problems)

    @property
    def identity(self) -> tuple[str, str]:
        return "force", self.name

    def describe(self) -> Description:
        return Description(
            f"air {self.name}",
            f"drag `{self.drag.name}`, lift `{self.lift.name}`, moment `{self.pitching.name}`",
            r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T\mathbf{F}"
            r" + \mathbf{W}_b^T\mathbf{M}`$",
        )

    def act(self, at: Surroundings) -> Action:
        """Append its power on the motion of the body."""
        body, program, own = self.body.name, at.program, f"{self.name}_"
        local, twists = at.local(body, self.point), at.twists(body)
        moving = {k: twist.linear + twist.angular.cross(local) for k, twist in twists.items()}
        velocity = Vector.of(0, 0, 0)
        for k, rate in moving.items():
            velocity += rate * at.rate(k)
        velocity = program.vector(f"{own}velocity", velocity)
        # the axes of components are not always those of the body at design
        forward, up = (at.direction(body, axis) for axis in (FORWARD, UP))
        ahead = program.define(f"{own}ahead", velocity.dot(forward))
        half = program.define(f"{own}half_density", self.density.symbol / 2)
        speed = program.define(f"{own}speed", sp.sqrt(velocity.dot(velocity) + _SMALL))
        drag = program.define(f"{own}drag", half * self.drag.symbol * speed)
        pressure = program.define(f"{own}pressure", half * ahead * ahead)
        lift = program.define(f"{own}lift", self.lift.symbol * pressure)
        force = program.vector(f"{own}force", velocity * (-drag) + up * lift)
        moment = up.cross(forward) * (self.pitching.symbol * pressure)
        forces = {
            k: force.dot(rate) + moment.dot(twists[k].angular)
            for k, rate in moving.items()
            if k in at.independent
        }
        return Action(forces, {f"{own}drag": drag * speed, f"{own}lift": lift})

    @override
    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        words = {"drag": "drag, against the velocity", "lift": "lift, positive upward"}
        for what, meaning in words.items():
            name = f"{self.name}_{what}"
            yield Shown(name, action.values[name], "N", meaning)
