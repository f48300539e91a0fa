"""Mechanisms whose motion is given as a whole: no state, and all the same a motion with signals."""

from dataclasses import replace

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.mechanisms import four_bar
from kintrafo.systems.compile.compiler import find_compiler
from mechanisms.every_closed_form import spatial_four_bar

pytestmark = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")

METHODS = ("BDF", "DormandPrince", "Radau", "LSODA", "RK45", "DOP853")
RATE = 20.0
"""Of the swing [rad/s]."""


def swing(time):
    return float(0.3 * np.sin(RATE * time))


@pytest.fixture(scope="module")
def lift():
    """An arm on a block on a guide: no loop, both joints prescribed."""
    ground, block = g.Ground("ground"), g.Body("block", 2.0, (0.0, 0.0, 0.3), (0.1, 0.1, 0.1))
    arm = g.Body("arm", 1.0, (0.2, 0.0, 0.3), (0.01, 0.02, 0.02))
    pivot, tip = (g.Point(name, (x, 0.0, 0.3)) for name, x in (("pivot", 0.0), ("tip", 0.4)))
    guide = g.Prismatic("guide", ground, block, g.Direction("up_there", (0.0, 0.0, 1.0)))
    across = g.Direction("across", (0.0, -1.0, 0.0))
    hinge = g.Revolute("hinge", block, arm, g.Line(pivot, across))
    spring = g.LinearSpring(
        g.SpringRate("rate", 1000.0, "of the spring"),
        free_length=g.Length("free", 0.3, "its length"),
    )
    seats = g.AlongLine((ground, g.Point("base", (0.1, 0.0, 0.0))), (arm, tip))
    mechanism = g.Mechanism(
        name="lift",
        title="An arm on a lift",
        joints=(guide, hinge),
        forces=(g.ForceElement("spring", seats, (spring,)),),
        outputs=(g.PositionOf("tip", arm, tip, "tip"),),
    )
    given = {guide: g.Motion("lift", "m", "height"), hinge: g.Motion("swing", "rad", "angle")}
    formulation = g.Formulation("lift", "An arm on a lift", mechanism, (), prescribed=given)
    return kintrafo.System(kintrafo.compile(formulation))


@pytest.fixture(scope="module", params=["driven", "driven_without_signals"])
def driven(request):
    """A four-bar whose rocker is prescribed, and whose crank has dead points."""
    name = request.param
    given = {four_bar.D: g.Motion("drive", "rad", "angle of the rocker")}
    plain = tuple(f for f in four_bar.FOUR_BAR.forces if not isinstance(f, g.JointForce))
    mechanism = replace(four_bar.FOUR_BAR, forces=plain)
    if name == "driven_without_signals":
        mechanism = replace(mechanism, forces=(), outputs=())
    formulation = g.Formulation(name, "A four-bar", mechanism, (), prescribed=given)
    return kintrafo.System(kintrafo.compile(formulation))


def test_what_has_no_loop_is_placed(lift):
    """All bodies hang on the ground by what is given: the tip is where trigonometry has it."""
    assert lift.state_names == ()
    times = np.linspace(0.0, 1.0, 7)
    inputs = {"swing_position": swing, "lift_position": lambda t: 0.1 * t}
    found = kintrafo.simulate(lift, (0.0, 1.0), [], inputs=inputs, t_eval=times).signals
    angles = np.array([swing(t) for t in times])
    # functions are followed to 1e-10 of their range
    np.testing.assert_allclose(found["tip_x"], 0.4 * np.cos(angles), atol=1e-10)
    np.testing.assert_allclose(found["tip_z"], 0.3 + 0.1 * times + 0.4 * np.sin(angles), atol=1e-10)


