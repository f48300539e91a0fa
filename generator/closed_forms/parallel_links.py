"""Three or more parallel and equally long links between the same two bodies.

The body that they carry does not turn relative to the other one, and each link turns like the first
one: ``x(B) = x(pin of the first link)`` with the axes of A, without an equation to solve. There is
one equation more than necessary, which is fulfilled if the links are parallel and equally long:
`prepare` checks that. A body that other links have placed must not turn either, for this; or else a
link follows one that has the same pins. Branch: the parallelogram, also behind the position in
which all pins lie on a line. Singular set: none.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, ClassVar

import sympy as sp
from typing_extensions import override

from ..loops.forms import ClosedForm
from ..loops.parallel import ends_of, is_along
from ..loops.turned import turn_alike
from ..program.conditions import Assumption
from .turned_alike import place_turned_alike

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..declare.joints import Revolute
    from ..kinematics.kinematics import Kinematics
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known
    from ..program.vectors import Vector


@dataclass(frozen=True)
class _Link:
    """A link between two bodies, by its hinges on the carrying and on the carried one."""

    name: str
    near: Revolute
    far: Revolute

    @property
    def design(self) -> Vector:
        """The vector from hinge to hinge at the design position."""
        return self.far.axis.through.position - self.near.axis.through.position

    def waits(self, known: Known) -> bool:
        """Return whether nothing determines its turn yet."""
        hinges = (self.near, self.far)
        return self.name not in known.placed and all(map(known.unknowns_of, hinges))

    def off(self, other: _Link) -> Iterator[Vector]:
        """Yield the distances of the hinges of another link from those of this one, as vectors."""
        for own, its in ((self.near, other.near), (self.far, other.far)):
            yield its.axis.through.position - own.axis.through.position

    def has_pins_of(self, other: _Link, known: Known) -> bool:
        """Return whether both have the same hinges at the default parameters."""
        hinge, length = self.near, self.design
        return all(is_along(known.mechanism, hinge, way, length) for way in self.off(other))


@dataclass(frozen=True)
class ParallelLinks(ClosedForm):
    """Links carry a body without turning it, of which one is placed; the others follow."""

    base: str
    body: str
    leader: _Link
    link: _Link
    # whether the body may turn, so that the link must have the pins of the leader
    on_its_pins: bool

    rank: ClassVar[int] = 0
    """Before any other form, none of which can use the third link."""

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the link of a loop that follows a parallel one, if that is placed."""
        loop = {*cut.bodies, *cut.others}
        for pair, links in known.topology.parallel_links.items():
            base = next((body for body in sorted(pair) if body in known.placed), None)
            if loop != {*pair, *loop.intersection(links)} or base is None:
                continue
            (body,) = pair - {base}
            lines = [
                _Link(link, ends[base], ends[body])
                for link in links
                if (ends := ends_of(known.mechanism, link, pair))
            ]
            turns = body in known.placed and not turn_alike(known, base, body)
            leaders = [line for line in lines if line.name in known.placed]
            waiting = [x for x in lines if x.name in loop and x.waits(known)]
            for leader, link in product(leaders, waiting):
                if not turns or link.has_pins_of(leader, known):
                    return cls(base, body, leader, link, turns)
        return None

    @property
    def about(self) -> str:
        return self.link.name

    @property
    def title(self) -> str:
        return f"{self.link.name}: parallel to {self.leader.name}"

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        if self.on_its_pins:
            return (
                f"pins of {self.link.name} = pins of {self.leader.name}",
                f"{self.link.name} turns with {self.leader.name}",
            )
        return (
            f"{self.link.name} = {self.leader.name}, as vectors",
            f"{self.body} turns with {self.base}, {self.link.name} with {self.leader.name}",
        )

    def accept(self, known: Known) -> set[Coordinate]:
        """Record body and link, with the hinges of both."""
        known.place(self.body)
        known.place(self.link.name)
        known.alike.add(frozenset((self.leader.name, self.link.name)))
        if not self.on_its_pins:
            known.alike.add(frozenset((self.base, self.body)))
        return known.add_all([self.leader.near, self.leader.far, self.link.near, self.link.far])

    def assumptions(self) -> Iterator[Assumption]:
        """Yield the conditions that make the links equal."""
        n, leader = self.leader.near.axis.vector, self.leader.design
        size = sp.sqrt(leader.dot(leader))
        between = f"{self.link.name} and {self.leader.name} hold {self.body} on {self.base}"
        if self.on_its_pins:
            for end, off in zip(("near", "far"), self.leader.off(self.link), strict=True):
                yield Assumption(
                    f"{self.link.name}_{end}_pin_off",
                    _across(n, off),
                    size,
                    "m",
                    f"{between}, which turn against each other, and their pins are not the same, "
                    "so that nothing moves",
                    f"give both the same pins, or leave {self.link.name} out",
                )
            return
        yield Assumption(
            f"{self.link.name}_not_parallel",
            _across(n, self.link.design - leader),
            size,
            "m",
            f"{between} with another "
            "link, and they are not parallel and equally long, so that nothing moves",
            "make the way from hinge to hinge the same in all of them",
        )

    def emit(self, kin: Kinematics) -> None:
        """Move the body along, and the link."""
        near, far = self.link.near.axis.through, self.leader.far.axis.through
        if self.body not in kin.placed:
            place_turned_alike(kin, self.body, kin.placed[self.base], self.leader.name, far)
        place_turned_alike(kin, self.link.name, kin.placed[self.leader.name], self.base, near)


def _across(n: Vector, way: Vector) -> sp.Expr:
    """Return the length of the part of a vector across a direction."""
    off = n.cross(way)
    return sp.sqrt(off.dot(off) / n.dot(n))
