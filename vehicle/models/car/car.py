"""`Car`: the data of a car's file, with the axles that it names."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np

from ....core.errors import InputError
from ....core.named_types import Array
from ....core.physical import ELEMENTS
from ....core.validator import Validator, shown
from ...data import data_sets
from ...data.starter import AXLE, AXLES, CAR, CARS, WHOLE_AXLES, whole_axle_in, whole_axles
from ...input.described import DescribedParts, described_by, parts_of
from ...input.toml_file import read_toml
from ...input.units import in_metres, point_in_metres
from ...kinds import Suspension
from ...tyres import Tyre
from ..axle.axle import Axle
from ..sides import SIDES
from ..whole_axle import WholeAxle, whole_axle_class
from .driving import SteeringColumn, carries, named, tyre_of, under_load
from .file import COORDINATES, ENDS, OF_DRIVING, CarFile

AnyAxle = Axle | WholeAxle

WHEELS = tuple(f"{end}_{side}" for end in ENDS for side in SIDES)
"""The names of the wheels of a car with two axles."""

# Greatest difference of lengths in two files: the last digit in mm [m].
_CLOSE = 5e-4
# The height of the gravity centre is usually rounded more [m].
_CLOSE_HEIGHT = 5e-3
# Greatest difference of the sum of shares from one.
_CLOSE_SHARE = 1e-9
# Greatest height of a wheel centre at design above the radius of its tyre [m].
_HIGHEST = 0.1
_PARTS = ("corner", *ENDS)


@dataclass(frozen=True)
class Car(DescribedParts):
    """A car: a body on two axles, or a quarter of one on one suspension. Immutable.

    Make one with `load` or `from_dict`.

    Attributes
    ----------
    described : CarFile
        The data of its own file.
    parts : dict of str to Suspension, Axle or WholeAxle
        The corner, or both axles, by the keys of the file, as their own files describe them.
    tyres : dict of str to kintrafo.tyres.Tyre
        The tyres of a car that drives, by end; empty for others.

    Examples
    --------
    >>> from kintrafo import Car
    >>> car = Car.load("reference_vehicle")
    >>> car.wheels
    ('front_left', 'front_right', 'rear_left', 'rear_right')
    """

    described: CarFile
    parts: Mapping[str, Any]
    tyres: Mapping[str, Tyre] = field(default_factory=dict)

    NEEDED = 'a kintrafo.Car, such as kintrafo.load("reference_vehicle"), is needed'

    whole_car = True
    KEY = CAR
    FILE = CarFile
    PACKAGE = CARS

    @classmethod
    def _without_key(cls, data: Mapping[str, Any]) -> str:
        return f'{CAR} is missing: how the body moves. Add a line `{CAR} = "roll"`.'

    @classmethod
    def _of_parts(cls, described: CarFile, folder: Path, source: str) -> Self:
        makers = {"corner": Suspension.given, **dict.fromkeys(ENDS, _axle)}
        parts = parts_of(described, makers, folder, source)
        described, tyres = _with_tyres(described, folder, source)
        car = cls(described, parts, tyres)
        problems = _problems_of_axles(car) if car.corner is None else []
        problems += _problems_of_gravity(car)
        problems += _problems_of_driving(car) if car.drives else []
        problems += _problems_of_load(car) if car.drives and not problems else []
        if problems:
            raise InputError(problems, source)
        return car

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged.

        They have the sections of corner or axles instead of the names of their files.
        """
        own = self.described.model_dump(
            mode="json",
            exclude_none=True,
            exclude_defaults=exclude_defaults,
            exclude={**dict.fromkeys(_PARTS, True), "tyres": {*ENDS}},
        )
        if self.described.tyres is not None:
            own["tyres"] |= {end: _copied(getattr(self.described.tyres, end)) for end in ENDS}
        parts = {
            name: part.to_dict(exclude_defaults=exclude_defaults)
            for name, part in self.parts.items()
        }
        return {CAR: own.pop(CAR)} | parts | {name: v for name, v in own.items() if v != {}}

    def save(self, path: str | Path, *, force: bool = False) -> Path:
        given = self.to_dict().get("tyres", {})
        problems = [
            f"[tyres] {end} is a tyre from Python. Write its file with kintrafo.tyres.write_tir, "
            f'and change "tyres.{end}" to its name.'
            for end in ENDS
            if isinstance(given.get(end), Tyre)
        ]
        if problems:
            raise InputError(problems, str(path))
        return super().save(path, force=force)

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return a car that differs in some values; all checks are made again.

        Parameters
        ----------
        changes : mapping of str to Any
            New values, in the units of the file, by section and key with dots between them:
            ``body.mass_kg``. Names of values of the corner begin with ``corner``, those of an axle
            with ``front`` or ``rear``: ``front.side.hardpoints.ball_joint.z``. None removes an
            optional key.

        Raises
        ------
        InputError
            If there is no such value, or the data are not valid.

        Examples
        --------
        >>> from kintrafo import Car
        >>> car = Car.load("quarter_car")
        >>> car.with_changes({"body.mass_kg": 400.0}).described.body.mass_kg
        400.0
        """
        data, of_part, source = self._changed_data(changes, self.parts)
        data |= {name: part for name, part in self.parts.items() if name not in changes}
        for name, own in of_part.items():
            if own:
                data[name] = self.parts[name].with_changes(own)
        return self.from_dict(data, source)

    # -- its properties ---------------------------------------------------------------------------

    @property
    def corner(self) -> Suspension | None:
        """The suspension of a quarter car."""
        return self.parts.get("corner")

    @property
    def described_axles(self) -> dict[str, AnyAxle]:
        """The axles as their files describe them, by end; empty for a quarter car."""
        return {end: self.parts[end] for end in ENDS if end in self.parts}

    @cached_property
    def axles(self) -> dict[str, AnyAxle]:
        """The front and the rear axle, by end; empty for a quarter car.

        Those of a car that drives are on its tyres: their ``[tyre]`` is the tyre of ``[tyres]``
        under the static load, see `under_load`.
        """
        axles = self.described_axles
        if not self.drives:
            return axles
        return {
            end: axle.on_tyre(under_load(self.tyres[end], _static_load(self, end)))
            for end, axle in axles.items()
        }

    @property
    def coordinates(self) -> tuple[str, ...]:
        """The coordinates of the body: heave [m], positive up, pitch and roll [rad]."""
        return COORDINATES[self.described.car]

    @property
    def drives(self) -> bool:
        """Whether its body moves freely, on rolling tyres."""
        return self.described.drives

    def tyre(self, wheel: str) -> Tyre:
        """Return the tyre of a wheel of a car that drives.

        Parameters
        ----------
        wheel : str
            Such as 'front_left'.

        Returns
        -------
        kintrafo.tyres.Tyre
            The tyre on that side.

        Raises
        ------
        InputError
            If the car does not drive, or has no such wheel.
        """
        with Validator("tyre") as given:
            given.among("wheel", wheel, self.wheels if self.drives else ())
        end, _, side = wheel.partition("_")
        return self.tyres[end].on(side)

    @property
    def relaxing(self) -> bool:
        """Whether the slips of its tyres lag by their relaxation lengths."""
        return self.described.tyres is not None and self.described.tyres.relaxation

    @property
    def column(self) -> SteeringColumn | None:
        """The steering column that twists, of a car that drives; None if the rack is prescribed."""
        return self.described.steering_column if self.drives else None

    @property
    def drive_shares(self) -> dict[str, float]:
        """The share of the driving force at each driven axle, by end [1]."""
        return {
            end: axle.drive.share
            for end, axle in self.described_axles.items()
            if axle.drive is not None
        }

    @property
    def front_brake_share(self) -> float | None:
        """The share of the brake torque at the front wheels [1]."""
        own = None if self.described.brakes is None else self.described.brakes.front_share
        shares = [axle.vehicle.front_brake_share for axle in self.described_axles.values()]
        return next((s for s in (own, *shares) if s is not None), None)

    @property
    def wheels(self) -> tuple[str, ...]:
        """The names of the wheels, the left one of an axle first."""
        return WHEELS if self.corner is None else (self.corner.vehicle.side,)

    @property
    def parts_named(self) -> list[str]:
        given = [getattr(self.described, key) for key in _PARTS]
        return [name for name in given if isinstance(name, str)]

    def heading(self) -> str:
        """Return the name of the car."""
        if self.corner is not None:
            return f"quarter car, {self.corner.TITLE}"
        return f"car, {' and '.join(axle.heading() for axle in self.described_axles.values())}"

    def steered(self) -> bool:
        """Return whether its front wheels are steered, by a rack or a Pitman arm."""
        return (self.corner or self.described_axles["front"]).steered()

    @property
    def origins(self) -> dict[str, float]:
        """The x coordinates of the axles' origins in the axes of the car, by end [m]."""
        return {"front": 0.0, "rear": in_metres(self.described.rear_origin_mm, "mm")}

    @cached_property
    def wheel_centers(self) -> dict[str, Array]:
        """The wheel centres at design, axes of the car, by wheel [m]."""
        if self.corner is not None:
            return {self.wheels[0]: self.corner.hardpoints.metres("wheel_center")}
        shift = np.array([1.0, 0.0, 0.0])
        return {
            f"{end}_{side}": center + self.origins[end] * shift
            for end, axle in self.described_axles.items()
            for side, center in axle.wheel_centers.items()
        }

    @property
    def axle_positions(self) -> dict[str, float]:
        """The mean x coordinates of the wheel centres of the axles, by end [m]."""
        return {
            end: float(np.mean([self.wheel_centers[f"{end}_{side}"][0] for side in SIDES]))
            for end in self.described_axles
        }

    @property
    def com(self) -> Array:
        """The centre of mass of the body at design, axes of the car [m]."""
        given = self.described.body.com_mm
        if given is None:  # of a quarter car, which only heaves
            return np.array(self.wheel_centers[self.wheels[0]])
        return point_in_metres(given, "mm")

    @property
    def unused(self) -> tuple[str, ...]:
        """The keys of its files that a car with these coordinates does not use."""
        body = self.described.body
        turns = {"pitch": "yy", "roll": "xx"}
        used = {turns[name] for name in self.coordinates if name in turns}
        used |= set(ELEMENTS) if "roll" in self.coordinates else set()
        given = {f"inertia_{name}_kg_m2": name for name, v in body.elements().items() if v}
        words = [f"[body] {key}" for key, name in given.items() if name not in used]
        if body.com_mm is not None and self.coordinates == ("heave",):
            words.append("[body] com_mm")
        words += self._unused_of_driving()
        rear = self.described_axles.get("rear")
        if rear is not None and rear.steered():
            held = "a part of the body, and its tie rods hold the toe"
            words.append(f"rear axle: [{rear.steered_by}] ({held})")
        return tuple(words)

    def _unused_of_driving(self) -> list[str]:
        """Return the unused keys of driving; of a driving car those that its tyres replace."""
        if not self.drives:
            given = [key for key in OF_DRIVING if getattr(self.described, key) is not None]
            # characteristics need the share of the brakes
            brakes = "[brakes], except front_share"
            return [brakes if key == "brakes" else f"[{key}]" for key in given]
        words = [f"{end} axle: [tyre] (a car that drives takes [tyres])" for end in ENDS]
        return words + [
            f"[tyres] {end}: {', '.join(tyre.left_out)}"
            for end, tyre in self.tyres.items()
            if tyre.left_out
        ]


