"""Damper curve, friction, stops and tyre of several kinds of corners, through their input files.

The equations are compared with maximal coordinates in `test_mechanisms`.
"""

import re

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, Suspension
from kintrafo.generated import double_wishbone, double_wishbone_general
from kintrafo.vehicle.files.schema import page_text
from kintrafo.vehicle.models.positions import design_height
from scipy.interpolate import PchipInterpolator

# A damper in the strut, one at the arm with its spring, one behind a rocker, and two by themselves.
CARS = {
    name: Suspension.load(name)
    for name in ("reference_car", "double_wishbone_car", "push_rod_car", "multi_link_car",
                 "trailing_arm_car")
}  # fmt: skip
VELOCITIES = (-1.0, -0.3, -0.05, 0.0, 0.05, 0.3, 1.0)
FORCES = (-2500.0, -1300.0, -400.0, 0.0, 250.0, 600.0, 1100.0)
STOPS = {
    "bump_stop": {"clearance_mm": 15.0, "rate_N_per_m": 2e4, "progression_N_per_mm3": 0.02},
    "rebound_stop": {"clearance_mm": 20.0, "rate_N_per_m": 5e4},
}

each_car = pytest.mark.parametrize("car", CARS.values(), ids=CARS)


def with_curve(car, **more):
    """Return a car whose damper has a curve."""
    curve = {"velocity_m_per_s": list(VELOCITIES), "force_N": list(FORCES)} | more
    if car.STOPPED == "strut":
        return car.with_changes({"strut.damper_rate_N_s_per_m": None, "damper": curve})
    given = {f"damper.{key}": values for key, values in curve.items()}
    return car.with_changes({"damper.rate_N_s_per_m": None} | given)


def slope_of(model, signal, state):
    """Return the derivative of a signal by the rate of the arm."""
    by_state = model.evaluate("signals_jacobian", state)
    rate = model.state_names.index(f"{model.names.arm}_rate")
    return by_state[model.signal_names.index(signal), rate]


def at_damper_velocity(model, velocity):
    """Return the state at design with the damper compressed at some velocity [m/s]."""
    slope = slope_of(model, f"{model.suspension.STOPPED}_velocity", model.design_state)
    return model.state(**{f"{model.names.arm}_rate": -velocity / slope})


@each_car
def test_damper_curve_is_the_monotone_cubic(car):
    """SciPy's own interpolation, with straight lines outside."""
    model, curve = Model(with_curve(car)), PchipInterpolator(VELOCITIES, FORCES)
    for velocity in np.linspace(-2.0, 2.0, 41):
        inside = np.clip(velocity, VELOCITIES[0], VELOCITIES[-1])
        expected = curve(inside) + curve.derivative()(inside) * (velocity - inside)
        found = model.signal("damper_force", at_damper_velocity(model, velocity))
        # in bump a damper pushes the ends apart
        assert float(found) == pytest.approx(float(expected), rel=1e-12, abs=1e-9)


@each_car
def test_straight_lines_between_the_points_of_a_damper(car):
    """As NumPy's interpolation, and on as the last lines go; the page has both of its figures."""
    models = {way: Model(with_curve(car, interpolation=way)) for way in ("linear", "cubic")}

    def force_of(way, velocity):
        model = models[way]
        return float(model.signal("damper_force", at_damper_velocity(model, velocity)))

    for velocity in np.linspace(-0.99, 0.99, 23):
        expected = np.interp(velocity, VELOCITIES, FORCES)
        assert force_of("linear", velocity) == pytest.approx(expected, rel=1e-12, abs=1e-9)
    for velocity, force, slope in ((1.5, 1100.0, 500.0 / 0.7), (-1.5, -2500.0, 1200.0 / 0.7)):
        beyond = force + slope * (abs(velocity) - 1.0) * np.sign(velocity)
        assert force_of("linear", velocity) == pytest.approx(beyond, rel=1e-12)
    printed = [f"{force_of(way, -0.7):.0f} N" for way in ("cubic", "linear")]
    assert printed == ["-2177 N", "-1986 N"]
    page = re.sub(r"\s+", " ", page_text({}))
    assert "has {} at -0.7 m/s, straight lines have {} there".format(*printed) in page


@each_car
def test_stops_begin_at_their_clearance(car):
    model, element = Model(car.with_changes(STOPS)), f"{car.STOPPED}_length"
    design = float(model.signal(element, model.design_state))
    seen = []
    for travel in np.linspace(-0.1, 0.1, 41):
        signals = model.signals(kintrafo.state_at_height(model, design_height(model) + travel))
        closed = design - float(signals[element])
        bump, rebound = max(closed - 0.015, 0.0), max(-closed - 0.02, 0.0)
        # in newtons: rates of some 1e4 N/m times roundings of lengths of 1 m
        assert signals["bump_stop_force"] == pytest.approx(2e4 * bump + 2e7 * bump**3, abs=1e-9)
        assert signals["rebound_stop_force"] == pytest.approx(-5e4 * rebound, abs=1e-9)
        seen.append(closed)
    assert max(seen) > 0.025  # both were touched
    assert min(seen) < -0.03


@each_car
def test_events_of_the_stops(car):
    model, element = Model(car.with_changes(STOPS)), car.STOPPED
    start = kintrafo.state_at_height(model, design_height(model) - 0.1)
    events = [f"{element}_reaches_{side}_stop" for side in ("bump", "rebound")]
    result = kintrafo.simulate(model, (0.0, 0.5), start, events=events)
    design = float(model.signal(f"{element}_length", model.design_state))
    for states, reached in zip(result.y_events, (design - 0.015, design + 0.02), strict=True):
        for state in states:
            length = float(model.signal(f"{element}_length", state))
            assert length == pytest.approx(reached, abs=1e-7)
    assert len(result.t_events[0]) >= 1  # released in rebound, it reaches the other stop


