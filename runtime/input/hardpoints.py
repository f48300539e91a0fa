"""The hardpoints of a MacPherson suspension, and what their geometry must fulfil."""

from collections.abc import Mapping
from itertools import combinations
from typing import Any, get_args

import numpy as np
from pydantic import Field

from .section import Section, Triple
from .units import LengthUnit, in_metres
from .vectors import Vector, angle_between_lines, components, distance_from_line, unit_vector

# Closer than this, two points that define a direction or a rod are taken for one, in m.
_SMALLEST_DISTANCE = 0.001
# Points are farther apart than this and nearer to the origin than that, if the unit is right, in m.
_SMALLEST_SUSPENSION = 0.01
_LARGEST_COORDINATE = 20.0
# Nearer to the vertical than this, the hinge axis has no upper side, in degrees.
_SMALLEST_HINGE_ANGLE = 1.0
# Nearer to the first axis of its universal joint than this, a link is not held, in degrees.
_SMALLEST_CROSS_ANGLE = 1.0

# The points that belong to one body; strut_top moves along the strut, so that it stands apart.
_POINTS_OF_BODIES = {
    "control arm": ("arm_front", "arm_rear", "ball_joint"),
    "knuckle": ("ball_joint", "tie_rod_outer", "wheel_center"),
    "strut": ("ball_joint", "strut_top"),
    "tie rod": ("tie_rod_outer", "tie_rod_inner"),
}

# The pairs of these points that define the directions of strut, tie rod and steering arm.
_DIRECTIONS_OF_STEERING = {
    ("ball_joint", "strut_top"),
    ("tie_rod_outer", "tie_rod_inner"),
    ("ball_joint", "tie_rod_outer"),
    ("strut_lower", "strut_top"),
}


# Points that a file may leave out, and which other point then stands in.
_STAND_INS = {"strut_lower": "ball_joint", "spring_top": "strut_top", "spring_seat": "strut_lower"}


