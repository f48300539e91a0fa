"""Mechanisms put together from copies of a declared one, also from its mirror image.

A copy has names of its own for everything but what the copies share: the ground, and bodies and
inputs that are named, with the joints and forces between these. The *parameters* stay those of
the declaration: where a copy says ``left_ball_joint_y``, its mechanism knows that this is
``-ball_joint_y`` (`Mechanism.derived`). A symmetrical machine is so given by the numbers of one
side, cannot become lopsided by a typing error, and what is alike on both sides is one step of the
constants. Parameters that shall differ between the copies are named, and each copy has its own.

The mirror is the plane y = 0. A point and a direction of motion have their image there, (x, -y, z).
Axes of rotation have the opposite of their image, (-x, y, -z): turns about them look in the mirror
like turns about the originals, so a wheel that rolls forward spins positively on both sides, and
mirrored motions have the same coordinates. Where a hinge counts its angle to a point, and for the
angles of a universal joint, the declaration's own rule holds on both sides.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import sympy as sp

from ..program.vectors import Vector
from .declared import DeclarationError
from .geometry import Direction, Line, Point
from .joints import Cylindrical, Joint, Prismatic, Revolute, Spherical, Universal
from .mechanism import Mechanism

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from .assembly import Body, Parameter, RelativeCoordinate
    from .forces import Force
    from .inputs import Input


def copy(
    mechanism: Mechanism,
    prefix: str,
    *,
    mirrored: bool = False,
    shared: Collection[str] = (),
    own: Collection[str] = (),
) -> Mechanism:
    """Return a mechanism under other names, or its mirror image.

    Parameters
    ----------
    mechanism
        What is written once.
    prefix
        Begins the names of the copy's bodies, joints, coordinates, points, elements and inputs.
    mirrored
        Whether the copy is the image in the plane y = 0.
    shared
        Names of the bodies, beside the ground, and of the inputs that all copies have in common.
        Joints between such bodies, with their coordinates and forces, are common too.
    own
        Names of parameters of which the copy has its own, with the prefix; as a default, the value
        that the declaration's would give it.
    """
    known = [b.name for b in mechanism.bodies], mechanism.input_names
    problems = [
        f"shared {name!r} is neither a body nor an input of it"
        for name in shared
        if not any(name in names for names in known)
    ]
    declared = [p.name for p in mechanism.parameters]
    problems += [f"own {name!r} is no parameter of it" for name in own if name not in declared]
    if problems:
        raise DeclarationError(f"copy {prefix!r} of {mechanism.name}", problems)
    return _Copy(mechanism, prefix, mirrored, frozenset(shared), frozenset(own)).whole()


def combined(
    name: str,
    title: str,
    parts: Iterable[Mechanism],
    *,
    forces: tuple[Force, ...] = (),
    parameters: tuple[Parameter, ...] = (),
    inputs: tuple[Input, ...] = (),
) -> Mechanism:
    """Return one mechanism of several; what they have in common is there once.

    Parameters
    ----------
    parts
        Each begins with the same ground.
    forces, parameters, inputs
        What acts between the parts.
    """
    parts = tuple(parts)
    bodies = dict.fromkeys((b.name, b) for part in parts for b in _unnumbered(part))
    derived: dict[str, sp.Expr] = {}
    for part in parts:
        derived |= part.derived
    return Mechanism(
        name=name,
        title=title,
        bodies=tuple(replace(body, number=i) for i, (_, body) in enumerate(bodies, 1)),
        joints=tuple(dict.fromkeys(j for part in parts for j in part.joints)),
        forces=(*dict.fromkeys(f for part in parts for f in part.forces), *forces),
        parameters=(*dict.fromkeys(p for part in parts for p in part.parameters), *parameters),
        coordinates=tuple(dict.fromkeys(c for part in parts for c in part.coordinates)),
        inputs=(*dict.fromkeys(i for part in parts for i in part.inputs), *inputs),
        derived=derived,
        fixed=parts[0].fixed,
    )


def _unnumbered(part: Mechanism) -> list[Body]:
    """Return the bodies of a part; they get their numbers in the whole."""
    return [replace(body, number=0) for body in part.bodies]


@dataclass
class _Copy:
    """The names and signs of one copy.

    Attributes
    ----------
    turned
        Components that the mirror turns round, by the name of what has them.
    """

    mechanism: Mechanism
    prefix: str
    mirrored: bool
    shared: frozenset[str]
    own: frozenset[str]
    turned: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def whole(self) -> Mechanism:
        """Return the copy."""
        source = self.mechanism
        bodies = tuple(map(self._body, source.bodies))
        joints = tuple(map(self._joint, source.joints))
        forces = tuple(force.copied(self) for force in source.forces)
        coordinates = tuple(map(self._coordinate, source.coordinates))
        self._note_loose_points()
        return replace(
            source,
            name=f"{self.prefix}{source.name}",
            bodies=bodies,
            joints=joints,
            forces=forces,
            coordinates=coordinates,
            parameters=self._parameters(),
            inputs=tuple(map(self._copied_input, source.inputs)),
            derived=self._derived(),
        )

    # -- names ------------------------------------------------------------------------------------

    def _is_shared(self, body: str) -> bool:
        return body == self.mechanism.ground or body in self.shared

    def _common(self, joint: str) -> bool:
        """Tell whether a joint is between shared bodies."""
        return all(map(self._is_shared, self.mechanism.joint(joint).bodies))

    def named(self, name: str) -> str:
        """Return the name of what each copy has for itself."""
        return f"{self.prefix}{name}"

    def body(self, name: str) -> str:
        """Return the name of a body of the copy."""
        return name if self._is_shared(name) else self.named(name)

    def joint(self, name: str) -> str:
        """Return the name of a joint of the copy."""
        return name if self._common(name) else self.named(name)

    def input(self, name: str) -> str:
        """Return the name of an input of the copy."""
        return name if name in self.shared else self.named(name)

    def _copied_input(self, entry: Input) -> Input:
        source = entry.derivative_of
        rate_of = None if source is None else self.input(source)
        return replace(entry, name=self.input(entry.name), derivative_of=rate_of)

    # -- parameters -------------------------------------------------------------------------------

    def _parameters(self) -> tuple[Parameter, ...]:
        """Return the parameters of the declaration, or the copy's own in their place."""
        # `or 0.0`: no minus before a zero
        return tuple(
            replace(p, name=self.named(p.name), default=self._sign(p.name) * p.default or 0.0)
            if p.name in self.own
            else p
            for p in self.mechanism.parameters
        )

    def _derived(self) -> dict[str, sp.Expr]:
        """Return what the copy's names of parameters stand for."""
        values = {p.name: sp.Symbol(p.name) for p in self.mechanism.parameters}
        values |= self.mechanism.derived
        own = {sp.Symbol(n): self._sign(n) * sp.Symbol(self.named(n)) for n in self.own}
        return {
            self.named(n): self._sign(n) * value.xreplace(own)
            for n, value in values.items()
            if n not in self.own
        }

    def _sign(self, parameter: str) -> int:
        name, _, component = parameter.rpartition("_")
        return -1 if self.mirrored and component in self.turned.get(name, ()) else 1

    def _note(self, name: str, *turned: str) -> None:
        """Note the components that the mirror turns round."""
        if self.mirrored and self.turned.setdefault(name, turned) != turned:
            problem = (
                f"{name!r} is an axis of rotation and a direction of motion; a mirror image needs "
                "two directions, since it turns the one round and not the other"
            )
            raise DeclarationError(self.mechanism.name, [problem])

    def _note_loose_points(self) -> None:
        """Note the points of which there are parameters only, for what acts between the copies."""
        metres = {p.name for p in self.mechanism.parameters if p.unit == "m"}
        for name in (n.removesuffix("_y") for n in metres if n.endswith("_y")):
            if name not in self.turned and {f"{name}_x", f"{name}_z"} & metres:
                self._note(name, "y")

    # -- geometry ---------------------------------------------------------------------------------

    def point(self, point: Point) -> Point:
        """Return a point of the copy."""
        self._note(point.name, "y")
        return replace(point, name=self.named(point.name))

    def _along(self, direction: Direction) -> Direction:
        """Copy a direction of motion, or one that a body shows."""
        if direction.fixed is not None:
            return self._fixed(direction, -1)
        if direction.between is not None:
            start, end = map(self.point, direction.between)
            return replace(direction, name=self.named(direction.name), between=(start, end))
        self._note(direction.name, "y")
        return replace(direction, name=self.named(direction.name))

    def axis(self, direction: Direction) -> Direction:
        """Copy an axis of rotation."""
        if direction.fixed is not None:
            return self._fixed(direction, 1)
        if direction.between is not None:
            start, end = map(self.point, direction.between)
            ends = (end, start) if self.mirrored else (start, end)
            return replace(direction, name=self.named(direction.name), between=ends)
        self._note(direction.name, "x", "z")
        return replace(direction, name=self.named(direction.name))

    def _fixed(self, direction: Direction, sense: int) -> Direction:
        """Copy a direction that is no parameter; one that is its own image keeps its name."""
        assert direction.fixed is not None
        x, y, z = direction.fixed
        image = Vector(-sense * x, sense * y, -sense * z) if self.mirrored else direction.fixed
        if image == direction.fixed:
            return direction
        return replace(direction, name=self.named(direction.name), fixed=image)

    def _line(self, line: Line) -> Line:
        if isinstance(line.towards, Point):
            return Line(self.point(line.through), self.point(line.towards))
        return Line(self.point(line.through), self._along(line.towards))

    def _axis(self, hinge: Revolute) -> Line:
        """Copy the axis of a hinge."""
        line, through = hinge.axis, self.point(hinge.axis.through)
        if isinstance(line.towards, Direction):
            return Line(through, self.axis(line.towards))
        towards = self.point(line.towards)
        if self.mirrored and hinge.angle_to is None:
            back = Direction(self.named(f"{hinge.name}_axis"), between=(towards, through))
            return Line(through, back)
        return Line(through, towards)

    # -- bodies and joints ------------------------------------------------------------------------

    def _body(self, body: Body) -> Body:
        if self._is_shared(body.name):
            return body
        self._note(f"{body.name}_inertia", "xy", "yz")
        return replace(
            body,
            name=self.named(body.name),
            center=self.point(body.center),
            rotor_axis=None if body.rotor_axis is None else self.axis(body.rotor_axis),
        )

    def _joint(self, joint: Joint) -> Joint:
        if self._common(joint.name):
            return joint
        first, second = map(self.body, joint.bodies)
        renamed = replace(joint, name=self.named(joint.name), first=first, second=second)
        if isinstance(renamed, Revolute):
            marker = None if renamed.angle_to is None else self.point(renamed.angle_to)
            zero = self._along(renamed.angle_from)
            return replace(renamed, axis=self._axis(renamed), angle_to=marker, angle_from=zero)
        if isinstance(renamed, Prismatic):
            return replace(renamed, direction=self._along(renamed.direction))
        if isinstance(renamed, Cylindrical):
            return replace(
                renamed,
                axis=self._line(renamed.axis),
                angle_to=self.point(renamed.angle_to),
                length_at_zero_slide=self.named(renamed.length_at_zero_slide),
            )
        if isinstance(renamed, Universal):
            return replace(
                renamed,
                at=self.point(renamed.at),
                shaft=self._line(renamed.shaft),
                first_axis=self._along(renamed.first_axis),
            )
        if isinstance(renamed, Spherical):
            renamed = replace(renamed, at=self.point(renamed.at))
        return renamed

    def _coordinate(self, coordinate: RelativeCoordinate) -> RelativeCoordinate:
        if self._common(coordinate.joint):
            return coordinate
        return replace(
            coordinate,
            name=self.named(coordinate.name),
            joint=self.joint(coordinate.joint),
        )
