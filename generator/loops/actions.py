"""What a plan is made of: the steps that the kinematics carries out, in order.

Each says which bodies, joints and points take part; the algebra is in `solutions`. `body` is what
a step is about: a body that it places, or whose line it finds.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..declare.geometry import Point

if TYPE_CHECKING:
    from ..declare.geometry import Direction
    from ..declare.joints import Cylindrical, Joint, Prismatic, Revolute, Universal


@dataclass(frozen=True)
class PlaceByJoint:
    """A body follows from its placed neighbour, because the joint's coordinate is known."""

    joint: Revolute | Prismatic
    parent: str
    child: str

    @property
    def body(self) -> str:
        """What the step is about."""
        return self.child

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.child}: {self.joint.kind} joint"


@dataclass(frozen=True)
class SolveTelescope:
    """Two placed points are the ends of a telescope: its length follows.

    Its direction follows too, unless the axis misses the end: then the rod that holds the body at
    the end decides.
    """

    joint: Cylindrical
    anchor: Point
    anchor_body: str
    anchor_link: str
    end: Point
    end_body: str
    end_link: str

    @property
    def body(self) -> str:
        """What the step is about."""
        return self.end_link

    @property
    def axis_point(self) -> Point:
        """The point of the end's link that the axis passes through."""
        assert isinstance(self.joint.axis.through, Point)
        return self.joint.axis.through

    @property
    def misses_end(self) -> bool:
        """Whether the axis passes beside the end point."""
        return self.axis_point != self.end

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: telescope {self.joint.name}"


@dataclass(frozen=True)
class SolveTurn:
    """A body known up to a rotation about a line is held by a rod: its rotation follows."""

    body: str
    rod: str
    end: Point
    anchor: Point
    anchor_body: str

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: {self.body} held by {self.rod}"


@dataclass(frozen=True)
class PinnedTelescope:
    """Two links on a common guide, each of them pinned to another body, in a plane.

    Attributes
    ----------
    joint
        The guide between the two links.
    near, near_hinge, anchor, anchor_body
        The link at the anchor; its hinge, at that point, and the body at the other side of it.
    far, far_hinge, end, end_body
        The same of the link at the end.
    """

    joint: Prismatic
    near: str
    near_hinge: Revolute
    anchor: Point
    anchor_body: str
    far: str
    far_hinge: Revolute
    end: Point
    end_body: str

    @property
    def body(self) -> str:
        """What the step is about."""
        return self.near

    @property
    def sense(self) -> int:
        """Return 1 if the telescope grows with the slide and its direction, -1 if it shrinks."""
        return 1 if self.joint.second == self.far else -1

    @property
    def links(self) -> str:
        """Both links, for messages."""
        return f"{self.near} and {self.far}"

    @property
    def along_pins(self) -> bool:
        """Whether the guide is declared to lie along the line of the two pins."""
        between = self.joint.direction.between
        return between is not None and set(between) == {self.anchor, self.end}


@dataclass(frozen=True)
class SolveStroke(PinnedTelescope):
    """Two placed pins are the ends of a telescope in a plane: slide and direction follow."""

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: telescope of {self.links}"


@dataclass(frozen=True)
class PlaceTelescope(PinnedTelescope):
    """Two placed pins are the ends of a telescope of known slide: its direction follows."""

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.links}: telescope"


@dataclass(frozen=True)
class SolveHinge:
    """A body on a hinge of a placed body is held by a rod: its angle follows.

    The rod may be a telescope of known slide; `rod` then is its link at the anchor.
    """

    body: str
    joint: Revolute
    parent: str
    rod: str
    end: Point
    anchor: Point
    anchor_body: str
    telescope: PlaceTelescope | Strut | None = None

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: {self.body} held by {self.rod}"


@dataclass(frozen=True)
class SolveSlide:
    """A body on a guide of a placed body is held by a rod: its slide follows.

    The rod may be a telescope of known slide; `rod` then is its link at the anchor.
    """

    body: str
    joint: Prismatic
    parent: str
    rod: str
    end: Point
    anchor: Point
    anchor_body: str
    telescope: PlaceTelescope | Strut | None = None

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: {self.body} held by {self.rod}"


@dataclass(frozen=True)
class PlaceByPin:
    """A body on a hinge of a placed body meets another placed body at a pin: its angle follows."""

    body: str
    joint: Revolute
    parent: str
    pin: Point
    pin_body: str

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.body}: pinned to {self.pin_body}"


@dataclass(frozen=True)
class PlaceByCross:
    """A shaft of known direction is turned by the cross of its universal joint."""

    joint: Universal
    parent: str
    child: str

    @property
    def body(self) -> str:
        """What the step is about."""
        return self.child

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.child}: cross of the universal joint"


@dataclass(frozen=True)
class PlaceIdle:
    """A link of known line, without mass, that may turn about that line: it gets some turn."""

    body: str

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.body}: idle turn about its line"


@dataclass(frozen=True)
class Strut:
    """Two links on a common guide along the line of their ends; a cross holds the first of them.

    Attributes
    ----------
    joint
        The guide between the two links.
    near, anchor, anchor_body
        The link that a cross holds; the centre of that, and the body at the other side of it.
    far, end, end_body
        The other link; its ball joint, and the body at the other side of that.
    """

    joint: Prismatic
    near: str
    anchor: Point
    anchor_body: str
    far: str
    end: Point
    end_body: str

    @property
    def body(self) -> str:
        """What the step is about."""
        return self.near

    @property
    def sense(self) -> int:
        """Return 1 if the strut grows with the slide, -1 if it shrinks."""
        forward = self.joint.direction.between == (self.anchor, self.end)
        return 1 if forward == (self.joint.second == self.far) else -1

    @property
    def links(self) -> str:
        """Both links, for messages."""
        return f"{self.near} and {self.far}"


