"""Gradients of motions over kinks: stops, knots of dampers, wheels that leave the road."""

from dataclasses import replace

import kintrafo
import numpy as np
import pytest
from kintrafo import InputError, Model, Samples, Suspension
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.simulation.solvers import native_available

SHIPPED = {model.name: model for model in MODELS}
CAR = Suspension.load("reference_car")
SPAN = (0.0, 0.5)
TIMES = np.linspace(*SPAN, 101)
SHARE = np.full(TIMES.size, 1.0 / (TIMES.size - 1))
SHARE[[0, -1]] /= 2.0
BUMP = {"road_height": Samples([0.0, 0.05, 0.1, 0.13, 0.5], [0.0, 0.0, 0.05, 0.0, 0.0])}
DAMPER = {"velocity_m_per_s": [-1.0, -0.2, 0.0, 0.2, 1.0], "force_N": [-2500, -1000, 0, 400, 1500]}


def with_changes(**sections):
    """Return the car with keys of sections added, or without those that are None."""
    data = CAR.to_dict()
    for section, keys in sections.items():
        merged = data.setdefault(section, {}) | keys
        data[section] = {key: value for key, value in merged.items() if value is not None}
    return Model(Suspension.from_dict(data))


STOPPED = with_changes(
    bump_stop={"clearance_mm": 15.0, "rate_N_per_m": 2e5},
    strut={"damper_rate_N_s_per_m": None},
    damper=DAMPER,
)
# straight lines that the spring is at when it is at rest, and in bump
BENT = with_changes(
    strut={key: None for key in CAR.strut.model_dump() if key.startswith("spring_")},
    spring={
        "compression_mm": [0.0, 110.0, 145.0, 160.0, 250.0],
        "force_N": [0.0, 2400.0, 3400.0, 4100.0, 9500.0],
        "force_at_design_N": 3300.0,
        "interpolation": "linear",
    },
    bump_stop={"clearance_mm": 15.0, "rate_N_per_m": 2e4},
)
LIFTING = with_changes(tyre={"lifts_off": True})
DAMPED = with_changes(tyre={"lifts_off": True, "damper_rate_N_s_per_m": 300.0})


@pytest.fixture(scope="module")
def equations():
    return kintrafo.compile(SHIPPED["macpherson_general"], parameter_derivatives=True)


def judged(system, start):
    """Return the RMS of the acceleration, and mean toe, of a motion that is followed closely."""
    # another method than that of the gradient, and in C: it is done two dozen times
    method = "Verner" if native_available() else "DOP853"
    found = kintrafo.simulate(
        system, SPAN, start, inputs=BUMP, t_eval=TIMES, method=method, max_step=1e-3,
        rtol=1e-12, atol=1e-14,
    )  # fmt: skip
    acceleration = found.signals["wheel_acceleration"]
    moved = acceleration - SHARE @ acceleration
    return float(np.sqrt(SHARE @ moved**2) + SHARE @ found.signals["toe"])


OF = {"wheel_acceleration": "rms", "toe": "mean"}


@pytest.mark.parametrize(
    ("car", "event", "names"),
    [
        (STOPPED, "strut_reaches_bump_stop", ["spring_rate", "bump_stop_rate", "bump_stop_length"]),
        (BENT, "strut_reaches_bump_stop", ["spring_table_linear_1", "spring_table_linear_2"]),
        (LIFTING, "wheel_leaves_ground", ["spring_rate", "tyre_free_height", "damper_rate"]),
    ],
    ids=["stop and knots", "straight lines of a spring", "off the road"],
)
def test_against_motions_beside_it(equations, car, event, names):
    """To 1e-3 at the usual tolerance; a step over a kink made errors of 2e-2 here.

    Differences of motions that are known to 1e-12 over 1e-4 of a parameter are known to 1e-6.
    """
    assert car.equations.NAME == equations.NAME
    system, start = kintrafo.System(equations, car.parameters), np.array(kintrafo.equilibrium(car))
    motion = kintrafo.simulate(system, SPAN, start, inputs=BUMP, events=event)
    assert motion.t_events[0].size
    found = kintrafo.motion_gradient(system, SPAN, start, OF, inputs=BUMP, t_eval=TIMES)
    assert found.value == pytest.approx(judged(system, start), rel=1e-5)
    for name in ("knuckle_mass", "tyre_rate", *names):
        # what steps over corners of lines miss, of a kilonewton, is noise: of 3e-3 in the mass by
        # differences over 1e-4
        step = (1e-3 if car is BENT else 1e-4) * system.parameters[name]
        up, down = (
            judged(kintrafo.System(equations, {**car.parameters, name: value}), start)
            for value in (system.parameters[name] + step, system.parameters[name] - step)
        )
        assert found.by[name] == pytest.approx((up - down) / (2.0 * step), rel=1e-3), name


def test_steps_end_where_the_stop_is_touched(equations):
    system = kintrafo.System(equations, STOPPED.parameters)
    start = np.array(kintrafo.equilibrium(STOPPED))
    motion = kintrafo.motion_gradient(system, SPAN, start, OF, inputs=BUMP, t_eval=TIMES).motion
    near = kintrafo.simulate(
        system, SPAN, start, inputs=BUMP, events="strut_reaches_bump_stop", rtol=1e-10, atol=1e-12
    )
    lengths = np.diff(motion.t)
    for time in near.t_events[0]:
        # within a few of the shortest steps: the root of rtol, of the longest
        step = np.searchsorted(motion.t, time) - 1
        assert lengths[step - 1 : step + 2].min() <= 4e-3 * lengths.max()


def test_where_rates_jump_there_is_none(equations, refused):
    """A damper in the tyre pushes at once when the wheel lands."""
    system = kintrafo.System(equations, DAMPED.parameters)
    start = np.array(kintrafo.equilibrium(DAMPED))
    refused(
        InputError,
        lambda: kintrafo.motion_gradient(system, SPAN, start, OF, inputs=BUMP, t_eval=TIMES),
    )


def test_a_mechanism_without_inputs():
    """It has the gradient of the same with an input that is zero."""
    found = []
    for declared in (FOUR_BAR, replace(FOUR_BAR, name="alone", forces=FOUR_BAR.forces[:1])):
        system = kintrafo.System(kintrafo.compile(declared, parameter_derivatives=True))
        start = system.state(crank_angle=0.3)
        of = {"crank_angle": "rms"}
        found.append(kintrafo.motion_gradient(system, (0.0, 0.5), start, of).by)
    given, alone = found
    assert given.keys() - alone.keys() == {"crank_torque"}
    assert alone == pytest.approx({name: given[name] for name in alone}, rel=1e-9, abs=1e-12)
