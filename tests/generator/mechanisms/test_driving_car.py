"""Cars that drive against the oracle in maximal coordinates: tyres, torques, air."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import car, model_named
from kintrafo.generator.mechanisms.steering_column import on_a_column as on_column
from oracle.random_states import check_with_the_oracle
from support.models import Built, own

PLACES = {"air_drag_area": 0.7, "air_lift_area": 0.1, "air_pitching": -0.2, "air_center_x": -1.3}


def linear(name):
    return g.LinearContact(name=name)


def on_arms():
    """Return a car on trailing arms: reactions on the body at the front, on arms at the rear."""
    arms = car.of_corners(model_named("trailing_arm"))
    front = car.driving(arms, linear, brakes_on="body", drive_on="body")
    rear = car.driving(arms, linear, relaxing=False, drive_on="carrier")
    return car.full("arms", "A car on arms", (front, rear))


def on_struts_and_a_beam():
    """Return a car with a steered front axle and an undriven axle without sides."""
    struts = car.of_corners(model_named("macpherson"), pulls="control_arm")
    beam = car.of_whole_axle(model_named("twist_beam"))
    axles = car.driving(struts, linear), car.driving(beam, linear, drive_on=None)
    return car.full("struts", "A car on struts and a beam", axles)


def on_a_column():
    """Return a car with a compliant steering column and an inertia of the pinion."""
    struts = on_column(car.of_corners(model_named("macpherson")))
    arms = car.of_corners(model_named("trailing_arm"))
    axles = (car.driving(one, linear, relaxing=False, drive_on=None) for one in (struts, arms))
    return car.full("column", "A car with a column", tuple(axles))


def on_arms_and_rods():
    """Return a car with a driven rigid axle, whose loops close by Newton's method."""
    arms = car.of_corners(model_named("trailing_arm"))
    rods = car.of_whole_axle(model_named("rigid_axle"))
    front = car.driving(arms, linear, relaxing=False, drive_on=None)
    return car.full("rods", "A car on rods", (front, car.driving(rods, linear, drive_on="carrier")))


def built_on(model):
    random = np.random.default_rng(1)
    module = own(model, arrays=True, derivatives=False)
    tyres = {
        p.name: p.default * random.uniform(0.8, 1.2)
        for p in model.mechanism.parameters
        if "tyre_" in p.name
    }
    more = {k: 0.02 * random.uniform() for k in tyres if k.endswith("rolling_resistance")}
    more |= {k: 2e3 * random.uniform() for k in tyres if k.endswith("camber_stiffness")}
    more |= {k: 300.0 for k in tyres if k.endswith("damper_rate")}
    if model.name == "column":
        more |= {"front_pinion_inertia_spin": 0.03, "front_pinion_inertia_diametral": 0.02}
        more |= {"front_column_damper_rate": 20.0, "front_rack_friction": 300.0}
        more |= {"front_pinion_turn": 40.0}  # angles of the oracle are within half a turn
    if model.name == "rods":
        more |= {k: 0.37 for k in tyres if k.startswith("rear_") and k.endswith("unloaded_radius")}
    return Built.of(model, module, PLACES | tyres | more)


def at_speed(built, random):
    """Return a state with wheels on the road that roll and slide at some 15 m/s, or fly."""
    layout, names = built.module.LAYOUT, list(built.module.STATE)
    state = built.module.design_state(built.parameters)
    state[list(layout.joints)] += random.uniform(-0.03, 0.03, len(layout.joints))
    (free,) = layout.free
    state[free : free + 3] = random.uniform(-1.0, 1.0, 3) * [5.0, 5.0, 0.02]
    turned = np.array([np.cos(0.4), *random.uniform(-0.02, 0.02, 2), np.sin(0.4)])
    state[free + 3 : free + 7] = turned / np.linalg.norm(turned)
    state[layout.positions :] = random.uniform(-0.5, 0.5, len(names) - layout.positions)
    state[names.index("body_u")] = 15.0
    for i, name in enumerate(names):
        if name.endswith(("spin_angle_rate", "beta5_rate")):
            state[i] = 15.0 / 0.29 * random.uniform(0.9, 1.1)
    state[layout.positions + layout.speeds :] *= 0.02
    return state


def given(built, random):
    """Return inputs of the size that they have on a road."""
    sizes = {"torque": 400.0, "height": 0.01, "velocity": 0.1, "position": 0.01}
    limits = [sizes.get(name.rpartition("_")[2], 30.0) for name in built.module.INPUTS]
    return np.array(limits) * random.uniform(-1.0, 1.0, len(limits))


