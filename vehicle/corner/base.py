"""The base of suspensions: hardpoints, alignment, rates and masses.

Each kind has a file of its own in `kinds`; `Suspension` is imported from there, so that all kinds
are registered. It has the values of the input file, in the units of its keys.
`Suspension.parameters` returns the parameters of the equations of motion, in SI units.

Axes are those of ISO 8855, fixed to the chassis: x forward, y left, z up. A right suspension is at
negative y, a left one at positive y.
"""

from abc import abstractmethod
from collections.abc import Mapping
from importlib.resources.abc import Traversable
from pathlib import Path
from types import ModuleType
from typing import Any, ClassVar, NamedTuple, Self, TypeVar, get_args

from pydantic import ConfigDict, Field, ValidationError

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.suggestions import suggestion
from ...core.validator import Validator, shown
from ...core.vectors import components
from ...systems.allowed import LengthLimit
from ..data import data_sets
from ..data.starter import AXLE, CAR, DEFAULT, not_of_a_suspension, whole_axle_in
from ..input.bodies import Bodies
from ..input.described import check_keys
from ..input.hardpoints import Hardpoints
from ..input.messages import messages_of
from ..input.pitman_arm import PitmanLinkage
from ..input.places import reverse
from ..input.stop import StopSection
from ..input.vehicle import GravitySection, Steering, TyreSection, VehicleSection, WheelSection
from .bushes import Bush, Bushings, bushes_of, mirrored_bushings, softness_of_rack
from .corner import CarrierMotion, Plane, SpringForce, Stroke, Strokes
from .drawing import Drawing
from .geometry import geometry_problems
from .structure import Structure
from .wheeled import NOT_STEERED, WheeledSection


class Names(NamedTuple):
    """The names in the equations of coordinates and inputs that every suspension has."""

    # states: angle of the lower arm, which falls as the wheel rises, and of the wheel [rad]
    arm: str
    spin: str
    # relative coordinate, and with a free rack a state: displacement of the rack [m]. Empty if the
    # wheel is not steered.
    rack: str
    actuator: str  # input: force of an actuator in the strut, or beside the spring [N]


class Extended(NamedTuple):
    """The strut or damper that limits rebound at its greatest length."""

    signal: str  # signal of its length
    length: float  # greatest length [m]
    # name, and the key of its greatest length in the file
    name: str
    key: str


# The top-level key of the kind of suspension in a file.
KIND = "suspension"
# The section that may replace that of the rack.
PITMAN_ARM = "pitman_arm"

_OTHERS = {
    AXLE: "this is the file of an axle, and one suspension is needed here. Give the hardpoint file "
    "that it names as `side`, `right` or `left`.",
    CAR: "this is the file of a car, and one suspension is needed here. Give a hardpoint file: the "
    "one that it names as `corner`, or one that the files of its axles name.",
}


def _steered_by_either(schema: dict[str, Any]) -> None:
    """Let a file have a rack or a Pitman arm, in the schema for editors."""
    required = schema.get("required", [])
    if "rack" in required:
        required.remove("rack")
        schema["oneOf"] = [{"required": ["rack"]}, {"required": [PITMAN_ARM]}]


