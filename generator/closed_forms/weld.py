"""Bodies that are welded to another one, and move with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..declare.joints import Joint, Weld
from ..kinematics.motion import BodyMotion
from ..loops.forms import Follower

if TYPE_CHECKING:
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.known import Known


@dataclass(frozen=True)
class PlaceWelded(Follower):
    """A body with the pose of the one that it is welded to."""

    body: str
    parent: str

    rank: ClassVar[int] = 3

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        return cls(child, parent) if isinstance(joint, Weld) else None

    @property
    def title(self) -> str:
        return f"{self.body}: welded to {self.parent}"

    def emit(self, kin: Kinematics) -> None:
        """Give the body the pose and the motion of the other one."""
        parent = kin.placed[self.parent]
        kin.placed[self.body] = BodyMotion(
            self.body,
            origin=parent.origin,
            axes=parent.axes,
            design_origin=parent.design_origin,
            design_axes=parent.design_axes,
            motion=dict(parent.motion),
            bias=parent.bias,  # later steps may add to it
        )
