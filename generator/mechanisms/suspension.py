"""Common parts of suspensions: inputs, and further elements of cars than plain springs.

The latter cost a third of an evaluation, so that they are in variants of their own: a spring and a
damper with a curve, friction, stops, and a tyre that damps and lifts off. With the defaults of all
these a variant is the plain suspension.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

from .. import declare as d
from ..declare.declared import parts
from ..declare.parameters import Owner

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..declare.laws import Law

RACK_MOTION = d.Motion(
    "rack",
    "m",
    "displacement of the rack along its axis",
    "velocity of the rack along its axis",
    "acceleration of the rack along its axis",
)
RACK_FORCE = d.Input("rack_force", "N", "force on the rack along its axis")
ROAD_HEIGHT = d.Input("road_height", "m", "height of the road under the tyre, positive up")
ROAD_VELOCITY = d.Input("road_velocity", "m/s", "rate of the road's height", ROAD_HEIGHT)


_SEGMENTS = 10
_Ends = tuple[tuple[d.Body, d.Point], tuple[d.Body, d.Point]]


def spring(rate: float, free_length: float, *, ends: str = "the seats") -> d.LinearSpring:
    """Return a coil spring of a rate [N/m] and a free length [m] between two ends."""
    return d.LinearSpring(
        rate=d.SpringRate("spring_rate", rate, "rate of the spring"),
        free_length=d.Length(
            "spring_free_length", free_length, f"distance of {ends} with the spring force-free"
        ),
    )


def damper(rate: float, *, along: str = "its axis") -> d.LinearDamper:
    """Return a damper of a rate [N s/m] along a named axis."""
    return d.LinearDamper(d.DamperRate("damper_rate", rate, f"rate of the damper along {along}"))


def actuator() -> d.Actuator:
    """Return a force between the ends of the spring, which is an input."""
    meaning = "actuator force, positive when it pushes the spring's seats apart"
    return d.Actuator(d.Input("spring_actuator", "N", meaning))


def tyre(name: str, wheel: d.Wheel, free_height: float, *, rate: float = 200000.0) -> d.LinearTyre:
    """Return a tyre on a road whose height is an input, with free height [m] and rate [N/m]."""
    meaning = "height of the wheel centre at which the tyre is free of force"
    return d.LinearTyre(
        name=name,
        wheel=wheel,
        rate=d.SpringRate("tyre_rate", rate, "radial rate of the tyre"),
        free_height=d.Displacement("tyre_free_height", free_height, meaning),
        road=ROAD_HEIGHT,
    )


def spring_table() -> d.SpringTable:
    """Return the force along a spring besides its linear part: a curve."""
    return d.SpringTable(name="spring_table", segments=_SEGMENTS)


def further_laws(damper: str, longest: float) -> tuple[Law, ...]:
    """Return the forces along a damper besides its linear part: a curve, friction, two stops.

    The damper does not exceed the length `longest` [m].
    """
    table = d.DamperTable(name="damper_table", segments=_SEGMENTS)
    friction = d.Friction(
        level=d.ForceLevel(f"{damper}_friction", 0.0, f"friction of the {damper} in full sliding"),
        speed=d.Speed(
            f"{damper}_friction_speed", 0.01, "velocity at which 71 % of the friction is reached"
        ),
    )
    return table, friction, _stop("bump", damper, 0.0), _stop("rebound", damper, longest)


def spring_and_damper(
    of_spring: _Ends, of_damper: _Ends, laws: tuple[d.LinearSpring, d.Actuator, d.LinearDamper]
) -> tuple[d.ForceElement, d.ForceElement]:
    """Return spring and damper elements between their ends, with further laws of both."""
    spring, actuator, damper = laws
    return (
        d.ForceElement("spring", d.AlongLine(*of_spring), (spring, spring_table(), actuator)),
        d.ForceElement("damper", d.AlongLine(*of_damper), (damper, *further_laws("damper", 1.0))),
    )


def rod_joints(
    rod: d.Body, start: tuple[d.Body, d.Point], end: tuple[d.Body, d.Point]
) -> tuple[d.Universal, d.Spherical]:
    """Return the universal joint at the start of a rod and the ball joint at its end.

    Their names begin with that of the rod; `start` and `end` are the body at each end, and the
    centre of the joint there.
    """
    (base, center), (carrier, ball) = start, end
    shaft = d.Line(center, ball)
    return (
        d.Universal(f"{rod.name}_cross", base, rod, at=center, shaft=shaft, first_axis=d.UP),
        d.Spherical(f"{rod.name}_ball", carrier, rod, at=ball),
    )


def own_values(side: tuple[Any, ...], carrier: d.Body) -> tuple[Owner, ...]:
    """Return the owners of the parameters of one side's parts, without those of its carrier."""
    others = set(parts(carrier))
    found = dict.fromkeys(parts(side))
    return tuple(part for part in found if isinstance(part, Owner) and part not in others)


