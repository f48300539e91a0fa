"""`SteeredRigidAxle`: the data of a steered rigid axle's file."""

from collections.abc import Iterable, Iterator
from typing import ClassVar, Literal

import numpy as np
from pydantic import Field
from pydantic.json_schema import SkipJsonSchema

from ....core.named_types import Array
from ....core.physical import ELEMENTS
from ....core.vectors import MIRROR, angle_between_lines, components, cross, unit_vector
from ...corner.corner import UP
from ...corner.structure import Structure
from ...input.bodies import RigidBody
from ...input.hardpoints import LARGEST_COORDINATE, SMALLEST_CROSS_ANGLE, SMALLEST_DISTANCE
from ...input.pitman_arm import PitmanArmSection
from ...input.units import point_in_metres
from ...input.vehicle import Share
from ..axle.file import Brakes
from ..rigid_axle.axle import BeamAxle
from ..rigid_axle.structure import CENTER
from ..sides import LEFT, RIGHT, SIDES
from ..whole_axle import WholeAxle
from ..whole_axle_file import AxleDrive
from .file import (
    LOWER,
    TRACK_ROD,
    UPPER,
    DragLinkSection,
    SteeredHardpoints,
    SteeredRigidAxleBodies,
)
from .structure import BALL, KNUCKLE_END, PITMAN_ARM, of_a_file, structure_of

# Elements of an inertia tensor that have the other sign in the mirror image.
_TURNED = ("xy", "yz")
_DRIVEN = (
    "[drive]: a steered axle is not driven here, since the joints in its half shafts would turn "
    "the knuckles. Leave it out."
)
# Colours of a drawing.
_KNUCKLES, _DRAG_LINK, _TRACK_ROD = "#4a525a", "#8c564b", "#17becf"


class _SteeredRigidAxleKey(WholeAxle):
    """The top-level key of the file; as the last base it has the first field of the axle."""

    steered_rigid_axle: Literal["front"] = Field(description='where the axle is: "front"')


class KnuckleBrakes(Brakes):
    """The brakes of the axle."""

    torque_on: Literal["carrier"] = Field(
        default="carrier",
        description='"carrier": the knuckles react the torque. Brakes on the chassis need half '
        "shafts, whose joints would turn the knuckles",
    )


class _RefusedDrive(AxleDrive):
    """A drive that needs no key, since the section as a whole is refused."""

    share: Share = 0.0


