"""Declared outputs, against the mechanism in maximal coordinates and against differences."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.loader import load
from mechanisms.every_closed_form import moving_slider_crank
from support.changes import named
from support.models import Built

POINT = g.Point("mark", (0.2, 0.15, 0.25))
LINE, HINGE = g.Direction("line", (0.4, -0.3, 0.8)), g.Direction("about", (0.2, 0.9, 0.3))


def declared():
    """Return the tilted slider-crank, whose table is prescribed, with every kind of output."""
    model = moving_slider_crank("shown_crank", prescribed=True)
    mechanism = model.mechanism
    rod, crank, slider = map(mechanism.body, ("rod", "crank", "slider"))
    end = named(model, g.Point, "slider_end")
    (spring,) = mechanism.elements
    outputs = (
        g.PositionOf("mark", rod, POINT, "mark on the rod"),
        g.VelocityOf("mark_velocity", rod, POINT, "mark on the rod"),
        g.AccelerationOf("mark_acceleration", rod, POINT, "mark on the rod"),
        g.DistanceBetween("reach", (crank, POINT), (slider, end), "from crank to slider"),
        g.AngleBetween("bend", (crank, LINE), (slider, g.FORWARD), HINGE, "bend of the crank"),
        g.ForceOf("push", spring, "force of spring and damper"),
    )
    return replace(model, mechanism=replace(mechanism, outputs=outputs))


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    model = declared()
    folder = tmp_path_factory.mktemp("outputs") / "shown_crank-arrays"
    folder.mkdir()
    build(generate(model, derivatives=False), folder, None)
    return Built.of(model, load(folder))


def states(built):
    random = np.random.default_rng(3)
    found = []
    for _ in range(6):
        q = built.design + random.uniform(-0.3, 0.3, built.size)
        inputs = random.uniform(-1.0, 1.0, len(built.module.INPUTS))
        inputs[list(built.module.INPUTS).index("tilt_position")] *= 0.2
        found.append((np.concatenate((q, random.normal(size=built.size))), inputs))
    return found


def shown(built, state, inputs):
    return dict(zip(built.module.SIGNALS, built("signals", state, inputs), strict=True))


def vector(signals, name):
    return np.array([signals[f"{name}_{axis}"] for axis in "xyz"])


def test_points_lengths_and_angles_are_those_of_maximal_coordinates(built):
    oracle, model = built.oracle, built.model
    place, end = np.array(POINT.place), oracle.place(named(model, g.Point, "slider_end"))
    for state, inputs in states(built):
        signals, motion = shown(built, state, inputs), built.motion(state, inputs)
        mark = oracle.point(motion, "rod", place)
        np.testing.assert_allclose(vector(signals, "mark"), mark.value, atol=1e-14)
        np.testing.assert_allclose(vector(signals, "mark_velocity"), mark.rate, atol=1e-13)
        reach = (oracle.point(motion, "slider", end) - oracle.point(motion, "crank", place)).norm()
        assert signals["reach"] == pytest.approx(reach.value[0], rel=1e-13)
        assert signals["reach_rate"] == pytest.approx(reach.rate[0], rel=1e-12, abs=1e-13)
        u, n = (oracle.vector(motion, "crank", oracle.along(d)).value for d in (LINE, HINGE))
        v = oracle.vector(motion, "slider", np.eye(3)[0]).value
        across = [w - n * (n @ w) for w in (u, v)]
        cosine = across[0] @ across[1] / np.prod([np.linalg.norm(w) for w in across])
        sense = np.sign(n @ np.cross(u, v))
        assert signals["bend"] == pytest.approx(sense * np.arccos(cosine), abs=1e-12)


def test_accelerations_are_those_of_the_equations_of_motion(built):
    oracle, place = built.oracle, np.array(POINT.place)
    for state, inputs in states(built):
        signals, motion = shown(built, state, inputs), built.motion(state, inputs)
        named_inputs = built.named(inputs)
        given = {"tilt": named_inputs["tilt_acceleration"]}
        reduced = oracle.reduced(motion, named_inputs, given)
        jet = oracle.point(motion, "rod", place)
        expected = jet.rows @ reduced.body_accelerations.ravel() + jet.convective
        size = np.abs(expected).max()
        found = vector(signals, "mark_acceleration")
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-11 * size)


def test_velocities_are_differences_of_positions(built):
    """Along the motion, by central differences."""
    rates = list(built.module.INPUTS).index("tilt_position")
    for state, inputs in states(built):
        step = 1e-5

        def at(ahead, state=state, inputs=inputs):
            moved, given = state.copy(), inputs.copy()
            moved[: built.size] += ahead * state[built.size :]
            given[rates] += ahead * inputs[rates + 1]
            signals = shown(built, moved, given)
            return np.array([*vector(signals, "mark"), signals["reach"]])

        expected = (at(step) - at(-step)) / (2.0 * step)
        signals = shown(built, state, inputs)
        found = [*vector(signals, "mark_velocity"), signals["reach_rate"]]
        np.testing.assert_allclose(found, expected, atol=1e-8)  # of the differences


def test_the_force_of_an_element_is_the_sum_of_its_laws(built):
    for state, inputs in states(built):
        signals = shown(built, state, inputs)
        total = signals["spring_force"] + signals["damper_force"]
        assert signals["push"] == pytest.approx(total, rel=1e-14)


def test_signals_have_units_and_meanings(built):
    entries = built.module.SIGNALS
    assert entries["mark_x"] == {"unit": "m", "meaning": "position of the mark on the rod, x"}
    assert entries["mark_acceleration_z"]["unit"] == "m/s^2"
    assert entries["reach_rate"]["unit"] == "m/s"
    assert entries["bend"]["unit"] == "rad"
    assert entries["push"]["unit"] == "N"


def test_copies_have_the_outputs_of_their_own():
    mechanism = declared().mechanism
    pair = g.combined(
        "pair", "Two", (g.Copy(mechanism, "a_"), g.Copy(mechanism, "b_", mirrored=True)), outputs=()
    )
    assert [o.name for o in pair.outputs][:2] == ["a_mark", "a_mark_velocity"]
    assert pair.derived["b_mark_y"] == -pair.derived["a_mark_y"]
    assert pair.derived["b_about_x"] == -pair.derived["a_about_x"]  # an axis of rotation
    assert pair.derived["b_line_x"] == pair.derived["a_line_x"]


def test_mistakes(refused):
    model = declared()
    rod, mechanism = model.mechanism.body("rod"), model.mechanism
    refused(
        g.DeclarationError,
        lambda: g.DistanceBetween("d", (rod, POINT), (rod, POINT), "d"),
        lambda: replace(mechanism, outputs=(*mechanism.outputs, mechanism.outputs[0])),
    )
    for name in ("spring_length", "drive_angle_rate", "tilt_position", "time"):
        clash = replace(mechanism, outputs=(g.ForceOf(name, mechanism.elements[0], "f"),))
        with refused(g.DeclarationError):
            generate(replace(model, mechanism=clash))
    with pytest.raises(g.DeclarationError, match="first"):
        g.AngleBetween("a", (rod, POINT), (rod, g.UP), g.UP, "a")
