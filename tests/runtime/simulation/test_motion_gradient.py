"""Gradients of what a motion is judged by, against differences of motions."""

from dataclasses import replace

import kintrafo
import numpy as np
import pytest
from kintrafo import InputError, Samples
from kintrafo.generator import Motion
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR

CAR = kintrafo.Model("reference_car")
SHIPPED = {model.name: model for model in MODELS}
TIMES = np.linspace(0.0, 0.3, 61)
SPAN = (0.0, 0.3)
START = np.array(kintrafo.state_at_height(CAR, 0.325, spin_rate=93.0))
WEIGHTS = np.cos(40.0 * TIMES)
OF = {"wheel_acceleration": "rms", "toe": "mean", "beta1": WEIGHTS}
LENGTHS = ["tie_rod_inner_z", "strut_top_y", "wheel_center_x"]
OTHERS = ["spring_rate", "tyre_rate", "damper_rate", "knuckle_mass", "gravity"]
ROAD = Samples([0.0, 0.1, 0.1, 0.3], [0.0, 0.01, 0.03, 0.0], "linear")


@pytest.fixture(scope="module")
def system():
    module = kintrafo.compile(SHIPPED[CAR.equations.NAME], parameter_derivatives=True)
    return kintrafo.System(module, CAR.parameters)


def judged(signals, states):
    """Return the number, from its definition."""
    share = np.full(TIMES.size, 1.0 / (TIMES.size - 1))
    share[[0, -1]] /= 2.0
    moved = signals["wheel_acceleration"] - share @ signals["wheel_acceleration"]
    return float(np.sqrt(share @ moved**2) + share @ signals["toe"] + WEIGHTS @ states[0])


def moved(system, name, by, inputs, **options):
    """Return the number of a motion in which something is another."""
    parameters, start, own = dict(system.parameters), START.copy(), dict(inputs)
    if name in parameters:
        parameters[name] += by
    elif name in system.state_names:
        start[system.state_names.index(name)] += by
    else:
        own[name] = own.get(name, 0.0) + by
    other = kintrafo.System(system.equations, parameters)
    found = kintrafo.simulate(other, SPAN, start, inputs=own, t_eval=TIMES, **options)
    return judged(found.signals, found.y)


def by_difference(system, name, step, inputs, **options):
    up, down = (moved(system, name, sign * step, inputs, **options) for sign in (1.0, -1.0))
    return (up - down) / (2.0 * step)


@pytest.mark.parametrize("inputs", [{}, {"road_height": ROAD}], ids=["free", "over a jump"])
def test_against_motions_beside_it(system, inputs):
    """Both followed to 1e-12; differences of steps of 1e-5 are known to about 1e-7."""
    tight = {"rtol": 1e-12, "atol": 1e-14}
    found = kintrafo.motion_gradient(system, SPAN, START, OF, inputs=inputs, t_eval=TIMES, **tight)
    there = kintrafo.simulate(
        system, SPAN, START, inputs=inputs, method="DOP853", t_eval=TIMES, **tight
    )
    assert found.value == pytest.approx(judged(there.signals, there.y), rel=1e-9)
    steps = {
        **dict.fromkeys(LENGTHS, 1e-05),
        **{name: 1e-4 * system.parameters[name] for name in OTHERS},
        **dict.fromkeys(("beta1", "beta1_rate"), 1e-5),
        "strut_force": 1.0,
    }
    for name, step in steps.items():
        expected = by_difference(system, name, step, inputs, method="DOP853", **tight)
        assert found.by[name] == pytest.approx(expected, rel=2e-6), name
    known = {*system.parameters, *system.state_names, *system.input_names}
    varied = {"road_height", "road_velocity"} if inputs else set()
    assert set(found.by) == known - varied


def test_what_is_at_rest_at_first_is_followed_too(system):
    """Nothing moves until the road does, and steps that err by nothing could have any length."""
    rest = kintrafo.equilibrium(CAR)
    inputs = {"road_height": Samples([0.0, 0.2, 0.2, 0.3], [0.0, 0.0, 0.01, 0.01], "linear")}
    rows = {"rtol": 1e-9, "atol": 1e-12}
    start, of = np.array(rest), {"wheel_acceleration": "rms"}

    def acceleration(parameters, at):
        other = kintrafo.System(system.equations, parameters)
        found = kintrafo.simulate(
            other, SPAN, at, inputs=inputs, method="DOP853", t_eval=TIMES, max_step=0.002,
            rtol=1e-12, atol=1e-14,
        )  # fmt: skip
        share = np.full(TIMES.size, 1.0 / (TIMES.size - 1))
        share[[0, -1]] /= 2.0
        own = found.signals["wheel_acceleration"]
        return float(np.sqrt(share @ (own - share @ own) ** 2))

    found = kintrafo.motion_gradient(system, SPAN, start, of, inputs=inputs, t_eval=TIMES, **rows)
    for name in ("spring_rate", "knuckle_mass", "beta1"):
        at, own = start.copy(), dict(system.parameters)
        step = 1e-6 if name == "beta1" else 1e-5 * own[name]
        ends = []
        for sign in (1.0, -1.0):
            if name == "beta1":
                at[0] = start[0] + sign * step
            else:
                own[name] = system.parameters[name] + sign * step
            ends.append(acceleration(own, at))
        assert found.by[name] == pytest.approx((ends[0] - ends[1]) / 2.0 / step, rel=1e-4), name


