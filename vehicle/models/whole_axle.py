"""The base of axles without sides, such as a rigid axle."""

from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from importlib import import_module
from importlib.resources.abc import Traversable
from types import ModuleType
from typing import TYPE_CHECKING, Any, ClassVar, Self, get_args

import numpy as np
from pydantic import ValidationError

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from ...core.vectors import MIRROR, components
from ...systems.allowed import LengthLimit
from ...systems.compile.build import require_generator
from ..corner.bushes import Bush
from ..corner.structure import FORCES_OF_A_DAMPER, LineForce, Structure
from ..corner.wheeled import WheeledSection
from ..data import data_sets
from ..data.starter import WHOLE_AXLES, words_of
from ..input.described import check_keys
from ..input.messages import messages_of
from .plausibility import (
    Plausibility,
    beyond_the_table,
    centres_of_mass,
    stray_points,
    unlikely_bushings,
    unlikely_inertia,
    unlikely_rates,
    unlikely_tyre,
    unlikely_vehicle,
    unlikely_wheel,
    unusual_alignment,
)
from .sides import LEFT, RIGHT, SIDES

if TYPE_CHECKING:
    from ..corner.coil_sprung import ApartDamper
    from ..input.bodies import RigidBody
    from ..input.spring import SpringSection
    from .axle.file import Brakes, End
    from .whole_axle_file import AxleDrive, WholeAxleVehicle

# Least distance of a wheel centre from the vehicle's centre plane [m].
_SMALLEST_HALF_TRACK = 0.1
# Least length of a spring or a damper [m].
SHORTEST = 0.001
# The signals and inputs of a side that sum up to the force of a spring or a damper.
_FORCES = {
    "spring": ("spring_spring_force", "spring_actuator"),
    "damper": tuple(f"damper_{name}" for name in FORCES_OF_A_DAMPER),
}
CHASSIS = "chassis"


