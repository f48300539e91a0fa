"""A MacPherson suspension as an engineer describes it: hardpoints, alignment, rates and masses.

`Suspension` holds the values as they stand in the input file, in the units that the names of its
keys carry. `Suspension.parameters` returns what the equations of motion take, in SI units.

Axes are those of ISO 8855, fixed to the chassis: x forward, y left, z up. A right suspension lies
at negative y, a left one at positive y.
"""

import math
from collections.abc import Mapping
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import Field, ValidationError

from .. import data as packaged_data
from ..errors import InputError
from .bodies import Bodies
from .damper import Damper
from .hardpoints import Hardpoints
from .messages import messages_of
from .section import Flag, NonNegative, Number, Positive, Range, Section, Triple
from .strut import Stop, Strut
from .suggestions import suggestion
from .toml_file import read_toml
from .units import in_metres
from .vectors import Vector, angle_between_lines, components, unit_vector

NO_DAMPER = Damper(velocity_m_per_s=(-1.0, 1.0), force_N=(0.0, 0.0))
NO_STOP = Stop(clearance_mm=0.0, rate_N_per_m=0.0)

SectionT = TypeVar("SectionT", bound=Section)

# A wheel nearer to the vehicle's centre plane than this is on neither side, in m.
_SMALLEST_HALF_TRACK = 0.001
# A wheel centre lower than this above z = 0 says that z = 0 is not the ground, in m.
_SMALLEST_WHEEL_RADIUS = 0.1
# Nearer to the strut axis than this, the spin axis would make the wheel turn instead of steer.
_SMALLEST_SPIN_AXIS_ANGLE = 1.0

_COMPONENTS = {"x": 0, "y": 1, "z": 2}

Angle = Annotated[
    Number,
    Field(ge=-45.0, le=45.0),
    Range(
        "-45 {unit} to 45 {unit}",
        "Enter the angle at design in degrees, with the sign that the file states.",
    ),
]


Share = Annotated[
    Number,
    Field(ge=0.0, le=1.0),
    Range("0 to 1", "Enter the part of the whole: 0.7 for 70 %."),
]


class Vehicle(Section):
    """The side that the suspension is on, and what the whole vehicle adds to its characteristics.

    Only the side enters the equations of motion.
    """

    side: Literal["left", "right"] = Field(description="the vehicle's side, left or right")
    wheelbase_mm: Positive | None = Field(
        default=None, description="distance of front and rear wheel centres along x"
    )
    center_of_gravity_height_mm: Positive | None = Field(
        default=None, description="height of the whole vehicle's centre of gravity above the ground"
    )
    front_brake_share: Share | None = Field(
        default=None, description="part of the braking force that acts at the front wheels"
    )

    @property
    def sign(self) -> float:
        """The sign of y at the wheel: +1 left, -1 right."""
        return 1.0 if self.side == "left" else -1.0


class Wheel(Section):
    """Alignment of the wheel at the design position.

    Camber is positive with the wheel's top outboard, toe is positive with its front inboard.
    """

    camber_deg: Angle = Field(description="camber at design, positive with the top outboard")
    toe_deg: Angle = Field(description="toe at design, positive toe-in")

    def spin_axis(self, side_sign: float) -> Vector:
        """Return the direction of the spin axis that points left at zero camber and toe.

        Parameters
        ----------
        side_sign : float
            +1 for a left, -1 for a right suspension.

        Returns
        -------
        numpy.ndarray
            Unit vector in chassis axes.
        """
        # The unit vector n that points outboard has camber = atan2(-n_z, s n_y) and
        # toe = atan2(n_x, s n_y), hence n ~ (tan toe, s, -tan camber); the spin axis is s n.
        toe, camber = math.radians(self.toe_deg), math.radians(self.camber_deg)
        return unit_vector([side_sign * math.tan(toe), 1.0, -side_sign * math.tan(camber)]) + 0.0


