"""Mechanisms composed of copies of a declared one, also of its mirror image.

A copy has names of its own for everything but the shared parts: the ground, and bodies and inputs
that are named, with the joints between these. The *parameters* are those of the declaration: the
point of a copy refers to ``left_ball_joint_y`` as ``-ball_joint_y`` (`Owner.image`). A symmetrical
machine is so given by the numbers of one side, cannot become lopsided by a typing error, and equal
quantities of both sides are one step of the constants. Points, directions and parameters that shall
differ between the copies are named, and each copy has its own.

The mirror is the plane y = 0, and every type has its image there. A point and a direction of motion
have theirs, (x, -y, z). Axes of rotation have the opposite of their image, (-x, y, -z): turns about
them look in the mirror like turns about the originals, so a wheel that rolls forward spins
positively on both sides, and mirrored motions have the same coordinates. Where a hinge counts its
angle to a point, and for the angles of a universal joint, the declaration's own rule holds on both
sides.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

from ..program.vectors import Vector
from .bodies import Body, Ground
from .declared import DeclarationError, checked
from .forces.force import Force
from .geometry import Direction, Line, Point
from .inputs import Input, Motion
from .joints import Joint, RelativeCoordinate, Revolute
from .mechanism import Mechanism
from .outputs import Output
from .parameters import Image, Owner, Parameter, next_order

if TYPE_CHECKING:
    from collections.abc import Collection

Thing = TypeVar("Thing")


class Copy:
    """A copy of a mechanism under other names, or of its mirror image.

    Parameters
    ----------
    source
        The original mechanism.
    prefix
        Prefix of the names of the copy's bodies, joints, coordinates, points, elements and inputs.
    mirrored
        Whether the copy is the mirror image in the plane y = 0.
    shared
        Bodies, beside the ground, and inputs that all copies have in common. Joints between such
        bodies, with their coordinates, are also common.
    own
        Points, directions and parameters that the copy has for itself, with the prefix in their
        names and the defaults of the original; all others are those of the original.

    Attributes
    ----------
    mechanism
        The copy.
    """

    def __init__(
        self,
        source: Mechanism,
        prefix: str,
        *,
        mirrored: bool = False,
        shared: Collection[Body | Input | Motion] = (),
        own: Collection[Owner] = (),
    ) -> None:
        self.source, self.prefix, self.mirrored = source, prefix, mirrored
        self.shared, self.own = tuple(shared), tuple(own)
        self._made: dict[Owner, Owner] = {}
        self._check()
        self._bodies = {body: self._body(body) for body in source.bodies}
        self.mechanism = replace(
            source,
            name=f"{prefix}{source.name}",
            joints=self.of(source.joints),
            forces=self.of(source.forces),
            coordinates=self.of(source.coordinates),
            outputs=self.of(source.outputs),
            constraints=self.of(source.constraints),
        )

    def _check(self) -> None:
        owners = self.source.every(Owner)
        known = [*self.source.bodies, *self.source.inputs]
        problems = [
            f"shared {thing.name!r} is neither a body nor an input of it"
            for thing in self.shared
            if not isinstance(thing, Motion) and thing not in known
        ]
        problems += [
            f"own {getattr(thing, 'name', thing)!r} is not a parameter, point or direction of it"
            for thing in self.own
            if thing not in owners
        ]
        if problems:
            raise DeclarationError(f"copy {self.prefix!r} of {self.source.name}", problems)

    def of(self, thing: Thing) -> Thing:
        """Return the object of the copy that belongs to an object of the original mechanism."""
        return self._copied(thing)

    def _copied(self, thing: Any, *, turns: bool = False) -> Any:  # noqa: PLR0911 (of types)
        """Return the image of a thing in the copy, which may be an axis of rotation (`turns`)."""
        if isinstance(thing, tuple):
            return tuple(map(self._copied, thing))
        if isinstance(thing, Mapping):
            return {self._copied(key): self._copied(value) for key, value in thing.items()}
        if isinstance(thing, Body):
            return self._bodies.get(thing) or self._body(thing)
        if not is_dataclass(thing) or isinstance(thing, type) or self._is_common(thing):
            return thing
        if isinstance(thing, Direction) and thing.along is None:
            return self._unowned(thing, turns=turns)
        if isinstance(thing, Owner):
            return self._owner(thing, turns=turns)
        if isinstance(thing, Revolute):
            return self._rebuilt(thing, axis=self._hinge_line(thing))
        if isinstance(thing, Line):
            return Line(self._copied(thing.through), self._copied(thing.towards, turns=turns))
        return self._rebuilt(thing)

    def _is_common(self, thing: Any) -> bool:
        """Return whether a thing is common to all copies."""
        if isinstance(thing, Ground) or thing in self.shared:
            return True
        if isinstance(thing, Force):
            return thing.in_common
        if isinstance(thing, Joint):
            return self._is_common(thing.first) and self._is_common(thing.second)
        return isinstance(thing, RelativeCoordinate) and self._is_common(thing.joint)

    def _body(self, body: Body) -> Body:
        """Return the copy of a body; a shared one, too, has its place in lists by the copy."""
        place = next_order()
        return (
            replace(body, order=place)
            if self._is_common(body)
            else self._rebuilt(body, order=place)
        )

    def _rebuilt(self, thing: Any, **known: Any) -> Any:
        """Return a copy of a thing, field by field."""
        if hasattr(thing, "name"):
            known["name"] = self._new(thing.name)
        turning = getattr(thing, "turns_about", ())
        for entry in fields(thing):
            if entry.init and entry.name not in known:
                value = getattr(thing, entry.name)
                known[entry.name] = self._copied(value, turns=entry.name in turning)
        return replace(thing, **known)

    def _new(self, name: str) -> str:
        return f"{self.prefix}{name}"

    # -- what owns parameters ---------------------------------------------------------------------

    def _owner(self, owner: Owner, *, turns: bool) -> Owner:
        """Return a copy of an owner of parameters; its own are represented by the declaration's."""
        signs = _signs(owner, turns=turns) if self.mirrored else (1,) * len(owner.numbers)
        changes: dict[str, Any] = {"image": Image(owner, signs)}
        if owner in self.own:
            changes = {"image": None, "order": next_order()}
        if isinstance(owner, Direction):
            changes["axial"] = turns
        named = "body" if hasattr(owner, "body") else "name"
        changes[named] = self._new(getattr(owner, named))
        made = replace(owner, **changes, **_turned_defaults(owner, signs))
        if self._made.setdefault(owner, made) != made:
            problem = (
                f"{getattr(owner, named)!r} is an axis of rotation and a direction of motion; a "
                "mirror image needs two directions, since it turns the one round and not the other"
            )
            raise DeclarationError(self.source.name, [problem])
        return made

    def _unowned(self, direction: Direction, *, turns: bool) -> Direction:
        """Return a copy of a direction without parameters; a fixed one may be its own image."""
        if direction.between is not None:
            start, end = map(self._copied, direction.between)
            ends = (end, start) if self.mirrored and turns else (start, end)
            return replace(direction, name=self._new(direction.name), between=ends)
        assert direction.fixed is not None
        x, y, z = direction.fixed
        sense = 1 if turns else -1
        image = Vector(-sense * x, sense * y, -sense * z) if self.mirrored else direction.fixed
        if image == direction.fixed:
            return direction
        return replace(direction, name=self._new(direction.name), fixed=image)

    def _hinge_line(self, hinge: Revolute) -> Line:
        """Return a copy of a hinge's axis; one between points is reversed for angles about it."""
        line = hinge.axis
        if isinstance(line.towards, Point) and self.mirrored and hinge.angle_to is None:
            through, towards = self._copied(line.through), self._copied(line.towards)
            back = Direction(self._new(f"{hinge.name}_axis"), between=(towards, through))
            return Line(through, back)
        return self._copied(line, turns=True)


