"""Loops of hinges and guides that are solved together, by iteration.

The oracles: maximal coordinates; the program itself in 50 digits; and the mean of the tangents,
where a motion has to be continuous.
"""

from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest
from kintrafo.equations.errors import ClosureError
from kintrafo.generator.backends.report.markdown import markdown
from kintrafo.generator.closed_forms.coupled_loops import MOST_UNKNOWNS, CoupledLoops, obstacle
from kintrafo.generator.closed_forms.tree import JointOfTree
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.loops.graph import JointGraph
from kintrafo.generator.loops.mobility import Mobility
from kintrafo.generator.mechanisms.chains import BRICARD, SEVEN_HINGES
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms import iterated_loops
from mechanisms.every_closed_form import askew, heading
from support import models
from support.changes import with_default
from support.models import Built, own
from support.symbolic import constants_of, derivatives_of

MODELS = {
    model.name: model
    for model in (
        SEVEN_HINGES,
        iterated_loops.CROSSED_RING,
        iterated_loops.BALL_RING,
        iterated_loops.BENNETT,
        BRICARD,
        iterated_loops.PLATE_ON_A_SLOT,
        iterated_loops.PLATE_ON_A_PIN,
        iterated_loops.ROCKERS,
        iterated_loops.FIVE_BAR,
        iterated_loops.DRIVEN_GUIDE,
    )
}
SPANS = {
    "seven_hinges": (-1.9, 0.7),
    "crossed_ring": (-1.6, 0.15),
    "ball_ring": (-0.02, 2.2),
    "bennett": (-2.0, 2.0),
    "bricard": (-2.0, 1.2),
    "plate_on_a_slot": (-0.1, 0.8),
    "plate_on_a_pin": (-0.1, 0.8),
    "rockers": (-0.02, 0.2),
    "five_bar": (-0.6, 0.6),
    "driven_guide": (-0.01, 0.01),
}
"""How far the first coordinate goes from design, rad or m: nearly to the dead points."""

DIFFERENTIATED = (SEVEN_HINGES, BRICARD, iterated_loops.PLATE_ON_A_SLOT, iterated_loops.BENNETT)
"""Those whose derivatives are looked at; the others are derived without, in half of the time."""


@pytest.fixture(scope="session")
def derive():
    return lambda model: models.derive(model, derivatives=False)


@pytest.fixture(scope="session")
def built():
    """Return a compiled model."""

    @cache
    def found(name):
        model = MODELS[name]
        return Built.of(model, own(model, derivatives=model in DIFFERENTIATED))

    return lambda model: found(model.name)


def states(built, count):
    """Return states over the whole span, at random rates; a wheel turns anywhere."""
    rng = np.random.default_rng(0)
    q = built.design + rng.uniform(-np.pi, np.pi, (count, built.size))
    q[:, 0] = built.design[0] + np.linspace(*SPANS[built.model.name], count)
    return np.hstack((q, rng.uniform(-3.0, 3.0, (count, built.size))))


def given(built):
    """Return inputs: no forces, and a prescribed joint that is on its way."""
    inputs = np.zeros(len(built.module.INPUTS))
    start = {
        motion.name: built.oracle.driven(built.at_design, joint).value[0]
        for joint, motion in built.model.motions.items()
    }
    for i, name in enumerate(built.module.INPUTS):
        motion, _, what = name.rpartition("_")
        if motion in start:
            inputs[i] = {"position": start[motion] + 0.1, "velocity": 0.7, "acceleration": 2.0}[
                what
            ]
    return inputs


def path(built, step):
    """Return states at rest from one end of the span to the other."""
    low, high = SPANS[built.model.name]
    found = np.zeros((round((high - low) / step), 2 * built.size))
    found[:, : built.size] = built.design
    found[:, 0] += np.linspace(low, high, len(found))
    return found


def each(*models):
    """Return the mark of a test of some models."""
    return pytest.mark.parametrize("model", models, ids=[m.name for m in models])


EVERY = each(*MODELS.values())