class Tyre(Section):
    """The tyre as a vertical spring in the plane of the wheel."""

    rate_N_per_m: NonNegative = Field(  # noqa: N815 (N is the newton)
        description="rate of the tyre"
    )
    free_height_mm: Number = Field(description="z of wheel_center with the tyre force-free")
    radius_mm: Positive | None = Field(
        default=None,
        description="radius of the wheel as a thin disc that touches the ground; only for "
        "characteristics, left out: the height of wheel_center above z = 0",
    )

    damper_rate_N_s_per_m: NonNegative = Field(  # noqa: N815 (N is the newton)
        default=0.0, description="radial damping of the tyre"
    )
    lifts_off: Flag = Field(
        default=False,
        description="true: the tyre can leave the road; false, as in the paper: it holds on to it",
    )

    def parameters(self) -> dict[str, float]:
        """Return the rate in N/m and the height in m by the names in the equations."""
        return {
            "tyre_rate": self.rate_N_per_m,
            "tyre_free_height": in_metres(self.free_height_mm, "mm"),
        }


class Steering(Section):
    """The steering rack."""

    axis: Triple = Field(description="direction in which the rack moves for positive displacement")
    travel_per_turn_mm: Positive | None = Field(
        default=None, description="rack travel for one turn of the steering wheel"
    )

    def problems(self) -> list[str]:
        """Refuse an axis that points nowhere."""
        length = math.hypot(*self.axis)
        if 1e-6 < length < math.inf:
            return []
        problem = (
            f"axis = {list(self.axis)} (without unit) has the length {length:g} and no direction; "
            "allowed are lengths of more than 1e-6. Enter [0.0, 1.0, 0.0] for a rack that moves "
            "to the left."
        )
        return [problem]


class Gravity(Section):
    """Gravity, which acts downward (-z)."""

    acceleration_m_per_s2: NonNegative = Field(description="acceleration of free fall")