class WholeAxle(WheeledSection):
    """An axle with both wheels in one file, at its design position. Immutable.

    Make one with `load`, `from_dict` or `with_changes`. The attributes are the sections of the
    file, with the file's keys and units; each class has them in the order of its file.

    Parameters
    ----------
    **data : Any
        The sections, as in a file.

    Raises
    ------
    InputError
        With all problems, if the data are not valid.

    Attributes
    ----------
    KEY : str
        The top-level key of such a file, whose value is the end of the vehicle: the name of the
        data set, see `data.starter.whole_axles`.
    NEEDED : str
        The message about other objects.
    PAGE : str
        The text in the reference of input files before its sections; Markdown.
    """

    KEY: ClassVar[str]
    NEEDED: ClassVar[str]
    PAGE: ClassVar[str]

    if TYPE_CHECKING:
        # sections of every class, each in the order of its file
        vehicle: WholeAxleVehicle
        spring: SpringSection
        damper: ApartDamper
        brakes: Brakes
        drive: AxleDrive | None
        bodies: Any

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise InputError(messages_of(error, type(self), data)) from None
        problems = self._problems_of_points() or self._own_problems() or self._lengths_refused()
        if problems:
            raise InputError(problems)
        if self.bushings is not None:
            with Validator("bushings") as given:
                self._check_bushes(given, self.bushes(given, self.bushings))

    # -- making one -----------------------------------------------------------------------------

    @classmethod
    def packaged(cls) -> Mapping[str, Traversable]:
        return data_sets(WHOLE_AXLES)

    @classmethod
    def _called(cls) -> str:
        return cls.KEY.replace("_", " ")

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], source: str = "input data") -> Self:
        check_keys(source, "data", data, f"keys and values of {words_of(cls.KEY)}'s file")
        if cls.KEY not in data:
            first, *others = reversed(get_args(cls.model_fields[cls.KEY].annotation))
            line = " or ".join([f'`{cls.KEY} = "{first}"`', *(f'"{end}"' for end in others)])
            problem = (
                f"{cls.KEY} is missing: where the axle is. Add a line {line}; "
                f"`kintrafo new FILE --suspension {cls.KEY}` writes such a file."
            )
            raise InputError([problem], source)
        try:
            return cls(**data)
        except InputError as error:
            raise InputError(error.problems, source) from None

    # -- its properties -------------------------------------------------------------------------

    @abstractmethod
    def heading(self) -> str:
        """Return the name of the axle."""

    @property
    def end(self) -> "End":
        """The end of the vehicle, 'front' or 'rear'."""
        return getattr(self, self.KEY)

    @property
    def overheld(self) -> bool:
        """Whether it moves only as its bushes deflect."""
        return False

    # -- interface for a car ----------------------------------------------------------------------

    whole: ClassVar[bool] = True
    """Whether it has no sides."""
    steering: ClassVar[None] = None
    """It has no curve of the steering."""
    rack_name: ClassVar[str] = ""
    """The name of the displacement of its steering in the equations; empty without steering."""
    link_part: ClassVar[str] = ""
    """No part has drop links."""

    @property
    def wheel_centers(self) -> dict[str, Array]:
        """The wheel centres at design by side [m]."""
        return {side: self.points(side)["wheel_center"] for side in SIDES}

    @property
    def equations_name(self) -> str:
        """The name of its equations."""
        return self.KEY

    def parameters_of_masses(self) -> list[Mapping[str, float]]:
        """Return the parameters of each side, with the names of the right one for both."""
        values = self.parameters()
        right = {name: value for name, value in values.items() if not name.startswith("left_")}
        return [right, of_side(values, LEFT)]

    def parameters_in_a_car(self) -> dict[str, float]:
        """Return the parameters by their names in the equations of a car."""
        require_generator()
        from ...generator.mechanisms import model_named  # noqa: PLC0415 (an extra)

        values, mechanism = self.parameters(), model_named(self.equations_name).mechanism
        known: dict[str, float] = {p.name: p.default for p in mechanism.parameters} | values
        # in a car the mirror images of values of one side have names and values of their own
        images = {
            name: float(value.xreplace({one: known[one.name] for one in value.free_symbols}))
            for name, value in mechanism.derived.items()
        }
        return values | images | {"right_gravity": values["gravity"]}

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return the lengths of the dampers that the file allows."""
        return tuple(
            one._replace(part=f"{side} {one.part}")
            for side in SIDES
            for one in self.damper.allowed_lengths(f"{side}_damper_length")
        )

    @property
    def center(self) -> Array:
        """The middle between the wheels at design [m]."""
        return self.hardpoints.metres("wheel_center") * [1.0, 0.0, 1.0]

    @property
    def half_track(self) -> float:
        """Half the distance of the wheel centres [m]."""
        return -float(self.hardpoints.metres("wheel_center")[1])

    def points(self, side: str) -> dict[str, Array]:
        """Return the hardpoints of a side at design [m]."""
        with Validator("points") as given:
            given.among("side", side, (RIGHT, LEFT))
        found = self.hardpoints.at_design()
        if side == RIGHT:
            return found
        return {name: point * MIRROR for name, point in found.items()} | self._left_points()

    def _left_points(self) -> dict[str, Array]:
        """Return the points of the left side that are not mirror images [m]."""
        return {}

    @abstractmethod
    def drawn_lines(self) -> Iterable[tuple[str, str, float, Array]]:
        """Return lines of a drawing besides wheels, springs and dampers.

        Each has a label, a colour, a width and its points, (n, 3) [m].
        """

    @abstractmethod
    def structure(self) -> Structure:
        """Return the structure that connects its parts."""

    @abstractmethod
    def bushes(self, given: Validator, described: Mapping[str, Any]) -> list[Bush]:
        """Return the bushes that are described by their hardpoints.

        Parameters
        ----------
        given : Validator
            It collects the problems.
        described : mapping
            ``[bushings]`` of a file.
        """

    @property
    @abstractmethod
    def joint_names(self) -> tuple[str, ...]:
        """The names of the moving points in the parts."""

    # -- its equations --------------------------------------------------------------------------

    @abstractmethod
    def parameters(self) -> dict[str, float]:
        """Return the parameters of the equations of motion by name, in SI units."""

    def parameters_of(self, side: str) -> Mapping[str, float]:
        """Return the parameters of a side, with the names of the right one."""
        return of_side(self.parameters(), side)

    def length(self, part: str, side: str) -> float:
        """Return the length of a spring or damper at design [m].

        Parameters
        ----------
        part : {'spring', 'damper'}
        side : {'left', 'right'}
        """
        points = self.points(side)
        return float(np.linalg.norm(points[f"{part}_top"] - points[f"{part}_seat"]))

    def _of_bodies(self, carrier: str) -> dict[str, float]:
        """Return the parameters of the carrier of the wheels, and of the parts of each side.

        These parts are wheels, springs, dampers, stops and tyres.
        """
        values, wheel = {}, dict[str, float]()
        for name, value in self.bodies.parameters(self.hardpoints).items():
            if name.startswith(f"{carrier}_"):
                values[name] = value
            elif name.startswith("wheel_"):
                wheel[name] = value
        for prefix, side, sign in (("", RIGHT, -1.0), ("left_", LEFT, 1.0)):
            own = {**wheel, **self._of_side(side, sign)}
            values |= {f"{prefix}{name}": value for name, value in own.items()}
        return values

    def _of_side(self, side: str, sign: float) -> dict[str, float]:
        """Return the parameters of spring, damper, stops and tyre of a side, without its name."""
        damper = self.damper
        values = {
            **self.tyre.parameters(),
            **components("spin_axis", self.wheel.spin_axis(sign)),
            **self.parameters_of_extras(self.length("damper", side), damper.curve),
            **self.spring.parameters(self.length("spring", side), general=True),
            "damper_rate": damper.rate_N_s_per_m or 0.0,
            "damper_friction": damper.friction_N,
            "damper_friction_speed": damper.friction_velocity_m_per_s,
        }
        for name, point in self.points(side).items():
            values |= components(name, point)
        return values

    # -- its checks -----------------------------------------------------------------------------

    def plausibility(self) -> Plausibility:
        """Return the unlikely values of its file."""
        notes = [*unusual_alignment(self.wheel)]
        for side in SIDES:
            notes += beyond_the_table(self.parameters_of(side), self.length("spring", side))
        if self.tyre_radius() is None:
            notes.append(
                "[tyre] radius_mm is not given, and wheel_center is not a wheel's radius above "
                "z = 0: results that need the ground are left out"
            )
        return Plausibility(tuple(self._unlikely()), tuple(notes))

    @abstractmethod
    def _unlikely(self) -> Iterable[str]:
        """Yield almost certain mistakes: units, swapped points."""

    def _unlikely_of(
        self,
        points: Mapping[str, Array],
        bodies: "Mapping[str, RigidBody]",
        reach: float,
        mass: float,
    ) -> Iterator[str]:
        """Yield the almost certain mistakes of any axle without sides.

        `points` are those besides the hardpoints [m], by their names in messages, `bodies` those
        besides the wheel; `reach` is their extent beyond the points, from the middle [m], `mass`
        the unsprung mass at a wheel, without the wheel [kg].
        """
        own = self.hardpoints
        given = {own.text(n): own.metres(n) for n in own.given() if n != "wheel_center"}
        given.update(points)
        yield from stray_points(given, own.unit)
        yield from stray_points(centres_of_mass(bodies), "mm")
        yield from unlikely_vehicle(self.vehicle)
        far = max(float(np.linalg.norm(at - self.center)) for at in given.values())
        yield from unlikely_tyre(self.tyre)
        yield from unlikely_inertia(bodies, reach + far)
        yield from unlikely_bushings(self.bushings)
        wheel = self.bodies.wheel
        yield from unlikely_wheel(wheel, self.tyre_radius())
        length = self.length("spring", RIGHT)
        yield from unlikely_rates(self.parameters(), length, mass + wheel.mass_kg, self.rate_key)

    def _own_problems(self) -> list[str]:
        """Return further problems, if the points have none."""
        return []

    def _check_bushes(self, given: Validator, bushes: list[Bush]) -> None:
        """Refuse bushes of the file with which it cannot move."""

    def _problems_of_points(self) -> list[str]:
        points = self.hardpoints
        problems = points.unit_problems() or points.geometry_problems()
        if self.half_track < _SMALLEST_HALF_TRACK:
            problems.append(
                f"{points.text('wheel_center')}: the points are those of the right side, and y "
                f"points left; less than {-1e3 * _SMALLEST_HALF_TRACK:g} mm is needed. Correct the "
                "sign of y."
            )
        left = [name for name, p in self.points(LEFT).items() if p[1] <= 0.0]
        own = [name for name in left if name in self._left_points()]
        mirrored = [name for name in left if name not in own]
        if mirrored and not problems:
            problems.append(
                f"{points.text(*mirrored)}: not on the right side, where y is less than 0. Correct "
                "the sign of y."
            )
        if own and not problems:
            problems.append(
                f"[left_hardpoints] {', '.join(own)}: not on the left side, where y is more than "
                "0. Correct the sign of y."
            )
        for name in ("spring", "damper"):
            length = self.length(name, LEFT)
            if length < SHORTEST and not problems:
                problems.append(
                    f"[left_hardpoints] {name}_top and {name}_seat are {1e3 * length:.3f} mm "
                    f"apart; at least {1e3 * SHORTEST:g} mm are needed. Move one of them."
                )
        return problems

    def _lengths_refused(self) -> list[str]:
        """Return problems of the dampers' lengths at design."""
        found = [self.damper.length_problems(self.length("damper", side)) for side in SIDES]
        return list(dict.fromkeys(problem for problems in found for problem in problems))


