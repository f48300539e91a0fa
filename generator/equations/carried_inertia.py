"""Inertia of each body with what its neighbours leave to it.

Three rules shorten the equations without changing the model: point masses go from a body to the
carrier of its origin, the mass and the transverse inertia of a rotor go to its carrier, and the
rest of the rotor is its momentum about the spin axis.

Source: section 4.4 of the paper.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp

from ..declare.geometry import Direction
from ..declare.joints import Revolute
from ..kinematics.hinge_angles import positive_axis_at_design
from ..program.vectors import ELEMENTS, SymmetricTensor, Vector, to_axes
from .inertia import NONE, SpatialInertia
from .on_base.moving import MovingBody
from .on_base.sums import kind_of
from .rotors import ReducedRotor

if TYPE_CHECKING:
    from ..declare.bodies import Body
    from ..kinematics.motion import BodyMotion
    from .in_motion import InMotion


def carried_inertia(moving: InMotion) -> tuple[dict[str, SpatialInertia], list[ReducedRotor]]:
    """Return the inertia that moves with each body, by its name, and the reduced rotors."""
    sums = _Sums(moving)
    return sums.named(), sums.rotors


class _Sums:
    """Sums of inertia by body, from the last body to the first."""

    def __init__(self, moving: InMotion) -> None:
        self.program, self.mechanism = moving.program, moving.mechanism
        self.moving, self.placed, self.part_of = moving, moving.placed, moving.part_of
        self.inertia = {name: SpatialInertia.none() for name in reversed(self.placed)}
        self.rotors: list[ReducedRotor] = []
        rotors = {body.name: k for k, body in moving.coordinates.rotors.items()}
        for body in moving.formulation.massive:
            if body.name in rotors:
                self._fold_rotor(rotors[body.name], body)
            else:
                self._add_rigid(body)
        for name, inertia in self.inertia.items():
            carrier = self.placed[name].carrier
            if carrier is not None and inertia.mass != 0 and not self._is_centred(name):
                onto, at = carrier
                self.inertia[onto].add_point(inertia.mass, at)
                inertia.mass = NONE

    def named(self) -> dict[str, SpatialInertia]:
        """Append all sums."""
        return {name: self._named(name, inertia) for name, inertia in self.inertia.items()}

    def _named(self, name: str, inertia: SpatialInertia) -> SpatialInertia:
        elements = zip(ELEMENTS, inertia.tensor, strict=True)
        return SpatialInertia(
            self.program.define(f"{name}_carried_mass", inertia.mass),
            self.program.vector(f"{name}_first_moment", inertia.moment, "123"),
            SymmetricTensor(
                *(self.program.define(f"{name}_carried_inertia_{e}", v) for e, v in elements)
            ),
        )

    def _is_centred(self, body: str) -> bool:
        """Return whether the equations of a body on a base are about its centre of mass."""
        carried = self.moving.carried.get(body)
        is_base = any(body == base.body for base in self.moving.bases)
        return carried is not None and not is_base and kind_of(carried) is MovingBody

    def _add_rigid(self, body: Body) -> None:
        """Add a body given by mass, centre and tensor in ground axes at the design position."""
        placed = self.placed[body.name]
        mass = sp.Symbol(f"{body.name}_mass")
        com = self.part_of[placed.body].local(placed, body.center)
        own = self.inertia[body.name]
        own.add_point(mass, com)
        own.tensor += self._own_tensor(body).in_axes(self._ground_axes(placed))

    def _own_tensor(self, body: Body) -> SymmetricTensor:
        if body.rotor_axis is None:
            return SymmetricTensor(*(sp.Symbol(f"{body.name}_inertia_{e}") for e in ELEMENTS))
        spin, across = _rotor_moments(body)
        part = self.part_of[body.name]
        axis = part.to_ground(part.design_direction(body.rotor_axis))
        axis = self.program.vector(f"{body.name}_rotor_axis", axis)
        tensor = SymmetricTensor.transverse(across, axis)
        x, y, z = axis
        spinning = SymmetricTensor(x * x, y * y, z * z, x * y, x * z, y * z)
        return tensor + SymmetricTensor(*(spin * element for element in spinning))

    def _ground_axes(self, placed: BodyMotion) -> tuple[Vector, Vector, Vector]:
        """Return the body axes at the design position, in ground axes."""
        names, part = ("first", "second", "third"), self.part_of[placed.body]
        x, y, z = (
            self.program.vector(f"{placed.body}_{name}_in_ground", part.to_ground(axis))
            for name, axis in zip(names, placed.design_axes, strict=True)
        )
        return x, y, z

    def _fold_rotor(self, coordinate: str, body: Body) -> None:
        """Add all of a rotor to its carrier but the momentum about its own axis."""
        joint = self.mechanism.joints_of(body.name)[0]
        carrier = self.placed[joint.other(body.name)]
        spin, across = _rotor_moments(body)
        assert isinstance(joint, Revolute)
        axis = self._bearing_axis(joint, carrier)
        own = self.inertia[carrier.body]
        center = self.part_of[carrier.body].local(carrier, body.center)
        own.add_point(sp.Symbol(f"{body.name}_mass"), center)
        own.tensor += SymmetricTensor.transverse(across, axis)
        self.rotors.append(ReducedRotor(coordinate, body, carrier, axis, spin))

    def _bearing_axis(self, joint: Revolute, carrier: BodyMotion) -> Vector:
        """Return the axis about which the angle of a rotor's hinge is positive, on its carrier.

        The axis of the rotor is the same line, but may point the other way.
        """
        if isinstance(joint.axis.towards, Direction) and joint.angle_to is None:
            return self.part_of[carrier.body].local_direction(carrier, joint.axis.towards)
        positive = positive_axis_at_design(self.part_of[carrier.body], joint)
        n = to_axes(carrier.design_axes, positive)
        return self.program.vector(f"{joint.name}_axis_on_{carrier.body}", n, "123")


def _rotor_moments(body: Body) -> tuple[sp.Symbol, sp.Symbol]:
    return (sp.Symbol(f"{body.name}_inertia_spin"), sp.Symbol(f"{body.name}_inertia_diametral"))
