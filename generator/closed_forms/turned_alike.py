"""Bodies that turn like another one and move with a point of a third."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from ..program.vectors import NO_TWIST, ZERO, Twist
from .solved_motion import place_at, projector

if TYPE_CHECKING:
    from ..declare.geometry import Point
    from ..kinematics.kinematics import Kinematics
    from ..kinematics.motion import BodyMotion


def place_turned_alike(kin: Kinematics, body: str, like: BodyMotion, on: str, point: Point) -> None:
    """Place a body with the axes of a body like it, and the origin at a point on a placed body."""
    moved = kin.point_motion(on, point)
    placed = place_at(kin, body, (on, point), like.axes, like.design_axes)
    to_body = projector(kin, placed)
    for k in dict.fromkeys([*like.motion, *moved.motion]):
        linear = to_body(f"velocity_{k}", moved.motion.get(k, ZERO))
        angular = like.motion.get(k, NO_TWIST).angular
        placed.motion[k] = kin.define_twist(body, k, Twist(angular, linear))

    def bias() -> Twist:
        linear = to_body("velocity_bias", moved.bias)
        return kin.define_bias(body, Twist(like.bias().angular, linear))

    placed.bias = cache(bias)
