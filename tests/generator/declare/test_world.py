"""World and chassis are two things: a mechanism is fixed in the world, or free in it."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo.generator import Body, Copy, DeclarationError, Free, Ground, Spherical, combined
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.backends.report.derivation import joint_rows, mobility_line
from kintrafo.generator.closed_forms.free_body import PlaceFree
from kintrafo.generator.loops.graph import JointGraph
from kintrafo.generator.loops.mobility import Mobility
from kintrafo.generator.mechanisms.double_wishbone import (
    CHASSIS,
    DOUBLE_WISHBONE,
    KNUCKLE,
    MODELS,
    RACK,
)
from kintrafo.generator.mechanisms.suspension import RACK_MOTION
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.planning.proposal import CoordinateSearch, proposals
from mechanisms.free_bodies import compared
from support.changes import changed
from support.models import Built, derive, own

FIXED = MODELS[0]
MOVING = Body("chassis", 300.0, (0.0, 0.0, 0.5), (30.0, 30.0, 30.0), order=CHASSIS.order)
"""The ground of the double wishbone, as a body that moves."""
BODY = Free("body", MOVING)


def instead(*pairs, more=()):
    """Return the double wishbone with other bodies for some, and more joints."""
    parts = ("joints", "forces", "coordinates")
    given = {name: changed(getattr(DOUBLE_WISHBONE, name), *pairs) for name in parts}
    return replace(DOUBLE_WISHBONE, **given | {"joints": (*given["joints"], *more)})


def freed():
    """Return the double wishbone on a chassis that moves in the world."""
    return instead((CHASSIS, MOVING), more=(BODY,))


def on_it(parts):
    """Return parts of the double wishbone at the chassis that moves."""
    return changed(parts, (CHASSIS, MOVING))


def free_model(**changes):
    """Return its model, with the six coordinates of the chassis."""
    given = {
        "mechanism": freed(),
        "independent": (BODY, *on_it(FIXED.independent)),
        "prescribed": on_it(FIXED.prescribed),
        "held": on_it(FIXED.held),
        "massive": (MOVING, *FIXED.massive),
    }
    return replace(FIXED, **given | changes)


def test_a_free_body_has_six_freedoms_more():
    fixed, free = JointGraph(DOUBLE_WISHBONE), JointGraph(freed())
    assert free.mobility == fixed.mobility + 6
    assert free.loop_count == fixed.loop_count
    assert {c.key for c in free.candidate_cycles} == {c.key for c in fixed.candidate_cycles}
    assert freed().moving[0].name == "chassis"
    assert len(DOUBLE_WISHBONE.moving) == len(DOUBLE_WISHBONE.bodies) - 1


def test_its_loops_are_solved_as_on_a_fixed_body():
    fixed, free = CataloguePlan.of(FIXED), CataloguePlan.of(free_model())
    steps = tuple(t.step for t in fixed.transformers)
    assert tuple(t.step for t in free.transformers) == on_it(steps)
    first, *rest = free.steps
    assert first == PlaceFree(BODY)
    assert tuple(rest) == on_it(tuple(fixed.steps))


def test_all_that_is_driven_can_move_whatever_the_others_do():
    model = free_model()
    mobility = Mobility(JointGraph(model.mechanism), [joint.name for joint in model.driven])
    assert mobility.is_known
    assert mobility.driven_move()


def test_its_tables_name_the_world():
    topology = JointGraph(freed())
    assert joint_rows(topology)[-1] == ("body", "free", "world", "1 chassis", "6", "nothing")
    assert mobility_line(topology).endswith(f"= {topology.mobility}")


def test_proposals_keep_the_free_body():
    found = next(proposals(free_model()))
    assert set(found.independent) == {joint.name for joint in FIXED.independent}
    model = CoordinateSearch(free_model()).model(found.independent)
    assert [joint.name for joint in model.independent] == ["body", *found.independent]


def test_its_equations_are_those_of_maximal_coordinates():
    """Two loops, a tyre, a spring, a wheel that spins and a rack that is given, in the air."""
    model = free_model()
    built = Built.of(model, own(model, arrays=True, derivatives=False))
    for state, inputs, motion, expected, positions in compared(built, 3):
        assert np.abs(built.oracle.closure(motion).rate).max() < 1e-12
        found, scale = built("rhs", state, inputs), np.abs(expected.accelerations).max()
        np.testing.assert_allclose(found[positions:], expected.accelerations, atol=1e-12 * scale)
        np.testing.assert_allclose(
            built("mass_matrix", state, inputs), expected.mass_matrix, atol=1e-10
        )


def test_its_motion_adds_nothing_to_how_loops_are_solved():
    """On it, no axes are along the hinge of the arm: so lines have three components there."""
    fixed, free = (
        derive(m, derivatives=False).functions["relative_coordinates"]
        for m in (FIXED, free_model())
    )
    assert operations_of(free).total() < 1.3 * operations_of(fixed).total()


def test_a_free_body_is_independent(refused):
    """Driven by nothing it has no pose, and it cannot be prescribed."""
    rest = on_it(FIXED.independent)
    refused(
        DeclarationError,
        lambda: free_model(independent=rest),
        lambda: free_model(independent=rest, prescribed={BODY: RACK_MOTION}, held={}),
    )


def test_a_pair_of_copies_shares_the_free_body():
    sides = [
        Copy(freed(), prefix, mirrored=prefix == "left_", shared=(MOVING,))
        for prefix in ("right_", "left_")
    ]
    whole = combined("pair", "two sides", sides)
    assert [b.name for b in whole.bodies].count("chassis") == 1
    assert [j for j in whole.joints if isinstance(j, Free)] == [BODY]
    assert JointGraph(whole).mobility == 6 + 2 * JointGraph(DOUBLE_WISHBONE).mobility


@pytest.mark.parametrize(
    ("pairs", "more"),
    [
        ([(CHASSIS, MOVING)], ()),
        ([], (Free("body", CHASSIS),)),
        ([(CHASSIS, replace(MOVING, name="world"))], ()),
        ([(CHASSIS, Ground("world", 1))], ()),
    ],
)
def test_a_mechanism_is_somewhere_in_the_world_once(pairs, more, refused):
    refused(DeclarationError, lambda: instead(*pairs, more=more))


def test_a_free_joint_begins_at_the_world():
    assert BODY.bodies == ("world", "chassis")
    with pytest.raises(DeclarationError, match="first"):
        Free(name="body", first=RACK, second=MOVING)


def test_any_body_can_rest_in_the_world():
    """The ground can be any body: here it is the knuckle."""
    bench = instead((CHASSIS, MOVING), (KNUCKLE, Ground("knuckle")))
    assert "chassis" in [b.name for b in bench.moving]
    assert JointGraph(bench).mobility == JointGraph(DOUBLE_WISHBONE).mobility
    ball = next(j for j in bench.joints if isinstance(j, Spherical))
    assert "knuckle" in ball.bodies
    assert np.isfinite(JointGraph(bench).loop_count)
