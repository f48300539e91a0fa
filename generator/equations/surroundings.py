"""Surroundings of a force: the mechanism in motion, in the steps of its kinematics."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import sympy as sp

from ...core.suggestions import suggestion
from ..declare.geometry import UP
from ..declare.joints import Cylindrical, Free, Joint, Prismatic, Revolute
from ..declare.surroundings import UnseenError
from ..kinematics.guide_slides import slide_of, sliding_rates
from ..kinematics.hinge_angles import angle_of, turning_rates
from .views import InBody, OnBase

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from ..declare.geometry import Direction, Point
    from ..declare.surroundings import Motion
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion
    from ..program.vectors import Twist, Vector
    from .in_motion import InMotion

OfKind = TypeVar("OfKind", bound=Joint)

Momenta = dict[tuple[str, str], "Vector"]
"""Linear momentum per unit rate, in body axes, by body and coordinate."""


class Seen:
    """The surroundings of all forces of a model; see `declare.surroundings.Surroundings`.

    `momenta` are those of the bodies that carry mass; `accelerations` of the independent
    coordinates are None until they are known. `driven` are the names of all coordinates, also of
    those that do not move in this variant.
    """

    def __init__(
        self, moving: InMotion, momenta: Momenta, accelerations: Mapping[str, sp.Expr] | None
    ) -> None:
        self._moving, self._placed, self._part_of = moving, moving.placed, moving.part_of
        self._driven = moving.coordinates
        self.program, self.mechanism = moving.program, moving.mechanism
        # a force along an eliminated speed acts on the others by the constraints
        self.independent, self.coordinates = self._driven.unconstrained, self._driven.moving
        self.driven = tuple(self._driven.symbols)
        self._momenta, self._accelerations = momenta, accelerations
        self._views: dict[str, InBody | OnBase] = {}

    @property
    def all_move(self) -> bool:
        """Whether all coordinates move."""
        return len(self.coordinates) == len(self.driven)

    # -- coordinates ------------------------------------------------------------------------------

    def coordinate(self, joint: str) -> str:
        """Return the coordinate of a driven joint."""
        found = self._joint(joint)
        if isinstance(found, Free):
            names = ", ".join(self._driven.all_of(found))
            raise UnseenError(f"joint {joint!r} is free, and has no single coordinate: {names}")
        if found not in self._driven.driven:
            problem = f"joint {joint!r} is neither independent nor prescribed"
            if found.gear:
                problem = f"joint {joint!r} follows {found.first_followed.name!r} through gears"
            names = ", ".join(repr(joint.name) for joint in self._driven.driven)
            problem = f"{problem}, and has no coordinate of its own; {names} have one"
            raise UnseenError(problem)
        return self._driven.of(found)

    def rate(self, coordinate: str) -> sp.Expr:
        """Return the rate of a coordinate."""
        return self._driven.true_rate(self._coordinate(coordinate))

    def acceleration(self, coordinate: str) -> sp.Expr:
        """Return the acceleration of a coordinate; that of a prescribed one is in the bias."""
        if self._accelerations is None:
            problem = (
                "forces are what accelerations follow from, so that act cannot read them; signals "
                "may"
            )
            raise UnseenError(problem)
        return self._accelerations.get(self._coordinate(coordinate), sp.Integer(0))

    def _coordinate(self, name: str) -> str:
        return _known("coordinate", name, self.driven)

    def _joint(self, name: str) -> Joint:
        joints = {joint.name: joint for joint in self.mechanism.joints}
        return joints[_known("joint", name, joints)]

    def _body(self, name: str) -> BodyMotion:
        return self._placed[_known("body", name, self._placed)]

    # -- bodies -----------------------------------------------------------------------------------

    def local(self, body: str, point: Point) -> Vector:
        """Return the constant coordinates of a point, in the axes of a body's view."""
        return self._view(body).local(point)

    def direction(self, body: str, direction: Direction) -> Vector:
        """Return the constant components of a direction fixed in a body, in these axes."""
        return self._view(body).direction(direction)

    def line(self, body: str, direction: Direction, follows: bool) -> Vector:
        """Return a unit vector in these axes, fixed in the body if it follows, or in the world."""
        view = self._view(body)
        return view.direction(direction) if follows else view.from_world(direction)

    def up(self, body: str) -> Vector:
        """Return the upward unit vector of the world, in these axes."""
        return self.line(body, UP, follows=False)

    def twists(self, body: str) -> Mapping[str, Twist]:
        """Return the twist per unit rate of each coordinate that moves a body, in these axes."""
        return self._view(body).twists

    def momenta(self) -> Iterator[tuple[str, str, Vector]]:
        """Yield body, coordinate and linear momentum per unit rate, of massive bodies."""
        yield from ((*key, momentum) for key, momentum in self._momenta.items())

    def height(self, body: str, local: Vector) -> sp.Expr:
        """Return the height of a point of a body in the world."""
        return self._view(body).height(local)

    def place(self, body: str, local: Vector) -> Vector:
        """Return the position of a point of a body in the world."""
        return self._view(body).place(local)

    def in_world(self, body: str, vector: Vector) -> Vector:
        """Return the components in the world of a vector in these axes."""
        return self._view(body).in_world(vector)

    def rising(self, body: str, local: Vector) -> sp.Expr:
        """Return the upward acceleration of a point without accelerations of the coordinates."""
        return self._view(body).rising(local)

    def _view(self, body: str) -> InBody | OnBase:
        """Return the view of a body: in its own axes, or in those of its base."""
        if body not in self._views:
            placed = self._body(body)
            carried = self._moving.carried.get(body)
            turns = carried is not None and carried.base.turns
            self._views[body] = (
                OnBase(carried) if carried and turns else InBody(placed, self._part_of[body])
            )
        return self._views[body]

    # -- paths ------------------------------------------------------------------------------------

    def telescope(self, joint: str) -> tuple[sp.Expr, Motion, sp.Expr]:
        """Return length of a telescope, its rate per unit rate, and its slide."""
        self._of_kind(joint, Cylindrical)
        part = self._with_joint(joint)
        line = part.telescopes[joint]
        return line.length, line.length_motion, part.slides[joint]

    def hinge(self, joint: str) -> tuple[sp.Expr, Motion]:
        """Return the angle of a hinge, and its rate per unit rate of each coordinate."""
        hinge = self._of_kind(joint, Revolute)
        part = self._with_joint(joint)
        return angle_of(part, hinge), turning_rates(part, hinge)

    def guide(self, joint: str) -> tuple[sp.Expr, Motion]:
        """Return the slide of a guide, and its rate per unit rate of each coordinate."""
        guide = self._of_kind(joint, Prismatic)
        part = self._with_joint(joint)
        return slide_of(part, guide), sliding_rates(part, guide)

    def _of_kind(self, name: str, kind: type[OfKind]) -> OfKind:
        joint = self._joint(name)
        if not isinstance(joint, kind):
            problem = f"joint {name!r} is {joint.kind}, where {kind.kind} is needed"
            raise UnseenError(problem)
        return joint

    def _with_joint(self, joint: str) -> Kinematics:
        """Return the part that a joint belongs to."""
        part = self._moving.part_with(*self.mechanism.joint(joint).bodies)
        assert part is not None
        return part

    def between(
        self, first: tuple[str, Point], second: tuple[str, Point]
    ) -> tuple[Vector, Mapping[str, Vector]]:
        """Return the vector between two points, and its rate per unit rate, in equal axes."""
        for body, _ in (first, second):
            self._body(body)
        relative = self._moving.relative_motion(first, second)
        return relative.position, relative.motion

    def extent(self, body: str, point: Point) -> Vector:
        """Return the design position of a point: a measure of size."""
        self._body(body)
        return self._part_of[body].design(point)


def _known(what: str, name: Any, names: Iterable[str]) -> str:
    """Return a name if it is known."""
    names = list(names)
    if isinstance(name, str) and name in names:
        return name
    if isinstance(name, str):
        problem = f"there is no {what} {name!r}. {suggestion(name, names)}"
    else:
        problem = f"{name!r} is not the name of a {what}: give one of {', '.join(names)}"
    raise UnseenError(problem)
