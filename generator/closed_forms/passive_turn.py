"""Links whose turn about their own line is free.

They have no mass, so that the turn has no effect. A link turns like one on a cross at its first
end, with an axis across the line at the design position.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..loops.forms import Leftover
from ..program.vectors import to_axes
from .universal_joint import line_from_own_end, turn_on_cross

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator
    from typing import Self

    from ..kinematics.kinematics import Kinematics
    from ..loops.known import Known


@dataclass(frozen=True)
class PlacePassive(Leftover):
    """A link of known line, without mass, that is free to turn about that line."""

    body: str

    @classmethod
    def left(cls, known: Known, massive: Collection[str]) -> Iterator[Self]:
        """Yield the links without mass that nothing keeps from turning about their line."""
        for body in known.mechanism.passive_links:
            if body in known.on_line and body not in massive:
                yield cls(body)

    @property
    def title(self) -> str:
        return f"{self.body}: passive turn about its line"

    def emit(self, kin: Kinematics) -> None:
        """Turn the link about its line by an arbitrary rule."""
        body, record = self.body, line_from_own_end(kin, self.body)
        parent = kin.placed[record.anchor_body]
        n = kin.unit(f"{body}_line_design", kin.design(record.end) - kin.design(record.anchor))
        axis, _ = kin.across(body, n)
        local = kin.program.vector(f"{body}_passive", to_axes(parent.design_axes, axis), "123")
        meaning = (
            f"the turn of {body} about its own line, which nothing holds, is not defined: the line "
            f"has turned by 90 degrees as seen from {record.anchor_body}"
        )
        turn_on_cross(kin, body, parent, local, axis, meaning)
