"""A car: suspensions on a body that moves, with one, two, three or six degrees of freedom.

The suspensions are those of one side, or whole axles, as they are declared on a ground: here the
body of the car replaces that ground, and the road is the ground. The body moves along the upward
axis of the world (heave), turns about the axis to the left (pitch) and about the axis forward
(roll), in this order, through its centre of mass, and does not travel. The body of a car that
drives moves freely; its wheels roll on tyres, and have torques of brakes and drive (`full`).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

from .. import declare as d
from ..declare.composition import replaced
from ..declare.parameters import Owner
from ..program.vectors import Vector
from . import axle, macpherson
from .suspension import bearing_of, with_tyres_named

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..declare.contact_laws import ContactLaw

FREEDOMS = ("heave", "pitch", "roll")
"""Coordinates of the body, in the order of its joints."""

FREE = ("free",)
"""Instead of some of these: the body moves freely in the world."""

ENDS = ("front", "rear")

Reaction = Literal["body", "carrier"]
"""The part on which a wheel's torque reacts: the body of the car, or the carrier of the wheel."""

ROAD = d.Ground("road")
BODY = d.Body("body", 1200.0, (-1.15, 0.0, 0.55), (450.0, 1600.0, 1800.0))

_TYRE = "tyre"
_LEFTWARD = d.Direction("leftward", fixed=Vector.of(0, 1, 0))
_UPWARD = d.Direction(
    "upward", (0.0, 0.0, 1.0), "direction opposite to gravity, in the axes of the road"
)
_ANGLES: dict[Literal["yaw", "pitch", "roll"], str] = {
    "yaw": "turn of the body about the upward axis, positive to the left",
    "pitch": "pitch of the body after yaw, positive nose down",
    "roll": "roll of the body after yaw and pitch, positive with its left side up",
}
_MEANINGS = {
    "heave": "height of the centre of mass of the body above that at design",
    "pitch": "pitch of the body, positive nose down",
    "roll": "roll of the body, positive with its left side up",
}
_AIR = d.AirForces(
    name="air",
    body=BODY,
    point=d.Point("air_center", (-1.15, 0.0, 0.55), "where the air acts on the body"),
    density=d.Parameter("air_density", 1.2, "kg/m^3", "density of the air", least=0.0),
    drag=d.Parameter("air_drag_area", 0.0, "m^2", "drag coefficient times area", least=0.0),
    lift=d.Parameter("air_lift_area", 0.0, "m^2", "lift coefficient times area, positive upward"),
    pitching=d.Parameter(
        "air_pitching", 0.0, "m^3", "the same of the pitching moment, times a length, nose down"
    ),
)


def quarter(corner: d.Formulation) -> d.Formulation:
    """Return the equations of a quarter car: a suspension whose body heaves."""
    name, title = f"quarter_{corner.name}", f"Quarter car: {_lower(corner.mechanism.title)}"
    return replace(_on_the_body(corner, FREEDOMS[:1]), name=name, title=title)


def car(
    name: str, title: str, axles: Sequence[d.Formulation], freedoms: Sequence[str]
) -> d.Formulation:
    """Return the equations of a car of two axles.

    The front and the rear one are from `of_corners` or `of_whole_axle`; `freedoms` are coordinates
    of the body, the first ones of `FREEDOMS`, or `FREE`.
    """
    joints, coordinates = _body_joints(freedoms)
    parts = [_on_the_car(one, f"{end}_") for end, one in zip(ENDS, axles, strict=True)]

    def of_all(what: str) -> tuple[Any, ...]:
        return tuple(dict.fromkeys(each for part in parts for each in part[what]))

    motions = {guide: motion for part in parts for guide, motion in part["prescribed"]}
    return d.Formulation(
        name=name,
        title=title,
        mechanism=d.Mechanism(
            name=name,
            title=title,
            joints=(*joints, *of_all("joints")),
            forces=tuple(map(_with_a_short_name, of_all("forces"))),
            coordinates=(*coordinates, *of_all("coordinates")),
        ),
        independent=(*joints, *of_all("independent")),
        prescribed=motions,
        massive=(BODY, *of_all("massive")),
        held={"rack_held": tuple(motions)} if motions else {},
        allow_iteration=any(one.allow_iteration for one in axles),
    )