@pytest.mark.parametrize("model", [on_arms, on_struts_and_a_beam, on_a_column, on_arms_and_rods])
def test_accelerations_are_those_of_the_oracle(model):
    built, random = built_on(model()), np.random.default_rng(5)
    layout, names = built.module.LAYOUT, list(built.module.STATE)
    rates = slice(layout.positions, layout.positions + layout.speeds)
    for _ in range(4):
        state, inputs = at_speed(built, random), given(built, random)
        motion, named = built.motion(state, inputs), built.named(inputs)
        deflections = {n: float(state[names.index(n)]) for n in names[rates.stop :]}
        moved = {joint: named[m.rates[1]] for joint, m in built.model.motions.items()}
        expected = built.oracle.reduced(motion, named | deflections, moved).accelerations
        found = built("rhs", state, inputs)[rates]
        scale = np.abs(expected).max()
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9 * scale)


def test_axes_of_the_air_are_those_of_the_body_at_design(tmp_path):
    """An arm turns about a line of its own, which is the first of the axes that it has itself."""
    arms = model_named("trailing_arm")
    air = next(f for f in on_arms().mechanism.forces if isinstance(f, g.AirForces))
    sizes = {"drag": 0.7, "lift": 20.0, "pitching": -30.0}
    more = {what: replace(getattr(air, what), default=size) for what, size in sizes.items()}
    place = g.Point("air_center", (-0.3, 0.2, 0.4), "where the air acts")
    acting = replace(air, body=arms.mechanism.body("trailing_arm"), point=place, **more)
    mechanism = replace(arms.mechanism, forces=(*arms.mechanism.forces, acting))
    check_with_the_oracle(replace(arms, mechanism=mechanism), tmp_path, 0.1, count=3)


def test_normal_forces_and_torques_at_rest_conserve_energy():
    """On slippery tyres without dampers, wheels on the road: what they store is in the sum."""
    model = on_arms()
    names = [p.name for p in model.mechanism.parameters]
    still = {n: 0.0 for n in names if n.endswith("damper_rate")}
    slippery = {n: 1e-12 for n in names if n.endswith("tyre_friction")}
    built = Built.of(model, own(model, arrays=True, derivatives=False), still | slippery)
    random = np.random.default_rng(8)
    inputs = np.zeros(len(built.module.INPUTS))
    pressed = [s.endswith("_deflection") for s in built.module.SIGNALS]

    def energies(state):
        """Return what bodies and springs have, and what tyres have by their deflection."""
        depth = np.maximum(built("signals", state, inputs)[pressed], 0.0)
        return np.array([built.oracle.energy(built.motion(state, inputs)), 1e5 * depth @ depth])

    state = at_speed(built, random)
    state[2] = -0.06  # all wheels are on the road
    rates, step = built("rhs", state, inputs), 1e-4
    body, tyres = (energies(state + step * rates) - energies(state - step * rates)) / (2.0 * step)
    assert abs(tyres) > 1e3
    # the third derivative over the step: it falls a hundredfold with a tenth of that
    assert abs(body + tyres) < 1e-3


def test_units_and_bearings_are_checked(refused):
    arms = model_named("trailing_arm")
    (tyre,) = (f for f in arms.mechanism.forces if isinstance(f, g.LinearTyre))
    other = next(j for j in arms.driven if not isinstance(j.second, g.Rotor))
    with pytest.raises(g.DeclarationError) as caught:
        g.ShaftTorque(
            name="shaft",
            wheel=tyre.wheel,
            bearing=other,
            reaction=tyre.wheel.carrier,
            torque=g.Input("torque", "N", "a force"),
        )
    assert len(caught.value.problems) == 3
    air = next(f for f in on_arms().mechanism.forces if isinstance(f, g.AirForces))
    refused(g.DeclarationError, lambda: replace(air, drag=air.density))


@pytest.mark.parametrize("on", ["chassis", "trailing_arm", "wheel"])
def test_a_reaction_is_on_the_carrier_or_on_what_all_hangs_on(on, refused):
    arms = model_named("trailing_arm")
    (tyre,) = (f for f in arms.mechanism.forces if isinstance(f, g.LinearTyre))
    bearing = next(j for j in arms.driven if isinstance(j.second, g.Rotor))
    torque = g.Input("torque", "N m", "a torque")
    body = arms.mechanism.body(on)
    shaft = g.ShaftTorque(
        name="shaft", wheel=tyre.wheel, bearing=bearing, reaction=body, torque=torque
    )
    forces = (*arms.mechanism.forces, shaft)
    model = replace(arms, mechanism=replace(arms.mechanism, forces=forces))
    if on != "wheel":
        generate(model, derivatives=False)
        return
    refused(g.DeclarationError, lambda: generate(model, derivatives=False))