class Suspension(WheeledSection):
    """The data of a suspension of one wheel at its design position. Immutable.

    Make one with `load`, `from_dict` or `with_changes`: they return the kind that the data name
    with ``suspension``, by default a MacPherson suspension. The attributes are the sections of the
    input file, with the file's keys and units.

    Parameters
    ----------
    **data : Any
        The sections, as in an input file.

    Raises
    ------
    InputError
        With all problems, if the data are not valid.

    Attributes
    ----------
    TITLE : str
        The name of the kind.
    NAMES : Names
        The names in its equations of those coordinates that every suspension has.
    STARTER : str
        The packaged data set from which a new file is copied.
    PAGE : str
        Text on the kind in the reference of input files.
    STOPPED : str
        Name of the element of its equations whose length the stops limit: strut or damper.

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

    model_config = ConfigDict(json_schema_extra=_steered_by_either)

    TITLE: ClassVar[str]
    NAMES: ClassVar[Names]
    STARTER: ClassVar[str]
    PAGE: ClassVar[str]
    STOPPED: ClassVar[str]

    suspension: str = Field(description="the kind of suspension")
    vehicle: VehicleSection = Field(description="where the suspension is mounted")
    hardpoints: Hardpoints = Field(description="the points that define the geometry")
    wheel: WheelSection = Field(description="alignment of the wheel")
    tyre: TyreSection = Field(description="the tyre")
    rack: Steering | None = Field(
        description="the steering rack of a steered wheel, or [pitman_arm] instead"
    )
    pitman_arm: PitmanLinkage | None = Field(
        default=None, description="a Pitman arm with relay rod and idler arm, instead of a rack"
    )
    gravity: GravitySection = Field(description="gravity")
    bodies: Bodies = Field(description="masses and inertia")
    bump_stop: StopSection | None = Field(default=None, description="the stop in bump")
    rebound_stop: StopSection | None = Field(default=None, description="the stop in rebound")
    bushings: Bushings | None = Field(
        default=None, description="the bushings at hardpoints, for compliance: see Compliance"
    )

    def __init__(self, /, **data: Any) -> None:
        problems = []
        if data.get(PITMAN_ARM) is not None:
            data.setdefault("rack", None)
        try:
            super().__init__(**data)
        except ValidationError as error:
            problems = messages_of(error, type(self), data)
        problems += geometry_problems(type(self), data, self.further_problems)
        if problems:
            raise InputError(problems)
        if self.bushings is not None:
            with Validator("bushings") as given:
                self.bushes(given, self.bushings)
                softness_of_rack(given, self.bushings)

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        """Register a kind by its name in a file."""
        for name in get_args(cls.model_fields[KIND].annotation):
            _known[name] = cls

    @classmethod
    def packaged(cls) -> Mapping[str, Traversable]:
        return data_sets()

    @classmethod
    def _called(cls) -> str:
        return "suspension"

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], source: str = "input data") -> Self:
        check_keys(source, "data", data, "keys and values of the input file")
        try:
            return _kind_of(data, cls)(**data)
        except InputError as error:
            raise InputError(error.problems, source) from None

    @classmethod
    def given(cls, given: Any, folder: Path, key: str) -> "Suspension":
        """Return the suspension that is the value of a key in the file of an axle or of a car.

        It is a suspension, the content of its file, or the name of the file; paths are relative to
        `folder`. Raises `InputError` for other values and impossible data.
        """
        if isinstance(given, Suspension):
            return given
        if isinstance(given, Mapping):
            return Suspension.from_dict(given)
        if isinstance(given, str | Path):
            packaged = isinstance(given, str) and given in data_sets()
            return Suspension.load(given if packaged else folder / given)
        problem = f"{shown(given)}: the name of a hardpoint file is needed."
        raise InputError([problem], key)

    @classmethod
    def heading(cls) -> str:
        """Return the name of the kind, as the beginning of a heading."""
        return cls.TITLE[:1].upper() + cls.TITLE[1:]

    @classmethod
    def steered(cls) -> bool:
        return bool(cls.NAMES.rack)

    def refuse_without_rack(self, what: str) -> None:
        """Raise an `InputError` for an option that needs a rack if there is none."""
        if not self.steered():
            raise InputError([NOT_STEERED.format(what)], self.TITLE)

    @property
    def steered_by(self) -> str:
        return "rack" if self.pitman_arm is None else PITMAN_ARM

    @property
    def steering_gear(self) -> Steering | PitmanLinkage:
        gear = self.rack or self.pitman_arm
        assert gear is not None  # only steered suspensions have this property
        return gear

    @property
    def carriers(self) -> Mapping[str, str]:
        """The moving body that carries each point; other points are fixed to the chassis."""
        found = self.hardpoints.CARRIERS
        if not self.steered():
            return found
        gear = self.steering_gear
        on = gear.TIE_RODS_ON
        moved = {point: on if body == "rack" else body for point, body in found.items()}
        return moved | dict.fromkeys(gear.MOVED, on)

    @property
    def carrier(self) -> str:
        """The body that carries the wheel."""
        return self.hardpoints.CARRIERS["wheel_center"]

    def mirrored(self) -> Self:
        """Return the mirror image in the plane y = 0, for the other side of the vehicle.

        The rack keeps its sense: its positive displacements have the same direction.
        """
        data = self.to_dict()
        data["vehicle"]["side"] = "left" if self.vehicle.side == "right" else "right"
        points = [data["hardpoints"][name] for name in self.hardpoints.given()]
        bodies = [data["bodies"][name] for name in self.bodies.rigid()]
        for point in points + [body["com_mm"] for body in bodies if "com_mm" in body]:
            reverse(point, 1)
        for body in bodies:
            reverse(body, "inertia_xy_kg_m2")
            reverse(body, "inertia_yz_kg_m2")
        if self.steered():
            self.steering_gear.mirror(data[self.steered_by])
        if self.bushings is not None:
            data["bushings"] = mirrored_bushings(self.bushings)
        return self.from_dict(data, "mirrored suspension")

    def bushes(self, given: Validator, described: Mapping[str, Any]) -> list[Bush]:
        """Return the described bushes; see `docs/suspension/compliance.md`.

        Parameters
        ----------
        given : Validator
            Collects problems.
        described : mapping
            By hardpoint.
        """
        sign = self.vehicle.sign
        spin = sign * self.wheel.spin_axis(sign)
        return bushes_of(given, described, self.structure(), self.hardpoints.at_design(), spin)

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return the limits of the strut's or the damper's length; empty if the file has none."""
        return ()

    def problems(self) -> list[str]:
        """Return the problems of a rack beside a Pitman arm, of neither, and of masses."""
        if not self.steered() or (self.rack is None) == (self.pitman_arm is not None):
            return self._problems_of_masses()
        if self.rack is None:
            return ["[rack] is missing: what steers the wheel. Add this section, or [pitman_arm]."]
        return ["[rack] and [pitman_arm] both steer the wheel; one is allowed. Remove the other."]

    def _problems_of_masses(self) -> list[str]:
        """Return the problems of bodies whose mass needs a free rack."""
        if self.pitman_arm is None:
            return []
        return [
            f"[bodies.{body}] mass_kg = {mass:g} kg: with a Pitman arm this body has no mass in "
            "the equations. Set it to zero."
            for body, mass in self.neglected_masses().items()
        ]

    def on_tyre(self, tyre: TyreSection) -> Self:
        """Return the suspension on another tyre.

        Its equations are the same: without a term for damping and lift-off of the tyre, these stay
        as they are.
        """
        found = super().on_tyre(tyre)
        if found.equations(free_rack=False) is self.equations(free_rack=False):
            return found
        kept = {key: getattr(self.tyre, key) for key in ("damper_rate_N_s_per_m", "lifts_off")}
        return super().on_tyre(tyre.model_copy(update=kept))

    # -- members of each kind -------------------------------------------------------------------

    @abstractmethod
    def equations(self, *, free_rack: bool) -> ModuleType:
        """Return the shortest equations with all elements of this suspension.

        With `free_rack` the rack is a degree of freedom. Raises `InputError` if there are none with
        one.
        """

    @abstractmethod
    def lengths(self) -> dict[str, float]:
        """Return the lengths at design that only this kind has, by name [m]."""

    @abstractmethod
    def drawing(self) -> Drawing:
        """Return the elements of a drawing."""

    @abstractmethod
    def structure(self) -> Structure:
        """Return the joints and force elements, for the loads on its parts."""

    @abstractmethod
    def links_at(self, points: Mapping[str, Array], travel: CarrierMotion) -> tuple[Plane, Plane]:
        """Return the planes of the links of the wheel carrier; see `Corner`.

        Parameters
        ----------
        points : mapping
            The hardpoints by name, each of shape (..., 3) [m].
        travel : CarrierMotion
            The motion of the wheel carrier per unit of wheel travel.
        """

    @abstractmethod
    def spring_at(self, strokes: Strokes) -> SpringForce:
        """Return stroke and force of the spring."""

    @abstractmethod
    def damper_at(self, strokes: Strokes) -> Stroke:
        """Return the stroke of the damper."""

    def stops_at(self, strokes: Strokes) -> tuple[SpringForce, ...]:
        """Return strokes and forces of the stops."""
        return tuple(strokes.spring(f"{side}_stop_force", self.STOPPED) for side in _sides(strokes))

    def gaps_at(self, strokes: Strokes) -> tuple[Array, ...]:
        """Return the gap of each stop [m]; the stop acts from zero gap on."""
        sense = {"bump": 1.0, "rebound": -1.0}
        length = strokes.stroke(self.STOPPED).length
        return tuple(
            sense[side] * (length - strokes.parameters[f"{side}_stop_length"])
            for side in _sides(strokes)
            if strokes.parameters[f"{side}_stop_rate"]
        )

    def extended(self) -> Extended | None:
        """Return the strut or damper at full extension; None if its length is not limited."""
        return None

    def without_friction(self) -> Self:
        """Return the suspension without friction, which may be this one."""
        return self

    def neglected_masses(self) -> dict[str, float]:
        """Return the masses by body [kg], above zero, that only equations with a free rack have."""
        return {}

    @abstractmethod
    def parameters(self) -> dict[str, float]:
        """Return the parameters of the equations of motion at design, in SI units and chassis axes.

        Names are those of the table ``PARAMETERS`` of the equations.
        """

    def shared_parameters(self, *, optional_points: bool = False) -> dict[str, float]:
        """Return the parameters of any suspension, in SI units.

        With `optional_points` the equations have the optional hardpoints. The parameters are

        - ``wheel_center_x`` and so on for every hardpoint and component, in m;
        - ``rack_axis_*``, if there is a rack, and ``spin_axis_*``, unit vectors; the spin axis is
          to the left at zero camber and toe on both sides, so that rolling forward is
          a positive rate;
        - ``tyre_rate`` in N/m and ``tyre_free_height`` in m, ``gravity`` in m/s^2;
        - ``knuckle_mass`` in kg, ``knuckle_com_*`` in m and ``knuckle_inertia_*`` in kg m^2, the
          latter the *elements* xx, yy, zz, xy, xz, yz of the tensor about the centre of mass (xy is
          minus the product of inertia); the same for all bodies but the wheel;
        - ``wheel_mass`` in kg, ``wheel_inertia_spin`` and ``wheel_inertia_diametral`` in kg m^2,
          the centre of mass at the hardpoint wheel_center.
        """
        return {
            **self.hardpoints.parameters(optional=optional_points),
            **(self.steering_gear.parameters() if self.steered() else {}),
            **components("spin_axis", self.wheel.spin_axis(self.vehicle.sign)),
            **self.tyre.parameters(),
            "gravity": self.gravity.acceleration_m_per_s2,
            **self.bodies.parameters(self.hardpoints),
        }

    def extras(self) -> list[str]:
        """Return the sections and keys of all kinds that plain equations do not have."""
        present = {
            "[bump_stop]": self.bump_stop is not None,
            "[rebound_stop]": self.rebound_stop is not None,
            "[tyre] damper_rate_N_s_per_m": self.tyre.damper_rate_N_s_per_m > 0.0,
            "[tyre] lifts_off": self.tyre.lifts_off,
        }
        return [name for name, is_present in present.items() if is_present]

    @classmethod
    def further_problems(cls, sections: Mapping[str, Any]) -> list[str]:
        """Return the problems of several sections together, from those that are valid alone."""
        return []