def full(name: str, title: str, axles: Sequence[d.Formulation]) -> d.Formulation:
    """Return the equations of a car that drives: its body moves freely, in still air.

    The front and the rear axle are from `driving`.
    """
    found = car(name, title, axles, FREE)
    mechanism = replace(
        found.mechanism,
        forces=(*map(_on_a_slope, map(_with_heading, found.mechanism.forces)), _AIR),
        outputs=(
            d.AccelerationOf("body_acceleration", BODY, BODY.center, "centre of mass of the body"),
        ),
    )
    # its rack moves: a variant with a rack at rest would take as long again to compile
    return replace(found, mechanism=mechanism, held={})


def _on_a_slope(force: d.Force) -> d.Force:
    """Return the weight with a direction of parameters, since the road may be a slope."""
    return replace(force, upward=_UPWARD) if isinstance(force, d.Weight) else force


def driving(
    of_a_car: d.Formulation,
    law: Callable[[str], ContactLaw],
    *,
    relaxing: bool = True,
    brakes_on: Reaction = "carrier",
    drive_on: Reaction | None = "body",
) -> d.Formulation:
    """Return an axle whose tyres roll, with torques of brakes and drive on its wheels.

    It is from `of_corners` or `of_whole_axle`. `law` returns the contact law of a tyre, by the
    prefix of its parameters; `relaxing` is whether slips follow with the relaxation lengths, which
    takes two states of each tyre. `brakes_on` and `drive_on` are the parts that react the torque;
    None: nothing drives the axle.
    """
    chassis = of_a_car.mechanism.body(of_a_car.mechanism.ground)
    slow = d.AngularSpeed(
        "brake_standstill", 0.5, "spin at which 71 % of the torque of a brake acts"
    )
    forces: list[d.Force] = []
    for force in of_a_car.mechanism.forces:
        if not isinstance(force, d.LinearTyre):
            forces.append(force)
            continue
        bearing = bearing_of(of_a_car, force.wheel)
        rolling = _rolling(force, bearing, law(force.name), relaxing=relaxing)
        forces += [rolling, _torque(rolling, "brake", brakes_on, chassis, slow)]
        if drive_on is not None:
            forces.append(_torque(rolling, "drive", drive_on, chassis, None))
    return replace(of_a_car, mechanism=replace(of_a_car.mechanism, forces=tuple(forces)))


def _torque(
    tyre: d.RollingTyre,
    kind: Literal["brake", "drive"],
    on: Reaction,
    chassis: d.Body,
    standstill: d.AngularSpeed | None,
) -> d.ShaftTorque:
    """Return the torque of a brake, which has a standstill, or of the drive on a wheel."""
    side = tyre.name.removesuffix(f"_{_TYRE}")
    words = "torque of the drive on this wheel, positive forward"
    if standstill is not None:
        words = "torque of the brake of this wheel as it slips; less than zero is no torque"
    return d.ShaftTorque(
        name=f"{side}_{kind}_moment",
        wheel=tyre.wheel,
        bearing=tyre.bearing,
        reaction=tyre.wheel.carrier if on == "carrier" else chassis,
        torque=d.Input(f"{side}_{kind}_torque", "N m", words),
        standstill=standstill,
    )


def _rolling(
    tyre: d.LinearTyre, bearing: d.Revolute, law: ContactLaw, *, relaxing: bool
) -> d.RollingTyre:
    """Return a rolling tyre instead of a radial spring."""
    rising = tyre.road.name.replace("height", "velocity")
    along = d.InternalState(f"{tyre.name}_along", "m", "deflection of the contact, forward")
    across = d.InternalState(f"{tyre.name}_across", "m", "deflection of the contact, to the left")
    return d.RollingTyre(
        name=tyre.name,
        wheel=tyre.wheel,
        bearing=bearing,
        law=law,
        road=tyre.road,
        damper=tyre.damper
        or d.DamperRate(f"{tyre.name}_damper_rate", 0.0, "damping of the tyre along the normal"),
        road_velocity=tyre.road_velocity
        or d.Input(rising, "m/s", "rate of the road's height", tyre.road),
        deflections=(along, across) if relaxing else None,
    )


def _with_heading(force: d.Force) -> d.Force:
    """Return a tyre with the angles of its wheel from the heading of the body."""
    if not isinstance(force, d.RollingTyre):
        return force
    return replace(force, wheel=replace(force.wheel, heading=BODY))


def _on_the_car(axle_on_ground: d.Formulation, prefix: str) -> dict[str, tuple[Any, ...]]:
    """Return the parts of an axle, under names of its own, on the body of a car."""
    source = axle_on_ground.mechanism
    copy = d.Copy(source, prefix, own=source.every(Owner))
    on = {source.body(source.ground): BODY}
    parts = {
        "joints": source.joints,
        "forces": source.forces,
        "coordinates": source.coordinates,
        "independent": axle_on_ground.independent,
        "massive": axle_on_ground.massive,
        "prescribed": tuple(axle_on_ground.prescribed),
    }
    found = {name: replaced(copy.of(each), on) for name, each in parts.items()}
    guided = zip(found["prescribed"], axle_on_ground.prescribed.values(), strict=True)
    return found | {"prescribed": tuple(guided)}