def of_side(values: Mapping[str, float], side: str) -> Mapping[str, float]:
    """Return the parameters of a side from those of an axle, with the names of the right side."""
    if side == RIGHT:
        return values
    return {n.removeprefix("left_"): v for n, v in values.items() if n.startswith("left_")}


def lines_of_sides(carriers: Mapping[str, str]) -> list[LineForce]:
    """Return the springs and dampers between the chassis and the carrier of each wheel, by side."""
    return [
        LineForce(
            f"{name}_{side}",
            tuple(f"{side}_{force}" for force in forces),
            CHASSIS,
            carrier,
            (f"{name}_top_{side}", f"{name}_seat_{side}"),
        )
        for name, forces in _FORCES.items()
        for side, carrier in carriers.items()
    ]


def on_both_sides(bush: Bush) -> list[Bush]:
    """Return the mirror image of a bush of the right side, and the bush."""
    at = bush.point
    return [bush.mirrored(f"{at}_{LEFT}"), replace(bush, point=f"{at}_{RIGHT}")]


def whole_axle_class(key: str) -> type[WholeAxle]:
    """Return the class of an axle without sides, from the module with its key."""
    return class_in(import_module(f".{key}", __package__), WholeAxle)


def class_in(module: ModuleType, base: type) -> Any:
    """Return the one class of a module, or of a package, that is derived from `base`."""
    (found,) = (
        kind
        for kind in vars(module).values()
        if isinstance(kind, type)
        and issubclass(kind, base)
        and kind.__module__.startswith(module.__name__)
    )
    return found