class Suspension(Section):
    """A MacPherson suspension at its design position. Immutable.

    Make one with `load`, `from_dict` or `with_changes`. Its attributes are the sections of the
    input file, with the file's keys and units.

    Parameters
    ----------
    **data : Any
        The sections, as in an input file.

    Raises
    ------
    InputError
        With all problems, if a suspension cannot be like this.

    Examples
    --------
    >>> from kintrafo import Suspension
    >>> car = Suspension.load("reference_car")
    >>> car.vehicle.side, car.strut.spring_rate_N_per_m
    ('right', 25000.0)
    >>> car.parameters()["ball_joint_y"]
    -0.71
    """

    vehicle: Vehicle = Field(description="where the suspension is mounted")
    hardpoints: Hardpoints = Field(description="the points that define the geometry")
    wheel: Wheel = Field(description="alignment of the wheel")
    strut: Strut = Field(description="spring and damper")
    tyre: Tyre = Field(description="the tyre")
    rack: Steering = Field(description="the steering rack")
    gravity: Gravity = Field(description="gravity")
    bodies: Bodies = Field(description="masses and inertia")
    damper: Damper | None = Field(default=None, description="a damper curve instead of a rate")
    bump_stop: Stop | None = Field(default=None, description="the strut's stop in bump")
    rebound_stop: Stop | None = Field(default=None, description="the strut's stop in rebound")

    def __init__(self, /, **data: Any) -> None:
        problems = []
        try:
            super().__init__(**data)
        except ValidationError as error:
            problems = messages_of(error, type(self), data)
        problems += _geometry_problems(data)
        if problems:
            raise InputError(problems)

    @classmethod
    def load(cls, path_or_name: str | Path) -> Self:
        """Read a suspension from a TOML file.

        Parameters
        ----------
        path_or_name : str or pathlib.Path
            The file; or, as a string, the name of one that comes with kintrafo:
            ``"reference_car"``.

        Returns
        -------
        Suspension
            The suspension.

        Raises
        ------
        InputError
            If the file cannot be read or no suspension can be like this; it lists everything that
            is wrong.
        """
        file = _find(path_or_name)
        # Printing the path inside the package would not help whoever asked for a name.
        return cls.from_dict(read_toml(file), source=str(path_or_name))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], source: str = "input data") -> Self:
        """Make a suspension from nested dictionaries with the keys of the input file.

        Parameters
        ----------
        data : mapping
            The sections, with their keys and units as in the file.
        source : str, optional
            Where the data come from, for error messages.

        Returns
        -------
        Suspension
            The suspension.

        Raises
        ------
        InputError
            If no suspension can be like this; it lists everything that is wrong.
        """
        try:
            return cls(**data)
        except InputError as error:
            raise InputError(error.problems, source) from None

    def to_dict(self) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged.

        Returns
        -------
        dict
            A copy of all values, with the keys and units of the input file; points are lists.
        """
        return self.model_dump(mode="json", exclude_none=True)

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return a suspension that differs in some values; all checks are made again.

        Parameters
        ----------
        changes : mapping of str to Any
            For each place in the file, section and key with dots between them, the new value in
            the file's unit. A component of a point is a place too. None removes an optional key.

        Returns
        -------
        Suspension
            The changed suspension.

        Raises
        ------
        InputError
            If there is no such place, or no suspension can be like this.

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> car = Suspension.load("reference_car")
        >>> stiffer = car.with_changes(
        ...     {"strut.spring_rate_N_per_m": 30e3, "hardpoints.ball_joint.z": 185.0}
        ... )
        >>> stiffer.hardpoints.ball_joint
        (5.0, -710.0, 185.0)
        """
        data = self.to_dict()
        source = f"suspension with changed {', '.join(changes)}"
        problems = [problem for place in changes if (problem := _put(data, place, changes[place]))]
        if problems:
            raise InputError(problems, source)
        return self.from_dict(data, source)

    def tyre_radius(self) -> float | None:
        """Return the radius of the wheel as a thin disc.

        Returns
        -------
        float or None
            ``tyre.radius_mm`` in m where it is given. Otherwise the height of the wheel centre at
            design above z = 0, which is the ground in files that follow the conventions; None where
            that is less than 100 mm, as no car has such wheels.
        """
        if self.tyre.radius_mm is not None:
            return in_metres(self.tyre.radius_mm, "mm")
        height = float(self.hardpoints.metres("wheel_center")[2])
        return height if height >= _SMALLEST_WHEEL_RADIUS else None

    def mirrored(self) -> Self:
        """Return the same suspension on the other side of the vehicle.

        The rack keeps its sense: what moved it to the left still does.

        Returns
        -------
        Suspension
            The mirror image in the plane y = 0.
        """
        data = self.to_dict()
        data["vehicle"]["side"] = "left" if self.vehicle.side == "right" else "right"
        points = [data["hardpoints"][name] for name in self.hardpoints.given()]
        bodies = [data["bodies"][name] for name in self.bodies.rigid()]
        for point in points + [body["com_mm"] for body in bodies if "com_mm" in body]:
            _reverse(point, 1)
        for body in bodies:
            _reverse(body, "inertia_xy_kg_m2")
            _reverse(body, "inertia_yz_kg_m2")
        # The mirror image of (x, y, z) is (x, -y, z), which with the sense kept is (-x, y, -z).
        _reverse(data["rack"]["axis"], 0)
        _reverse(data["rack"]["axis"], 2)
        return self.from_dict(data, "mirrored suspension")

    def parameters(self) -> dict[str, float]:
        """Return everything that the equations of motion need, in SI units.

        Returns
        -------
        dict of str to float
            At the design position, in chassis axes:

            - ``arm_front_x`` and so on for every hardpoint and component, in m;
            - ``rack_axis_*`` and ``spin_axis_*``, unit vectors; the spin axis points left at zero
              camber and toe on both sides, so that rolling forward is a positive rate;
            - ``strut_length_max`` and ``spring_free_slide`` in m, ``spring_rate`` in N/m,
              ``damper_rate`` in N s/m; with anything of `beyond_the_paper` instead of the slide
              ``spring_free_length``, and what ``generated.macpherson_general`` lists besides;
            - ``tyre_rate`` in N/m and ``tyre_free_height`` in m, ``gravity`` in m/s^2;
            - ``control_arm_mass`` in kg, ``control_arm_com_*`` in m and ``control_arm_inertia_*``
              in kg m^2, the latter the *elements* xx, yy, zz, xy, xz, yz of the tensor about the
              centre of mass (xy is minus the product of inertia); so for ``knuckle``, ``tie_rod``,
              ``rack`` and ``upper_strut``;
            - ``wheel_mass`` in kg, ``wheel_inertia_spin`` and ``wheel_inertia_diametral`` in
              kg m^2 (its centre of mass is the hardpoint wheel_center).

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> Suspension.load("reference_car").parameters()["strut_length_max"]
        0.85
        """
        general = bool(self.beyond_the_paper())
        values = {
            **self.hardpoints.parameters(optional=general),
            **components("rack_axis", unit_vector(self.rack.axis)),
            **components("spin_axis", self.wheel.spin_axis(self.vehicle.sign)),
            **self.strut.parameters(self.damper),
            **self.tyre.parameters(),
            "gravity": self.gravity.acceleration_m_per_s2,
            **self.bodies.parameters(self.hardpoints),
        }
        seats = self.hardpoints.distance("spring_seat", "spring_top")
        if not general:
            return values | {"spring_free_slide": self.strut.free_slide(seats)}
        return (
            values
            | self._general_parameters()
            | {"spring_free_length": self.strut.free_length(seats)}
        )

    def _general_parameters(self) -> dict[str, float]:
        """Return what only the equations of the general suspension take, in SI units."""
        length = self.hardpoints.distance("strut_lower", "strut_top")
        stops = {"bump": self.bump_stop, "rebound": self.rebound_stop}
        values = (self.damper or NO_DAMPER).parameters()
        for side, stop in stops.items():
            values |= (stop or NO_STOP).parameters(side, length)
        return values | {
            "strut_friction": self.strut.friction_N,
            "strut_friction_speed": self.strut.friction_velocity_m_per_s,
            "tyre_damper_rate": self.tyre.damper_rate_N_s_per_m,
            "tyre_lifts_off": float(self.tyre.lifts_off),
        }

    def beyond_the_paper(self) -> list[str]:
        """Return what this suspension has that the paper's equations leave out.

        Returns
        -------
        list of str
            Sections and keys; empty for the paper's suspension.

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> car = Suspension.load("reference_car")
        >>> car.beyond_the_paper(), car.with_changes({"tyre.lifts_off": True}).beyond_the_paper()
        ([], ['[tyre] lifts_off'])
        """
        points, strut, tyre = self.hardpoints, self.strut, self.tyre
        optional = points.given()[len(points.names()) :]
        present = {
            **{f"[hardpoints] {name}": True for name in optional},
            "[strut] friction_N": strut.friction_N > 0.0,
            "[damper]": self.damper is not None,
            "[bump_stop]": self.bump_stop is not None,
            "[rebound_stop]": self.rebound_stop is not None,
            "[tyre] damper_rate_N_s_per_m": tyre.damper_rate_N_s_per_m > 0.0,
            "[tyre] lifts_off": tyre.lifts_off,
        }
        return [name for name, is_present in present.items() if is_present]


