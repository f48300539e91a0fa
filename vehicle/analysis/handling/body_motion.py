"""Motion of the body of a car in the terms of ISO 8855, from the states of its equations.

The axes of the heading are horizontal: x along the projection of the body's x axis onto the road, y
to the left, z up. Velocities and accelerations are those of a point of the body, the reference
point.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....core.named_types import Array

QUANTITIES = {
    "x": ("position along the road", "m"),
    "y": ("position across the road, positive to the left", "m"),
    "yaw_angle": ("yaw angle, positive to the left", "rad"),
    "roll_angle": ("roll angle, positive with the left side up", "rad"),
    "pitch_angle": ("pitch angle, positive nose down", "rad"),
    "speed": ("speed along the heading", "m/s"),
    "lateral_velocity": ("velocity across the heading, positive to the left", "m/s"),
    "sideslip_angle": ("sideslip angle, positive moving to the left", "rad"),
    "yaw_rate": ("yaw velocity, positive to the left", "rad/s"),
    "longitudinal_acceleration": ("longitudinal acceleration, positive forward", "m/s^2"),
    "lateral_acceleration": ("lateral acceleration, positive to the left", "m/s^2"),
    "vertical_acceleration": ("vertical acceleration, positive upward", "m/s^2"),
}
"""Quantities of the motion: meaning and SI unit, by name."""


@dataclass(frozen=True)
class ReferencePoint:
    """A point of a free body, whose motion it computes."""

    names: Sequence[str]  # names of the states
    center: Array  # centre of mass of the body at design, (3,) [m]
    reference: Array  # the point at design, (3,) [m]

    def rows(self, kinds: Sequence[str]) -> list[int]:
        """Return the indices of states of the body, such as ``x`` or ``e0``."""
        return [self.names.index(f"body_{kind}") for kind in kinds]

    def of(self, states: Any, rates: Any) -> dict[str, Any]:
        """Return the motion by the names of `QUANTITIES`, of states (..., states) with their rates.

        Complex numbers are allowed.
        """
        place = np.moveaxis(states[..., self.rows(("x", "y", "z"))], -1, 0)
        turn = _rotation(np.moveaxis(states[..., self.rows(("e0", "e1", "e2", "e3"))], -1, 0))
        v = states[..., self.rows(("u", "v", "w"))]
        omega = states[..., self.rows(("p", "q", "r"))]
        dv = rates[..., self.rows(("u", "v", "w"))]
        d_omega = rates[..., self.rows(("p", "q", "r"))]
        arm = self.reference - self.center
        at = v + np.cross(omega, arm)
        accelerated = (
            dv + np.cross(omega, v) + np.cross(d_omega, arm)
            + np.cross(omega, np.cross(omega, arm))
        )  # fmt: skip
        velocity, acceleration, spun, moved = (
            _turned(turn, each) for each in (at, accelerated, omega, arm)
        )
        yaw = _angle(turn[1][0], turn[0][0])
        cosine, sine = np.cos(yaw), np.sin(yaw)
        tilt = np.sqrt(turn[0][0] ** 2 + turn[1][0] ** 2)
        forward = cosine * velocity[0] + sine * velocity[1]
        left = cosine * velocity[1] - sine * velocity[0]
        # the rate of the yaw angle has a part of the roll of a pitched body
        heading_rate = spun[2] - turn[2][0] / tilt**2 * (
            turn[0][0] * spun[0] + turn[1][0] * spun[1]
        )
        return {
            "x": place[0] + moved[0] + self.center[0],
            "y": place[1] + moved[1] + self.center[1],
            "yaw_angle": yaw,
            "roll_angle": _angle(turn[2][1], turn[2][2]),
            "pitch_angle": _angle(-turn[2][0], tilt),
            "speed": forward,
            "lateral_velocity": left,
            "sideslip_angle": _angle(left, forward),
            "yaw_rate": heading_rate,
            "longitudinal_acceleration": cosine * acceleration[0] + sine * acceleration[1],
            "lateral_acceleration": cosine * acceleration[1] - sine * acceleration[0],
            "vertical_acceleration": acceleration[2],
        }


def _turned(turn: Any, vector: Any) -> list[Any]:
    """Return the components in the world of a vector in the axes of the body."""
    x, y, z = np.moveaxis(np.asarray(vector), -1, 0)
    return [row[0] * x + row[1] * y + row[2] * z for row in turn]


def _rotation(quaternion: Any) -> list[list[Any]]:
    """Return the matrix of unit quaternions, scalar first."""
    a, b, c, d = quaternion
    return [
        [1 - 2 * (c * c + d * d), 2 * (b * c - a * d), 2 * (b * d + a * c)],
        [2 * (b * c + a * d), 1 - 2 * (b * b + d * d), 2 * (c * d - a * b)],
        [2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b * b + c * c)],
    ]


def _angle(above: Any, below: Any) -> Any:
    """Return the arc tangent of a quotient, to first order in imaginary parts."""
    found = np.arctan2(np.real(above), np.real(below))
    if np.iscomplexobj(above) or np.iscomplexobj(below):
        squared = np.real(above) ** 2 + np.real(below) ** 2
        turned = np.imag(above) * np.real(below) - np.real(above) * np.imag(below)
        return found + 1j * turned / squared
    return found
