"""A rigid axle: what the sections of its file make together."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from pydantic import Field, ValidationError

from ....core.arguments import Arguments
from ....core.errors import InputError
from ....core.vectors import components, unit_vector
from ...corner.bushes import Bush, Bushings, bushes_of
from ...corner.corner import Array
from ...corner.structure import Structure
from ...corner.wheel_loads import needed_radius
from ...data import data_sets, find
from ...data.starter import RIGID_AXLE, RIGID_AXLES
from ...input.damper import NO_CURVE
from ...input.messages import messages_of
from ...input.places import put
from ...input.section import Section
from ...input.spring import Spring, rate_key
from ...input.stop import NO_STOP, Stop
from ...input.toml_file import read_toml
from ...input.units import in_metres
from ...input.vehicle import Gravity, Tyre, Wheel
from ..axle.file import Brakes, End
from ..sides import LEFT, RIGHT, SIDES
from .file import (
    AxleDamper,
    AxleDrive,
    LeftHardpoints,
    RigidAxleBodies,
    RigidAxleHardpoints,
    RigidAxleVehicle,
    Rod,
    RollBar,
)
from .rods import NEEDED, Ends, Hold
from .structure import CENTER, CHASSIS, of_a_file, structure_of

# A wheel centre nearer to the vehicle's centre plane than this is on neither side [m].
_SMALLEST_HALF_TRACK = 0.1
# Nearer to the vertical than this, a rod stands on its axle and does not guide it [deg].
_SMALLEST_ANGLE = 1.0
# What is less of how soft a bush is in any direction is rounding.
_ROUNDING = 1e-12
# Two ends of a rod are farther apart than this [m], and no coordinate is larger than that.
_SHORTEST, _LARGEST = 0.001, 20.0
# What loads are on, or come from, besides the rods; there are two of most of them.
_PARTS = (
    "chassis", "beam", "wheel", "spring", "damper", "bar", "road", "drive", "gravity", "inertia",
)  # fmt: skip
# A wheel centre lower than this above z = 0 says that z = 0 is not the ground [m].
_SMALLEST_WHEEL_RADIUS = 0.1


class RigidAxle(Section):
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
        With all problems, if no axle can be like this.

    Examples
    --------
    >>> from kintrafo import RigidAxle
    >>> axle = RigidAxle.load("rigid_axle")
    >>> list(axle.rods), axle.rigid_axle
    (['left_link', 'right_link', 'upper_link', 'panhard_rod'], 'rear')
    """

    NEEDED: ClassVar[str] = 'a kintrafo.RigidAxle, such as RigidAxle.load("rigid_axle"), is needed'

    rigid_axle: End = Field(description='where the axle is: "front" or "rear"')
    vehicle: RigidAxleVehicle = Field(
        default=RigidAxleVehicle(), description="what the whole vehicle adds"
    )
    hardpoints: RigidAxleHardpoints = Field(description="the points of the right side")
    left_hardpoints: LeftHardpoints = Field(
        default=LeftHardpoints(), description="what of the left side is not the mirror image"
    )
    rods: dict[str, Rod] = Field(
        description="four rods between chassis and axle, by names of any choice; or five, with "
        "bushings"
    )
    wheel: Wheel = Field(
        default=Wheel(camber_deg=0.0, toe_deg=0.0), description="alignment of the wheels"
    )
    spring: Spring = Field(description="the springs, between chassis and axle")
    damper: AxleDamper = Field(description="the dampers, between chassis and axle")
    anti_roll_bar: RollBar | None = Field(default=None, description="the anti-roll bar")
    bump_stop: Stop | None = Field(default=None, description="the stops in bump, of the dampers")
    rebound_stop: Stop | None = Field(
        default=None, description="the stops in rebound, of the dampers"
    )
    tyre: Tyre = Field(description="the tyres")
    gravity: Gravity = Field(description="gravity")
    bodies: RigidAxleBodies = Field(description="masses and inertia")
    brakes: Brakes = Field(default=Brakes(), description="what holds the torque of the brakes")
    drive: AxleDrive | None = Field(default=None, description="what drives the axle")
    bushings: Bushings | None = Field(
        default=None, description="what deflects at hardpoints, for compliance: see Loads"
    )

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise InputError(messages_of(error, type(self), data)) from None
        problems = self._problems_of_points() or self._problems_of_rods() or self._lengths_refused()
        if problems:
            raise InputError(problems)
        if self.bushings is not None:
            with Arguments("bushings") as given:
                bushes = self.bushes(given, self.bushings)
                if self.overheld and not given.refused:
                    self._refuse_rigid(given, bushes)

    # -- making one -----------------------------------------------------------------------------

    @classmethod
    def load(cls, path_or_name: str | Path) -> Self:
        """Read a rigid axle from a TOML file.

        Parameters
        ----------
        path_or_name : str or pathlib.Path
            The file; or, as a string, the name of one that comes with kintrafo: ``"rigid_axle"``.

        Raises
        ------
        InputError
            If the file cannot be read or no axle can be like this; it lists everything that is
            wrong.
        """
        with Arguments(cls.__name__) as given:
            given.path("path_or_name", path_or_name)
        file = find(path_or_name, data_sets(RIGID_AXLES))
        return cls.from_dict(read_toml(file), source=str(path_or_name))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], source: str = "input data") -> Self:
        """Make a rigid axle from nested dictionaries with the keys of the file.

        Parameters
        ----------
        data : mapping
            The sections, with their keys and units as in the file.
        source : str, optional
            Where the data come from, for error messages.

        Raises
        ------
        InputError
            If no axle can be like this; it lists everything that is wrong.
        """
        with Arguments(source) as checked:
            for key in checked.mapping("data", data, "keys and values of a rigid axle's file"):
                checked.kind("key of data", key, str, "a text is needed")
        if RIGID_AXLE not in data:
            problem = (
                f"{RIGID_AXLE} is missing: where the axle is. Add a line "
                f'`{RIGID_AXLE} = "rear"` or "front"; `kintrafo new FILE --rigid-axle` writes such '
                "a file."
            )
            raise InputError([problem], source)
        try:
            return cls(**data)
        except InputError as error:
            raise InputError(error.problems, source) from None

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged.

        Parameters
        ----------
        exclude_defaults : bool, optional
            Whether values that are as by default are left out.
        """
        return self.model_dump(mode="json", exclude_none=True, exclude_defaults=exclude_defaults)

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return an axle that differs in some values; all checks are made again.

        Parameters
        ----------
        changes : mapping of str to Any
            For each place in the file, section and key with dots between them, the new value in
            the file's unit, such as ``{"rods.panhard_rod.axle.z": 390.0}``. None removes an
            optional key, or a rod.

        Raises
        ------
        InputError
            If there is no such place, or no axle can be like this.
        """
        with Arguments("rigid axle") as checked:
            for key in checked.mapping("changes", changes, "places and values"):
                checked.kind("key of changes", key, str, "a text is needed")
        data = self.to_dict()
        source = f"rigid axle with changed {', '.join(changes)}"
        problems = [problem for place in changes if (problem := put(data, place, changes[place]))]
        if problems:
            raise InputError(problems, source)
        rods = data["rods"]
        if isinstance(rods, dict):
            data["rods"] = {name: rod for name, rod in rods.items() if rod is not None}
        return self.from_dict(data, source)

    # -- what it is -----------------------------------------------------------------------------

    def heading(self) -> str:
        """Return what the axle is called."""
        return f"rigid {self.rigid_axle} axle"

    @property
    def center(self) -> Array:
        """The middle between the wheels at design [m]."""
        center: Array = self.hardpoints.metres("wheel_center") * [1.0, 0.0, 1.0]
        return center

    @property
    def half_track(self) -> float:
        """Half the distance of the wheel centres [m]."""
        return -float(self.hardpoints.metres("wheel_center")[1])

    def ends(self) -> dict[str, Ends]:
        """Return where the rods are at design, on the chassis and on the axle [m]."""
        unit = self.hardpoints.unit
        return {
            name: (
                np.array([in_metres(value, unit) for value in rod.chassis]),
                np.array([in_metres(value, unit) for value in rod.axle]),
            )
            for name, rod in self.rods.items()
        }

    def points(self, side: str) -> dict[str, Array]:
        """Return the hardpoints of a side at design [m]."""
        with Arguments("points") as given:
            given.among("side", side, (RIGHT, LEFT))
        found = self.hardpoints.at_design()
        if side == RIGHT:
            return found
        mirrored = {name: point * [1.0, -1.0, 1.0] for name, point in found.items()}
        own = self.left_hardpoints.model_dump(exclude_none=True)
        unit = self.hardpoints.unit
        return mirrored | {
            name: np.array([in_metres(value, unit) for value in point])
            for name, point in own.items()
        }

    def tyre_radius(self) -> float | None:
        """Return the radius of a wheel as a thin disc [m]; None where nothing says it.

        ``tyre.radius_mm`` where it is given, otherwise the height of the wheel centre above z = 0.
        """
        if self.tyre.radius_mm is not None:
            return in_metres(self.tyre.radius_mm, "mm")
        height = float(self.center[2])
        return height if height >= _SMALLEST_WHEEL_RADIUS else None

    @property
    def guides(self) -> tuple[str, ...]:
        """The rods by which the equations close their loops: all four, or four of five."""
        return Hold.of(self.ends(), self.center).guides()

    @property
    def overheld(self) -> bool:
        """Whether five rods hold it, so that it moves only as its bushes deflect."""
        return self.bushings is not None and len(self.guides) == len(self.rods) - 1 == NEEDED

    def wheel_load_parameters(self) -> dict[str, float]:
        """Return what equations need besides that have the loads on the wheels as inputs [m].

        Raises
        ------
        InputError
            If the radius of the wheels is not known.
        """
        return {"tyre_radius": needed_radius(self.tyre_radius())}

    def structure(self) -> Structure:
        """Return what holds its parts together."""
        return structure_of(self.rods)

    def bushes(self, given: Arguments, described: Mapping[str, Any]) -> list[Bush]:
        """Return bushes by their hardpoints; see `docs/suspension/rigid-axle.md`.

        Parameters
        ----------
        given : Arguments
            Gets what is wrong.
        described : mapping
            By the name of a rod with ``_chassis`` or ``_axle`` behind it, and ``wheel_center`` for
            the bearings of both wheels.
        """
        points = {CENTER: self.hardpoints.metres(CENTER)}
        for name, (inner, outer) in self.ends().items():
            points |= {f"{name}_{CHASSIS}": inner, f"{name}_axle": outer}
        spin = -self.wheel.spin_axis(-1.0)
        found = bushes_of(given, described, of_a_file(self.rods), points, spin)
        sides = [
            bush
            for bearing in found
            if bearing.point == CENTER
            for bush in (
                bearing.mirrored(f"{CENTER}_{LEFT}"),
                replace(bearing, point=f"{CENTER}_{RIGHT}"),
            )
        ]
        return [*(bush for bush in found if bush.point != CENTER), *sides]

    def parameters(self) -> dict[str, float]:
        """Return everything that the equations of motion need, by their names, in SI units."""
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
        bodies = self.bodies.parameters(self.hardpoints)
        values |= {name: value for name, value in bodies.items() if name.startswith("beam_")}
        wheel = {name: value for name, value in bodies.items() if name.startswith("wheel_")}
        for prefix, side, sign in (("", RIGHT, -1.0), ("left_", LEFT, 1.0)):
            of_side = wheel | self._of_side(side, sign)
            values |= {f"{prefix}{name}": value for name, value in of_side.items()}
        return values

    def length(self, part: str, side: str) -> float:
        """Return the length of a spring or a damper at design [m].

        Parameters
        ----------
        part : {'spring', 'damper'}
        side : {'left', 'right'}
        """
        return _length(self.points(side), part)

    def rate_key(self, part: str) -> str:
        """Return where the rate of the springs or the dampers is, or the springs' curve."""
        return rate_key(part, self.spring)

    def _of_side(self, side: str, sign: float) -> dict[str, float]:
        """Return the parameters of spring, damper, stops and tyre of a side, without its name."""
        points, damper = self.points(side), self.damper
        length = _length(points, "damper")
        curve = dict(NO_CURVE) if damper.curve is None else damper.curve.parameters()
        values = {
            **self.tyre.parameters(),
            **components("spin_axis", self.wheel.spin_axis(sign)),
            **curve,
            **(self.bump_stop or NO_STOP).parameters("bump", length),
            **(self.rebound_stop or NO_STOP).parameters("rebound", length),
            **self.spring.parameters(_length(points, "spring"), general=True),
            "damper_rate": damper.rate_N_s_per_m or 0.0,
            "damper_friction": damper.friction_N,
            "damper_friction_speed": damper.friction_velocity_m_per_s,
            "tyre_damper_rate": self.tyre.damper_rate_N_s_per_m,
            "tyre_lifts_off": float(self.tyre.lifts_off),
        }
        for name, point in points.items():
            values |= components(name, point)
        return values

    # -- its checks -----------------------------------------------------------------------------

    def _problems_of_points(self) -> list[str]:
        points = self.hardpoints
        problems = points.unit_problems() or points.geometry_problems()
        if self.half_track < _SMALLEST_HALF_TRACK:
            problems.append(
                f"{points.text('wheel_center')}: the points are those of the right side, and y "
                f"points left; less than {-1e3 * _SMALLEST_HALF_TRACK:g} mm is needed. Correct the "
                "sign of y."
            )
        left = {name: p for name, p in self.points(LEFT).items() if p[1] <= 0.0}
        if left and not problems:
            problems.append(
                f"[left_hardpoints] {', '.join(left)}: not on the left side, where y is more than "
                "0. Correct the sign of y."
            )
        for name in ("spring", "damper"):
            length = _length(self.points(LEFT), name)
            if length < _SHORTEST and not problems:
                problems.append(
                    f"[left_hardpoints] {name}_top and {name}_seat are {1e3 * length:.3f} mm "
                    f"apart; at least {1e3 * _SHORTEST:g} mm are needed. Move one of them."
                )
        return problems

    def _problems_of_rods(self) -> list[str]:
        problems, ends = [], self.ends()
        problems += [
            f"[rods] {name!r} is no name; letters, digits, _ and - are needed, a letter first. "
            "Rename the rod."
            for name in ends
            if not re.fullmatch("[A-Za-z][A-Za-z0-9_-]*", name)
        ]
        problems += [
            f"[rods] {name!r} is the name of another part, which loads could not distinguish from "
            f"it; {', '.join(_PARTS)} are taken, with _left and _right behind them, too. "
            "Rename the rod."
            for name in ends
            if name.removesuffix("_left").removesuffix("_right") in _PARTS
        ]
        for name, (chassis, axle) in ends.items():
            length = float(np.linalg.norm(axle - chassis))
            across = float(np.hypot(*(axle - chassis)[:2]))
            if max(np.abs(chassis).max(), np.abs(axle).max()) > _LARGEST:
                problems.append(
                    f"[rods.{name}] is farther than {_LARGEST:g} m from the origin. Correct its "
                    f'points, or `unit = "{self.hardpoints.unit}"` in [hardpoints].'
                )
            elif length < _SHORTEST:
                problems.append(
                    f"[rods.{name}] chassis and axle are {1e3 * length:.3f} mm apart; at least "
                    f"{1e3 * _SHORTEST:g} mm are needed. Move one of them."
                )
            elif across < length * np.sin(np.radians(_SMALLEST_ANGLE)):
                problems.append(
                    f"[rods.{name}] is upright: at least {_SMALLEST_ANGLE:g} deg from the "
                    "vertical are needed, or the axle cannot rise. Move one of its ends."
                )
        if problems or self.overheld:
            return problems
        return Hold.of(ends, self.center).problems()

    def _refuse_rigid(self, given: Arguments, bushes: Sequence[Bush]) -> None:
        """Refuse five rods of which none deflects along itself."""
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
            given.refuse(
                f"of the five rods {', '.join(ends)} one or more must deflect along itself, or "
                "the axle neither heaves nor rolls. Give its bush axial_N_per_mm, or "
                "radial_N_per_mm where its axis is across the rod."
            )

    def _lengths_refused(self) -> list[str]:
        """Say why a damper cannot be as long as it is at design."""
        found = [
            self.damper.length_problems(_length(self.points(side), "damper")) for side in SIDES
        ]
        return list(dict.fromkeys(problem for problems in found for problem in problems))


def _length(points: Mapping[str, Array], name: str) -> float:
    return float(np.linalg.norm(points[f"{name}_top"] - points[f"{name}_seat"]))


def packaged_rigid_axles() -> dict[str, Any]:
    """Return the files of the rigid axles that come with kintrafo, by their names."""
    return data_sets(RIGID_AXLES)


def is_rigid_axle(path_or_name: str | Path) -> bool:
    """Return whether a file, or a packaged name, is that of a rigid axle.

    A file that is missing or cannot be read has none: its reader then says why.
    """
    if path_or_name in packaged_rigid_axles():
        return True
    if path_or_name in data_sets() or not Path(path_or_name).is_file():
        return False
    try:
        return RIGID_AXLE in read_toml(Path(path_or_name))
    except InputError:
        return False