def _with_tyres(described: CarFile, folder: Path, source: str) -> tuple[CarFile, dict[str, Tyre]]:
    """Return the data of a file with absolute paths of tyres, and the tyres by end."""
    if described.tyres is None:
        return described, {}
    given = {end: _copied(named(getattr(described.tyres, end), folder)) for end in ENDS}
    if not described.drives:
        tyres = described.tyres.model_copy(update=given)
        return described.model_copy(update={"tyres": tyres}), {}
    found, problems = {}, []
    for end, one in given.items():
        try:
            found[end] = tyre_of(getattr(described.tyres, end), end, folder)
        except InputError as error:
            words = f"{end} = {shown(one)}" if isinstance(one, str) else end
            problems += [f"[tyres] {words}: {problem}" for problem in error.problems]
    if problems:
        raise InputError(problems, source)
    tyres = described.tyres.model_copy(update=given)
    return described.model_copy(update={"tyres": tyres}), found


def _copied(given: Any) -> Any:
    """Return a copy of the table of a tyre; names and tyres as they are."""
    return dict(given) if isinstance(given, Mapping) else given


def _axle(given: Any, folder: Path, key: str) -> AnyAxle:
    if isinstance(given, Axle | WholeAxle):
        return given
    if isinstance(given, Mapping):
        whole = whole_axle_in(given)
        return whole_axle_class(whole).from_dict(given) if whole else Axle.from_dict(given)
    if isinstance(given, str | Path):
        named = isinstance(given, str) and given in data_sets(AXLES) | data_sets(WHOLE_AXLES)
        file = given if named else folder / given
        sort = described_by(file)
        if sort in whole_axles():
            return whole_axle_class(sort).load(file)
        if sort == AXLE or not Path(file).is_file() or AXLE in read_toml(Path(file)):
            return Axle.load(file)
        problem = (
            f"{given} is not the file of an axle: it has no line `{AXLE} = ...`, nor any of "
            f"{', '.join(f'`{known} = ...`' for known in whole_axles())}. Name an axle's file, "
            "which names the hardpoint file of its sides."
        )
        raise InputError([problem], key)
    problem = f"{shown(given)}: the name of an axle's file is needed."
    raise InputError([problem], key)


