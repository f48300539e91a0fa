"""A body that moves freely in the world: six coordinates say where it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NoReturn

from ..declare.declared import DeclarationError
from ..declare.joints import Free, Joint
from ..loops.forms import Follower

if TYPE_CHECKING:
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.known import Coordinate, Known


@dataclass(frozen=True)
class PlaceFree(Follower):
    """A body placed by the coordinates of a free joint, all of which are given."""

    joint: Free

    rank: ClassVar[int] = 3

    @classmethod
    def follow(cls, known: Known, joint: Joint, parent: str, child: str) -> Self | None:
        """Return the step, where the joint is driven."""
        del parent
        if not isinstance(joint, Free) or joint.second.name != child or known.unknowns_of(joint):
            return None
        return cls(joint)

    @property
    def about(self) -> str:
        """The body."""
        return self.joint.second.name

    @property
    def title(self) -> str:
        """What the derivation calls this step."""
        return f"{self.about}: free in the world"

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the body."""
        known.place(self.about)
        return set()

    def carry_out(self, kin: Kinematics) -> NoReturn:
        """Refuse: its pose has no formula yet."""
        del kin
        problem = f"there are no equations yet for a body that moves freely, like {self.about!r}"
        raise DeclarationError(self.joint.name, [problem])