def test_it_is_the_gradient_of_the_numbers_that_the_steps_give(system):
    """Steps of 10 ms with any error: gradients of these numbers, not of the true motion."""
    coarse = {"rtol": 0.5, "atol": 1e3, "max_step": 0.01}
    found = kintrafo.motion_gradient(system, SPAN, START, OF, t_eval=TIMES, **coarse)
    true = kintrafo.motion_gradient(system, SPAN, START, OF, t_eval=TIMES, rtol=1e-11, atol=1e-13)
    apart = []
    for name in ("damper_rate", "spring_rate", "knuckle_mass"):
        step = 1e-4 * system.parameters[name]
        expected = by_difference(system, name, step, {}, method="DormandPrince", **coarse)
        assert found.by[name] == pytest.approx(expected, rel=1e-6), name
        apart.append(abs(found.by[name] / true.by[name] - 1.0))
    assert max(apart) > 1e-4


def test_a_signal_that_stays_has_no_slope_of_its_rms():
    module = kintrafo.compile(FOUR_BAR, parameter_derivatives=True)
    floating = kintrafo.System(module, {"spring_rate": 0.0})
    start = floating.design_state
    found = kintrafo.motion_gradient(floating, SPAN, start, {"crank_angle": "rms"}, t_eval=TIMES)
    assert found.value == 0.0
    assert not any(found.by.values())


def test_a_mechanism_without_signals():
    """It has the gradient of the same with a spring and a damper that do nothing."""
    bare = replace(FOUR_BAR, name="bare", forces=())
    found = []
    for declared, idle in ((FOUR_BAR, {"spring_rate": 0.0, "damper_rate": 0.0}), (bare, {})):
        module = kintrafo.compile(declared, parameter_derivatives=True)
        system = kintrafo.System(module, idle)
        start = system.state(crank_angle=0.3, crank_angle_rate=1.0)
        found.append(kintrafo.motion_gradient(system, SPAN, start, {"crank_angle": "rms"}).by)
    given, alone = found
    assert set(alone) < set(given)
    assert any(alone.values())
    assert alone == pytest.approx({n: given[n] for n in alone}, rel=1e-9, abs=1e-12, nan_ok=True)


def test_a_mechanism_that_is_prescribed_as_a_whole():
    """Nothing is integrated: against differences of the signals, of a length of some 0.1 m."""
    given = replace(
        SHIPPED["four_bar"],
        mechanism=replace(FOUR_BAR, name="driven", forces=FOUR_BAR.forces[:1]),
        independent=(),
        prescribed={FOUR_BAR.joint("A"): Motion("crank", "rad", "angle of the crank")},
    )
    system = kintrafo.System(kintrafo.compile(given, parameter_derivatives=True))
    driven = {"crank_position": lambda t: 0.1 * np.sin(20.0 * t)}

    def found(**others):
        moved = kintrafo.System(system.equations, dict(system.parameters) | others)
        of = {"spring_length": "rms"}
        return kintrafo.motion_gradient(moved, SPAN, [], of, inputs=driven, t_eval=TIMES)

    gradient = found()
    for name in ("crank_pin_y", "rocker_bearing_x", "spring_ground_y"):
        place, step = system.parameters[name], 1e-5
        up, down = (found(**{name: place + sign * step}).value for sign in (1.0, -1.0))
        # the third derivative is of the order of 1/length^2: 1e-10 * 100; rounding is less
        assert gradient.by[name] == pytest.approx((up - down) / (2.0 * step), abs=1e-8)
        assert abs(gradient.by[name]) > 1e-4


def test_rounding_of_what_stays_has_no_slope_either(system):
    rest = kintrafo.equilibrium(CAR, rack_position=0.01)
    found = kintrafo.motion_gradient(system, SPAN, rest, {"wheel_center_z": "rms"})
    assert 0.0 < found.value < 1e-14
    assert not any(found.by.values())


@pytest.mark.parametrize(
    "changes",
    [
        {"of": {"camberr": "rms"}},
        {"of": {"camber": "max"}},
        {"of": {"camber": [1.0, 2.0]}},
        {"of": {}},
        {"t_span": (0.3, 0.0)},
        {"t_eval": [0.1]},
        {"system": CAR},
        {"y0": [0.0, 1.0]},
    ],
)
def test_bad_arguments_are_refused(system, changes, refused):
    given = {
        "system": system,
        "t_span": SPAN,
        "of": {"camber": "rms"},
        "t_eval": TIMES,
        "y0": START,
    } | changes
    refused(
        InputError,
        lambda: kintrafo.motion_gradient(
            given["system"], given["t_span"], given["y0"], given["of"], t_eval=given["t_eval"]
        ),
    )