class Hardpoints(Section):
    """The points that define the suspension, at the design position.

    All are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    unit: LengthUnit = Field(description='the unit of the hardpoints, "mm" or "m"')
    arm_front: Triple = Field(description="front bearing of the control arm")
    arm_rear: Triple = Field(description="rear bearing of the control arm")
    ball_joint: Triple = Field(description="ball joint of control arm and knuckle")
    strut_top: Triple = Field(description="upper mount of the strut")
    tie_rod_outer: Triple = Field(description="ball joint of tie rod and knuckle")
    tie_rod_inner: Triple = Field(description="joint of tie rod and rack")
    wheel_center: Triple = Field(description="centre of the wheel")
    strut_lower: Triple | None = Field(
        default=None,
        description="a point of the knuckle on the strut's axis; left out: the axis passes through "
        "ball_joint",
    )
    spring_top: Triple | None = Field(
        default=None, description="upper seat of the spring, on the chassis; left out: strut_top"
    )
    spring_seat: Triple | None = Field(
        default=None, description="lower seat of the spring, on the knuckle; left out: strut_lower"
    )

    @classmethod
    def unit_of_key(cls, key: str, table: Mapping[str, Any]) -> str:
        """Return the unit of the points: the section's own `unit`."""
        unit = str(table.get("unit"))
        return unit if key != "unit" and unit in get_args(LengthUnit) else ""

    def metres(self, name: str) -> Vector:
        """Return the position of a hardpoint; that of its stand-in, if it is left out.

        Parameters
        ----------
        name : str
            The hardpoint's key.

        Returns
        -------
        numpy.ndarray
            Its coordinates in chassis axes, in m.
        """
        point = getattr(self, name)
        if point is None:
            return self.metres(_STAND_INS[name])
        return np.array([in_metres(value, self.unit) for value in point])

    @classmethod
    def names(cls) -> list[str]:
        """Return the keys of the hardpoints that every file has."""
        return [name for name in cls.model_fields if name not in ("unit", *_STAND_INS)]

    def given(self) -> list[str]:
        """Return the keys of all hardpoints that this file has."""
        return [*self.names(), *(name for name in _STAND_INS if getattr(self, name) is not None)]

    def has_spring_seats(self) -> bool:
        """Return whether the spring has an axis of its own."""
        return self.spring_top is not None or self.spring_seat is not None

    def parameters(self, *, optional: bool = False) -> dict[str, float]:
        """Return the coordinates in m, such as ``arm_front_x``; if asked, all of them."""
        values: dict[str, float] = {}
        for name in [*self.names(), *(_STAND_INS if optional else ())]:
            values |= components(name, self.metres(name))
        return values

    def strut_axis(self) -> Vector:
        """Return the unit vector along the strut, upward from its lower end."""
        return unit_vector(self.metres("strut_top") - self.metres("strut_lower"))

    def strut_offset(self) -> float:
        """Return the distance of the ball joint from the strut's axis, in m."""
        return distance_from_line(
            self.metres("ball_joint"), self.metres("strut_lower"), self.metres("strut_top")
        )

    def distance(self, first: str, second: str) -> float:
        """Return the distance of two hardpoints, given by their keys, in m."""
        return float(np.linalg.norm(self.metres(second) - self.metres(first)))

    def text(self, *names: str) -> str:
        """Return hardpoints as they stand in the file, with their unit, for error messages."""
        names = tuple(n if getattr(self, n) is not None else _STAND_INS[n] for n in names)
        points = [f"{name} = {list(getattr(self, name))} {self.unit}" for name in names]
        return f"[hardpoints] {' and '.join(points)}"

    def has_strut_axis(self) -> bool:
        """Return whether the ends of the strut are far enough apart to define its axis."""
        return self.distance("strut_lower", "strut_top") >= _SMALLEST_DISTANCE

    def unit_problems(self) -> list[str]:
        """Find coordinates that suggest that the unit is wrong, which no other check survives.

        Returns
        -------
        list of str
            One text for each problem.
        """
        points = {name: self.metres(name) for name in self.given()}
        far = [name for name, point in points.items() if np.abs(point).max() > _LARGEST_COORDINATE]
        remedy = f'Correct the coordinates or `unit = "{self.unit}"`.'
        if far:
            limit = f"allowed is -{_LARGEST_COORDINATE:g} m to {_LARGEST_COORDINATE:g} m"
            return [f"{self.text(*far)}: out of range, {limit}. {remedy}"]
        size = max(self.distance(*pair) for pair in combinations(points, 2))
        if size < _SMALLEST_SUSPENSION:
            problem = (
                f"[hardpoints] unit = {self.unit!r}: all points lie within {1000 * size:.3f} mm; a "
                f"suspension measures at least {1000 * _SMALLEST_SUSPENSION:g} mm. {remedy}"
            )
            return [problem]
        return []

    def geometry_problems(self) -> list[str]:
        """Say why the mechanism cannot move, or cannot be told from its mirror image.

        Returns
        -------
        list of str
            One text for each problem.
        """
        coinciding = {
            pair: body
            for body, names in _POINTS_OF_BODIES.items()
            for pair in combinations(names, 2)
            if self.distance(*pair) < _SMALLEST_DISTANCE
        }
        coinciding |= {
            pair: part
            for part, pair in (
                ("strut", ("strut_lower", "strut_top")),
                ("spring", ("spring_seat", "spring_top")),
            )
            if set(pair) & set(self.given()[len(self.names()) :])
            and self.distance(*pair) < _SMALLEST_DISTANCE
        }
        problems = [
            f"{self.text(*pair)} are {1000 * self.distance(*pair):.3f} mm apart; two points of the "
            f"{body} must be at least {1000 * _SMALLEST_DISTANCE:g} mm apart. Move one of them."
            for pair, body in coinciding.items()
        ]
        # The other checks need the directions that these pairs of points define.
        if "control arm" not in coinciding.values():
            problems += self._hinge()
        if not coinciding.keys() & _DIRECTIONS_OF_STEERING:
            problems += self._steering_arm()
            problems += self._cross_axes()
            problems += self._offset()
        return problems

    def _cross_axes(self) -> list[str]:
        """Check that no link lies along the axis of its universal joint on the car's side."""
        problems = []
        for ends, link, axis, name in (
            (("strut_top", "strut_lower"), "strut", (1.0, 0.0, 0.0), "the x axis"),
            (("tie_rod_inner", "tie_rod_outer"), "tie rod", (0.0, 0.0, 1.0), "the vertical"),
        ):
            first, second = (self.metres(end) for end in ends)
            angle = angle_between_lines(second - first, np.array(axis))
            if angle < _SMALLEST_CROSS_ANGLE:
                problems.append(
                    f"{self.text(*ends)}: the {link} is {angle:.3f} deg from {name}; at least "
                    f"{_SMALLEST_CROSS_ANGLE:g} deg are needed for its universal joint to hold "
                    "it. Move one of the two points."
                )
        return problems

    def _offset(self) -> list[str]:
        """Check that the ball joint is below the strut top, seen along the strut."""
        span = self.metres("strut_top") - self.metres("ball_joint")
        reach = float(span @ self.strut_axis())
        if reach >= _SMALLEST_DISTANCE:
            return []
        problem = (
            f"{self.text('ball_joint', 'strut_lower', 'strut_top')}: along the strut, strut_top is "
            f"{1000 * reach:.3f} mm above ball_joint; at least {1000 * _SMALLEST_DISTANCE:g} mm "
            "are needed. Swap the ends of the strut, or correct strut_lower."
        )
        return [problem]

    def _hinge(self) -> list[str]:
        """Check the axis about which the control arm turns."""
        front, rear = self.metres("arm_front"), self.metres("arm_rear")
        bearings = self.text("arm_front", "arm_rear")
        problems = []
        lever = distance_from_line(self.metres("ball_joint"), front, rear)
        if lever < _SMALLEST_DISTANCE:
            problems.append(
                f"{self.text('ball_joint')} lies {1000 * lever:.3f} mm from the hinge axis through "
                f"arm_front and arm_rear; the arm needs at least {1000 * _SMALLEST_DISTANCE:g} mm "
                "to move the wheel. Move ball_joint outboard, or correct the bearings."
            )
        tilt = angle_between_lines(front - rear, np.array([0.0, 0.0, 1.0]))
        if tilt < _SMALLEST_HINGE_ANGLE:
            problems.append(
                f"{bearings}: the hinge axis is {tilt:.3f} deg from the vertical; at least "
                f"{_SMALLEST_HINGE_ANGLE:g} deg are needed for the arm to swing up and down. "
                "Move arm_front forward or arm_rear rearward."
            )
        elif front[0] <= rear[0]:
            problems.append(
                f"{bearings}: the front bearing must have the greater x (x points forward), which "
                "fixes the sign of the arm's angle. Swap the two, or correct the sign of x."
            )
        return problems

    def _steering_arm(self) -> list[str]:
        """Check that the tie rod can turn the knuckle about the strut axis."""
        outer, ball_joint = self.metres("tie_rod_outer"), self.metres("ball_joint")
        arm = distance_from_line(outer, ball_joint, self.metres("strut_top"))
        if arm < _SMALLEST_DISTANCE:
            problem = (
                f"{self.text('tie_rod_outer')} lies {1000 * arm:.3f} mm from the strut axis "
                "through ball_joint and strut_top; the steering arm must be at least "
                f"{1000 * _SMALLEST_DISTANCE:g} mm long. Move tie_rod_outer off the axis."
            )
            return [problem]
        rod = unit_vector(self.metres("tie_rod_inner") - outer)
        lever = abs(float(np.cross(outer - ball_joint, rod) @ self.strut_axis()))
        if lever < _SMALLEST_DISTANCE:
            problem = (
                f"{self.text('tie_rod_outer', 'tie_rod_inner')}: the tie rod pulls with a lever of "
                f"{1000 * lever:.3f} mm about the strut axis; at least "
                f"{1000 * _SMALLEST_DISTANCE:g} mm are needed, or the linkage is at its dead "
                "centre. Move tie_rod_inner, so that the rod stands across the steering arm."
            )
            return [problem]
        return []