def _find(path_or_name: str | Path) -> Path | Traversable:
    """Return the packaged file of this name, or else the file at this path."""
    packaged = {
        file.name.removesuffix(".toml"): file
        for file in resources.files(packaged_data).iterdir()
        if file.name.endswith(".toml")
    }
    if isinstance(path_or_name, str) and path_or_name in packaged:
        return packaged[path_or_name]
    path = Path(path_or_name)
    if not path.exists():
        hint = suggestion(path.name, packaged)
        problem = f"There is no such file. Give the path of a TOML file, or a packaged name. {hint}"
        raise InputError([problem], str(path_or_name))
    return path


def _put(data: dict[str, Any], place: str, value: Any) -> str:
    """Change one value of nested dictionaries, in which points are lists.

    Returns what is wrong with the place; empty if nothing is. A key that is not known is left to
    the checks of the section.
    """
    *sections, key = place.split(".")
    table: Any = data
    for section in sections:
        known = table if isinstance(table, dict) else {}
        if section not in known:
            return f"{place}: there is no {section} in the data. {suggestion(section, known)}"
        table = known[section]
    if isinstance(table, dict):
        table[key] = value
        return ""
    if isinstance(table, list) and key in _COMPONENTS:
        table[_COMPONENTS[key]] = value
        return ""
    return f"{place}: {key} is no part of {sections[-1]}. Points have x, y and z; numbers no parts."


def _reverse(values: Any, index: int | str) -> None:
    """Change the sign of one value in a list or a dictionary."""
    values[index] = 0.0 - values[index]  # unlike -x, this leaves no negative zero