@each_car
def test_stops_are_part_of_the_wheel_rate(car):
    """The wheel rate is the slope of the force that holds the wheel at a height."""
    model = Model(car.with_changes(STOPS))

    def held(travel):
        """Return the load on the wheel that springs and stops carry, by virtual work."""
        state = kintrafo.state_at_height(model, design_height(model) + travel)
        rise, forces = slope_of(model, "wheel_velocity", state), model.signals(state)
        stopped = f"{car.STOPPED}_velocity"
        carriers = dict.fromkeys(("bump_stop_force", "rebound_stop_force"), stopped)
        carriers["spring_force"] = stopped if car.STOPPED == "strut" else "spring_velocity"
        return -sum(
            float(forces[force]) * slope_of(model, way, state) / rise
            for force, way in carriers.items()
        )

    for travel in (-0.07, 0.0, 0.06):
        found = kintrafo.characteristics.over(model, "travel", [travel])["wheel_rate"][0]
        step = 1e-4
        slope = (held(travel + step) - held(travel - step)) / (2.0 * step)
        # second differences: the third derivative of the cubic stop times a step squared
        assert float(found) == pytest.approx(slope, rel=1e-5)


@each_car
def test_tyre_that_lifts_off_carries_nothing_in_the_air(car):
    grounded, lifting = Model(car), Model(car.with_changes({"tyre.lifts_off": True}))
    at_rest = grounded.signals(kintrafo.equilibrium(grounded))
    sag = float(at_rest["tyre_force"]) / grounded.parameters["tyre_rate"]
    for part, in_the_air in ((0.8, False), (1.2, True)):
        height = float(at_rest["wheel_center_z"]) + part * sag
        # a plain array: the inputs that the state carries are those of another model
        state = np.array(kintrafo.state_at_height(grounded, height))
        held, free = (float(m.signal("tyre_force", state)) for m in (grounded, lifting))
        assert free == (0.0 if in_the_air else pytest.approx(held, rel=1e-13))
        assert (held < 0.0) == in_the_air


@each_car
def test_friction_resists_and_can_be_left_out(car):
    section = "strut" if car.STOPPED == "strut" else "damper"
    rough = car.with_changes({f"{section}.friction_N": 60.0})
    smooth = rough.without_friction()
    assert getattr(smooth, section).friction_N == 0.0
    assert smooth.without_friction() is smooth
    model = Model(rough)
    force = float(model.signal("friction_force", at_damper_velocity(model, 0.4)))
    assert force == pytest.approx(60.0 * 0.4 / np.hypot(0.4, 0.01), rel=1e-12)


@each_car
def test_mirror_image_moves_alike(car):
    full = with_curve(car).with_changes(STOPS | {"tyre.lifts_off": True})
    right, left = Model(full), Model(full.mirrored())
    rates = {right.state_names[2]: 1.0, right.state_names[3]: 80.0}
    found, image = (m.evaluate("rhs", m.state(**rates)) for m in (right, left))
    assert image == pytest.approx(found, rel=1e-11)


# -- plain and general equations ----------------------------------------------------------------

WISHBONES, STRUT = CARS["double_wishbone_car"], CARS["reference_car"]
# With equations for more, all of it switched off.
OFF = {
    "strut": (STRUT, {"hardpoints.strut_lower": [5.0, -710.0, 180.0]}),
    "wishbones": (WISHBONES, {"bump_stop": {"clearance_mm": 20.0, "rate_N_per_m": 0.0}}),
}
MORE = [
    {"damper": {"velocity_m_per_s": list(VELOCITIES), "force_N": list(FORCES)}},
    {"damper.friction_N": 10.0},
    {"tyre.lifts_off": True},
    {"tyre.damper_rate_N_s_per_m": 5.0},
]


@pytest.mark.parametrize("changes", MORE, ids=lambda changes: next(iter(changes)))
def test_only_what_has_more_is_solved_by_longer_equations(changes):
    assert Model(WISHBONES).equations is double_wishbone
    model = Model(WISHBONES.with_changes(changes))
    assert model.equations is double_wishbone_general
    assert set(model.suspension.parameters()) == set(double_wishbone_general.PARAMETERS)
    assert len(model.suspension.beyond_the_plain()) == 1


@pytest.mark.parametrize(("car", "changes"), OFF.values(), ids=OFF)
def test_with_all_of_it_switched_off_the_numbers_are_those_of_the_plain_one(car, changes):
    plain, model = Model(car), Model(car.with_changes(changes))
    name = f"{plain.equations.NAME}_general"
    assert name == model.equations.NAME
    random = np.random.default_rng(3)
    for _ in range(20):
        state = plain.design_state + random.normal(size=4) * [0.1, 3.0, 2.0, 50.0]
        values = random.normal(size=5) * [0.02, 0.3, 5.0, 300.0, 0.01]
        given = dict(zip(plain.input_names, values, strict=True))
        found = model.evaluate("rhs", state, model.inputs(given))
        expected = plain.evaluate("rhs", state, plain.inputs(given))
        # a longer sum of the same forces, of which accelerations are small differences
        assert found == pytest.approx(expected, rel=1e-11, abs=1e-9)
