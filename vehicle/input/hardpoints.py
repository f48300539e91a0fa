"""The hardpoints of a suspension, and checks of their geometry."""

from abc import abstractmethod
from collections.abc import Iterable, Mapping
from itertools import combinations
from typing import Any, ClassVar, get_args

import numpy as np
from pydantic import Field

from ...core.columns import greatest, length, number
from ...core.vectors import (
    Vector,
    angle_between_lines,
    components,
    cross,
    distance_from_line,
    unit_vector,
)
from .section import Section
from .units import LengthUnit, point_in_metres

# Least distance of two points that define a direction or a rod [m].
SMALLEST_DISTANCE = 0.001
# Least size of a suspension and largest coordinate; beyond them the unit is wrong [m].
_SMALLEST_SUSPENSION = 0.01
LARGEST_COORDINATE = 20.0
# Least angle of a hinge axis to the vertical [deg].
_SMALLEST_HINGE_ANGLE = 1.0
# Least angle of a link to the first axis of its universal joint [deg].
SMALLEST_CROSS_ANGLE = 1.0

Pair = tuple[str, str]


class Hardpoints(Section):
    """The points that define a suspension, at the design position.

    Any suspension has ``wheel_center``, a steered one ``tie_rod_outer`` and ``tie_rod_inner``. All
    points are in chassis axes (ISO 8855: x forward, y left, z up), in the unit that `unit` names.
    """

    STAND_INS: ClassVar[Mapping[str, str]] = {}  # substitutes of points that a file may leave out
    # moving body of each point; the others are fixed to the chassis
    CARRIERS: ClassVar[Mapping[str, str]]
    ARMS: ClassVar[Mapping[str, Pair]]  # bearings of each arm on the chassis, by its ball joint
    # moving points of a table of positions, besides the wheel centre
    JOINTS: ClassVar[tuple[str, ...]]
    # lower and the upper point on the steering axis; None if the axis has no two points and follows
    # from the motion
    STEERING_AXIS: ClassVar[Pair | None]
    AXIS_NAME: ClassVar[str] = "steering axis"  # name of this axis in messages

    unit: LengthUnit = Field(description='the unit of the hardpoints, "mm" or "m"')

    # -- reading them ---------------------------------------------------------------------------

    @classmethod
    def unit_of_key(cls, key: str, table: Mapping[str, Any]) -> str:
        unit = str(table.get("unit"))
        return unit if key != "unit" and unit in get_args(LengthUnit) else ""

    def metres(self, name: str) -> Vector:
        """Return the position of a hardpoint, or of its substitute, chassis axes [m]."""
        point = getattr(self, name)
        if point is None:
            return self.metres(self.STAND_INS[name])
        return point_in_metres(point, self.unit)

    def at_design(self) -> dict[str, Vector]:
        """Return all hardpoints [m]; those left out have the position of their substitute."""
        return {name: self.metres(name) for name in (*self.names(), *self.STAND_INS)}

    @classmethod
    def names(cls) -> list[str]:
        """Return the keys of the hardpoints that every file has."""
        return [name for name in cls.model_fields if name not in ("unit", *cls.STAND_INS)]

    def given(self) -> list[str]:
        """Return the keys of all hardpoints that this file has."""
        return [*self.names(), *self.given_optional()]

    def given_optional(self) -> list[str]:
        """Return the keys of the optional hardpoints that this file has."""
        return [name for name in self.STAND_INS if getattr(self, name) is not None]

    def parameters(self, *, optional: bool = False) -> dict[str, float]:
        """Return the coordinates [m], such as ``wheel_center_x``, optionally of all hardpoints."""
        values: dict[str, float] = {}
        for name in [*self.names(), *(self.STAND_INS if optional else ())]:
            values |= components(name, self.metres(name))
        return values

    def distance(self, first: str, second: str) -> float:
        """Return the distance of two hardpoints [m]."""
        return length(self.metres(second) - self.metres(first))

    def text(self, *names: str) -> str:
        """Return hardpoints as in the file, with their unit, for error messages."""
        names = tuple(n if getattr(self, n) is not None else self.STAND_INS[n] for n in names)
        points = [f"{name} = {list(getattr(self, name))} {self.unit}" for name in names]
        return f"[hardpoints] {' and '.join(points)}"

    def steering_axis(self) -> Vector | None:
        """Return the unit vector upward along the steering axis; None without points on it."""
        if self.STEERING_AXIS is None or self.distance(*self.STEERING_AXIS) < SMALLEST_DISTANCE:
            return None
        low, high = map(self.metres, self.STEERING_AXIS)
        return unit_vector(high - low)

    # -- their checks ---------------------------------------------------------------------------

    def unit_problems(self) -> list[str]:
        """Return the problem of coordinates with a wrong unit, which precedes all other checks."""
        points = {name: self.metres(name) for name in self.given()}
        far = [n for n, point in points.items() if greatest(map(abs, point)) > LARGEST_COORDINATE]
        remedy = f'Correct the coordinates or `unit = "{self.unit}"`.'
        if far:
            limit = f"allowed is -{LARGEST_COORDINATE:g} m to {LARGEST_COORDINATE:g} m"
            return [f"{self.text(*far)}: out of range, {limit}. {remedy}"]
        size = greatest(self.distance(*pair) for pair in combinations(points, 2))
        if size < _SMALLEST_SUSPENSION:
            problem = (
                f"[hardpoints] unit = {self.unit!r}: all points lie within {1000 * size:.3f} mm; a "
                f"suspension measures at least {1000 * _SMALLEST_SUSPENSION:g} mm. {remedy}"
            )
            return [problem]
        return []

    @abstractmethod
    def geometry_problems(self) -> list[str]:
        """Return the problems of points with which the mechanism cannot move or is ambiguous."""

    def coinciding(self, bodies: Mapping[str, Iterable[str]]) -> dict[Pair, str]:
        """Return the pairs of points of one body that are too close, with the body's name."""
        return {
            pair: body
            for body, names in bodies.items()
            for pair in combinations(names, 2)
            if self.distance(*pair) < SMALLEST_DISTANCE
        }

    def coincidence_problems(self, coinciding: Mapping[Pair, str]) -> list[str]:
        """Return the problems of points of one body that are too close."""
        return [
            f"{self.text(*pair)} are {1000 * self.distance(*pair):.3f} mm apart; two points of the "
            f"{body} must be at least {1000 * SMALLEST_DISTANCE:g} mm apart. Move one of them."
            for pair, body in coinciding.items()
        ]

    def hinge_problems(self, front: str, rear: str, tip: str) -> list[str]:
        """Return the problems of the axis through two bearings of an arm with a tip."""
        at_front, at_rear = self.metres(front), self.metres(rear)
        bearings = self.text(front, rear)
        problems = []
        lever = distance_from_line(self.metres(tip), at_front, at_rear)
        if lever < SMALLEST_DISTANCE:
            problems.append(
                f"{self.text(tip)} lies {1000 * lever:.3f} mm from the hinge axis through "
                f"{front} and {rear}; the arm needs at least {1000 * SMALLEST_DISTANCE:g} mm "
                f"to move the wheel. Move {tip} outboard, or correct the bearings."
            )
        tilt = angle_between_lines(at_front - at_rear, np.array([0.0, 0.0, 1.0]))
        if tilt < _SMALLEST_HINGE_ANGLE:
            problems.append(
                f"{bearings}: the hinge axis is {tilt:.3f} deg from the vertical; at least "
                f"{_SMALLEST_HINGE_ANGLE:g} deg are needed for the arm to swing up and down. "
                f"Move {front} forward or {rear} rearward."
            )
        elif at_front[0] <= at_rear[0]:
            problems.append(
                f"{bearings}: the front bearing must have the greater x (x points forward), which "
                "fixes the sign of the arm's angle. Swap the two, or correct the sign of x."
            )
        return problems

    def cross_problems(self, ends: Pair, link: str, axis: Vector, name: str) -> list[str]:
        """Return the problem of a link along the fixed axis of its universal joint.

        `ends` are the joint and the other end of the link; `name` is the name of the axis.
        """
        first, second = (self.metres(end) for end in ends)
        angle = angle_between_lines(second - first, axis)
        if angle >= SMALLEST_CROSS_ANGLE:
            return []
        problem = (
            f"{self.text(*ends)}: the {link} is {angle:.3f} deg from {name}; at least "
            f"{SMALLEST_CROSS_ANGLE:g} deg are needed for its universal joint to hold "
            "it. Move one of the two points."
        )
        return [problem]

    def steering_problems(self, low: str, high: str) -> list[str]:
        """Return the problem of a tie rod that cannot turn the knuckle about two points of it."""
        direction = unit_vector(self.metres(high) - self.metres(low))
        outer, foot = self.metres("tie_rod_outer"), self.metres(low)
        arm = distance_from_line(outer, foot, self.metres(high))
        if arm < SMALLEST_DISTANCE:
            problem = (
                f"{self.text('tie_rod_outer')} lies {1000 * arm:.3g} mm from the {self.AXIS_NAME} "
                f"through {low} and {high}; the steering arm must be at least "
                f"{1000 * SMALLEST_DISTANCE:g} mm long. Move tie_rod_outer off the axis."
            )
            return [problem]
        inner = self.metres("tie_rod_inner")
        beside = distance_from_line(inner, foot, self.metres(high))
        if beside < SMALLEST_DISTANCE:
            problem = (
                f"{self.text('tie_rod_inner')} lies {1000 * beside:.3g} mm from the line through "
                f"{low} and {high}, about which the knuckle turns, so that the tie rod does not "
                f"hold it; at least {1000 * SMALLEST_DISTANCE:g} mm are needed. Move "
                "tie_rod_inner off that line."
            )
            return [problem]
        rod = unit_vector(inner - outer)
        lever = abs(number(cross(outer - foot, rod) @ direction))
        if lever < SMALLEST_DISTANCE:
            problem = (
                f"{self.text('tie_rod_outer', 'tie_rod_inner')}: the tie rod pulls with a lever of "
                f"{1000 * lever:.3f} mm about the {self.AXIS_NAME}; at least "
                f"{1000 * SMALLEST_DISTANCE:g} mm are needed, or the linkage is at its dead "
                "centre. Move tie_rod_inner, so that the rod is not in line with the steering arm."
            )
            return [problem]
        return []
