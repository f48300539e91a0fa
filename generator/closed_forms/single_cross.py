"""A body on a hinge that a placed body turns through a single cross, as two shafts at an angle do.

The axes of all hinges of the loop meet in the centre of the cross, so that it turns about this
point and closes with three equations, for two angles of the cross and that of the hinge. `yoke` has
the solution, its branch and its singular set.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from typing_extensions import override

from ..declare.joints import Revolute, Universal
from ..loops.forms import ClosedForm
from ..program.vectors import from_axes, to_axes
from .yoke import DrivenYoke, GivenAxis, norm, second_axis, through_center, turn_through_cross

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.cut import CutLoop
    from ..loops.forms import Closing
    from ..loops.known import Coordinate, Known
    from ..program.conditions import Assumption


@dataclass(frozen=True)
class SingleCross(ClosedForm):
    """A placed body turns another one on its hinge, through a cross between the two."""

    yoke: DrivenYoke
    others: tuple[Revolute, ...]  # other hinges of the loop; their axes go through the centre, too

    rank: ClassVar[int] = 8
    equations: ClassVar[tuple[int, ...]] = (0,)
    """About the centre, cut there: none remains."""

    @classmethod
    def match(cls, known: Known, cut: CutLoop) -> Self | None:
        """Return the body of one arc of a loop, between the cross and its hinge."""
        if len(cut.bodies) != 1:
            return None
        (body,), (first, last) = cut.bodies, (cut.others[0], cut.others[-1])
        cross, hinge = (known.topology.joint_between(body, other) for other in (first, last))
        if not isinstance(cross, Universal) or not isinstance(hinge, Revolute):
            return None
        waits = body not in known.bodies and known.unknowns_of(hinge) > 0
        if not waits or not {first, last} <= known.placed:
            return None
        others = tuple(joint for joint in cut.other_joints if isinstance(joint, Revolute))
        return cls(DrivenYoke(cross, hinge, last, first, first), others)

    @property
    def about(self) -> str:
        return self.yoke.body

    @property
    def title(self) -> str:
        return f"transformer: {self.about} turned through {self.yoke.cross.name}"

    def accept(self, known: Known) -> set[Coordinate]:
        """Record the driven body and its joints."""
        known.place(self.about)
        return known.add_all([self.yoke.cross, self.yoke.hinge])

    def assumptions(self) -> Iterator[Assumption]:
        """Yield the conditions that all axes meet in the centre of the cross."""
        cross = self.yoke.cross
        for hinge in (self.yoke.hinge, *self.others):
            scale = norm(cross.at.position - hinge.axis.through.position)
            yield from through_center(hinge, cross, scale)

    @override
    def words(self, closing: Closing | None) -> tuple[str, str]:
        return f"the axes of {self.yoke.cross.name} at right angles", self.yoke.solution

    def emit(self, kin: Kinematics) -> None:
        """Turn the driven body until the cross fits."""
        cross, driving = self.yoke.cross, kin.placed[self.yoke.driving]
        axes = [
            kin.design_direction(cross.first_axis),
            second_axis(
                kin, cross, kin.unit(f"{cross.name}_line", kin.to_work(cross.shaft.vector))
            ),
        ]
        own, design = axes if cross.first.name == self.about else reversed(axes)
        local = kin.program.vector(
            f"{cross.name}_on_{driving.body}", to_axes(driving.design_axes, design), "123"
        )
        given = GivenAxis(kin.program.vector(cross.name, from_axes(driving.axes, local)), design)
        turn_through_cross(kin, self, self.yoke, own, given)
