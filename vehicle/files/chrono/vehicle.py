"""A whole vehicle of Project Chrono as a car.

Chrono's file names others: chassis, suspensions with their places, wheels, tires, steering, bars,
brakes and driveline. The axes of the car have their origin on the road below the front wheel
centres, those of the rear axle below its own.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np

from ....core.errors import InputError
from ....core.named_types import Array
from ....core.validator import Validator
from ...input.commented_json import content
from ...models.car import Car
from ...models.car.car import center_of_gravity
from ...tyres import load
from .keys import Part, checked, listed, others, shown
from .parts import POINTS_ONLY, raised_moments
from .reading import imported, suspension_file
from .suspension_file import RACK, SteeredPoints, SuspensionFile
from .tires import TYRE_RATE, Tire, tire_of
from .vehicle_file import AxlePlace, Folder, VehicleFile
from .vehicle_parts import (
    BarFile,
    Brake,
    Chassis,
    Driveline,
    PitmanArm,
    RackPinion,
    WheelFile,
    is_rotation,
    rotation,
    rounded,
)

Kind = TypeVar("Kind", bound=Part)

ENDS = ("front", "rear")

_GRAVITY = 9.81
_TIR = "TIR Specification File"
_STEERINGS: Mapping[str, type[RackPinion] | type[PitmanArm]] = {
    "RackPinion": RackPinion,
    "PitmanArm": PitmanArm,
}
_CLOSE = 1e-3  # difference of wheelbases that is not reported [m]


class ImportedCar(NamedTuple):
    """A car from files of another program.

    Attributes
    ----------
    car : Car
        The car that was read.
    assumptions : tuple of str
        Assumptions, and differences between both programs, one sentence each.
    left_out : tuple of str
        The unread keys of the files, with their values, by file.
    files : tuple of pathlib.Path
        The files that were read.
    """

    car: Car
    assumptions: tuple[str, ...]
    left_out: tuple[str, ...]
    files: tuple[Path, ...]


def is_vehicle(path: str | Path) -> bool:
    """Return whether a file of Project Chrono describes a whole vehicle."""
    return content(path).get("Type") == "Vehicle"


def read_vehicle(path: str | Path, *, tire: str | Path | None = None) -> ImportedCar:
    """Return the car of a file of a whole vehicle of Project Chrono.

    Parameters
    ----------
    path : str or pathlib.Path
        JSON file of the template "WheeledVehicle": that of a vehicle, or one that names this and a
        tire. The files that it names are in the folders of Chrono's folder of data.
    tire : str or pathlib.Path, optional
        JSON file of a tire for all wheels, instead of those that are named.

    Returns
    -------
    ImportedCar
        The car with its assumptions, and the keys that were not read.

    Raises
    ------
    InputError
        If a file is missing or not one of Chrono, or a part is of a kind that cannot be read; with
        the keys of the files.
    """
    with Validator("read_vehicle") as given:
        given.path("path", path)
        if tire is not None:
            given.path("tire", tire)
    reader = _VehicleReader(Path(path), None if tire is None else Path(tire))
    return reader.read()


class _Axle(NamedTuple):
    """An axle in the axes of the chassis."""

    place: AxlePlace
    suspension: SuspensionFile
    data: dict[str, Any]  # content of its file
    file: Path
    tire: Tire  # with the rim

    @property
    def center(self) -> Array:
        """The left wheel centre [m]."""
        return np.add(self.suspension.spindle.com, self.place.location)

    @property
    def mass(self) -> float:
        """The mass of arms, carriers and wheels of both sides [kg]."""
        parts = {**self.suspension.arms(), **self.suspension.carriers()}.values()
        wheel = self.suspension.spindle.mass + self.tire.mass
        return 2.0 * (wheel + sum(body.mass for _, body in parts))


class _VehicleReader:
    """The reader of a vehicle's file and those that it names."""

    def __init__(self, path: Path, tire: Path | None) -> None:
        self.files: list[Path] = []
        self.assumed: list[str] = []
        self.left_out: list[str] = []
        self.rolling: dict[str, str | None] = {}
        self.torques: list[float] = []
        self.path, self.tire = path, tire
        self.folder = Folder(path)

    def read(self) -> ImportedCar:
        vehicle = self._vehicle()
        chassis = self._part(Chassis, vehicle.chassis.file, "Chassis > Input File")
        axles = {
            end: self._axle(end, place) for end, place in zip(ENDS, vehicle.axles, strict=True)
        }
        front, rear = axles.values()
        base = front.center[0] - rear.center[0]
        if base <= 0.0:
            problem = (
                f'"Axles": the wheel centres of the first are at x = {front.center[0]:g} m, those '
                f"of the second at {rear.center[0]:g} m: the front ones must come first; x points "
                "forward."
            )
            raise InputError([problem], str(self.path))
        self._compare_wheelbase(vehicle, base)
        origin = np.array([front.center[0], 0.0, _ground(chassis, front, rear)])
        shared = {"wheelbase_mm": rounded(base)} | self._brake_share(vehicle)
        steering = self._steering(vehicle, origin)
        sections = {
            end: self._section(end, axle, origin[2], shared, steering if end == "front" else {})
            for end, axle in axles.items()
        }
        for end, share in self._shares(vehicle).items():
            sections[end]["drive"] = {"share": share}
        data = {
            "car": "roll",
            **sections,
            "wheelbase_mm": rounded(base),
            "rear_origin_mm": rounded(-base),
            "body": chassis.section(origin),
        }
        data |= self._driving()
        if chassis.driver is not None:
            place = np.array(chassis.driver.location) - origin
            data["seats"] = {"driver": {"place_mm": [rounded(value) for value in place]}}
        self.assumed.append(
            "road: where the front tires carry their part of the weight with their vertical "
            "stiffness in the design position"
        )
        car = _with_height(Car.from_dict(data, str(self.path)))
        assumed, left_out = dict.fromkeys(self.assumed), dict.fromkeys(self.left_out)
        return ImportedCar(car, tuple(assumed), tuple(left_out), tuple(dict.fromkeys(self.files)))

    def _vehicle(self) -> VehicleFile:
        """Return the vehicle's file, which another file with a tire may name."""
        data = content(self.path)
        self.files.append(self.path)
        if isinstance(data.get("Vehicle"), dict):
            outer, self.path = data, self.folder.find(_named(data, "Vehicle", self.path), "Vehicle")
            if self.tire is None and "Tire" in outer:
                name = _named(outer, "Tire", self.files[0])
                self.tire = self.folder.find(name, "Tire > Input File")
            data = content(self.path)
            self.files.append(self.path)
            known = ("Name", "Type", "Template", "Vehicle", "Tire")
            self._list(self.files[0], [((k,), v) for k, v in outer.items() if k not in known])
        if "Axles" not in data:
            problem = (
                f'"Template" is {shown(data.get("Template"))}, and there are no "Axles": of whole '
                'vehicles, those of the template "WheeledVehicle" with their axles can be read.'
            )
            raise InputError([problem], str(self.path))
        vehicle = checked(VehicleFile, data, self.path)
        _raise(vehicle.problems(), self.path)
        self._list(self.path, [(place, value) for place, value, _ in others(VehicleFile, data)])
        return vehicle

    def _list(self, file: Path, unread: Any) -> None:
        self.left_out += [f"{file.name} > {line}" for line in listed(unread)]

    def _possible(self, data: dict[str, Any], file: Path) -> dict[str, Any]:
        """Return the content of a file with impossible moments of inertia raised.

        Many of Chrono's files have a moment that is more than the sum of the other two.
        """
        found = {}
        for key, value in data.items():
            found[key] = value
            if isinstance(value, dict):
                found[key] = self._possible(value, file)
            elif "Inertia" in key and "Products" not in key and (raised := raised_moments(value)):
                found[key] = raised
                self.assumed.append(
                    f"inertia: in {file.name} {shown(value)} kg m^2, of which the largest is more "
                    f"than the other two together, as no body has it; read as {shown(raised)}, "
                    "with larger other ones"
                )
        return found

    def _part(self, kind: type[Kind], name: str, key: str) -> Kind:
        """Return a part that a file describes."""
        file = self.folder.find(name, key)
        data = content(file)
        part = checked(kind, data, file)
        problems = getattr(part, "problems", None)
        _raise(problems() if problems else [], file)
        self.files.append(file)
        self._list(file, [(place, value) for place, value, _ in others(kind, data)])
        return part

    # -- its axles --------------------------------------------------------------------------------

    def _axle(self, end: str, place: AxlePlace) -> _Axle:
        file = self.folder.find(place.suspension, "Axles > Suspension Input File")
        data = self._possible(content(file), file)
        suspension = suspension_file(data, file)
        self.files.append(file)
        tire = self._tire(end, place)
        rim = self._part(WheelFile, str(place.left_wheel), "Axles > Left Wheel Input File")
        inertia = tuple(np.add(tire.inertia, rim.inertia).tolist())
        wheel = replace(tire, mass=tire.mass + rim.mass, inertia=inertia)
        return _Axle(place, suspension, data, file, wheel)

    def _tire(self, end: str, place: AxlePlace) -> Tire:
        file = self.tire
        if file is None and place.tire is not None:
            file = self.folder.find(place.tire, "Axles > Tire Input File")
        if file is None:
            beside = self.folder.tires()
            there = f" Beside it there are {', '.join(beside)}." if beside else ""
            problem = (
                f"no file of a tire is named for the {end} wheels, and its radius is needed. Give "
                f"one: --tire FILE (tire=...).{there}"
            )
            raise InputError([problem], str(self.path))
        tire = tire_of(self._possible(content(file), file), file)
        if tire.radius is None:
            raise InputError(
                ["the radius of the tire is needed, and is not in this file."], str(file)
            )
        self.files.append(file)
        self.rolling[end] = self._rolling(file)
        self.assumed += tire.assumed
        self.left_out += [f"{file.name} > {line.removeprefix('tire > ')}" for line in tire.left_out]
        return tire if tire.rate is not None else self._with_a_rate(tire, file, self.rolling[end])

    def _with_a_rate(self, tire: Tire, file: Path, rolling: str | None) -> Tire:
        """Return a tire whose file has no constant stiffness with one."""
        if rolling is None:
            rate, words = TYRE_RATE, f"as {file.name} has no constant vertical stiffness"
        else:
            tyre = load(rolling)
            state = tyre.evaluate(load=tyre.nominal_load)
            rate, words = float(state.vertical_stiffness), f"of {file.name} at its nominal load"
        self.assumed.append(f"tire: {rate / 1e3:.4g} N/mm, {words}")
        return replace(tire, rate=rate)

    def _section(
        self,
        end: str,
        axle: _Axle,
        ground: float,
        shared: Mapping[str, float],
        steering: Mapping[str, Any],
    ) -> dict[str, Any]:
        """Return the section of an axle, in axes with the origin below its wheel centres."""
        try:
            found = imported(axle.suspension, axle.data, axle.file, axle.tire)
        except InputError as error:
            problems = [text.replace(f", or {POINTS_ONLY}", "") for text in error.problems]
            raise InputError(problems, str(axle.file)) from None
        self.assumed += [f"{end}: {line}" for line in found.assumptions]
        self.left_out += [f"{axle.file.name} > {line}" for line in found.left_out]
        origin = np.array([axle.center[0], 0.0, ground])
        side = _moved(found.suspension.to_dict(exclude_defaults=True), axle.place.location - origin)
        side["tyre"] |= {"free_height_mm": side["tyre"]["radius_mm"], "lifts_off": True}
        side["vehicle"] |= {"end": end, **shared}
        if isinstance(axle.suspension, SteeredPoints):
            side |= {"rack": None, **steering} if steering else {}
            if end == "front" and not steering:
                self.assumed.append(f"front: {RACK}")
        section: dict[str, Any] = {"axle": end, "side": side}
        if axle.place.bar is not None:
            bar = self._part(BarFile, axle.place.bar, "Axles > Antirollbar Input File")
            at = axle.place.bar_location - origin
            section["anti_roll_bar"] = bar.section(at, axle.suspension.LINKED)
        return section

    # -- its other parts --------------------------------------------------------------------------

    def _compare_wheelbase(self, vehicle: VehicleFile, base: float) -> None:
        given = vehicle.wheelbase
        if given is not None and abs(given - base) > _CLOSE:
            self.assumed.append(
                f"wheelbase: {1e3 * base:.6g} mm, the distance of the wheel centres; the "
                f"{1e3 * given:g} mm of the vehicle's file move nothing, in Chrono neither"
            )

    def _steering(self, vehicle: VehicleFile, origin: Array) -> dict[str, Any]:
        """Return the section of the steering of the front axle; empty without steering.

        `origin` is that of the axes of the axle, (3,) [m].
        """
        index = vehicle.axles[0].steering
        for i, unused in enumerate(vehicle.steerings):
            if i != index:
                self._list(self.path, [(("Steering Subsystems",), {"Input File": unused.file})])
        if index is None:
            return {}
        place = vehicle.steerings[index]
        if not is_rotation(place.orientation):
            problem = f'"Orientation" = {list(place.orientation)} is not a unit quaternion.'
            raise InputError([problem], str(self.path))
        key = "Steering Subsystems > Input File"
        file = self.folder.find(place.file, key)
        template = str(content(file).get("Template"))
        if template not in _STEERINGS:
            known = " and ".join(f'"{name}"' for name in _STEERINGS)
            problem = f'"Template" is {shown(template)}; of steerings, {known} can be read.'
            raise InputError([problem], str(file))
        found, words = self._part(_STEERINGS[template], place.file, key).steering(
            rotation(place.orientation), np.array(place.location) - origin
        )
        self.assumed.append(words)
        return found

    def _brake_share(self, vehicle: VehicleFile) -> dict[str, float]:
        """Return the front share of the brake torque; empty without brakes."""
        torques = [
            0.0
            if axle.left_brake is None
            else self._part(Brake, axle.left_brake, "Axles > Left Brake Input File").torque
            for axle in vehicle.axles
        ]
        total, self.torques = sum(torques), torques
        if not total:
            return {}
        self.assumed.append(
            f"brakes: {torques[0]:g} N m at a front wheel and {torques[1]:g} N m at a rear one "
            "with the pedal fully down"
        )
        return {"front_brake_share": round(torques[0] / total, 9)}

    def _driving(self) -> dict[str, Any]:
        """Return the sections of a driving car: tyres, if their files can be read, and brakes.

        The car itself drives only after a change of its file.
        """
        if None in self.rolling.values():
            return {}
        self.assumed.append('tyres: those of a car that drives, which it does with car = "full"')
        brakes = {} if not any(self.torques) else {
            "brakes": {"torque_Nm": 2.0 * sum(self.torques)}
        }  # fmt: skip
        return {"tyres": {**self.rolling, "relaxation": False}} | brakes

    def _rolling(self, file: Path) -> str | None:
        """Return the file of a rolling tyre, or None with a reason among the assumptions."""
        given = content(file).get(_TIR)
        try:
            tyre = file if not isinstance(given, str) else self.folder.find(given, _TIR)
            load(tyre)
        except InputError as error:
            self.assumed.append(
                f"tyres: none for a car that drives, as {file.name} cannot be read as one: "
                f"{error.problems[0]}"
            )
            return None
        return str(tyre)

    def _shares(self, vehicle: VehicleFile) -> dict[str, float]:
        """Return the share of the driving force by end; empty without a driveline."""
        place = vehicle.driveline
        if place is None:
            return {}
        line = self._part(Driveline, place.file, "Driveline > Input File")
        if not set(place.driven) <= set(range(len(ENDS))) or not place.driven:
            problem = f'"Driveline > Suspension Indexes" = {list(place.driven)}; allowed: 0 and 1.'
            raise InputError([problem], str(self.path))
        if len(set(place.driven)) == 1:
            return {ENDS[place.driven[0]]: 1.0}
        return {"front": line.to_front, "rear": 1.0 - line.to_front}