def _problems_of_axles(car: Car) -> list[str]:
    problems = [
        f"{end}: its file describes the {axle.end} axle. Exchange the two files, or correct "
        "this one."
        for end, axle in car.described_axles.items()
        if axle.end != end
    ]
    if car.described_axles["rear"].steering is not None:
        problems.append(
            "rear: [steering]: the rear wheels are not steered, and their rack is a part of the "
            "body. Remove that section."
        )
    problems += [
        f"{end}: [rods] {', '.join(axle.to_dict()['rods'])}: an axle on five rods moves only on "
        "its bushes, and rods are rigid in a car. Leave one of them out."
        for end, axle in car.described_axles.items()
        if axle.overheld
    ]
    return problems or [*_problems_of_places(car), *_problems_of_shared(car)]


def _problems_of_places(car: Car) -> list[str]:
    """Return problems of the wheelbase, and of a centre of mass that is not between the wheels."""
    x = car.axle_positions
    between, given = x["front"] - x["rear"], in_metres(car.described.wheelbase_mm or 0.0, "mm")
    problems = []
    if abs(between - given) > _CLOSE:
        origin = 1e3 * car.origins["rear"]
        problems.append(
            f"wheelbase_mm = {1e3 * given:g} mm, and the wheel centres of the axles are "
            f"{1e3 * between:g} mm apart: the front ones at x = {1e3 * x['front']:g} mm, the rear "
            f"ones at {1e3 * x['rear']:g} mm with rear_origin_mm = {origin:g} mm. Correct one of "
            f"them; rear_origin_mm = {origin + 1e3 * (between - given):g} mm would agree."
        )
    com = float(car.com[0])
    if not problems and not x["rear"] < com < x["front"]:
        problems.append(
            f"[body] com_mm: x = {1e3 * com:g} mm is not between the wheel centres of the rear "
            f"axle at {1e3 * x['rear']:g} mm and of the front axle at {1e3 * x['front']:g} mm, so "
            "that the car would tip over. Correct it; x points forward."
        )
    y, wheels = float(center_of_gravity(car)[1]), [at[1] for at in car.wheel_centers.values()]
    if not problems and not min(wheels) < y < max(wheels):
        problems.append(
            f"[body] com_mm: with it the centre of gravity of the whole car is at y = "
            f"{1e3 * y:.1f} mm, and its wheels are between {1e3 * min(wheels):g} mm and "
            f"{1e3 * max(wheels):g} mm, so that the car would tip over. Correct it; y points left."
        )
    return problems


