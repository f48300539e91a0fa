"""Motions of the compiled right-hand sides: expected values, energy, and the wheel's spin.

All are integrated with DOP853 at a relative tolerance of 1e-13, close to the smallest that SciPy
takes. The error that it leaves over a second is about 1e-12.
"""

from collections.abc import Callable

import numpy as np
import pytest
from cases import car_parameters
from kintrafo.generated import macpherson, macpherson_free_rack
from oracle.constraints import Array
from oracle.newton import Mechanism
from oracle.reference import BETA1_DESIGN, DYNAMICS, DYNAMICS_COLUMNS, SPIN_RATE, vector
from scipy.integrate import solve_ivp

TOLERANCE = 1e-13
# Height 0.325 m, at rest
START = [BETA1_DESIGN - DYNAMICS[0, 1], 0.0, 0.0, SPIN_RATE]


def integrate(derivative: Callable[[float, Array], Array], start, times: Array) -> Array:
    """Return the states at some times, one a row."""
    result = solve_ivp(
        derivative,
        (times[0], times[-1]),
        start,
        method="DOP853",
        t_eval=times,
        rtol=TOLERANCE,
        atol=TOLERANCE,
    )
    assert result.success
    return result.y.T


def test_reference_motion() -> None:
    times = DYNAMICS[:, 0]
    states = integrate(lambda _, y: macpherson.rhs_rack_held(y), START, times)
    signals = macpherson.signals(states)
    names = list(macpherson.SIGNALS)
    found = {
        "time": times,
        "arm_rise": BETA1_DESIGN - states[:, 0],
        "arm_rise_rate": -states[:, 2],
        "spin": states[:, 1],
        "spin_rate": states[:, 3],
        "wheel_center_z": signals[:, names.index("wheel_center_z")],
        "wheel_center_z_rate": signals[:, names.index("wheel_velocity")],
    }
    # The expected states are good to about 1e-10 and the last column, a central difference, to
    # about 1e-8; in fact they agree to 1e-12 and 3e-11.
    for name, expected in zip(DYNAMICS_COLUMNS, DYNAMICS.T, strict=True):
        tolerance = 1e-9 if name == "wheel_center_z_rate" else 1e-10
        assert found[name] == pytest.approx(expected, rel=0.0, abs=tolerance), name


def inputs_over_time(model, time: float) -> Array:
    """Return inputs on a rough road, with a rack that is pushed but does not follow a path."""
    values = {
        "road_height": 0.02 * np.sin(40.0 * time),
        "strut_force": 500.0 * np.cos(25.0 * time),
        "rack_force": 300.0 * np.sin(15.0 * time),
        "rack_position": 0.02,
    }
    return np.array([values.get(name, 0.0) for name in model.INPUTS])


def resting(car: Mechanism, model) -> Array:
    """Return a state at the design position, with the wheel spinning and the arm moving."""
    rates = {"beta1": car.beta1_design, "beta1_rate": -1.0, "beta5_rate": 60.0, "beta9_rate": 0.1}
    return np.array([rates.get(name, 0.0) for name in model.STATE])


each_motion = pytest.mark.parametrize("seed", range(3), ids=lambda seed: f"car{seed}")
each_model = pytest.mark.parametrize(
    "model", [macpherson, macpherson_free_rack], ids=lambda model: model.NAME
)


