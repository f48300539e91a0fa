"""Plausibility of input files: wrong signs, units and points.

Such files describe mechanisms that move, and are not refused; `kintrafo check` lists the findings.
A *problem* is almost certainly a mistake, which the text names; a *note* is an unusual value. A
limit is the geometric mean of the value of a car and the value with the mistake: wrong units are
factors of 1,000 or more.
"""

import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import resources
from typing import Any, Protocol

import numpy as np

from ...core.named_types import Array
from ...core.vectors import angle_between_lines
from ..input.bodies import RigidBody, WheelBody
from ..input.damper import TABLE as CURVE
from ..input.spring import SEATS, ends_of_table, rate_at
from ..input.units import point_in_metres
from ..input.vehicle import TyreSection, WheelSection
from ..kinds import Suspension

# Frequency of wheel hop of passenger cars [Hz]: TRL Report SR12 UC, vehicles over discontinuities
# of the road.
USUAL_HOP = (10.0, 15.0)

# Greatest distance of a point beyond the centre plane [m]. Racks with a central take-off have their
# joints within some centimetres of that plane.
_ACROSS = 0.1
# At this angle of rack axis and tie rod the rack moves the rod lengthwise by half its travel [deg].
_LARGEST_RACK_ANGLE = 60.0
# A point nearer to the origin is in metres in a file in millimetres [m]: the points of a car are
# within 3 m of its origin.
_NEAR_ORIGIN = 0.003
# Greatest distance of the wheel centre inboard of a ball joint [m]: with inboard brakes, it is some
# centimetres outboard.
_INBOARD = 0.1
# Greatest distance of a wheel centre below the bearings of its arm [m]; portal axles have more.
_BELOW = 0.1
# Unusual distance of caster and kingpin inclination from their usual range, in widths of the range.
_WIDTHS = 2.0
# A wheel hops on its tyre at 10 to 15 Hz (`USUAL_HOP`). A rate in N/mm or masses in grams change
# this by a factor of 30, the root of 1,000; the limit is its root.
_APART = 5.6
# The rate of a tyre is 5 to 20 times that of the spring, of racing cars equal to it; a spring in
# N/mm makes it 1,000 times more, a tyre in N/mm 1,000 times less.
_TYRE_TO_SPRING = (0.05, 500.0)
# Dampers have 10 to 60 % of the critical damping of the wheel on its tyre.
_DAMPING = (0.005, 20.0)
# Bushes have 100 to 20 000 N/mm; rates in kN/mm or N/m are 1,000 times less or more [N/mm].
_BUSHES = (3.0, 2e5)
# Racks of cars move by 30 to 80 mm for a turn of the steering wheel [m].
_PER_TURN = (0.0015, 1.5)
# Radii of wheels, from karts to lorries, are 0.1 to 0.7 m; wrong units make them 1,000 times more
# or less [m].
_RADII = (0.005, 20.0)
# Rates of one tyre are similar; one in N/mm is 1,000 times less, and the limit is the root of this.
_ALIKE = 31.6
# No wheel has more inertia than a hoop. In kg mm^2 an inertia is 1,000,000 times as much; the limit
# is the root of this.
_HOOPS = 1e3
# The wheelbase of a car is 1.5 to 4 m, and its centre of gravity 0.25 to 1 m high; a value in
# metres is 1,000 times less in millimetres [m].
_SHORTEST_WHEELBASE, LOWEST_CENTER = 0.05, 0.01
# Wheels of cars stand within some degrees of upright and straight ahead [deg].
_MOST_ALIGNMENT = 10.0
# Rounding of lengths [m].
_ROUNDING = 1e-9


class WholeVehicle(Protocol):
    """The data of the whole vehicle in a file; None if a key is missing."""

    @property
    def wheelbase_mm(self) -> float | None:
        """Distance of the axles."""

    @property
    def center_of_gravity_height_mm(self) -> float | None:
        """Height above the ground."""


@dataclass(frozen=True)
class Plausibility:
    """The findings of a file."""

    # values that are almost certainly mistakes; and unusual values
    problems: tuple[str, ...]
    notes: tuple[str, ...]


