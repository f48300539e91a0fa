"""The equations of motion of a car: packaged for some, otherwise derived at first use."""

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache, partial
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from ....core.validator import Validator
from ....core.vectors import components
from ....systems.allowed import LengthLimit
from ....systems.compile.build import (
    compile_mechanism,
    packed_mechanism,
    require_generator,
)
from ....systems.system import System
from ...tyres.tyre import ContactTerms
from ..model import Model
from ..packaged import packaged_equations
from .car import Car
from .driving import Air, SteeringColumn
from .slope import Slope

if TYPE_CHECKING:
    from ....generator import Formulation

Report = Callable[[str], None]


class CarModel(System):
    """The compiled equations of a car: body, axles, tyres.

    Those of quarter cars are part of kintrafo, and its binary packages contain those of all
    packaged cars; others are derived and compiled at first use, as by `kintrafo.compile`, and
    cached.

    Parameters
    ----------
    car : Car
    slope : Slope, optional
        The slope of the road of a car that drives; level by default.
    progress : callable, optional
        Called with a short description of the present step.

    Attributes
    ----------
    car : Car
        The data of the files.
    parameters, constants, design_state
        Parameters, constants and state at design of the equations. States are those of the body,
        ``heave``, ``pitch`` and ``roll``, followed by those of the suspensions; their names, and
        those of inputs and signals, have the prefix of the wheel, ``front_left_``, or of the axle,
        and no prefix in a quarter car. The body of a driving car moves freely, with ``body_x`` to
        ``body_r``; the last states are the deflections of its tyres.

    Examples
    --------
    >>> from kintrafo import CarModel, load
    >>> CarModel(load("quarter_car")).state_names[:3]
    ('heave', 'beta1', 'beta5')
    """

    NEEDED = 'a kintrafo.CarModel, such as CarModel(load("quarter_car")), is needed'

    def __init__(
        self, car: Car, *, slope: Slope | None = None, progress: Report | None = None
    ) -> None:
        with Validator("CarModel") as given:
            given.instance("car", car, Car, Car.NEEDED)
            given.function("progress", progress)
            if slope is not None:
                given.instance("slope", slope, Slope, "a Slope(grade, crossfall) is needed")
                if not given.failed:
                    slope = Slope.checked(given, *slope)
                if not given.failed and not car.drives:
                    given.fail('slope: only a car that drives, car = "full", can be on a slope.')
        equations = _equations(car, progress)
        parameters = _parameters(car, equations.PARAMETERS)
        if slope is not None:
            parameters |= components("upward", slope.upward)
        super().__init__(equations, parameters)
        self.car, self.slope = car, slope
        self.wheel_loads = False

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        if self.car.corner is not None:
            return self.car.corner.allowed_lengths()
        return tuple(
            one._replace(signal=f"{end}_{one.signal}", part=f"{end} {one.part}")
            for end, axle in self.car.axles.items()
            for one in axle.allowed_lengths()
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(CarModel, slope=self.slope), (self.car,)

    def __repr__(self) -> str:
        return f"<CarModel {self.equations.NAME}>"


def name_of(car: Car) -> str:
    """Return the name of the equations of a car, from their elements."""
    if car.corner is not None:
        return f"quarter_{Model(car.corner).equations.NAME}"
    tyres = dict.fromkeys(tyre.law for tyre in car.tyres.values())
    axles = [part for a in car.axles.values() for part in (a.equations_name, a.link_part) if part]
    column = ["column"] if car.column is not None else []
    return "_".join([car.described.car, "car", *axles, *column, *tyres])


def _equations(car: Car, progress: Report | None) -> ModuleType:
    """Return the packaged equations of a car, or those compiled for it.

    Cars that differ only in values have the same equations.
    """
    if not car.drives:  # the terms of driving cars depend on the coefficients of their tyres
        packaged = packaged_equations(name_of(car))
        if packaged is not None:
            return packaged
    structure = CarStructure.of(car)
    known = _LAST.get(structure.name)
    if known is not None and known[0] == structure:
        return known[1]
    found = packed_mechanism(structure.name, structure.text(), structure.declared)
    if found is None:
        found = compile_mechanism(structure.declared(), progress=progress)
    _LAST[structure.name] = structure, found
    return found


def declared(car: Car) -> "Formulation":
    """Return the declaration of a car, without values; cars that differ only in values share it."""
    return CarStructure.of(car).declared()


@dataclass(frozen=True)
class _End:
    """The structure of an axle on which the equations of a car depend."""

    suspension: str  # name of its equations
    whole: bool  # whether it has no sides
    pulls: str = ""  # part to which the drop links of its anti-roll bar are joined
    steered: bool = False
    column: bool = False  # whether a compliant steering column moves the rack
    # of a driving car, see `generator.mechanisms.car.driving`
    contact: ContactTerms | None = None
    relaxing: bool = False
    brakes_on: Any = None
    drive_on: Any = None

    @classmethod
    def of(cls, car: Car, end: str) -> "_End":
        """Return the structure of an axle of a car."""
        axle = car.axles[end]
        rolling: dict[str, Any] = {}
        if car.drives:
            rolling = {
                "contact": car.tyres[end].contact,
                "relaxing": car.relaxing,
                "brakes_on": axle.brakes.torque_on,
                "drive_on": drive.torque_on if (drive := axle.drive) else None,
            }
        steered = end == "front" and not axle.whole
        name = axle.equations_name
        if not steered:  # what would move the tie rods is a part of the body
            name = name.removesuffix("_pitman_arm")
        column = end == "front" and car.column is not None
        return cls(name, axle.whole, axle.link_part, steered, column, **rolling)

    def declared(self) -> "Formulation":
        """Return the declaration of the axle."""
        from ....generator.mechanisms import car as page  # noqa: PLC0415 (an extra)
        from ....generator.mechanisms import model_named  # noqa: PLC0415 (an extra)
        from ....generator.mechanisms.steering_column import on_a_column  # noqa: PLC0415 (an extra)

        found = (
            page.of_whole_axle(model_named(self.suspension))
            if self.whole
            else page.of_corners(
                model_named(self.suspension), pulls=self.pulls, steered=self.steered
            )
        )
        if self.column:
            found = on_a_column(found)
        if self.contact is None:
            return found
        return page.driving(
            found,
            self.contact.law,
            relaxing=self.relaxing,
            brakes_on=self.brakes_on,
            drive_on=self.drive_on,
        )


@dataclass(frozen=True)
class CarStructure:
    """The structure of a car: everything on which its declaration depends, without values."""

    name: str
    title: str = ""
    ends: tuple[_End, ...] = ()  # structures of the axles; empty for a quarter car
    coordinates: tuple[str, ...] | None = None  # those of the body; None for a driving car
    corner: str = ""  # equations of the suspension of a quarter car

    @classmethod
    def of(cls, car: Car) -> "CarStructure":
        """Return the structure of a car."""
        name = name_of(car)
        if car.corner is not None:
            return cls(name, corner=str(Model(car.corner).equations.NAME))
        heading = car.heading()
        title = heading[:1].upper() + heading[1:]
        ends = tuple(_End.of(car, end) for end in car.axles)
        return cls(name, title, ends, None if car.drives else tuple(car.coordinates))

    def text(self) -> str:
        """Return the structure and the source of this file, which declares a car from it."""
        source = Path(__file__).read_text(encoding="utf-8")
        return json.dumps([asdict(self), source])

    def declared(self) -> "Formulation":
        """Return the declaration of the car."""
        require_generator()
        return _declared(self)


@lru_cache(maxsize=8)
def _declared(structure: CarStructure) -> "Formulation":
    from ....generator.mechanisms import car as page  # noqa: PLC0415 (an extra)
    from ....generator.mechanisms import model_named  # noqa: PLC0415 (an extra)

    if structure.corner:
        return page.quarter(model_named(structure.corner))
    axles = [end.declared() for end in structure.ends]
    if structure.coordinates is None:
        return page.full(structure.name, structure.title, axles)
    return page.car(structure.name, structure.title, axles, structure.coordinates)


# The last structure by name, and its equations: a study varies values of one car, and identifying
# a declaration takes longer than a steady turn.
_LAST: dict[str, tuple[CarStructure, ModuleType]] = {}


def _parameters(car: Car, described: Mapping[str, Mapping[str, Any]]) -> dict[str, float]:
    """Return the values of the described parameters of a car's equations, in SI units."""
    body = car.described.body
    values = {"body_mass": body.mass_kg, **components("body_com", car.com)}
    values |= {f"body_inertia_{name}": value for name, value in body.elements().items()}
    if car.corner is not None:
        return values | Model(car.corner).parameters
    for end, axle in car.axles.items():
        own = axle.parameters_in_a_car()
        values["gravity"] = own["right_gravity"]
        values |= {f"{end}_{name}": value for name, value in own.items()}
    known = {name: value for name, value in values.items() if name in described}
    # points are in the axes of each axle; directions have no unit
    known |= {
        name: value + car.origins["rear"]
        for name, value in known.items()
        if name.startswith("rear_") and name.endswith("_x") and described[name]["unit"] == "m"
    }
    driving = _of_driving(car) if car.drives else {}
    return known | {name: value for name, value in driving.items() if name in described}


def _of_column(car: Car, column: SteeringColumn) -> dict[str, float]:
    """Return the parameters of a steering column, in SI units."""
    front = car.axles["front"]
    travel = front.steering_gear.travel_per_turn()
    assert travel is not None
    return column.parameters(travel, np.mean([*front.wheel_centers.values()], axis=0))


def _of_driving(car: Car) -> dict[str, float]:
    """Return the parameters of rolling tyres, brakes and air, in SI units."""
    values: dict[str, float] = {}
    for wheel in car.wheels:
        name = f"{wheel}_tyre"
        tyre = car.tyre(wheel)
        values |= tyre.parameters(name, relaxing=car.relaxing)
        values[f"{name}_damper_rate"] = tyre.vertical_damping
    if (column := car.column) is not None:
        values |= {f"front_{name}": value for name, value in _of_column(car, column).items()}
    if (brakes := car.described.brakes) is not None:
        values |= {f"{end}_brake_standstill": brakes.standstill_rad_per_s for end in car.axles}
    air = car.described.air or Air()
    center = car.com if air.center_mm is None else 1e-3 * np.array(air.center_mm)
    lifts = {"front": air.front_lift_area_m2, "rear": air.rear_lift_area_m2}
    levers = {end: x - center[0] for end, x in car.axle_positions.items()}
    return (
        values
        | components("air_center", center)
        | {
            "air_density": air.density_kg_per_m3,
            "air_drag_area": air.drag_area_m2,
            "air_lift_area": sum(lifts.values()),
            "air_pitching": -float(sum(lift * levers[end] for end, lift in lifts.items())),
        }
    )
