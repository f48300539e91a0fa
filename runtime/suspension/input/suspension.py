"""A suspension as an engineer describes it: hardpoints, alignment, rates and masses.

`Suspension` is what all have in common; each kind has a file of its own. It holds the values as
they stand in the input file, in the units that the names of its keys carry.
`Suspension.parameters` returns what the equations of motion take, in SI units.

Axes are those of ISO 8855, fixed to the chassis: x forward, y left, z up. A right suspension lies
at negative y, a left one at positive y.
"""

from abc import abstractmethod
from collections.abc import Mapping
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, Self

from pydantic import Field, ValidationError

from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.files import told
from ...core.suggestions import suggestion
from .. import data as packaged_data
from .bodies import Bodies
from .hardpoints import Hardpoints
from .messages import messages_of, subsection
from .section import Section
from .toml_file import read_toml
from .units import in_metres
from .vectors import angle_between_lines, components, unit_vector
from .vehicle import Gravity, Steering, Tyre, Vehicle, Wheel

# The top-level key that says which suspension a file describes.
KIND = "suspension"

# A wheel nearer to the vehicle's centre plane than this is on neither side, in m.
_SMALLEST_HALF_TRACK = 0.001
# A wheel centre lower than this above z = 0 says that z = 0 is not the ground, in m.
_SMALLEST_WHEEL_RADIUS = 0.1
# Nearer to the axis of steering than this, the spin axis would make the wheel turn instead of
# steer, in degrees.
_SMALLEST_SPIN_AXIS_ANGLE = 1.0

_COMPONENTS = {"x": 0, "y": 1, "z": 2}


class Allowed(NamedTuple):
    """What a length may be, as the file says.

    Attributes
    ----------
    signal : str
        The signal of the equations that is the length.
    limit : float
        The least length; the greatest, with a minus sign [m].
    meaning : str
        What it means that the length is there.
    """

    signal: str
    limit: float
    meaning: str


class Suspension(Section):
    """A suspension at its design position. Immutable.

    Make one with `load`, `from_dict` or `with_changes`: they return the kind that the data name
    with ``suspension``, a MacPherson suspension where they do not say. The attributes are the
    sections of the input file, with the file's keys and units.

    Parameters
    ----------
    **data : Any
        The sections, as in an input file.

    Raises
    ------
    InputError
        With all problems, if a suspension cannot be like this.

    Attributes
    ----------
    TITLE : str
        What the suspension is called.

    Examples
    --------
    >>> from kintrafo import Suspension
    >>> car = Suspension.load("reference_car")
    >>> car.vehicle.side, car.strut.spring_rate_N_per_m
    ('right', 25000.0)
    >>> car.parameters()["ball_joint_y"]
    -0.71
    >>> Suspension.load("double_wishbone_car").TITLE
    'double wishbone suspension'
    """

    TITLE: ClassVar[str]

    suspension: str = Field(description="the kind of suspension")
    vehicle: Vehicle = Field(description="where the suspension is mounted")
    hardpoints: Hardpoints = Field(description="the points that define the geometry")
    wheel: Wheel = Field(description="alignment of the wheel")
    tyre: Tyre = Field(description="the tyre")
    rack: Steering = Field(description="the steering rack")
    gravity: Gravity = Field(description="gravity")
    bodies: Bodies = Field(description="masses and inertia")

    def __init__(self, /, **data: Any) -> None:
        problems = []
        try:
            super().__init__(**data)
        except ValidationError as error:
            problems = messages_of(error, type(self), data)
        problems += _geometry_problems(type(self), data)
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
            The suspension, of the kind that the file names.

        Raises
        ------
        InputError
            If the file cannot be read or no suspension can be like this; it lists everything that
            is wrong.
        """
        with Arguments(cls.__name__) as given:
            given.path("path_or_name", path_or_name)
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
            The suspension, of the kind that the data name.

        Raises
        ------
        InputError
            If no suspension can be like this; it lists everything that is wrong.
        """
        _check_keys("data", data, source)
        # here, because a kind is made from this class
        from ..kinds import kind_of  # noqa: PLC0415

        try:
            return kind_of(data, cls)(**data)
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
        _check_keys("changes", changes, "suspension")
        data = self.to_dict()
        source = f"suspension with changed {', '.join(changes)}"
        problems = [problem for place in changes if (problem := _put(data, place, changes[place]))]
        if problems:
            raise InputError(problems, source)
        return self.from_dict(data, source)

    @classmethod
    def heading(cls) -> str:
        """Return what the suspension is called, as the beginning of a heading."""
        return cls.TITLE[:1].upper() + cls.TITLE[1:]

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

    def allowed_lengths(self) -> tuple[Allowed, ...]:
        """Return the lengths that positions must keep, besides closing the loops.

        Returns
        -------
        tuple of Allowed
            Of what can be drawn in or out; empty where the file gives no limit.
        """
        return ()

    @abstractmethod
    def parameters(self) -> dict[str, float]:
        """Return everything that the equations of motion need, in SI units.

        Returns
        -------
        dict of str to float
            At the design position, in chassis axes; names as in the table ``PARAMETERS`` of the
            equations.
        """

    def shared_parameters(self, *, optional_points: bool = False) -> dict[str, float]:
        """Return the parameters that any suspension has, in SI units.

        Parameters
        ----------
        optional_points : bool, optional
            Whether the equations take the hardpoints that a file may leave out.

        Returns
        -------
        dict of str to float
            - ``wheel_center_x`` and so on for every hardpoint and component, in m;
            - ``rack_axis_*`` and ``spin_axis_*``, unit vectors; the spin axis points left at zero
              camber and toe on both sides, so that rolling forward is a positive rate;
            - ``tyre_rate`` in N/m and ``tyre_free_height`` in m, ``gravity`` in m/s^2;
            - ``knuckle_mass`` in kg, ``knuckle_com_*`` in m and ``knuckle_inertia_*`` in kg m^2,
              the latter the *elements* xx, yy, zz, xy, xz, yz of the tensor about the centre of
              mass (xy is minus the product of inertia); so for every other body but the wheel;
            - ``wheel_mass`` in kg, ``wheel_inertia_spin`` and ``wheel_inertia_diametral`` in
              kg m^2 (its centre of mass is the hardpoint wheel_center).
        """
        return {
            **self.hardpoints.parameters(optional=optional_points),
            **components("rack_axis", unit_vector(self.rack.axis)),
            **components("spin_axis", self.wheel.spin_axis(self.vehicle.sign)),
            **self.tyre.parameters(),
            "gravity": self.gravity.acceleration_m_per_s2,
            **self.bodies.parameters(self.hardpoints),
        }

    @classmethod
    def further_problems(cls, sections: Mapping[str, Any]) -> list[str]:
        """Say what is wrong among sections of this kind of suspension.

        Parameters
        ----------
        sections : mapping
            The sections that are right in themselves, the hardpoints among them.

        Returns
        -------
        list of str
        """
        del sections  # nothing that every kind has
        return []