def plausibility(suspension: Suspension) -> Plausibility:
    """Return the implausible and the unusual values of a hardpoint file.

    Examples
    --------
    >>> from kintrafo import Suspension
    >>> car = Suspension.load("reference_car")
    >>> plausibility(car)
    Plausibility(problems=(), notes=())
    >>> along = car.with_changes({"rack.axis": [1.0, 0.0, 0.0]})
    >>> print(plausibility(along).problems[0].split(":")[0])
    [rack] axis = [1.0, 0.0, 0.0]
    """
    problems = (
        *_other_side(suspension),
        *_swapped(suspension),
        *_stray(suspension),
        *_rack(suspension),
        *_rates(suspension),
        *unlikely_tyre(suspension.tyre),
        *_inertia(suspension),
        *unlikely_bushings(suspension.bushings),
        *unlikely_wheel(suspension.bodies.wheel, suspension.tyre_radius()),
        *unlikely_vehicle(suspension.vehicle),
    )
    notes = (
        *_wheel_place(suspension),
        *_steering_axis(suspension),
        *unusual_alignment(suspension.wheel),
        *beyond_the_table(suspension.parameters(), suspension.hardpoints.distance(*SEATS)),
    )
    return Plausibility(problems, notes)


def _outboard(suspension: Suspension, name: str) -> float:
    """Return the distance of a point from the centre plane, positive on the wheel's side [m]."""
    return suspension.vehicle.sign * float(suspension.hardpoints.metres(name)[1])


def _other_side(suspension: Suspension) -> Iterator[str]:
    points = suspension.hardpoints
    given = {points.text(name): points.metres(name) for name in points.given()}
    for text, place in (given | centres_of_mass(suspension.bodies.rigid())).items():
        across = -suspension.vehicle.sign * float(place[1])
        if across > _ACROSS:
            yield (
                f"{text} is {1e3 * across:.0f} mm beyond the centre plane, and the "
                f"wheel is on the {suspension.vehicle.side}. Is the sign of y right?"
            )


def _swapped(suspension: Suspension) -> Iterator[str]:
    points = suspension.hardpoints
    at_knuckle = [name for name, part in points.CARRIERS.items() if part == "knuckle"]
    for rod in (name.removesuffix("_outer") for name in at_knuckle if name.endswith("_outer")):
        outer, inner = (_outboard(suspension, f"{rod}_{end}") for end in ("outer", "inner"))
        if outer < inner:
            words, base = rod.replace("_", " "), "rack" if rod == "tie_rod" else "chassis"
            yield (
                f"{points.text(f'{rod}_outer', f'{rod}_inner')}: the {words}'s end at the knuckle "
                f"is {1e3 * (inner - outer):.0f} mm inboard of that at the {base}. Are the two "
                "swapped?"
            )
    for ball, bearings in points.ARMS.items():
        hinge = min(_outboard(suspension, name) for name in bearings)
        inboard = hinge - _outboard(suspension, ball)
        if inboard > 0.0:
            yield (
                f"{points.text(ball, *bearings)}: {ball} is {1e3 * inboard:.0f} mm inboard of the "
                "arm's bearings on the chassis. Are they swapped?"
            )
    if points.STEERING_AXIS is None:
        return
    low, high = points.STEERING_AXIS
    drop = float(points.metres(low)[2] - points.metres(high)[2])
    if drop > 0.0:
        yield (
            f"{points.text(low, high)}: {high} is {1e3 * drop:.0f} mm below {low}. z points up: is "
            "its sign right?"
        )


def _stray(suspension: Suspension) -> Iterator[str]:
    points = suspension.hardpoints
    given = {points.text(n): points.metres(n) for n in points.given() if n != "wheel_center"}
    yield from stray_points(given, points.unit)
    yield from stray_points(centres_of_mass(suspension.bodies.rigid()), "mm")
    if suspension.pitman_arm is not None:
        yield from stray_points(suspension.pitman_arm.given_points(), "mm")


def centres_of_mass(bodies: Mapping[str, RigidBody]) -> dict[str, Array]:
    """Return the given centres of mass of bodies, (3,) [m], by their text in the file."""
    return {
        f"[bodies.{name}] com_mm = {list(body.com_mm)}": point_in_metres(body.com_mm, "mm")
        for name, body in bodies.items()
        if body.com_mm is not None
    }