def _sides(strokes: Strokes) -> tuple[str, ...]:
    """Return the sides on which the equations have a stop."""
    return tuple(side for side in ("bump", "rebound") if f"{side}_stop_force" in strokes)


SuspensionT = TypeVar("SuspensionT", bound=Suspension)

_known: dict[str, type[Suspension]] = {}


def known_kinds() -> dict[str, type[Suspension]]:
    """Return the registered kinds by their names in files, the default first."""
    return dict(sorted(_known.items(), key=lambda item: item[0] != DEFAULT))


def _kind_of(data: Mapping[str, Any], wanted: type[SuspensionT]) -> type[SuspensionT]:
    """Return the class of the suspension in the unchecked content of a file.

    Raises `InputError` if the kind is unknown, or is not `wanted`, or is missing although the
    hardpoints are not those of a MacPherson suspension.
    """
    for key, problem in _OTHERS.items():
        if key in data and "hardpoints" not in data:
            raise InputError([problem])
    other = whole_axle_in(data)
    if other is not None:
        raise InputError([not_of_a_suspension(other)])
    name = data.get(KIND, DEFAULT)
    if not isinstance(name, str) or name not in _known:
        meant = suggestion(str(name), known_kinds())
        problem = f"{KIND} = {name!r} is not a known kind of suspension. {meant}"
        raise InputError([problem.rstrip()])
    if KIND not in data:
        _refuse_hardpoints_of_another(data)
    kind = _known[name]
    if issubclass(kind, wanted):
        return kind
    problem = f'{KIND} = "{name}": a {wanted.TITLE} is needed here. Load it with Suspension.'
    raise InputError([problem])


def _refuse_hardpoints_of_another(data: Mapping[str, Any]) -> None:
    """Refuse data without a kind whose hardpoints are not those of the default kind."""
    points = data.get("hardpoints")
    if not isinstance(points, Mapping):
        return
    own = _points_of(DEFAULT)
    for name, kind in _known.items():
        strange = [point for point in points if point in _points_of(name) - own]
        if strange:
            problem = (
                f"[hardpoints] {', '.join(map(str, strange))} are points of a {kind.TITLE}. Add a "
                f'line `{KIND} = "{name}"` above the first section.'
            )
            raise InputError([problem])


def _points_of(name: str) -> set[str]:
    """Return the names of the hardpoints of a kind."""
    hardpoints = _known[name].model_fields["hardpoints"].annotation
    return set(getattr(hardpoints, "model_fields", ()))