def _stop(side: Literal["bump", "rebound"], damper: str, touched: float) -> d.Stop:
    length = f"{damper} length at which the {side} stop is touched"
    return d.Stop(
        side=side,
        length=d.Length(f"{side}_stop_length", touched, length),
        rate=d.SpringRate(f"{side}_stop_rate", 0.0, f"rate of the {side} stop at first touch"),
        progression=d.Progression(
            f"{side}_stop_progression", 0.0, f"cubic term of the {side} stop"
        ),
    )


def with_damping_and_liftoff(tyre: d.LinearTyre) -> d.LinearTyre:
    """Return a tyre that also damps and lifts off."""
    return replace(
        tyre,
        damper=d.DamperRate("tyre_damper_rate", 0.0, "radial damping of the tyre"),
        road_velocity=ROAD_VELOCITY,
        lifts_off=d.Share(
            "tyre_lifts_off", 0.0, "1: the tyre can leave the road; 0: it holds on to it"
        ),
    )


_RADIUS = d.Length("tyre_radius", 0.3, "radius of the wheel, at whose lowest point it loads")


def with_tyres_named(mechanism: d.Mechanism, new_name: Callable[[str], str]) -> d.Mechanism:
    """Return a mechanism with other names of its tyres, each from the present name."""
    forces = tuple(
        replace(force, name=new_name(force.name)) if isinstance(force, d.LinearTyre) else force
        for force in mechanism.forces
    )
    return mechanism if forces == mechanism.forces else replace(mechanism, forces=forces)


def bearing_of(declared: d.Formulation, wheel: d.Wheel) -> d.Revolute:
    """Return the driven hinge about which a wheel turns on its carrier."""
    (found,) = (
        joint
        for joint in declared.driven
        if isinstance(joint, d.Revolute)
        and isinstance(joint.second, d.Rotor)
        and joint.axis.towards == wheel.spin
    )
    return found


def with_wheel_loads(corner: d.Formulation) -> d.Formulation:
    """Return the equations of a suspension, or a rigid axle, with the loads of wheels as inputs.

    A wheel turns on its carrier by a driven hinge. The inputs of both wheels of a rigid axle begin
    like their hinges: ``left_``, ``right_``.
    """
    wheels = [tyre.wheel for tyre in corner.mechanism.every(d.LinearTyre)]
    loads = []
    for wheel in wheels:
        bearing = bearing_of(corner, wheel)
        prefix = f"{bearing.name.partition('_')[0]}_" if len(wheels) > 1 else ""
        loads.append(_loads(wheel, bearing, prefix))
    mechanism = replace(corner.mechanism, forces=(*corner.mechanism.forces, *loads))
    return replace(
        corner,
        name=f"{corner.name}_wheel_loads",
        title=f"{corner.title}; loads on the wheel as inputs",
        mechanism=mechanism,
        cites={},
    )


def _loads(wheel: d.Wheel, bearing: d.Revolute, prefix: str) -> d.WheelLoads:
    """Return the loads of a wheel, with a prefix of their inputs."""
    by_shaft = "from the chassis, by a drive shaft or an inboard brake"
    return d.WheelLoads(
        wheel=wheel,
        bearing=bearing,
        radius=_RADIUS,
        contact=_components(f"{prefix}contact_force", "N", "force of the road on the wheel"),
        moment=_components(f"{prefix}wheel_moment", "N m", "moment on the wheel"),
        center=_components(f"{prefix}center_force", "N", "force on the wheel at its centre"),
        shaft=_torque(f"{prefix}shaft_torque", by_shaft),
        hub=_torque(f"{prefix}hub_torque", "from its carrier, by a brake or a motor there"),
    )


def _components(name: str, unit: str, words: str) -> tuple[d.Input, d.Input, d.Input]:
    x, y, z = (
        d.Input(f"{name}_{axis}", unit, f"{words}, {sense} in the axes of the tyre")
        for axis, sense in (("x", "forward"), ("y", "to the left"), ("z", "up"))
    )
    return x, y, z


def _torque(name: str, words: str) -> d.Input:
    return d.Input(name, "N m", f"torque on the wheel {words}; positive as it rolls forward")
