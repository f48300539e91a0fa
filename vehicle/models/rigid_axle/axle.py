"""`BeamAxle`: the data of every axle with a beam; `RigidAxle`: those of a rigid axle's file."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from pydantic import Field

from ....core.named_types import Array
from ....core.validator import Validator
from ....core.vectors import components, unit_vector
from ...corner.bushes import Bush, Bushings, bushes_of
from ...corner.coil_sprung import ApartDamper
from ...corner.structure import Structure
from ...input.bodies import RigidBody
from ...input.hardpoints import LARGEST_COORDINATE
from ...input.spring import SpringSection
from ...input.stop import StopSection
from ...input.units import point_in_metres
from ...input.vehicle import GravitySection, TyreSection, WheelSection
from ..axle.file import Brakes, End
from ..sides import SIDES
from ..whole_axle import CHASSIS, SHORTEST, WholeAxle, on_both_sides
from ..whole_axle_file import AxleDrive, WholeAxleHardpoints, WholeAxleVehicle
from .file import LeftHardpoints, RigidAxleBodies, RodSection, RollBarSection
from .rods import NEEDED, Ends, Hold
from .structure import CENTER, of_a_file, structure_of

# Least angle of a rod that guides the axle to the vertical [deg].
_SMALLEST_ANGLE = 1.0
# Rounding of a flexibility, relative to the greatest one of a bush.
_ROUNDING = 1e-12
# Names of parts and sources of loads besides the rods; there are two of most of them.
_PARTS = (
    "chassis", "beam", "wheel", "spring", "damper", "bar", "road", "drive", "gravity", "inertia",
)  # fmt: skip
# The ends of a rod are swapped if the one on the axle is farther from it by this distance [m].
_SWAPPED = 0.2
_LEFTWARD = np.array([0.0, 1.0, 0.0])
# The colours of rods and axle in drawings.
_RODS, _BEAM = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#999933"), "#4a525a"


class BeamAxle(WholeAxle):
    """An axle with a beam on four rods, which leave it heave and roll; the sections of its file."""

    vehicle: WholeAxleVehicle = Field(
        default=WholeAxleVehicle(), description="data of the whole vehicle"
    )
    hardpoints: WholeAxleHardpoints = Field(description="the points of the right side")
    left_hardpoints: LeftHardpoints = Field(
        default=LeftHardpoints(), description="points of the left side that are not mirror images"
    )
    rods: dict[str, RodSection] = Field(
        description="four rods between chassis and axle, with names of your choice; or five, with "
        "bushings"
    )
    wheel: WheelSection = Field(
        default=WheelSection(camber_deg=0.0, toe_deg=0.0), description="alignment of the wheels"
    )
    spring: SpringSection = Field(description="the springs, between chassis and axle")
    damper: ApartDamper = Field(description="the dampers, between chassis and axle")
    anti_roll_bar: RollBarSection | None = Field(default=None, description="the anti-roll bar")
    bump_stop: StopSection | None = Field(
        default=None, description="the stops in bump, of the dampers"
    )
    rebound_stop: StopSection | None = Field(
        default=None, description="the stops in rebound, of the dampers"
    )
    tyre: TyreSection = Field(description="the tyres")
    gravity: GravitySection = Field(description="gravity")
    bodies: RigidAxleBodies = Field(description="masses and inertia")
    brakes: Brakes = Field(default=Brakes(), description="reaction of the brake torque")
    drive: AxleDrive | None = Field(default=None, description="the drive of the axle")
    bushings: Bushings | None = Field(
        default=None, description="the bushings at hardpoints, for compliance: see Compliance"
    )

    PARTS: ClassVar[tuple[str, ...]] = _PARTS
    """Names of its parts besides rods, and of sources of loads."""
    POINTS_OF_SIDES: ClassVar[tuple[str, ...]] = (CENTER,)
    """Points of the right side with bushes, which the left side has, too."""

    # -- its properties -------------------------------------------------------------------------

    def ends(self) -> dict[str, Ends]:
        """Return the ends of the rods at design, on the chassis and on the axle [m]."""
        unit = self.hardpoints.unit
        return {
            name: (point_in_metres(rod.chassis, unit), point_in_metres(rod.axle, unit))
            for name, rod in self.rods.items()
        }

    def _left_points(self) -> dict[str, Array]:
        unit, own = self.hardpoints.unit, self.left_hardpoints.model_dump(exclude_none=True)
        return {name: point_in_metres(point, unit) for name, point in own.items()}

    @property
    def joint_names(self) -> tuple[str, ...]:
        ends = [f"{name}_axle" for name in self.rods]
        own = [name for name in self.points(SIDES[0]) if not name.endswith("_top")]
        return (*ends, *(f"{name}_{side}" for name in own for side in SIDES))

    def drawn_lines(self) -> Iterator[tuple[str, str, float, Array]]:
        half = self.half_track * _LEFTWARD
        yield "axle", _BEAM, 5.0, np.array([self.center - half, self.center + half])
        for color, (name, ends) in zip(_RODS, self.ends().items(), strict=False):
            yield name.replace("_", " "), color, 2.4, np.array(ends)

    @property
    def guides(self) -> tuple[str, ...]:
        """The rods by which the equations close their loops: all four, or four of five."""
        return Hold.of(self.ends(), self.center).guides()

    @property
    def overheld(self) -> bool:
        return self.bushings is not None and len(self.guides) == len(self.rods) - 1 == NEEDED

    def structure(self) -> Structure:
        return structure_of(self.rods)

    def bushes(self, given: Validator, described: Mapping[str, Any]) -> list[Bush]:
        """Return the described bushes; see `docs/suspension/compliance.md`.

        They are described by the name of a rod with the ending ``_chassis`` or ``_axle``, or of
        another point; one of the right side has the bushes of both sides.
        """
        spin = -self.wheel.spin_axis(-1.0)
        found = bushes_of(given, described, self._joints_of_a_file(), self._bush_points(), spin)
        return [
            own
            for bush in sorted(found, key=lambda bush: bush.point in self.POINTS_OF_SIDES)
            for own in (on_both_sides(bush) if bush.point in self.POINTS_OF_SIDES else [bush])
        ]

    def _joints_of_a_file(self) -> Structure:
        """Return the joints that have bushes in a file: those of both sides are one."""
        return of_a_file(self.rods)

    def _bush_points(self) -> dict[str, Array]:
        """Return the points of these joints at design by name [m]."""
        points = {name: self.hardpoints.metres(name) for name in self.POINTS_OF_SIDES}
        for name, (inner, outer) in self.ends().items():
            points |= {f"{name}_{CHASSIS}": inner, f"{name}_axle": outer}
        return points

    def parameters(self) -> dict[str, float]:
        values = {
            **components("axle_center", self.center),
            "gravity": self.gravity.acceleration_m_per_s2,
            "bar_rate": 0.0,
        }
        if self.anti_roll_bar is not None:
            values["bar_rate"] = float(np.degrees(self.anti_roll_bar.rate_Nm_per_deg))
        ends = self.ends()
        for number, name in enumerate(self.guides, 1):
            chassis, axle = ends[name]
            values |= components(f"rod_{number}_chassis", chassis)
            values |= components(f"rod_{number}_axle", axle)
        return values | self._of_bodies("beam")

    # -- its checks -----------------------------------------------------------------------------

    def _own_problems(self) -> list[str]:
        problems, ends = [], self.ends()
        problems += [
            f"[rods] {name!r} is not a name; letters, digits, _ and - are needed, a letter first. "
            "Rename the rod."
            for name in ends
            if not re.fullmatch("[A-Za-z][A-Za-z0-9_-]*", name)
        ]
        problems += [
            f"[rods] {name!r} is the name of another part, which loads could not distinguish from "
            f"it; {', '.join(self.PARTS)} are taken, also with the endings _left and _right. "
            "Rename the rod."
            for name in ends
            if name.removesuffix("_left").removesuffix("_right") in self.PARTS
        ]
        for name, (chassis, axle) in ends.items():
            length = float(np.linalg.norm(axle - chassis))
            across = float(np.hypot(*(axle - chassis)[:2]))
            if max(np.abs(chassis).max(), np.abs(axle).max()) > LARGEST_COORDINATE:
                problems.append(
                    f"[rods.{name}] is farther than {LARGEST_COORDINATE:g} m from the origin. "
                    f'Correct its points, or `unit = "{self.hardpoints.unit}"` in [hardpoints].'
                )
            elif length < SHORTEST:
                problems.append(
                    f"[rods.{name}] chassis and axle are {1e3 * length:.3f} mm apart; at least "
                    f"{1e3 * SHORTEST:g} mm are needed. Move one of them."
                )
            elif across < length * np.sin(np.radians(_SMALLEST_ANGLE)):
                problems.append(
                    f"[rods.{name}] is upright: at least {_SMALLEST_ANGLE:g} deg from the "
                    "vertical are needed, or the axle cannot rise. Move one of its ends."
                )
        if problems or self.overheld:
            return problems
        return Hold.of(ends, self.center).problems()

    def _check_bushes(self, given: Validator, bushes: Sequence[Bush]) -> None:
        if given.failed or not self.overheld:
            return
        ends = self.ends()
        ways = {
            f"{name}_{end}": unit_vector(axle - chassis)
            for name, (chassis, axle) in ends.items()
            for end in (CHASSIS, "axle")
        }
        along = [(bush, ways[bush.point]) for bush in bushes if bush.point in ways]
        if not any(
            way @ bush.compliance[:3, :3] @ way > _ROUNDING * bush.soft.max() for bush, way in along
        ):
            given.fail(
                f"of the five rods {', '.join(ends)} one or more must deflect along itself, or "
                "the axle neither heaves nor rolls. Give its bush axial_N_per_mm, or "
                "radial_N_per_mm where its axis is across the rod."
            )

    def _further_points(self) -> dict[str, Array]:
        """Return points besides hardpoints and rods [m], by their names in messages."""
        return {}

    def _carriers(self) -> dict[str, RigidBody]:
        """Return the bodies besides the wheels, by name."""
        return {"beam": self.bodies.beam}

    def _unsprung_mass(self) -> float:
        """Return the unsprung mass at a wheel, without the wheel [kg]."""
        return 0.5 * self.bodies.beam.mass_kg

    def _unlikely(self) -> Iterable[str]:
        ends_of_rods = {
            f"[rods.{name}] {end}": at
            for name, ends in self.ends().items()
            for end, at in zip(RodSection.model_fields, ends, strict=True)
        }
        yield from self._unlikely_of(
            ends_of_rods | self._further_points(),
            self._carriers(),
            self.half_track,
            self._unsprung_mass(),
        )
        for name, ends in self.ends().items():
            inner, outer = (float(np.hypot(*(end - self.center)[[0, 2]])) for end in ends)
            if outer > inner + _SWAPPED:
                yield (
                    f"[rods.{name}]: the end on the axle is {1e3 * outer:.0f} mm from the line "
                    f"through the wheels, that on the chassis {1e3 * inner:.0f} mm. Are the two "
                    "swapped?"
                )


class _RigidAxleKey(WholeAxle):
    """The top-level key of the file; as the last base it has the first field of `RigidAxle`."""

    rigid_axle: End = Field(description='where the axle is: "front" or "rear"')


class RigidAxle(BeamAxle, _RigidAxleKey):
    """A beam with two wheels on four rods, at its design position. Immutable.

    Make one with `load`, `from_dict` or `with_changes`. The attributes are the sections of the
    file, with the file's keys and units.

    Parameters
    ----------
    **data : Any
        The sections, as in a file.

    Raises
    ------
    InputError
        With all problems, if the data are not valid.

    Examples
    --------
    >>> from kintrafo import RigidAxle
    >>> axle = RigidAxle.load("rigid_axle")
    >>> list(axle.rods), axle.rigid_axle
    (['left_link', 'right_link', 'upper_link', 'panhard_rod'], 'rear')
    """

    KEY: ClassVar[str] = "rigid_axle"
    NEEDED: ClassVar[str] = 'a kintrafo.RigidAxle, such as RigidAxle.load("rigid_axle"), is needed'
    PAGE: ClassVar[str] = """\
A file of its own, of a beam on four rods; `kintrafo new FILE --rigid-axle` writes one. See
[Rigid axles](../suspension/types.md#rigid-axle). The other sections are those of every suspension:
`[tyre]`, `[gravity]`, the stops, and `[wheel]`, which may be left out; and `[bushings.POINT]`.
Points of bushings are the names of the rods with the ending `_chassis` or `_axle`, and
`wheel_center` of both wheels.
"""

    def heading(self) -> str:
        return f"rigid {self.rigid_axle} axle"