def _problems_of_shared(car: Car) -> list[str]:
    """Return the differences of car and axles in the data of the whole vehicle."""
    problems = []
    described = {end: axle.vehicle for end, axle in car.described_axles.items()}
    for end, vehicle in described.items():
        base = vehicle.wheelbase_mm
        if base is not None and abs(base - (car.described.wheelbase_mm or 0.0)) > 1e3 * _CLOSE:
            problems.append(
                f"{end}: [vehicle] wheelbase_mm = {base:g} mm, and the car's wheelbase_mm = "
                f"{car.described.wheelbase_mm:g} mm. Make them equal, or remove the first."
            )
        height = vehicle.center_of_gravity_height_mm
        own = center_of_gravity(car)[2]
        if height is not None and abs(in_metres(height, "mm") - own) > _CLOSE_HEIGHT:
            problems.append(
                f"{end}: [vehicle] center_of_gravity_height_mm = {height:g} mm, and that of the "
                f"whole car is {1e3 * own:.1f} mm by the masses of body, axles and wheels. Make "
                "them agree within 5 mm, or remove the first."
            )
    shares = {s for v in described.values() if (s := v.front_brake_share) is not None}
    if len(shares) > 1:
        problems.append(
            f"[vehicle] front_brake_share is {' and '.join(f'{s:g}' for s in sorted(shares))} in "
            "the files of the axles. Make them equal."
        )
    brakes = car.described.brakes
    if brakes is not None and brakes.front_share is not None:
        problems += [
            f"[brakes] front_share = {brakes.front_share:g}, and front_brake_share is {other:g} in "
            "the file of an axle. Make them equal, or remove the first."
            for other in sorted(shares - {brakes.front_share})
        ]
    return problems


def _problems_of_gravity(car: Car) -> list[str]:
    found = {one.gravity.acceleration_m_per_s2 for one in car.parts.values()}
    if len(found) == 1:
        return []
    values = " and ".join(f"{value:g} m/s^2" for value in sorted(found))
    return [f"[gravity] acceleration_m_per_s2 is {values} in its files. Make them equal."]