# -- against maximal coordinates, and against itself ----------------------------------------------


@EVERY
def test_loops_close_and_accelerate(model, built):
    compiled = built(model)
    inputs = given(compiled)
    named = compiled.named(inputs)
    accelerations = {j: named[m.rates[1]] for j, m in model.motions.items()}
    for state in states(compiled, 25):
        motion = compiled.motion(state, inputs)
        rates = np.abs(motion.twist).max()
        for i, joint in enumerate(model.independent):
            driven = compiled.oracle.driven(motion, joint.name)
            turns = (driven.value[0] - state[i]) / (2.0 * np.pi)
            # some ten roundings of an angle below one turn; a rate is a difference of twists
            assert turns == pytest.approx(round(turns), abs=5e-15)
            assert driven.rate[0] == pytest.approx(state[compiled.size + i], abs=1e-14 * rates)
        closure = compiled.oracle.closure(motion)
        # lengths and sines below 1; rates of bodies next to a dead point are those of the twists
        np.testing.assert_allclose(closure.value, 0.0, atol=5e-15)
        np.testing.assert_allclose(closure.rate, 0.0, atol=1e-14 * rates)
        oracle = compiled.oracle.reduced(motion, named, accelerations)
        inverse = np.abs(np.linalg.inv(oracle.mass_matrix))
        scale = (inverse @ (np.abs(oracle.applied) + np.abs(oracle.inertial))).max()
        found = compiled("rhs", state, inputs)[compiled.size :]
        # a hundred roundings leave three digits for the squared condition of the loops, which is
        # bad next to the dead points at the ends of the spans
        np.testing.assert_allclose(found, oracle.accelerations, rtol=0.0, atol=1e-11 * scale)


@EVERY
def test_motion_is_continuous_over_the_whole_span(model, built):
    """No state of the span is on another branch: every step goes along the tangents."""
    compiled = built(model)
    low, high = SPANS[model.name]
    along = path(compiled, min(0.004, (high - low) / 50))
    step = along[1, 0] - along[0, 0]
    inputs = np.tile(given(compiled), (len(along), 1))
    assert (compiled("margins", along, inputs)[:, 0] > 0.0).all()
    beta = compiled("relative_coordinates", along, inputs)
    slope = compiled("relative_jacobian", along, inputs)[:, :, 0]
    went = np.diff(beta, axis=0)
    turns = np.array(["angle" in name for name in compiled.module.RELATIVE_COORDINATES])
    went[:, turns] = (went[:, turns] + np.pi) % (2.0 * np.pi) - np.pi
    expected = step * (slope[1:] + slope[:-1]) / 2
    # the curvature, which next to a dead point is that of a root; its change, 1e-5, where it is
    # zero. Other branches are 1e-2 away and more
    bend = np.abs(np.diff(slope, axis=0)) * step
    assert (np.abs(went - expected) <= bend + 1e-5).all()


@each(SEVEN_HINGES, BRICARD, iterated_loops.PLATE_ON_A_SLOT)
def test_jacobians_are_exact(model, built, derive):
    # differences in 50 digits: every perturbed state is solved again, to 50 digits
    compiled, derived = built(model), derive(model)
    state = states(compiled, 5)[3]
    with mpmath.workdps(50):
        values = constants_of(derived, compiled.parameters)
        values |= {name: mpmath.mpf(0) for name in compiled.module.INPUTS}
        values |= dict(zip(compiled.module.STATE, map(mpmath.mpf, state), strict=True))
        expected = derivatives_of(derived.functions["rhs"], values, compiled.module.STATE)
    scale = np.abs(expected).max(axis=1, keepdims=True)
    found = compiled("rhs_jacobian", state)
    # a hundred roundings leave three digits for the condition of the loops, a power of it more
    # than in the right-hand side
    np.testing.assert_allclose(found / scale, expected / scale, rtol=0.0, atol=1e-11)


# -- where it fails -------------------------------------------------------------------------------