def stray_points(points: Mapping[str, Array], unit: str) -> Iterator[str]:
    """Yield problems of points that are in metres in a file in millimetres.

    `points` are positions [m] by their text in the file, `unit` is its unit.
    """
    for text, place in points.items():
        distance = float(np.linalg.norm(place))
        if distance < _NEAR_ORIGIN and unit == "mm":
            yield (
                f"{text} is {1e3 * distance:.3g} mm from the origin. Is it in metres? The unit of "
                'all points is "mm".'
            )


def _rack(suspension: Suspension) -> Iterator[str]:
    if suspension.rack is None:
        return
    points, axis = suspension.hardpoints, suspension.rack.axis
    rod = points.metres("tie_rod_outer") - points.metres("tie_rod_inner")
    angle = angle_between_lines(np.array(axis), rod)
    if angle > _LARGEST_RACK_ANGLE:
        yield (
            f"[rack] axis = {list(axis)}: the rack moves at {angle:.1f} deg to the tie rod, and so "
            "hardly moves it. A rack lies across the car: [0.0, 1.0, 0.0], which moves to the left."
        )
    least, most = _PER_TURN
    turn = suspension.rack.travel_per_turn_mm
    if turn is not None and not least <= 1e-3 * turn <= most:
        yield (
            f"[rack] travel_per_turn_mm = {turn:g} mm: racks of cars move by 30 to 80 mm. Is it in "
            f"{'m' if 1e-3 * turn < least else 'another unit'}?"
        )


def _rates(suspension: Suspension) -> Iterator[str]:
    bodies = suspension.bodies
    mass = bodies.wheel.mass_kg + sum(body.mass_kg for body in bodies.rigid().values())
    length = suspension.hardpoints.distance(*SEATS)
    yield from unlikely_rates(suspension.parameters(), length, mass, suspension.rate_key)


def unlikely_rates(
    values: Mapping[str, float], length: float, mass: float, key: Callable[[str], str]
) -> Iterator[str]:
    """Yield problems of tyre and masses, of tyre and spring, and of the damper.

    `values` are rates by their names in the equations, `length` that of the spring at design [m],
    `mass` that of all bodies of a wheel [kg]; `key` returns the key of the rate of a part, "spring"
    or "damper", in the file.
    """
    tyre, damper = values["tyre_rate"], values["damper_rate"]
    where, unit = f"{key('damper')} = {damper:g} N s/m", "Is it in N s/mm?"
    if not damper:
        damper = _mean_damper_rate(values)
        where, unit = f"[damper] force_N rises by {damper:g} N s/m", "Are velocities in mm/s?"
    spring = float(rate_at(values, np.array(length)))
    if tyre == 0.0:
        return
    hop = float(np.sqrt(tyre / mass)) / (2.0 * np.pi)
    low, high = USUAL_HOP
    if not low / _APART <= hop <= high * _APART:
        yield (
            f"[tyre] rate_N_per_m = {tyre:g} N/m and {mass:g} kg of all bodies: the wheel would "
            f"hop on its tyre at {hop:.3g} Hz, on cars it does at {low:g} to {high:g} Hz. Is the "
            "rate in N/mm, or a mass in grams?"
        )
        return
    least, most = _TYRE_TO_SPRING
    if spring != 0.0 and not least <= tyre / spring <= most:
        yield (
            f"{key('spring')} = {spring:g} N/m: the tyre's rate is "
            f"{tyre / spring:.3g} times that, on cars it is 5 to 20 times as much. Is it in N/mm?"
        )
    least, most = _DAMPING
    ratio = damper / (2.0 * float(np.sqrt(tyre * mass)))
    if damper != 0.0 and not least <= ratio <= most:
        yield (
            f"{where}: the wheel on its tyre has a damping ratio of {ratio:.2g} by it, on cars "
            f"some 0.1 to 0.6. {unit}"
        )


def _mean_damper_rate(values: Mapping[str, float]) -> float:
    """Return the slope of a damper's curve from its first to its last point [N s/m]."""
    knots = [value for name, value in values.items() if name.startswith(f"{CURVE}_knot_")]
    width = max(knots, default=0.0) - min(knots, default=0.0)
    parts = tuple(f"{CURVE}_{part}_" for part in ("linear", "quadratic", "cubic"))
    rise = sum(value for name, value in values.items() if name.startswith(parts))
    return rise / width if width else 0.0