def _check_keys(name: str, given: Any, source: str) -> None:
    """Refuse what is no dict with texts as keys."""
    with Arguments(source) as checked:
        for key in checked.mapping(name, given, "keys and values of the input file"):
            checked.kind(f"key of {name}", key, str, "a text is needed")


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
    with told(path, "cannot be read"):
        found = path.exists()
    if not found:
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


def _valid(kind: type[Suspension], data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the sections that are right, whatever the others are; None for one left out."""
    sections: dict[str, Any] = {}
    for name, field in kind.model_fields.items():
        model = subsection(kind, name)
        if model is None:
            continue
        if data.get(name) is None and not field.is_required():
            sections[name] = None
            continue
        try:
            sections[name] = model.model_validate(data.get(name))
        except ValidationError:
            continue
    return sections


def _geometry_problems(kind: type[Suspension], data: Mapping[str, Any]) -> list[str]:
    """Say what is wrong with the geometry, as far as the sections that define it are right."""
    sections = _valid(kind, data)
    hardpoints = sections.get("hardpoints")
    if hardpoints is None:
        return []
    problems: list[str] = hardpoints.unit_problems()
    if problems:
        return problems
    problems = hardpoints.geometry_problems()
    vehicle, wheel = sections.get("vehicle"), sections.get("wheel")
    if vehicle is not None:
        problems += _wrong_side(vehicle, hardpoints)
    if vehicle is not None and wheel is not None:
        problems += _spin_axis_along_steering_axis(vehicle, wheel, hardpoints)
    return problems + kind.further_problems(sections)


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


def _spin_axis_along_steering_axis(
    vehicle: Vehicle, wheel: Wheel, hardpoints: Hardpoints
) -> list[str]:
    """Refuse a wheel that would spin when it should steer."""
    axis = hardpoints.steering_axis()
    if axis is None:
        return []
    angle = angle_between_lines(wheel.spin_axis(vehicle.sign), axis)
    if angle >= _SMALLEST_SPIN_AXIS_ANGLE:
        return []
    problem = (
        f"[wheel] camber_deg = {wheel.camber_deg} deg and toe_deg = {wheel.toe_deg} deg put the "
        f"spin axis within {angle:.3f} deg of the {hardpoints.AXIS_NAME}; at least "
        f"{_SMALLEST_SPIN_AXIS_ANGLE:g} deg are needed to steer the wheel. Correct the angles, or "
        f"{hardpoints.text(*hardpoints.STEERING_AXIS)}."
    )
    return [problem]