def _named(data: Mapping[str, Any], key: str, path: Path) -> str:
    inner = data[key]
    name = inner.get("Input File") if isinstance(inner, dict) else None
    if not isinstance(name, str):
        raise InputError([f'"{key} > Input File" is {shown(name)}; a path is needed.'], str(path))
    return name


def _raise(problems: list[str], file: Path) -> None:
    if problems:
        raise InputError(problems, str(file))


def _ground(chassis: Chassis, front: _Axle, rear: _Axle) -> float:
    """Return the height of the road in the axes of the chassis [m]."""
    mass, com, _ = chassis.body()
    part = (com[0] - rear.center[0]) / (front.center[0] - rear.center[0])
    load = 0.5 * _GRAVITY * (mass * part + front.mass)
    rate = TYRE_RATE if front.tire.rate is None else front.tire.rate
    assert front.tire.radius is not None  # checked when the tire was read
    return float(front.center[2] - front.tire.radius + (load / rate if rate else 0.0))


def _moved(data: dict[str, Any], by: Array) -> dict[str, Any]:
    """Return the file of a suspension with points in metres, shifted [m]."""
    points, unit = data["hardpoints"], data["hardpoints"]["unit"]
    assert unit == "m"
    moved = {
        name: [rounded(value) for value in np.add(point, by)]
        for name, point in points.items()
        if name != "unit"
    }
    bodies = {name: _body_moved(body, by) for name, body in data["bodies"].items()}
    return data | {"hardpoints": {"unit": "mm", **moved}, "bodies": bodies}


def _body_moved(body: dict[str, Any], by: Array) -> dict[str, Any]:
    if "com_mm" not in body:
        return body
    return body | {"com_mm": [rounded(value) for value in np.multiply(body["com_mm"], 1e-3) + by]}


def _with_height(car: Car) -> Car:
    """Return a car with the height of the centre of gravity in the files of its axles."""
    height = round(1e3 * float(center_of_gravity(car)[2]), 3)
    if height <= 0.0:
        return car
    key = "side.vehicle.center_of_gravity_height_mm"
    return car.with_changes({f"{end}.{key}": height for end in ENDS})