def beyond_the_table(values: Mapping[str, float], length: float) -> Iterator[str]:
    """Yield a note on a spring whose length at design [m] is beyond its curve."""
    ends = ends_of_table(values)
    if ends is not None and not ends[0] - _ROUNDING <= length <= ends[1] + _ROUNDING:
        shortest, longest = (1e3 * end for end in ends)
        yield (
            f"[spring] force_N: at design the spring is {1e3 * length:.1f} mm long, and its curve "
            f"goes from {shortest:.1f} to {longest:.1f} mm; beyond it goes on straight. Add points."
        )


def _inertia(suspension: Suspension) -> Iterator[str]:
    points = suspension.hardpoints
    size = max(points.distance(name, "wheel_center") for name in points.given())
    yield from unlikely_inertia(suspension.bodies.rigid(), size)


def unlikely_inertia(bodies: Mapping[str, RigidBody], size: float) -> Iterator[str]:
    """Yield problems of a radius of gyration greater than the size of the suspension [m]."""
    for name, body in bodies.items():
        gyration = _radius_of_gyration(body)
        if gyration > size:
            yield (
                f"[bodies.{name}] mass_kg = {body.mass_kg:g} kg and its inertia make a radius "
                f"of gyration of {gyration:.3g} m in a suspension of the size {size:.2f} m. "
                "Is the inertia in kg mm^2, or the mass wrong?"
            )


def unlikely_bushings(bushings: Mapping[str, Mapping[str, Any]] | None) -> Iterator[str]:
    """Yield problems of stiffnesses of bushes."""
    least, most = _BUSHES
    for point, table in (bushings or {}).items():
        for key in ("axial_N_per_mm", "radial_N_per_mm"):
            for value in np.ravel(table.get(key, [])):
                if not least <= value <= most:
                    other = "kN/mm?" if value < least else "N/m? Leave out a rigid direction."
                    yield (
                        f"[bushings.{point}] {key} = {value:g} N/mm: bushes have 100 to 20000 "
                        f"N/mm. Is it in {other}"
                    )


def _radius_of_gyration(body: RigidBody) -> float:
    """Return the polar radius of gyration [m]; zero without mass."""
    if not body.mass_kg > 0.0:
        return 0.0
    elements = body.elements()
    # the trace of the tensor is twice the polar moment about the centre of mass
    polar = 0.5 * (elements["xx"] + elements["yy"] + elements["zz"])
    return float(np.sqrt(max(polar, 0.0) / body.mass_kg))


def unlikely_body(body: RigidBody, center: Array, wheelbase: float) -> Iterator[str]:
    """Yield problems of the body of a car by the centre of gravity of the car, (3,), in metres."""
    height = float(center[2])
    if height < LOWEST_CENTER:
        yield (
            f"[body] com_mm: with it the centre of gravity of the whole car is {1e3 * height:.3g} "
            "mm above z = 0: cars have 250 to 1000 mm. Is it in metres, or in other axes?"
        )
    gyration = _radius_of_gyration(body)
    if gyration > wheelbase:
        yield (
            f"[body] mass_kg = {body.mass_kg:g} kg and its inertia make a radius of gyration of "
            f"{gyration:.3g} m in a car with a wheelbase of {wheelbase:.2f} m. Is the inertia in "
            "kg mm^2, or the mass wrong?"
        )


def unlikely_vehicle(vehicle: WholeVehicle) -> Iterator[str]:
    """Yield problems of lengths of the whole vehicle that are in metres."""
    for name, least, usual in (
        ("wheelbase_mm", _SHORTEST_WHEELBASE, "1500 to 4000"),
        ("center_of_gravity_height_mm", LOWEST_CENTER, "250 to 1000"),
    ):
        value = getattr(vehicle, name)
        if value is not None and value < 1e3 * least:
            yield f"[vehicle] {name} = {value:g} mm: cars have {usual} mm. Is it in metres?"


def unusual_alignment(wheel: WheelSection) -> Iterator[str]:
    """Yield notes on camber and toe that no car has."""
    for name in ("camber_deg", "toe_deg"):
        value = getattr(wheel, name)
        if abs(value) > _MOST_ALIGNMENT:
            yield f"[wheel] {name} = {value:g} deg: cars have some degrees. Is it right?"


