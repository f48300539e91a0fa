"""The torque of the steering wheel of a stationary car, against energies."""

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import LINES
from kintrafo.vehicle.analysis.handling import drive, load_manoeuvre
from kintrafo.vehicle.analysis.loads.on_a_car import CarInMotion
from kintrafo.vehicle.assembly.of import assembly_of
from scipy.integrate import dblquad
from scipy.interpolate import CubicSpline

CHANGES = {"largest_deg": 240.0, "step_deg": 20.0}


@pytest.fixture(scope="module")
def car():
    return kintrafo.load("driving_car")


@pytest.fixture(scope="module")
def found(car):
    return drive(car, "parking", CHANGES).curves[""]


def test_the_lifting_torque_is_the_slope_of_the_energy(car, found):
    """The energy is that of weights, springs, bar and tyres at rest."""
    model = kintrafo.CarModel(car)
    assembly = assembly_of(model)
    angles = np.deg2rad(np.linspace(-240.0, 240.0, 25))
    racks = assembly.controls.rack(angles)["rack_position"]
    rests = [kintrafo.equilibrium(model, rack_position=rack) for rack in racks]
    states, inputs = np.array(rests), np.array([rest.inputs for rest in rests])
    signals = model.signals(states, inputs)
    motion = CarInMotion(assembly, states, inputs)
    heights = model.evaluate("positions", states, inputs)[:, :, 2]
    masses = np.array([model.parameters.get(f"{b}_mass", 0.0) for b in model.equations.BODIES])

    def slope(values):
        return CubicSpline(angles, values)(angles, 1)

    energy = 9.81 * slope(heights @ masses)
    for line in LINES:
        energy -= signals[f"{line}_spring_force"] * slope(signals[f"{line}_length"])
    energy -= signals["front_bar_spring_moment"] * slope(signals["front_bar_angle"])
    for wheel in car.wheels:
        energy += signals[f"{wheel}_fz"] * slope(signals[f"{wheel}_deflection"])
        # the overturning moment of a tyre that leans has no energy, but does work
        end, _, side = wheel.partition("_")
        wheel_of_axle = motion.axle(end).poses[f"_{side}"].wheels["wheel"]
        upward = (wheel_of_axle.vehicle.side * wheel_of_axle.axis * motion.up).sum(axis=1)
        energy -= signals[f"{wheel}_mx"] * slope(np.arcsin(upward))
    torque = found["lifting_torque"].values[12:37][::-1]  # from the left to the right
    inside = slice(3, -3)  # where the slopes of splines are accurate
    assert np.ptp(torque) > 2.0
    np.testing.assert_allclose(torque[inside], energy[inside], atol=2e-4)


def test_the_moment_of_a_wheel_is_that_of_a_round_contact():
    parking = load_manoeuvre("parking", {"friction": 0.7, "pressure_kPa": 200.0, "twist_deg": 2.0})
    load, pressure = 4000.0, 200e3
    radius = np.sqrt(load / (np.pi * pressure))
    sliding, _ = dblquad(lambda r, _: 0.7 * pressure * r * r, 0.0, 2.0 * np.pi, 0.0, radius)
    steer = np.deg2rad([0.0, 2.0, 60.0, 58.0, 0.0])[None]
    moments = parking.moments(steer, np.full_like(steer, load))[0] / sliding
    back = -1.0 + 2.0 * np.exp(-1.0)
    np.testing.assert_allclose(moments, [0.0, 1.0 - np.exp(-1.0), 1.0, back, -1.0], atol=1e-9)


def test_the_work_of_a_turn_is_that_of_the_friction(found):
    """From the left to the right and back, lifting does no work in total."""
    loop = found.isel(steering_wheel_angle=slice(12, None))
    angle = loop["steering_wheel_angle"].values
    torque, lifting = loop["steering_torque"].values, loop["lifting_torque"].values
    assert np.trapezoid(lifting, angle) == pytest.approx(0.0, abs=1e-9)
    steer, mz = loop["steer"].values, loop["mz"].values
    friction = sum(np.trapezoid(*pair) for pair in zip(mz, steer, strict=True))
    # by the trapezoidal rule: steps of 20 deg, in which wheels turn by 1.3 deg
    assert np.trapezoid(torque, angle) == pytest.approx(friction, rel=2e-3)
    without = load_manoeuvre("parking", CHANGES | {"friction": 0.0})
    assert np.all(without.moments(steer, loop["fz"].values) == 0.0)


def test_mistakes_are_named(car, refused):
    for changes in (
        {"step_deg": 200.0},
        {"step_deg": 1e-3},
        {"pressure_kPa": 2.3},
        {"friction": 80.0},
    ):
        with refused(kintrafo.InputError):
            drive(car, "parking", CHANGES | changes)
    with pytest.raises(kintrafo.InputError, match=r"-2000\.0 deg"):
        drive(car, "parking", CHANGES | {"largest_deg": 2000.0, "step_deg": 500.0})
