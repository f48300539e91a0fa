"""Mechanisms on which everything acts that can act on a single joint, point or body."""

from dataclasses import replace

from kintrafo import generator as g
from support.changes import named

from mechanisms.every_closed_form import moving_slider_crank, oblique_four_bar

WORLD_LINE = g.Direction("world_line", fixed=(0, 3, 4))
OWN_LINE = g.Direction("own_line", (0.3, -0.7, 0.4))
OWN_AXIS = g.Direction("own_axis", (-0.2, 0.5, 0.6))


def on_hinge(name, hinge):
    """Return a torsion spring, a rotary damper, a stop and a motor."""
    return g.ForceElement(
        name,
        g.AlongHinge(hinge),
        (
            g.LinearSpring(
                g.TorsionRate(f"{name}_rate", 7.0, "rate"),
                free_length=g.Angle(f"{name}_free", 0.4, "free angle"),
            ),
            g.LinearDamper(g.TorsionDamperRate(f"{name}_damping", 0.6, "damping")),
            g.Stop(
                side="bump",
                length=g.Angle(f"{name}_touch", 0.9, "angle at which the stop is touched"),
                rate=g.TorsionRate(f"{name}_stop_rate", 30.0, "rate of the stop"),
                progression=g.TorsionProgression(f"{name}_stop_cubic", 200.0, "cubic term"),
            ),
            g.Actuator(g.Input(f"{name}_motor", "N m", "moment of the motor")),
        ),
    )


def on_guide(name, guide):
    """Return a spring, a damper, friction, a stop and a linear motor."""
    return g.ForceElement(
        name,
        g.AlongGuide(guide),
        (
            g.LinearSpring(
                g.SpringRate(f"{name}_rate", 80.0, "rate"),
                free_length=g.Displacement(f"{name}_free", -0.03, "slide without force"),
            ),
            g.LinearDamper(g.DamperRate(f"{name}_damping", 5.0, "damping")),
            g.Friction(
                g.ForceLevel(f"{name}_friction", 2.0, "friction"),
                g.Speed(f"{name}_friction_speed", 0.3, "speed of most of it"),
            ),
            g.Stop(
                side="rebound",
                length=g.Displacement(f"{name}_touch", -0.01, "slide at which the stop is touched"),
                rate=g.SpringRate(f"{name}_stop_rate", 300.0, "rate of the stop"),
                progression=g.Progression(f"{name}_stop_cubic", 2e4, "cubic term"),
            ),
            g.Actuator(g.Input(f"{name}_motor", "N", "force of the motor")),
        ),
    )


def pushed(model, body, point):
    """Return forces and moments on a body, in directions of the world and of its own."""
    on = model.mechanism.body(body)

    def given(what, unit):
        return g.Input(f"{body}_{what}", unit, what)

    return (
        g.AppliedForce(on, point, WORLD_LINE, given("push", "N")),
        g.AppliedForce(on, point, OWN_LINE, given("thrust", "N"), follows=True),
        g.AppliedMoment(on, WORLD_LINE, given("turn", "N m")),
        g.AppliedMoment(on, OWN_AXIS, given("twist", "N m"), follows=True),
    )


def _loaded(model, name, *forces):
    mechanism = replace(model.mechanism, name=name, forces=(*model.mechanism.forces, *forces))
    return replace(model, name=name, mechanism=mechanism)


def loaded_crank(name="loaded_crank"):
    """Return the slider-crank of which all moves: a driven hinge and a guide that follows."""
    model = moving_slider_crank(name)
    drive, way = map(model.mechanism.joint, ("drive", "way"))
    mark = g.Point("mark", (0.3, 0.1, 0.2))
    return _loaded(
        model, name, on_hinge("motor", drive), on_guide("rail", way), *pushed(model, "rod", mark)
    )


def loaded_bar(name="loaded_bar"):
    """Return the four-bar in an oblique plane, a hinge that follows under load."""
    model = oblique_four_bar()
    pivot, point = model.mechanism.joint("pivot"), named(model, g.Point, "coupler_com")
    return _loaded(model, name, on_hinge("bearing", pivot), *pushed(model, "coupler", point))