class SteeredRigidAxle(BeamAxle, _SteeredRigidAxleKey):
    """A rigid axle with steered wheels, at its design position; see `WholeAxle`.

    Its beam is on four rods. A drag link turns one knuckle, and a track rod the other one.

    Examples
    --------
    >>> import kintrafo
    >>> axle = kintrafo.load("steered_rigid_axle")
    >>> axle.heading(), axle.drag_link.side, axle.pitman_arm.gear_ratio
    ('steered rigid front axle', 'left', 18.0)
    """

    KEY: ClassVar[str] = "steered_rigid_axle"
    NEEDED: ClassVar[str] = (
        'a steered rigid axle, such as kintrafo.load("steered_rigid_axle"), is needed'
    )
    rack_name: ClassVar[str] = "rack_displacement"
    PAGE: ClassVar[str] = """\
A file of its own, of a beam on four rods, with two knuckles, a Pitman arm, a drag link and a track
rod; `kintrafo new FILE --suspension steered_rigid_axle` writes one. See
[Steered rigid axles](../suspension/steered-rigid-axle.md). The other sections are those of
every suspension: `[tyre]`, `[gravity]`, the stops, and `[wheel]`, which may be left out; and
`[bushings.POINT]`. Points of bushings are the names of the rods with the ending `_chassis` or
`_axle`; `kingpin_lower`, `kingpin_upper`, `track_rod` and `wheel_center` of both sides; and the
ends of the drag link, `pitman_ball` and `drag_link_knuckle`.
"""

    hardpoints: SteeredHardpoints = Field(description="the points of the right side")
    pitman_arm: PitmanArmSection = Field(description="the Pitman arm of the steering gear")
    drag_link: DragLinkSection = Field(description="the drag link from Pitman arm to knuckle")
    brakes: KnuckleBrakes = Field(default=KnuckleBrakes(), description="the brakes of the axle")
    # not a section of these files: the schema does not have it, and the check refuses it
    drive: SkipJsonSchema[_RefusedDrive | None] = Field(default=None, description="the drive")
    bodies: SteeredRigidAxleBodies = Field(description="masses and inertia")

    PARTS: ClassVar[tuple[str, ...]] = (
        *BeamAxle.PARTS, "knuckle", "drag_link", "track_rod", "pitman_arm", "steering",
    )  # fmt: skip
    POINTS_OF_SIDES: ClassVar[tuple[str, ...]] = (LOWER, UPPER, TRACK_ROD, CENTER)

    def heading(self) -> str:
        return "steered rigid front axle"

    # -- its steering ---------------------------------------------------------------------------

    @classmethod
    def steered(cls) -> bool:
        return True

    @property
    def steered_by(self) -> str:
        return "pitman_arm"

    @property
    def steering_gear(self) -> PitmanArmSection:
        return self.pitman_arm

    @property
    def near(self) -> str:
        """The side of the knuckle that the drag link turns."""
        return self.drag_link.side

    @property
    def equations_name(self) -> str:
        return self.KEY if self.near == LEFT else f"{self.KEY}_{RIGHT}"

    def steering_points(self) -> dict[str, Array]:
        """Return the points of Pitman arm and drag link at design by name [m]."""
        end = point_in_metres(self.drag_link.knuckle, self.hardpoints.unit)
        return self.pitman_arm.points() | {KNUCKLE_END: end}

    def links(self) -> dict[str, tuple[Array, Array]]:
        """Return the ends of drag link and track rod at design [m]."""
        points = self.steering_points()
        ends = [self.points(side)[TRACK_ROD] for side in SIDES]
        return {"drag_link": (points[BALL], points[KNUCKLE_END]), TRACK_ROD: (ends[0], ends[1])}

    # -- its properties -------------------------------------------------------------------------

    @property
    def joint_names(self) -> tuple[str, ...]:
        return (*super().joint_names, BALL, KNUCKLE_END)

    def drawn_lines(self) -> Iterator[tuple[str, str, float, Array]]:
        steering = self.steering_points()
        pins = {side: self._kingpin(side) for side in SIDES}
        middle = {side: 0.5 * (low + high) for side, (low, high) in pins.items()}
        for label, color, width, line in super().drawn_lines():
            beam = np.array([middle[side] for side in SIDES])
            yield label, color, width, beam if label == "axle" else line
        for side in SIDES:
            points = self.points(side)
            ends = [points[CENTER], points[TRACK_ROD]]
            ends += [steering[KNUCKLE_END]] if side == self.near else []
            yield "knuckles", _KNUCKLES, 2.4, np.array(pins[side])
            for end in ends:
                yield "knuckles", _KNUCKLES, 2.4, np.array([middle[side], end])
        arm = np.array([steering["pitman_pivot"], steering[BALL]])
        yield "Pitman arm", _DRAG_LINK, 4.0, arm
        colors = _DRAG_LINK, _TRACK_ROD
        for (name, link), color in zip(self.links().items(), colors, strict=True):
            yield name.replace("_", " "), color, 2.4, np.array(link)

    def _kingpin(self, side: str) -> tuple[Array, Array]:
        points = self.points(side)
        return points[LOWER], points[UPPER]

    def structure(self) -> Structure:
        return structure_of(self.rods, self.near)

    def _joints_of_a_file(self) -> Structure:
        return of_a_file(self.rods)

    def _bush_points(self) -> dict[str, Array]:
        other = {f"{TRACK_ROD}_other": self.points(LEFT)[TRACK_ROD]}
        return super()._bush_points() | other | self.steering_points()

    def parameters(self) -> dict[str, float]:
        values = super().parameters() | self.pitman_arm.parameters()
        values |= components(KNUCKLE_END, self.steering_points()[KNUCKLE_END])
        for prefix, side in (("", RIGHT), ("left_", LEFT)):
            for axis in "xyz":
                values[f"{TRACK_ROD}_{side}_{axis}"] = values.pop(f"{prefix}{TRACK_ROD}_{axis}")
        return values | self._of_knuckles()

    def _of_knuckles(self) -> dict[str, float]:
        """Return mass, centre and inertia of both knuckles by name, in SI units."""
        body, found = self.bodies.knuckle, {}
        center, elements = body.centre_of_mass(self.hardpoints), body.elements()
        for name, side in (("knuckle", RIGHT), ("left_knuckle", LEFT)):
            turned = {e: -1.0 if side == LEFT and e in _TURNED else 1.0 for e in ELEMENTS}
            found[f"{name}_mass"] = body.mass_kg
            found |= components(f"{name}_com", center * MIRROR if side == LEFT else center)
            found |= {f"{name}_inertia_{e}": turned[e] * elements[e] + 0.0 for e in ELEMENTS}
        return found

    # -- its checks -----------------------------------------------------------------------------

    def _own_problems(self) -> list[str]:
        """Return problems of drive and brakes, of rods, and of drag link and track rod."""
        if self.drive is not None:
            return [_DRIVEN]
        problems = super()._own_problems()
        if np.abs(self.steering_points()[KNUCKLE_END]).max() > LARGEST_COORDINATE:
            problems.append(
                f"[drag_link] knuckle is farther than {LARGEST_COORDINATE:g} m from the origin. "
                f'Correct it, or `unit = "{self.hardpoints.unit}"` in [hardpoints].'
            )
            return problems
        for name, ends in self.links().items():
            problems += self._problems_of_link(name, *ends)
        return problems or [*self._problems_of_pitman_arm()]

    def _problems_of_pitman_arm(self) -> Iterator[str]:
        ball, end = self.links()["drag_link"]
        lever = self.pitman_arm.lever(PITMAN_ARM, end - ball)
        if lever < SMALLEST_DISTANCE:
            yield (
                f"[drag_link] pulls at the Pitman arm with a lever of {1e3 * lever:.3f} mm; at "
                f"least {1e3 * SMALLEST_DISTANCE:g} mm are needed, or the steering is at its dead "
                "centre. Move [pitman_arm] ball_mm, so that arm and link are not in line."
            )

    def _problems_of_link(self, name: str, first: Array, last: Array) -> Iterator[str]:
        section = "[drag_link]" if name == "drag_link" else "[hardpoints] track_rod: the track rod"
        length = float(np.linalg.norm(last - first))
        if length < SMALLEST_DISTANCE:
            yield (
                f"{section} is {1e3 * length:.3f} mm long; at least {1e3 * SMALLEST_DISTANCE:g} mm "
                "are needed. Move one of its ends."
            )
            return
        angle = angle_between_lines(last - first, UP)
        if angle < SMALLEST_CROSS_ANGLE:
            yield (
                f"{section} is {angle:.3f} deg from the vertical; at least "
                f"{SMALLEST_CROSS_ANGLE:g} deg are needed for its universal joint to hold it. "
                "Move one of its ends."
            )
        sides = [self.near] if name == "drag_link" else [RIGHT]
        for side in sides:
            lever = self._lever(side, last, last - first)
            if lever < SMALLEST_DISTANCE:
                yield (
                    f"{section} turns the {side} knuckle with a lever of {1e3 * lever:.3f} mm "
                    f"about its kingpin; at least {1e3 * SMALLEST_DISTANCE:g} mm are needed. Move "
                    "its end on the knuckle away from the kingpin, so that arm and rod are not in "
                    "line."
                )

    def _lever(self, side: str, at: Array, along: Array) -> float:
        """Return the lever of a force along a line about the kingpin of a side [m]."""
        low, high = self._kingpin(side)
        return abs(float(cross(unit_vector(high - low), at - low) @ unit_vector(along)))

    def _further_points(self) -> dict[str, Array]:
        end = self.steering_points()[KNUCKLE_END]
        return {**self.pitman_arm.given_points(), "[drag_link] knuckle": end}

    def _carriers(self) -> dict[str, RigidBody]:
        return super()._carriers() | {"knuckle": self.bodies.knuckle}

    def _unsprung_mass(self) -> float:
        return super()._unsprung_mass() + self.bodies.knuckle.mass_kg

    def _unlikely(self) -> Iterable[str]:
        yield from super()._unlikely()
        end = self.steering_points()[KNUCKLE_END]
        far = {side: np.linalg.norm(end - np.mean(self._kingpin(side), axis=0)) for side in SIDES}
        nearest = min(far, key=far.__getitem__)
        if nearest != self.near:
            yield (
                f"[drag_link] knuckle is nearer to the {nearest} kingpin, and side is "
                f'"{self.near}". Correct one of them.'
            )