def _problems_of_driving(car: Car) -> list[str]:
    """Return problems of shares of brakes and drive, and of the height of the tyres."""
    problems = []
    shares, total = car.drive_shares, sum(car.drive_shares.values())
    if shares and abs(total - 1.0) > _CLOSE_SHARE:
        words = " and ".join(f"{share:g} at the {end}" for end, share in shares.items())
        problems.append(
            f"[drive] share is {words} in the files of the axles: together {total:g}, and 1 is "
            "needed. Correct them; an axle without [drive] is not driven."
        )
    if car.column is not None:
        problems += _problems_of_column(car.described_axles["front"])
    if car.described.brakes is not None and car.front_brake_share is None:
        problems.append(
            "[brakes] front_share is missing: the part of the torque at the front wheels. Add it, "
            "or front_brake_share in [vehicle] of an axle's file."
        )
    for end, tyre in car.tyres.items():
        height = max(float(car.wheel_centers[f"{end}_{side}"][2]) for side in SIDES)
        if not height < tyre.free_radius + _HIGHEST:
            problems.append(
                f"[tyres] {end}: the tyre has a radius of {1e3 * tyre.free_radius:g} mm without "
                f"load, and the wheel centre is {1e3 * height:g} mm above the ground at design. "
                "Use a tyre that reaches the ground."
            )
    return problems


def _problems_of_load(car: Car) -> list[str]:
    """Return the problems of tyres that do not carry the static load."""
    found = {end: (_static_load(car, end), tyre) for end, tyre in car.tyres.items()}
    return [
        f"[tyres] {end}: the tyre does not carry the static load of {load:.0f} N on each wheel: it "
        "has no stiffness there, or its axis reaches the road. Check its vertical stiffness and "
        "radius, and the masses."
        for end, (load, tyre) in found.items()
        if not carries(tyre, load)
    ]


def _problems_of_column(front: AnyAxle) -> list[str]:
    """Return the problem of a steering column that moves no rack, or by an unknown ratio."""
    if not front.steered():
        problem = "the front wheels are not steered. Remove this section."
    elif front.steering is not None:
        problem = (
            "front: [steering]: the rack follows the angle by a curve, and a column that twists "
            f"needs a constant ratio. Replace [steering] by {front.steering_gear.TURN_KEY}, or "
            "remove this section."
        )
    elif front.steering_gear.travel_per_turn() is None:
        problem = (
            f"front: {front.steering_gear.TURN_KEY} is missing: the ratio by which the column "
            "moves the steering. Add it."
        )
    else:
        return []
    return [f"[steering_column]: {problem}"]


def masses(car: Car) -> list[tuple[float, Array]]:
    """Return every mass of a car with its centre at design, axes of the car [kg, m]."""
    found = [(car.described.body.mass_kg, car.com)]
    for end, axle in car.described_axles.items():
        shift = np.array([car.origins[end], 0.0, 0.0])
        for values in axle.parameters_of_masses():
            for name, mass in values.items():
                if not name.endswith("_mass"):
                    continue
                body = name.removesuffix("_mass")
                at = "wheel_center" if body == "wheel" else f"{body}_com"
                center = np.array([values[f"{at}_{axis}"] for axis in "xyz"])
                found.append((mass, center + shift))
    return found


def suspension_masses(car: Car) -> dict[str, float]:
    """Return the mass of all parts of each axle [kg], by end; of a quarter car by ""."""
    if car.corner is not None:
        parts: dict[str, list[Mapping[str, float]]] = {"": [car.corner.parameters()]}
    else:
        parts = {end: [*axle.parameters_of_masses()] for end, axle in car.described_axles.items()}
    return {
        end: sum(
            mass for values in several for name, mass in values.items() if name.endswith("_mass")
        )
        for end, several in parts.items()
    }


def _static_load(car: Car, end: str) -> float:
    """Return the mean load of the wheels of an axle of a car at rest on a level road [N]."""
    other = next(one for one in ENDS if one != end)
    weight = sum(mass for mass, _ in masses(car)) * car.parts[end].gravity.acceleration_m_per_s2
    x, center = car.axle_positions, center_of_gravity(car)[0]
    return float(0.5 * weight * (center - x[other]) / (x[end] - x[other]))


def center_of_gravity(car: Car) -> Array:
    """Return the centre of gravity of a whole car at design, axes of the car [m]."""
    found = masses(car)
    total = sum(mass for mass, _ in found)
    return np.sum([mass * place for mass, place in found], axis=0) / total
