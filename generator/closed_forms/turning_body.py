"""What a body on a hinge is given by its carrier, and what its end must follow.

Hinges, pairs of links and pinned telescopes have this in common. All of it is in axes of the body,
where the rate about the first axis is the only unknown.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..kinematics.motion import BodyMotion, PointMotion, from_axes
from ..program.vectors import ZERO, Vector
from .lines import projector

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..kinematics.kinematics import Kinematics


@dataclass(frozen=True)
class Given:
    """Rates that do not depend on how fast the body turns on its carrier.

    Attributes
    ----------
    base
        Velocity of the point through which its axis goes; of a bias, the acceleration.
    carried
        Angular velocity of the carrier; of a bias, the angular acceleration without that of the
        turn.
    target
        Velocity, or bias acceleration, of what the end of the body must follow.
    """

    base: Vector
    carried: Vector
    target: Vector


class TurningBody:
    """A body on a hinge of its carrier whose end follows a target.

    Parameters
    ----------
    kin
        The kinematics so far.
    placed
        The body, whose first axis is that of the hinge.
    origin, end
        Motion of the point through which the axis goes, and of the target.
    """

    def __init__(
        self, kin: Kinematics, placed: BodyMotion, origin: PointMotion, end: PointMotion
    ) -> None:
        assert placed.carrier is not None
        self.kin, self.placed, self.origin, self.end = kin, placed, origin, end
        self.parent = kin.placed[placed.carrier[0]]
        self.to_body = projector(kin, placed)

    def moved_by(self, others: Iterable[str] = ()) -> list[str]:
        """Return the coordinates that move the body, those of others at the end."""
        motions = (self.origin.motion, self.parent.motion, self.end.motion)
        return list(dict.fromkeys([*(k for motion in motions for k in motion), *others]))

    def _carried(self, label: str, v: Vector) -> Vector:
        return self.to_body(label, from_axes(self.parent.axes, v))

    def rates(self, k: str) -> Given:
        """Return what is given per unit rate of a coordinate."""
        moving = self.parent.motion.get(k)
        base = self.to_body(f"velocity_{k}", self.origin.motion.get(k, ZERO))
        carried = ZERO
        if moving is not None:
            carried = self._carried(f"carried_{k}", moving.angular)
        return Given(base, carried, self.to_body(f"target_{k}", self.end.motion.get(k, ZERO)))

    def biases(self) -> Given:
        """Return what is given without accelerations of the independent coordinates."""
        omega = self.kin.total(self.placed).angular
        parent = self._carried("carried_now", self.kin.total(self.parent).angular)
        base = self.to_body("acceleration", self.origin.bias)
        target = self.to_body("target_bias", self.end.bias)
        spin = Vector(omega.x - parent.x, ZERO.y, ZERO.z)
        alpha = self._carried("carried_bias", self.parent.bias().angular) + parent.cross(spin)
        name = f"{self.placed.body}_alpha_carried"
        return Given(base, self.kin.program.vector(name, alpha, "123"), target)