def _signs(owner: Owner, *, turns: bool) -> tuple[int, ...]:
    """Return the signs of numbers in the mirror; an axis of rotation has the opposite ones."""
    opposite = turns and isinstance(owner, Direction)
    return tuple(-sign for sign in owner.turned) if opposite else owner.turned


def _turned_defaults(owner: Owner, signs: tuple[int, ...]) -> dict[str, Any]:
    """Return the defaults of an image."""
    # `or 0.0`: no minus before a zero
    turned = tuple(sign * p.default or 0.0 for sign, p in zip(signs, owner.numbers, strict=True))
    if isinstance(owner, Parameter):
        return {"default": turned[0]}
    if isinstance(owner, Point):
        return {"place": turned}
    return {"along": turned} if isinstance(owner, Direction) else {}


def replaced(thing: Thing, bodies: Mapping[Body, Body]) -> Thing:
    """Return a declared thing in which some bodies are replaced, and all else is the same.

    It is a joint, a force, a coordinate and so on, also in tuples and mappings; `bodies` are the
    new ones, by the replaced ones.
    """
    return _replaced(thing, bodies)


def _replaced(thing: Any, bodies: Mapping[Body, Body]) -> Any:
    if isinstance(thing, tuple):
        return tuple(_replaced(part, bodies) for part in thing)
    if isinstance(thing, Mapping):
        return {_replaced(k, bodies): _replaced(value, bodies) for k, value in thing.items()}
    if isinstance(thing, Body):
        return bodies.get(thing, thing)
    if not is_dataclass(thing) or isinstance(thing, type | Owner):
        return thing
    values = {entry.name: getattr(thing, entry.name) for entry in fields(thing) if entry.init}
    changed = {name: _replaced(value, bodies) for name, value in values.items()}
    return replace(thing, **changed) if changed != values else thing


@checked
def combined(
    name: str,
    title: str,
    parts: tuple[Copy, ...],
    *,
    forces: tuple[Force, ...] = (),
    coordinates: tuple[RelativeCoordinate, ...] = (),
    outputs: tuple[Output, ...] = (),
) -> Mechanism:
    """Return one mechanism of several copies; shared parts occur once.

    Parameters
    ----------
    name, title
        Of the mechanism.
    parts
        Copies with the same ground.
    forces, coordinates, outputs
        Forces between the parts, and further signals.
    """
    wholes = [part.mechanism for part in parts]
    return Mechanism(
        name=name,
        title=title,
        joints=tuple(dict.fromkeys(j for whole in wholes for j in whole.joints)),
        forces=(*dict.fromkeys(f for whole in wholes for f in whole.forces), *forces),
        coordinates=(
            *dict.fromkeys(c for whole in wholes for c in whole.coordinates),
            *coordinates,
        ),
        outputs=(*dict.fromkeys(o for whole in wholes for o in whole.outputs), *outputs),
        constraints=tuple(dict.fromkeys(c for whole in wholes for c in whole.constraints)),
    )