@EVERY
def test_anywhere_it_closes_or_says_so(model, built):
    compiled, rng = built(model), np.random.default_rng(1)
    outcomes = set()
    for _ in range(60):
        state = np.concatenate((rng.uniform(-np.pi, np.pi, compiled.size), np.ones(compiled.size)))
        try:
            motion = compiled.motion(state, given(compiled))
        except ClosureError:
            outcomes.add("refused")
            continue
        outcomes.add("closed")
        # what the iteration may leave, 1e-13 of its unknowns; also next to a singular position,
        # where the unknowns are worse than the closure
        assert np.abs(compiled.oracle.closure(motion).value).max() < 1e-12
    rounds = {"bennett"}  # its crank goes all the way round
    assert outcomes == {"closed"} | ({"refused"} if model.name not in rounds else set())


def test_a_chain_that_moves_by_its_dimensions_alone_is_refused_with_others(built, refused):
    """Without Bricard's symmetry the loop closes at the design position alone."""
    compiled = built(BRICARD)
    parameters = dict(compiled.parameters)
    parameters["place_3_x"] += 1e-3
    broken = replace(compiled, parameters=parameters)
    refused(ClosureError, lambda: broken("rhs", np.array([0.3, 0.0])))


def test_report_names_joints_and_equations(derive):
    text = markdown(derive(iterated_loops.PLATE_ON_A_PIN))
    assert "Some loops of this model are solved by iteration." in text
    assert "bar and plate have an axis in common at plate_pin: 2 equations" in text
    assert "|rod_end - rod_start| = length of rod" in text
    assert text.count("3 equations for the 3 coordinates of bar_pin, block_hinge, slot") == 2


# -- errors ---------------------------------------------------------------------------------------


def test_without_permission_the_loop_is_refused(refused):
    for model in (SEVEN_HINGES, BRICARD, iterated_loops.PLATE_ON_A_PIN, iterated_loops.BALL_RING):
        with refused(NoClosedFormError):
            CataloguePlan.of(replace(model, allow_iteration=False))


def test_six_hinges_in_general_cannot_move(refused):
    """Bricard's chain with another place of a hinge: recognised before anything is derived."""
    model = with_default(BRICARD, place_3_x=-0.25)
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


def test_a_dead_point_at_design_is_refused(refused):
    """Bar, rod and block push on the plate along lines through one point: it turns about that."""
    places = {  # the point is at 0.3, 0.3 of the plane
        "rod_start": askew(0.3, 0.5),  # the rod ends at 0.3, 0.38
        "bar_start": askew(0.1, 0.2),  # the bar ends at 0.2, 0.25
        "slot_direction": heading(np.arctan2(0.2, 0.3)),  # the block hinges at 0.5, 0.0
    }
    changes = {f"{n}_{a}": c for n, p in places.items() for a, c in zip("xyz", p, strict=True)}
    refused(
        NoClosedFormError,
        lambda: CataloguePlan.of(with_default(iterated_loops.PLATE_ON_A_SLOT, **changes)),
    )


def test_too_many_unknowns_are_refused():
    mechanism = SEVEN_HINGES.mechanism
    branch = JointOfTree(mechanism.joint("hinge_1"), "one", "two")
    action = CoupledLoops("two", (branch,) * (MOST_UNKNOWNS + 1), (), ())
    caught = obstacle(action, Mobility(JointGraph(mechanism), ("hinge_0",)))
    assert (
        caught == f"{MOST_UNKNOWNS + 1} unknowns are more than the {MOST_UNKNOWNS} of an iteration"
    )


# -- mobility in numbers --------------------------------------------------------------------------


def test_mobility_at_the_design_position():
    for model in MODELS.values():
        driven = [joint.name for joint in model.driven]
        mobility = Mobility(JointGraph(model.mechanism), driven)
        assert mobility.driven_move()
        joints = [j for j in model.mechanism.joints if j.name not in driven]
        assert mobility.determines((j.name, c) for j in joints for c in j.coordinates)
        assert not Mobility(JointGraph(model.mechanism), ()).determines(
            [(joints[0].name, joints[0].coordinates[0])]
        )