def of_corners(corner: d.Formulation, *, pulls: str = "", steered: bool = True) -> d.Formulation:
    """Return an axle of two suspensions for a car.

    `corner` has the equations of the suspension of the right side, on a chassis that rests. The
    drop link of an anti-roll bar is joined to its body `pulls`; without that, there is no bar.
    `steered` is whether its rack, if any, moves; otherwise it is a part of the body.
    """
    one = corner if steered else with_a_fixed_rack(corner)
    mechanism = axle.mechanism(_TYRE, one.title, one, pulls=pulls, own=True, end=_TYRE)
    return axle.model(one, mechanism)


def of_whole_axle(whole: d.Formulation) -> d.Formulation:
    """Return an axle without sides, such as a rigid one, for a car."""
    mechanism = with_tyres_named(whole.mechanism, lambda name: name.replace("axle", _TYRE))
    return replace(whole, mechanism=mechanism)


def with_a_fixed_rack(corner: d.Formulation) -> d.Formulation:
    """Return a suspension whose rack, if it has one, is a part of the chassis."""
    if not corner.prescribed:
        return corner
    guides = tuple(corner.prescribed)
    source, ground = corner.mechanism, corner.mechanism.body(corner.mechanism.ground)
    mechanism = replace(
        source,
        joints=tuple(joint for joint in source.joints if joint not in guides),
        forces=tuple(force for force in source.forces if force.along not in guides),
        coordinates=tuple(c for c in source.coordinates if c.joint not in guides),
    )
    fixed = {guide.second: ground for guide in guides}
    return replace(
        corner,
        mechanism=replaced(mechanism, fixed),
        independent=replaced(corner.independent, fixed),
        prescribed={},
        held={},
        cites={},
    )


def _on_the_body(source: d.Formulation, freedoms: Sequence[str]) -> d.Formulation:
    """Return equations in which the moving body of a car replaces the ground."""
    joints, coordinates = _body_joints(freedoms)
    on = {source.mechanism.body(source.mechanism.ground): BODY}
    mechanism = replace(
        source.mechanism,
        joints=(*joints, *replaced(source.mechanism.joints, on)),
        forces=replaced(source.mechanism.forces, on),
        coordinates=(*coordinates, *replaced(source.mechanism.coordinates, on)),
    )
    return replace(
        source,
        mechanism=mechanism,
        independent=(*joints, *replaced(source.independent, on)),
        massive=(BODY, *replaced(source.massive, on)),
        prescribed=replaced(source.prescribed, on),
        held=replaced(source.held, on),
        cites={},
    )


def _body_joints(
    freedoms: Sequence[str],
) -> tuple[tuple[d.Joint, ...], tuple[d.RelativeCoordinate, ...]]:
    """Return the joints from the road to the body, and their coordinates."""
    if freedoms == FREE:
        free = d.Free("body_free", BODY)
        angles = (free.coordinate(kind, f"body_{kind}", _ANGLES[kind]) for kind in _ANGLES)
        return (free,), tuple(angles)
    bodies = [ROAD, *(d.Body(f"body_after_{f}", 0.0, BODY.center) for f in freedoms[:-1]), BODY]
    joints: list[d.Joint] = []
    coordinates = []
    for freedom, first, second in zip(freedoms, bodies[:-1], bodies[1:], strict=True):
        if freedom == "heave":
            guide = d.Prismatic("body_guide", first, second, direction=d.UP)
            joints.append(guide)
            coordinates.append(guide.slide(freedom, _MEANINGS[freedom]))
            continue
        along = _LEFTWARD if freedom == "pitch" else d.FORWARD
        hinge = d.Revolute(f"body_{freedom}_hinge", first, second, axis=d.Line(BODY.center, along))
        joints.append(hinge)
        coordinates.append(hinge.angle(freedom, _MEANINGS[freedom]))
    return tuple(joints), tuple(coordinates)


def _with_a_short_name(force: d.Force) -> d.Force:
    if not isinstance(force, d.LinearTyre | d.RollingTyre):
        return force
    return replace(force, name=force.name.removesuffix(f"_{_TYRE}"))


def _lower(title: str) -> str:
    return title[:1].lower() + title[1:] if title[1:2].islower() else title


MODELS = (quarter(macpherson.MODELS[0]),)