@pytest.mark.parametrize("method", METHODS)
def test_events_are_at_their_times(lift, method):
    """No step passes over a turn of an input, so each crossing between two turns is seen."""
    found = kintrafo.simulate(
        lift,
        (0.0, 1.0),
        [],
        inputs={"swing_position": swing},
        method=method,
        t_eval=[0.0, 1.0],
        events=[kintrafo.SignalEvent("tip_z", 0.3, direction=1.0), lambda t, _: np.cos(RATE * t)],
    )
    turns = np.arange(1, int(RATE / np.pi) + 1) * np.pi / RATE
    quarters = turns - 0.5 * np.pi / RATE
    # 1e-11 s by the solver; a function is followed to 1e-10 of 0.6 rad, at 6 rad/s
    np.testing.assert_allclose(found.t_events[0], turns[1::2], atol=3e-11)
    np.testing.assert_allclose(found.t_events[1], quarters, atol=1e-11)
    assert [len(states) for states in found.y_events] == [turns.size // 2, quarters.size]
    ended = kintrafo.SignalEvent("tip_z", 0.3, direction=-1.0, terminal=True)
    found = kintrafo.simulate(
        lift, (0.0, 1.0), [], inputs={"swing_position": swing}, method=method, events=ended
    )
    assert found.status == 1
    assert found.t[-1] == pytest.approx(turns[0], abs=3e-11)


@pytest.mark.parametrize("turns", [1.0, 1000.0])
@pytest.mark.parametrize("method", METHODS)
def test_a_motion_ends_at_a_dead_point(driven, method, turns):
    """Also where the loop would close again at the next output, or within a step."""
    crank, coupler, rocker = 0.1, float(np.hypot(0.24, 0.16)), float(np.hypot(0.06, 0.26))
    # the coupler folded back over the crank: ground and rocker make a triangle with both
    folded = np.arccos((0.3**2 + rocker**2 - (coupler - crank) ** 2) / (2.0 * 0.3 * rocker))
    dead = np.arctan2(0.26, 0.06) - folded  # from design on
    with pytest.raises(kintrafo.SimulationError, match="dead point") as caught:
        kintrafo.simulate(
            driven,
            (0.0, 1.0),
            [],
            inputs={"drive_position": lambda t: 2.0 * np.pi * turns * t},
            method=method,
            t_eval=[0.0, 1.0],
        )
    # the margin is a square of a length: to 1e-9 of the time, and of 1e-10 of the angle
    assert caught.value.time * turns == pytest.approx(dead / (2.0 * np.pi), abs=2e-9)


@pytest.mark.parametrize("rate", [1.0, -1.0])
@pytest.mark.parametrize("method", METHODS)
def test_a_motion_that_begins_beyond_a_dead_point_ends_there(driven, method, rate):
    """Whether it moves on, or back to where the loop closes."""
    with pytest.raises(kintrafo.SimulationError, match="dead point") as caught:
        kintrafo.simulate(
            driven,
            (2.0, 4.0),
            [],
            inputs={"drive_position": lambda t: 1.0 + rate * (t - 2.0)},
            method=method,
        )
    assert caught.value.time == 2.0
    assert caught.value.partial.t.tolist() == [2.0]


def test_methods_that_need_a_state_say_so(lift, refused):
    for method in ("Adams", "Verner"):
        with refused(kintrafo.InputError):
            kintrafo.simulate(lift, (0.0, 1.0), [], method=method)


def test_its_linear_equations_are_those_of_the_signals(lift):
    linear = kintrafo.linearise(lift, lift.state(), outputs=["tip_x", "tip_z"])
    assert (linear.A.shape, linear.B.shape, linear.C.shape) == ((0, 0), (0, 6), (2, 0))
    # of x = 0.4 cos(swing) and z = 0.3 + lift + 0.4 sin(swing), at zero
    np.testing.assert_allclose(linear.D[:, [0, 3]], [[0.0, 0.0], [1.0, 0.4]], atol=1e-15)
    assert linear.steady
    assert linear.modes == ()
    response = linear.frequency_response([0.0, 5.0], "swing_position")
    np.testing.assert_allclose(response["tip_z"], [0.4, 0.4])


def test_a_loop_that_is_driven():
    model = spatial_four_bar("all_given")
    forces = tuple(f for f in model.mechanism.forces if not isinstance(f, g.JointForce))
    mechanism = replace(model.mechanism, forces=forces)
    motion = {mechanism.joint("drive"): g.Motion("drive", "rad", "angle of the crank")}
    given = replace(model, mechanism=mechanism, independent=(), prescribed=motion)
    system = kintrafo.System(kintrafo.compile(given))
    driven = {"drive_position": lambda t: 0.1 * t}
    times = np.linspace(0.0, 2.0, 5)
    result = kintrafo.simulate(system, (0.0, 2.0), system.state(), t_eval=times, inputs=driven)
    free = kintrafo.System(kintrafo.compile(model))
    for time, length in zip(times, result.signals["spring_length"], strict=True):
        expected = free.signals(free.state(drive_angle=0.1 * time))
        assert length == pytest.approx(expected["spring_length"], rel=1e-14)
