"""Rotors: bodies of revolution on a bearing, as wheels and flywheels.

Their carriers have taken over their mass and transverse inertia (`carried_inertia`), so that the
momentum about the spin axis is left. With the axis a on a carrier that turns at omega, the spin
equation is ``I (a . omega' + spin') = torque``, and the couple of the carrier is
``(omega x a) I (a . omega + spin)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import sympy as sp

from ..program.vectors import ZERO, Vector, from_axes
from .inertia import NONE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from ..declare.bodies import Body
    from ..kinematics.motion import BodyMotion
    from .in_motion import InMotion
    from .on_base.loaded import Loaded


@dataclass(frozen=True)
class ReducedRotor:
    """The rest of a body of revolution without the inertia that its carrier has taken over."""

    coordinate: str
    body: Body
    carrier: BodyMotion
    axis: Vector
    inertia: sp.Expr


class Rotors:
    """The terms of rotors in the equations of motion.

    `bases` are the bases of the model by name, with the bodies on them.
    """

    def __init__(
        self, moving: InMotion, bases: Mapping[str, Loaded], rotors: list[ReducedRotor]
    ) -> None:
        self.program, self.coordinates = moving.program, moving.coordinates
        self.names = self.coordinates.unconstrained
        self._moving, self._bases, self._rotors = moving, bases, rotors
        self._of_base = {k: loaded for loaded in bases.values() for k in loaded.base.coordinates}

    def __iter__(self) -> Iterator[ReducedRotor]:
        return iter(self._rotors)

    def gyroscopic(self, rotor: ReducedRotor) -> tuple[dict[str, Vector], Vector] | None:
        """Return the gyroscopic couple on the carrier of a rotor, and what turns it.

        That is the angular velocity of the carrier per unit rate of each coordinate. None where the
        couple does no work: ``omega x a`` is perpendicular to the only direction of motion.
        """
        turned = self._is_turned(rotor)
        if self.coordinates.rate_scale_of(self._relative(rotor)) != 1 and not turned:
            return None
        axis, columns, omega = self._seen(rotor)
        spin = self.coordinates.true_rate(rotor.coordinate) + axis.dot(omega)
        momentum = self.program.define(f"{rotor.body.name}_spin_momentum", rotor.inertia * spin)
        swing = omega.cross(axis)
        if turned:
            swing = self._swing(rotor, swing)
        couple = self.program.vector(f"{rotor.body.name}_gyroscopic", swing * momentum, "123")
        return columns, couple

    def row(self, rotor: ReducedRotor) -> dict[str, sp.Expr]:
        """Return the rate of ``a . omega + spin`` per unit rate of each coordinate."""
        share = {k: self._share(rotor, k) for k in self._carrying(rotor)}
        share[rotor.coordinate] = sp.Integer(1)
        return {k: share.get(k, NONE) for k in self.names}

    def bias(self, rotor: ReducedRotor, accelerations: Mapping[str, sp.Expr]) -> sp.Expr:
        """Return ``a . omega'`` of the carrier; missing accelerations of coordinates are zero."""
        own = [k for k in self._carrying(rotor) if k not in self._of_base]
        total = sum((self._share(rotor, k) * accelerations.get(k, NONE) for k in own), NONE)
        placed = self._relative(rotor)
        scale = self.coordinates.rate_scale_of(placed) ** 2
        total += rotor.axis.dot(placed.bias().angular) * scale
        loaded = self.base_of(rotor)
        if loaded is None or not self._is_turned(rotor):
            return total
        axis, _, omega = self._seen(rotor)
        base = loaded.acceleration("_of_all" if accelerations else "_left", accelerations)
        # a . (w x omega), where omega x a is a factor of the gyroscopic couple
        swing = self._swing(rotor, omega.cross(axis))
        return total + axis.dot(base.angular) + loaded.base.omega.dot(swing)

    def reaction(self, k: str, torques: Mapping[str, sp.Expr]) -> sp.Expr:
        """Return the torques on bearings, reduced to a coordinate of the carriers.

        `torques` are by the coordinates of the rotors.
        """
        rotors = [r for r in self if torques[r.coordinate] != 0 and k in self._carrying(r)]
        if k not in self._of_base:
            return sum((self._share(r, k) * torques[r.coordinate] for r in rotors), NONE)
        base = self._of_base[k].base
        total = ZERO
        for rotor in rotors:
            total += self._seen(rotor)[0] * torques[rotor.coordinate]
        total = self.program.vector(f"{base.body}_bearings", total)
        return base.twists[k].angular.dot(total)

    def base_of(self, rotor: ReducedRotor) -> Loaded | None:
        """Return the base of the carrier of a rotor; None on the ground."""
        carried = self._moving.carried.get(rotor.carrier.body)
        return self._bases[carried.base.body] if carried else None

    def _share(self, rotor: ReducedRotor, k: str) -> sp.Expr:
        """Return ``a . omega`` per unit rate of a coordinate."""
        axis, columns, _ = self._seen(rotor)
        loaded = self._of_base.get(k)
        along = columns[k] if loaded is None else loaded.base.twists[k].angular
        return self.program.define(f"{rotor.body.name}_share_{k}", axis.dot(along))

    def _seen(self, rotor: ReducedRotor) -> tuple[Vector, dict[str, Vector], Vector]:
        """Return the axis of a rotor, and its carrier's angular velocity: per rate, and in total.

        In the axes of its base, without the coordinates of that; in those of the carrier on the
        ground.
        """
        body, placed = rotor.carrier.body, self._relative(rotor)
        if not self._is_turned(rotor):
            columns = {k: placed.motion[k].angular for k in self.names if k in placed.motion}
            return rotor.axis, columns, self._moving.part_of[body].total(placed).angular
        carried, program = self._moving.carried[body], self.program
        base = carried.base
        axis = program.vector(
            f"{rotor.body.name}_axis_on_{base.body}", from_axes(carried.axes, rotor.axis)
        )
        rates, omega, columns = self.coordinates.true_rate, base.omega, {}
        for k, twist in carried.relative.motion.items():
            name = f"{body}_on_{base.body}_omega_{k}"
            turning = program.vector(name, from_axes(carried.axes, twist.angular))
            omega += turning * rates(k)
            if k in self.names:
                columns[k] = turning
        return axis, columns, program.vector(f"{body}_on_{base.body}_turning", omega)

    def _swing(self, rotor: ReducedRotor, rate: Vector) -> Vector:
        """Name the rate of the axis of a rotor, by which its bias and its couple are computed."""
        return self.program.vector(f"{rotor.body.name}_swing", rate)

    def _relative(self, rotor: ReducedRotor) -> BodyMotion:
        """Return the motion of the carrier of a rotor on its base, or on the ground."""
        carried = self._moving.carried.get(rotor.carrier.body)
        return rotor.carrier if carried is None else carried.relative

    def _is_turned(self, rotor: ReducedRotor) -> bool:
        """Return whether the carrier of a rotor is on a base that turns."""
        loaded = self.base_of(rotor)
        return loaded is not None and loaded.base.turns

    def _carrying(self, rotor: ReducedRotor) -> list[str]:
        """Return the coordinates that move the carrier of a rotor."""
        return [k for k in self.names if k in rotor.carrier.motion]