@each_motion
@each_model
def test_kinetic_energy_is_the_work_of_the_forces(model, seed: int) -> None:
    """With the rack held or free, nothing but Q does work: d/dt (q'^T M q' / 2) = q'^T Q.

    That holds only if B is what M demands, so it tests both.
    """
    parameters = car_parameters(seed)
    if seed == 0:  # a rack without mass would leave M singular: the reference car gets one
        parameters["rack_mass"] = 3.0
    constants = model.prepare(parameters)
    count = len(model.STATE) // 2

    def derivative(time: float, y: Array) -> Array:
        inputs = inputs_over_time(model, time)
        power = y[count:-1] @ model.forces(y[:-1], inputs, constants)
        # in units of 100 J, so that the tolerance means the same as for the coordinates
        return np.append(model.rhs(y[:-1], inputs, constants), power / 100.0)

    times = np.linspace(0.0, 0.3, 7)
    motion = integrate(derivative, [*resting(Mechanism(parameters), model), 0.0], times)
    states, work = motion[:, :-1], 100.0 * motion[:, -1]
    inputs = np.array([inputs_over_time(model, time) for time in times])
    rates = states[:, count:]
    kinetic = 0.5 * np.einsum(
        "ti,tij,tj->t", rates, model.mass_matrix(states, inputs, constants), rates
    )
    assert np.ptp(work) > 10.0
    # 2 kJ in the wheel's spin, to the error of the integration
    assert kinetic - kinetic[0] == pytest.approx(work, rel=0.0, abs=1e-9)


def absolute_spin_rate(model, states: Array, inputs: Array, constants: Array) -> Array:
    """Return spin rate plus the knuckle's angular velocity about the spin axis.

    With the rack held the latter is the knuckle's rate about the spin axis, per unit of the arm's
    rate, times the arm's rate.
    """
    knuckle = model.BODIES.index("knuckle")
    axis = vector({n: p["default"] for n, p in model.PARAMETERS.items()}, "spin_axis")
    now = model.orientations(states, inputs, constants)[:, knuckle] @ axis
    omega = model.velocities(states, inputs, constants)[:, knuckle, :3]
    spin_rate = states[:, list(model.STATE).index("beta5_rate")]
    return spin_rate + np.einsum("ti,ti->t", now, omega)


@each_model
def test_nothing_turns_the_wheel_about_its_axis(model) -> None:
    """The bearing is free of friction: the absolute spin rate is constant, though the spin is not.

    For the model with a prescribed rack, the rack is steered meanwhile.
    """
    parameters = car_parameters(0)
    parameters["rack_mass"] = 3.0
    constants = model.prepare(parameters)

    def inputs_at(time: float) -> Array:
        inputs = inputs_over_time(model, time)
        if model is macpherson:
            phase = 20.0 * time
            steer = 0.02 * np.sin(phase), 0.4 * np.cos(phase), -8.0 * np.sin(phase)
            for kind, value in zip(("position", "velocity", "acceleration"), steer, strict=True):
                inputs[list(model.INPUTS).index(f"rack_{kind}")] = value
        return inputs

    times = np.linspace(0.0, 0.3, 31)
    states = integrate(
        lambda t, y: model.rhs(y, inputs_at(t), constants),
        resting(Mechanism(parameters), model),
        times,
    )
    inputs = np.array([inputs_at(time) for time in times])
    invariant = absolute_spin_rate(model, states, inputs, constants)
    assert np.ptp(states[:, list(model.STATE).index("beta5_rate")]) > 0.05
    # the error of the integration, relative to 60 rad/s
    assert np.ptp(invariant) < 1e-10


def test_arm_does_not_feel_the_spin() -> None:
    """With the rack held the gyroscopic couple of the wheel is taken up by the joints alone."""
    times = np.linspace(0.0, 0.5, 26)
    motions = [
        integrate(lambda _, y: macpherson.rhs_rack_held(y), [*START[:3], rate], times)
        for rate in (0.0, SPIN_RATE, -5.0 * SPIN_RATE)
    ]
    assert np.ptp(motions[0][:, 0]) > 0.05
    for motion in motions[1:]:
        # the error of the integration, whose steps differ
        assert motion[:, [0, 2]] == pytest.approx(motions[0][:, [0, 2]], rel=0.0, abs=1e-10)
        # The spin rate changes by a total derivative: as much, whatever its value, to the error
        # of the integration relative to 500 rad/s.
        change = motion[:, 3] - motion[0, 3]
        assert change == pytest.approx(motions[0][:, 3], rel=0.0, abs=1e-9)
