"""A body that moves freely in the world: the base of bodies that hang on it (`kinematics.base`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from ..declare.joints import Free, Joint
from ..loops.forms import Follower

if TYPE_CHECKING:
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.known import Known


@dataclass(frozen=True)
class PlaceFree(Follower):
    """A body placed by the positions of a free joint, which are states."""

    joint: Free

    rank: ClassVar[int] = 3

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        if not isinstance(joint, Free) or joint.second.name != child or known.unknowns_of(joint):
            return None
        return cls(joint)

    @property
    def about(self) -> str:
        return self.joint.second.name

    @property
    def title(self) -> str:
        return f"{self.about}: free in the world"

    def emit(self, kin: Kinematics) -> None:
        """Do nothing: bodies that hang on it are solved in its own axes, in which it rests."""
