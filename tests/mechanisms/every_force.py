"""Mechanisms on which everything acts that can act on a single joint, point or body."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from kintrafo.generator import (
    Actuator,
    AlongGuide,
    AlongHinge,
    Angle,
    AppliedForce,
    AppliedMoment,
    DamperRate,
    Direction,
    Displacement,
    Force,
    ForceElement,
    ForceLevel,
    Formulation,
    Friction,
    Input,
    LinearDamper,
    LinearSpring,
    Point,
    Progression,
    Speed,
    SpringRate,
    Stop,
    TorsionDamperRate,
    TorsionProgression,
    TorsionRate,
)
from support.changes import named

from mechanisms.every_closed_form import moving_slider_crank, oblique_four_bar

if TYPE_CHECKING:
    from kintrafo.generator import Prismatic, Revolute

WORLD_LINE = Direction("world_line", fixed=(0, 3, 4))
OWN_LINE = Direction("own_line", (0.3, -0.7, 0.4))
OWN_AXIS = Direction("own_axis", (-0.2, 0.5, 0.6))


def on_hinge(name: str, hinge: Revolute) -> ForceElement:
    """Return a torsion spring, a rotary damper, a stop and a motor."""
    return ForceElement(
        name,
        AlongHinge(hinge),
        (
            LinearSpring(
                TorsionRate(f"{name}_rate", 7.0, "rate"),
                free_length=Angle(f"{name}_free", 0.4, "free angle"),
            ),
            LinearDamper(TorsionDamperRate(f"{name}_damping", 0.6, "damping")),
            Stop(
                side="bump",
                length=Angle(f"{name}_touch", 0.9, "angle at which the stop is touched"),
                rate=TorsionRate(f"{name}_stop_rate", 30.0, "rate of the stop"),
                progression=TorsionProgression(f"{name}_stop_cubic", 200.0, "cubic term"),
            ),
            Actuator(Input(f"{name}_motor", "N m", "moment of the motor")),
        ),
    )


def on_guide(name: str, guide: Prismatic) -> ForceElement:
    """Return a spring, a damper, friction, a stop and a linear motor."""
    return ForceElement(
        name,
        AlongGuide(guide),
        (
            LinearSpring(
                SpringRate(f"{name}_rate", 80.0, "rate"),
                free_length=Displacement(f"{name}_free", -0.03, "slide without force"),
            ),
            LinearDamper(DamperRate(f"{name}_damping", 5.0, "damping")),
            Friction(
                ForceLevel(f"{name}_friction", 2.0, "friction"),
                Speed(f"{name}_friction_speed", 0.3, "speed of most of it"),
            ),
            Stop(
                side="rebound",
                length=Displacement(f"{name}_touch", -0.01, "slide at which the stop is touched"),
                rate=SpringRate(f"{name}_stop_rate", 300.0, "rate of the stop"),
                progression=Progression(f"{name}_stop_cubic", 2e4, "cubic term"),
            ),
            Actuator(Input(f"{name}_motor", "N", "force of the motor")),
        ),
    )


def pushed(model: Formulation, body: str, point: Point) -> tuple[Force, ...]:
    """Return forces and moments on a body, in directions of the world and of its own."""
    on = model.mechanism.body(body)

    def given(what: str, unit: str) -> Input:
        return Input(f"{body}_{what}", unit, what)

    return (
        AppliedForce(on, point, WORLD_LINE, given("push", "N")),
        AppliedForce(on, point, OWN_LINE, given("thrust", "N"), follows=True),
        AppliedMoment(on, WORLD_LINE, given("turn", "N m")),
        AppliedMoment(on, OWN_AXIS, given("twist", "N m"), follows=True),
    )


def _loaded(model: Formulation, name: str, *forces: Force) -> Formulation:
    mechanism = replace(model.mechanism, name=name, forces=(*model.mechanism.forces, *forces))
    return replace(model, name=name, mechanism=mechanism)


def loaded_crank(name: str = "loaded_crank") -> Formulation:
    """Return the slider-crank of which all moves: a driven hinge and a guide that follows."""
    model = moving_slider_crank(name)
    drive, way = map(model.mechanism.joint, ("drive", "way"))
    mark = Point("mark", (0.3, 0.1, 0.2))
    return _loaded(
        model, name, on_hinge("motor", drive), on_guide("rail", way), *pushed(model, "rod", mark)
    )


def loaded_bar(name: str = "loaded_bar") -> Formulation:
    """Return the four-bar in an oblique plane, a hinge that follows under load."""
    model = oblique_four_bar()
    pivot, point = model.mechanism.joint("pivot"), named(model, Point, "coupler_com")
    return _loaded(model, name, on_hinge("bearing", pivot), *pushed(model, "coupler", point))