def unlikely_tyre(tyre: TyreSection) -> Iterator[str]:
    """Yield problems of the radius of a tyre, and of its rates in different directions."""
    radius = tyre.radius_mm
    if radius is not None and not _RADII[0] <= 1e-3 * radius <= _RADII[1]:
        yield (
            f"[tyre] radius_mm = {radius:g} mm: wheels of vehicles have 100 to 700 mm. Is it in "
            f"{'m' if 1e-3 * radius < _RADII[0] else 'another unit'}?"
        )
    for name in ("lateral_rate_N_per_m", "longitudinal_rate_N_per_m"):
        rate, vertical = getattr(tyre, name), tyre.rate_N_per_m
        if rate is not None and vertical and not 1.0 / _ALIKE <= rate / vertical <= _ALIKE:
            yield (
                f"[tyre] {name} = {rate:g} N/m, beside a rate_N_per_m of {vertical:g} N/m: tyres "
                "deflect by much the same in all directions. Is one of them in N/mm?"
            )


def unlikely_wheel(wheel: WheelBody, radius: float | None) -> Iterator[str]:
    """Yield a problem of a wheel with far more inertia about its axis than a hoop."""
    hoop = wheel.mass_kg * (radius or np.inf) ** 2
    if wheel.inertia_spin_kg_m2 - wheel.inertia_shaft_kg_m2 > _HOOPS * hoop:
        yield (
            f"[bodies.wheel] inertia_spin_kg_m2 = {wheel.inertia_spin_kg_m2:g} kg m^2: a hoop of "
            f"{wheel.mass_kg:g} kg and the tyre's radius of {radius:.3f} m has {hoop:.3g} kg m^2, "
            "and no wheel has more. Is it in kg mm^2?"
        )


def _wheel_place(suspension: Suspension) -> Iterator[str]:
    points = suspension.hardpoints
    for ball, bearings in points.ARMS.items():
        inboard = _outboard(suspension, ball) - _outboard(suspension, "wheel_center")
        if inboard > _INBOARD:
            yield (
                f"{points.text('wheel_center', ball)}: the wheel centre is {1e3 * inboard:.0f} mm "
                f"inboard of {ball}."
            )
        hinge = 0.5 * sum(float(points.metres(name)[2]) for name in bearings)
        below = hinge - float(points.metres("wheel_center")[2])
        if below > _BELOW and ball == (points.STEERING_AXIS or ("",))[0]:
            yield (
                f"{points.text('wheel_center')} is {1e3 * below:.0f} mm below the bearings of its "
                "arm. z points up: is its sign right?"
            )


def _steering_axis(suspension: Suspension) -> Iterator[str]:
    points = suspension.hardpoints
    if points.STEERING_AXIS is None:
        return
    low, high = points.STEERING_AXIS
    x, y, z = points.metres(high) - points.metres(low)
    if z <= 0.0:
        return
    usual = typical_ranges(suspension.suspension)
    for name, away, axis in (
        ("caster", -x, "x"),
        ("kingpin_inclination", -suspension.vehicle.sign * y, "y"),
    ):
        angle = float(np.degrees(np.arctan2(away, z)))
        low_end, high_end = usual[name]["low"], usual[name]["high"]
        beside = max(low_end - angle, angle - high_end)
        if beside > _WIDTHS * (high_end - low_end):
            yield (
                f"{points.text(low, high)}: the {name.replace('_', ' ')} is {angle:.1f} deg; cars "
                f"have {low_end:g} to {high_end:g} ({usual[name]['source']}). Is the sign of "
                f"{axis} right?"
            )


def typical_ranges(kind: str) -> dict[str, dict[str, Any]]:
    """Return ``low``, ``high``, ``unit`` and ``source`` of the usual ranges, by characteristic.

    `kind` is the kind of the suspension, as in the input file.
    """
    text = resources.files(__package__).joinpath("typical.toml").read_text(encoding="utf-8")
    ranges: dict[str, dict[str, Any]] = tomllib.loads(text)
    return {name: usual for name, usual in ranges.items() if usual.get("only", kind) == kind}
