"""Two links on a common guide: a candidate for a strut, or a cylinder with its piston rod."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..declare.joints import Prismatic

if TYPE_CHECKING:
    from typing import Self

    from ..declare.geometry import Point
    from ..declare.joints import Joint
    from ..loops.cut import CutLoop


@dataclass(frozen=True)
class GuidedPair:
    """Two links on a guide, each of them held by another body at a point."""

    joint: Prismatic  # guide between the two links
    # link at the anchor; that point, and the body at the other side of it
    near: str
    anchor: Point
    anchor_body: str
    # same of the link at the end
    far: str
    end: Point
    end_body: str

    @classmethod
    def match(cls, cut: CutLoop) -> Self | None:
        """Return the two links of one arc of a loop."""
        if len(cut.joints) != 1 or not isinstance(cut.joints[0], Prismatic):
            return None
        near, far = cut.bodies
        return cls(cut.joints[0], near, cut.anchor, cut.others[0], far, cut.end, cut.others[-1])

    @property
    def sense(self) -> int:
        """1 if the far link moves along the direction of the guide with the slide, else -1."""
        return 1 if self.joint.second.name == self.far else -1

    @property
    def forward(self) -> bool:
        """Whether the guide is declared to run from the anchor to the end."""
        return self.joint.direction.between == (self.anchor, self.end)

    @property
    def along_ends(self) -> bool:
        """Whether the guide is declared to lie along the line of the two points."""
        between = self.joint.direction.between
        return between is not None and set(between) == {self.anchor, self.end}

    @property
    def links(self) -> str:
        """Both links, for messages."""
        return f"{self.near} and {self.far}"

    @property
    def line(self) -> str:
        """The distance of the two points, for the report."""
        return f"|{self.end.name} - {self.anchor.name}|"

    @property
    def points(self) -> tuple[Point, ...]:
        """The two points."""
        return self.anchor, self.end

    def joints_at_ends(self, joints: tuple[Joint, ...]) -> tuple[Joint, Joint]:
        """Return the joints, among those of a mechanism, that hold the two links."""
        first, second = (self.anchor_body, self.near), (self.end_body, self.far)
        near, far = (
            next(j for j in joints if set(j.bodies) == set(ends)) for ends in (first, second)
        )
        return near, far