def _valid(model: type[SectionT], table: object) -> SectionT | None:
    """Return a section of a file whose other sections may be wrong; None if it is wrong itself."""
    try:
        return model.model_validate(table)
    except ValidationError:
        return None


def _geometry_problems(data: Mapping[str, Any]) -> list[str]:
    """Say what is wrong with the geometry, as far as the sections that define it are right."""
    hardpoints = _valid(Hardpoints, data.get("hardpoints"))
    if hardpoints is None:
        return []
    problems = hardpoints.unit_problems()
    if problems:
        return problems
    problems = hardpoints.geometry_problems()
    vehicle = _valid(Vehicle, data.get("vehicle"))
    wheel = _valid(Wheel, data.get("wheel"))
    strut = _valid(Strut, data.get("strut"))
    if vehicle is not None:
        problems += _wrong_side(vehicle, hardpoints)
    if vehicle is not None and wheel is not None and hardpoints.has_strut_axis():
        problems += _spin_axis_along_strut(vehicle, wheel, hardpoints)
    if strut is not None:
        problems += _strut_too_long(strut, hardpoints)
        problems += strut.spring_problems(hardpoints)
        problems += _damper_problems(strut, with_curve=data.get("damper") is not None)
    return problems


def _wrong_side(vehicle: Vehicle, hardpoints: Hardpoints) -> list[str]:
    """Compare the declared side with that of the wheel."""
    if vehicle.sign * hardpoints.metres("wheel_center")[1] >= _SMALLEST_HALF_TRACK:
        return []
    half = "above" if vehicle.side == "left" else "below"
    limit = 1000.0 * vehicle.sign * _SMALLEST_HALF_TRACK
    problem = (
        f'[vehicle] side = "{vehicle.side}", but {hardpoints.text("wheel_center")}: '
        f"y points left, so a {vehicle.side} wheel must have y {half} {limit:g} mm. Change "
        "side, or the sign of y of all hardpoints."
    )
    return [problem]


def _spin_axis_along_strut(vehicle: Vehicle, wheel: Wheel, hardpoints: Hardpoints) -> list[str]:
    """Refuse a wheel that would spin when it should steer."""
    angle = angle_between_lines(wheel.spin_axis(vehicle.sign), hardpoints.strut_axis())
    if angle >= _SMALLEST_SPIN_AXIS_ANGLE:
        return []
    problem = (
        f"[wheel] camber_deg = {wheel.camber_deg} deg and toe_deg = {wheel.toe_deg} deg put the "
        f"spin axis within {angle:.3f} deg of the strut axis; at least "
        f"{_SMALLEST_SPIN_AXIS_ANGLE:g} deg are needed to steer the wheel. Correct the angles, or "
        f"{hardpoints.text('ball_joint', 'strut_top')}."
    )
    return [problem]


def _damper_problems(strut: Strut, *, with_curve: bool) -> list[str]:
    """See that the damper is given once."""
    if (strut.damper_rate_N_s_per_m is None) == with_curve:
        return []
    if with_curve:
        problem = (
            f"[strut] damper_rate_N_s_per_m = {strut.damper_rate_N_s_per_m} N s/m and [damper] "
            "both describe the damper; one is allowed. Remove the other."
        )
        return [problem]
    problem = (
        "[strut] damper_rate_N_s_per_m is missing: rate of the damper, unless a section [damper] "
        "has its curve. Add a line `damper_rate_N_s_per_m = ...`, in N s/m."
    )
    return [problem]


def _strut_too_long(strut: Strut, hardpoints: Hardpoints) -> list[str]:
    """Refuse a strut that is longer at design than when it is fully extended."""
    length = 1000.0 * hardpoints.distance("strut_lower", "strut_top")
    lower = "ball_joint" if hardpoints.strut_lower is None else "strut_lower"
    if strut.length_max_mm >= length:
        return []
    limit = math.ceil(10.0 * length) / 10.0  # rounded up, so that the printed value is accepted
    problem = (
        f"[strut] length_max_mm = {strut.length_max_mm} mm is less than the length at design; "
        f"allowed is {limit:.1f} mm or more, the distance of {lower} and strut_top. Raise "
        "it, or correct these hardpoints."
    )
    return [problem]