@dataclass(frozen=True)
class SolveStrut(Strut):
    """Two placed points are the ends of a strut: its slide and its line follow."""

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformer: strut of {self.links}"


@dataclass(frozen=True)
class PlaceByGuide:
    """The second link of a strut: turned like the first, and at the end."""

    strut: Strut

    @property
    def child(self) -> str:
        """The link that is placed."""
        return self.strut.far

    @property
    def body(self) -> str:
        """What the step is about."""
        return self.strut.far

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.strut.far}: on the guide of {self.strut.near}"


@dataclass(frozen=True)
class HeldByRod:
    """A rod that is one equation of several: from an anchor to a point of a body.

    Attributes
    ----------
    guide
        Of a strut of known slide along the line of its ends, which is a rod of known variable
        length: the joint from `rod`, its link at the anchor, to `far`, that at the body.
    """

    body: str
    rod: str
    end: Point
    anchor: Point
    anchor_body: str
    guide: Prismatic | None = None
    far: str | None = None

    @property
    def links(self) -> tuple[str, ...]:
        """The rod, or the two links of a strut."""
        return (self.rod,) if self.far is None else (self.rod, self.far)


@dataclass(frozen=True)
class SolveCarrier:
    """A body that only rods hold, all together: its pose follows by iteration.

    Attributes
    ----------
    pin
        A ball joint at a placed body, and that body: then three rods hold the orientation. Without
        it six rods hold position and orientation.
    """

    body: str
    rods: tuple[HeldByRod, ...]
    pin: tuple[Point, str] | None = None

    @property
    def closing(self) -> tuple[HeldByRod, ...]:
        """What closes the loops."""
        return self.rods

    @property
    def rod_names(self) -> str:
        """The rods, for messages."""
        return ", ".join(held.rod for held in self.rods)

    @property
    def equations(self) -> int:
        """Number of closure equations: one of each rod."""
        return len(self.rods)

    @property
    def loops(self) -> int:
        """Number of independent loops that the rods close, of those at the body."""
        return len(self.rods) - (self.pin is None)

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformers with iteration: {self.body} held by {len(self.rods)} rods"


@dataclass(frozen=True)
class JointOfTree:
    """A hinge or guide, from a body that is nearer to what is placed.

    Attributes
    ----------
    driven
        Whether its coordinate is given; of others it is an unknown.
    """

    joint: Revolute | Prismatic
    parent: str
    child: str
    driven: bool = False

    @property
    def sense(self) -> int:
        """Return 1 if the coordinate is that of the child as seen from the parent, else -1."""
        return 1 if self.joint.second == self.child else -1


@dataclass(frozen=True)
class CutJoint:
    """A joint at which a loop is cut: what it leaves in common makes the closure equations.

    Attributes
    ----------
    normal
        Of a loop that moves in a plane: the direction of its hinges. It closes with three equations
        less the freedoms, a loop in space with six.
    """

    joint: Joint
    normal: Direction | None = None

    @property
    def planar(self) -> bool:
        """Whether the loop moves in a plane."""
        return self.normal is not None

    @property
    def equations(self) -> int:
        """Number of closure equations."""
        return (3 if self.planar else 6) - self.joint.freedoms


@dataclass(frozen=True)
class SolveTogether:
    """Loops of hinges and guides that close together: their coordinates follow by iteration.

    Attributes
    ----------
    body
        The first body that is placed.
    tree
        What carries the bodies, in the order from placed ones outward; their coordinates are the
        unknowns, but for those that are driven.
    cuts, rods
        Joints and rods that close a loop each. A rod is one equation.
    """

    body: str
    tree: tuple[JointOfTree, ...]
    cuts: tuple[CutJoint, ...]
    rods: tuple[HeldByRod, ...]

    @property
    def bodies(self) -> list[str]:
        """The bodies that are placed, rods apart."""
        return [branch.child for branch in self.tree]

    @property
    def unknowns(self) -> list[JointOfTree]:
        """The joints of the tree whose coordinates are unknown."""
        return [branch for branch in self.tree if not branch.driven]

    def base_of(self, body: str) -> str:
        """Return the placed body at which the way from a body through the tree ends."""
        parents = {branch.child: branch.parent for branch in self.tree}
        while body in parents:
            body = parents[body]
        return body

    @property
    def equations(self) -> int:
        """Number of closure equations."""
        return sum(cut.equations for cut in self.cuts) + len(self.rods)

    @property
    def closing(self) -> tuple[CutJoint | HeldByRod, ...]:
        """What closes the loops: one of each."""
        return (*self.cuts, *self.rods)

    @property
    def joint_names(self) -> str:
        """The joints of the unknown coordinates, for messages."""
        return ", ".join(branch.joint.name for branch in self.unknowns)

    @property
    def closing_names(self) -> str:
        """The joints and rods that close the loops, for messages."""
        return ", ".join([*(c.joint.name for c in self.cuts), *(held.rod for held in self.rods)])

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"transformers with iteration: {self.joint_names}"


Solution = (
    SolveTelescope
    | SolveTurn
    | SolveHinge
    | SolveSlide
    | SolveStroke
    | SolveStrut
    | SolveCarrier
    | SolveTogether
)
Action = (
    PlaceByJoint | PlaceByPin | PlaceByCross | PlaceByGuide | PlaceIdle | PlaceTelescope | Solution
)
