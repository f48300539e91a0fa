"""A Pitman arm, alone or with relay rod and idler arm, which steers wheels instead of a rack."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field

from ...core.columns import hypot, number
from ...core.physical import ELEMENTS
from ...core.vectors import (
    Vector,
    angle_between_lines,
    components,
    cross,
    distance_from_line,
    unit_vector,
)
from .hardpoints import LARGEST_COORDINATE, SMALLEST_CROSS_ANGLE, SMALLEST_DISTANCE
from .section import Number, Remedy, Section, Triple, without_direction
from .units import in_metres

RELAY_ROD = "relay_rod"

_NAMES = {"pitman_arm": "Pitman arm", "idler_arm": "idler arm"}
_UP = np.array([0.0, 0.0, 1.0])

GearRatio = Annotated[
    Number, Field(gt=0.0), Remedy("Enter the turns of the steering wheel for one turn of the arm.")
]


class PitmanArmSection(Section):
    """A Pitman arm on the chassis, without mass.

    Points are in chassis axes, at the middle position. The displacement of the steering is the arc
    length that the ball of the arm has moved along its circle [m]; for a positive one the arm turns
    right-handed about its axis.
    """

    BODIES: ClassVar[Mapping[str, tuple[str, str]]] = {"pitman_arm": ("pivot", "ball")}

    pivot_mm: Triple = Field(description="point on the axis of the Pitman arm")
    axis: Triple = Field(
        description="axis of the Pitman arm; it turns right-handed about it for positive "
        "displacement"
    )
    ball_mm: Triple = Field(description="joint of the Pitman arm and the rod that it moves")
    gear_ratio: GearRatio | None = Field(
        default=None, description="turns of the steering wheel for one turn of the Pitman arm"
    )

    def metres(self, name: str) -> Vector:
        """Return the position of a point, ``pivot`` or ``ball`` [m]."""
        return np.array([in_metres(value, "mm") for value in getattr(self, f"{name}_mm")])

    def given_points(self) -> dict[str, Vector]:
        """Return the positions of the points in the file, by section and key [m]."""
        names = [name for ends in self.BODIES.values() for name in ends]
        given = [n for n in dict.fromkeys(names) if getattr(self, f"{n}_mm") is not None]
        return {f"[pitman_arm] {name}_mm": self.metres(name) for name in given}

    def direction_of(self, arm: str) -> Vector:
        """Return the unit vector along the axis of an arm, ``pitman_arm``."""
        return unit_vector(self.axis)

    def length(self) -> float:
        """Return the distance of the ball of the Pitman arm from its axis [m]."""
        return self._length_of("pitman_arm")

    def lever(self, arm: str, rod: Vector) -> float:
        """Return the lever of a force along a rod at the ball of an arm, about its axis [m].

        `rod` is a vector along the rod, of any length, (3,).
        """
        pivot, ball = self.BODIES[arm]
        across = cross(self.direction_of(arm), self.metres(ball) - self.metres(pivot))
        return abs(number(across @ unit_vector(rod)))

    # -- interface of a steering, as that of a rack -----------------------------------------------

    WORDS: ClassVar[str] = "steered by a Pitman arm"
    """How both wheels of an axle are steered."""
    TURN_KEY: ClassVar[str] = "[pitman_arm] gear_ratio"
    """The key from which its travel for one turn of the steering wheel follows."""

    def direction(self) -> Vector:
        """Return the direction in which the ball moves from the middle, a unit vector."""
        arm = self.metres("ball") - self.metres("pivot")
        return unit_vector(cross(self.direction_of("pitman_arm"), arm))

    def travel_per_turn(self) -> float | None:
        """Return the arc length that the ball moves in one turn of the steering wheel [m].

        None without a gear ratio.
        """
        return None if self.gear_ratio is None else 2.0 * math.pi * self.length() / self.gear_ratio

    def points(self) -> dict[str, Vector]:
        """Return the points at design by name [m]."""
        return {f"pitman_{name}": self.metres(name) for name in ("pivot", "ball")}

    def centers_of_mass(self) -> dict[str, Vector]:
        """Return the reference point of each part in the equations: its middle [m]."""
        return {
            body: 0.5 * (self.metres(first) + self.metres(second))
            for body, (first, second) in self.BODIES.items()
        }

    def parameters(self) -> dict[str, float]:
        """Return points, axes and bodies by their names in the equations, in SI units."""
        values = components("rack_axis", self.direction()) | {"pitman_turn": 1.0 / self.length()}
        for name, place in self.points().items():
            values |= components(name, place)
        values |= components("pitman_axis", self.direction_of("pitman_arm"))
        for body, center in self.centers_of_mass().items():
            values |= {f"{body}_mass": 0.0, **components(f"{body}_com", center)}
            values |= {f"{body}_inertia_{element}": 0.0 for element in ELEMENTS}
        return values

    # -- checks -----------------------------------------------------------------------------------

    def problems(self) -> list[str]:
        """Return the reasons why an arm cannot turn: an axis without direction, or no length.

        Points with a wrong unit precede them.
        """
        far = {
            name.removeprefix("[pitman_arm] "): at
            for name, at in self.given_points().items()
            if max(map(abs, at)) > LARGEST_COORDINATE
        }
        if far:
            limit = f"allowed is -{LARGEST_COORDINATE:g} m to {LARGEST_COORDINATE:g} m"
            listed = " and ".join(f"{name} = {list(getattr(self, name))} mm" for name in far)
            return [f"{listed}: out of range, {limit}. Correct the coordinates, in mm."]
        axes = {"axis": self.axis} | self._further_axes()
        remedy = "Enter [0.0, 0.0, 1.0] for an arm that turns to the left."
        problems = without_direction(axes, remedy)
        arms = [arm for arm in _NAMES if arm in self.BODIES]
        return problems or [problem for arm in arms for problem in self._arm_problems(arm)]

    def _further_axes(self) -> dict[str, Any]:
        """Return the axes of other arms by key; None for a default."""
        return {}

    def _length_of(self, arm: str) -> float:
        pivot, ball = self.BODIES[arm]
        base = self.metres(pivot)
        return distance_from_line(self.metres(ball), base, base + self.direction_of(arm))

    def _arm_problems(self, arm: str) -> list[str]:
        """Return the problem of an arm without length."""
        _, ball = self.BODIES[arm]
        length = self._length_of(arm)
        if length >= SMALLEST_DISTANCE:
            return []
        problem = (
            f"{ball}_mm is {1e3 * length:.3f} mm from the axis of the {_NAMES[arm]}; at "
            f"least {1e3 * SMALLEST_DISTANCE:g} mm are needed. Move it off the axis."
        )
        return [problem]


class PitmanLinkage(PitmanArmSection):
    """A Pitman arm, a relay rod to an idler arm, both on the chassis; no part has mass.

    Points are in chassis axes, at the middle position. The relay rod carries the tie rods. The
    default of the idler arm is the mirror image of the Pitman arm. The displacement of the steering
    is the arc length that the ball of the Pitman arm has moved along its circle [m]; for a positive
    one the arm turns right-handed about its axis.
    """

    BODIES: ClassVar[Mapping[str, tuple[str, str]]] = {
        "pitman_arm": ("pivot", "ball"),
        RELAY_ROD: ("ball", "idler_ball"),
        "idler_arm": ("idler_pivot", "idler_ball"),
    }

    idler_pivot_mm: Triple | None = Field(
        default=None, description="point on the axis of the idler arm; default: mirror image"
    )
    idler_axis: Triple | None = Field(
        default=None, description="axis of the idler arm; default: mirror image"
    )
    idler_ball_mm: Triple | None = Field(
        default=None, description="joint of idler arm and relay rod; default: mirror image"
    )

    TIE_RODS_ON: ClassVar[str] = RELAY_ROD
    """The part that the tie rods are joined to."""
    MOVED: ClassVar[tuple[str, ...]] = ("pitman_ball", "idler_ball")
    """Points of the steering that this part carries."""

    def metres(self, name: str) -> Vector:
        """Return the position of ``pivot``, ``ball``, ``idler_pivot`` or ``idler_ball`` [m]."""
        if getattr(self, f"{name}_mm") is None:
            x, y, z = self.metres(name.removeprefix("idler_"))
            return np.array([x, 0.0 - y, z])
        return super().metres(name)

    def direction_of(self, arm: str) -> Vector:
        """Return the unit vector along the axis of ``pitman_arm`` or ``idler_arm``."""
        if arm != "idler_arm":
            return super().direction_of(arm)
        x, y, z = self.axis
        return unit_vector(self.idler_axis or [x, 0.0 - y, z])

    def points(self) -> dict[str, Vector]:
        return super().points() | {n: self.metres(n) for n in ("idler_pivot", "idler_ball")}

    def parameters(self) -> dict[str, float]:
        return super().parameters() | components("idler_axis", self.direction_of("idler_arm"))

    @staticmethod
    def mirror(data: dict[str, Any]) -> None:
        """Change nothing of the section for the other side, which has the same linkage."""

    # -- checks -----------------------------------------------------------------------------------

    def _further_axes(self) -> dict[str, Any]:
        return {"idler_axis": self.idler_axis}

    def problems(self) -> list[str]:
        """Return the reasons why the linkage cannot move, or is at a dead centre in the middle."""
        problems = super().problems()
        rod = self.metres("idler_ball") - self.metres("ball")
        length = hypot(*rod)
        if length < SMALLEST_DISTANCE:
            problems.append(
                f"the ends of the relay rod, ball_mm and idler_ball_mm, are {1e3 * length:.3f} mm "
                f"apart; at least {1e3 * SMALLEST_DISTANCE:g} mm are needed. Move one of them."
            )
        return problems or self._rod_problems(rod)

    def _rod_problems(self, rod: Vector) -> list[str]:
        """Return the problems of an arm in line with the rod, and of an upright rod."""
        problems = []
        angle = angle_between_lines(rod, _UP)
        if angle < SMALLEST_CROSS_ANGLE:
            problems.append(
                f"the relay rod, from ball_mm to idler_ball_mm, is {angle:.3f} deg from the "
                f"vertical; at least {SMALLEST_CROSS_ANGLE:g} deg are needed for its universal "
                "joint to hold it. Move one of the two points."
            )
        for arm, name in _NAMES.items():
            _, ball = self.BODIES[arm]
            lever = self.lever(arm, rod)
            if lever < SMALLEST_DISTANCE:
                problems.append(
                    f"the relay rod pulls at the {name} with a lever of "
                    f"{1e3 * lever:.3f} mm; at least {1e3 * SMALLEST_DISTANCE:g} mm are needed, or "
                    f"the linkage is at its dead centre. Move {ball}_mm, so that arm and rod are "
                    "not in line."
                )
        return problems
