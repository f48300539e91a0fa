"""World and chassis are two things: a mechanism is fixed in the world, or free in it."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo.generator import DeclarationError, Free, Model, Spherical
from kintrafo.generator.backends.report.markdown import joint_rows, mobility_line
from kintrafo.generator.closed_forms.free import PlaceFree
from kintrafo.generator.declare.composition import combined, copy
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.loops.graph import Topology
from kintrafo.generator.loops.mobility import Mobility
from kintrafo.generator.mechanisms.double_wishbone import DOUBLE_WISHBONE, MODELS
from kintrafo.generator.planning.plan import Plan
from kintrafo.generator.planning.proposal import Search, proposals

FIXED = MODELS[0]
BODY = Free(name="body", second="chassis")


def freed(**changes):
    """Return the double wishbone on a chassis that moves in the world."""
    given = {"fixed": None, "joints": (*DOUBLE_WISHBONE.joints, BODY)} | changes
    return replace(DOUBLE_WISHBONE, **given)


def free_model(**changes) -> Model:
    """Return its model, with the six coordinates of the chassis."""
    given = {"independent": ("body", *FIXED.independent), "mechanism": freed()}
    return replace(FIXED, massive=("chassis", *FIXED.massive), **(given | changes))


def test_a_free_body_has_six_freedoms_more():
    fixed, free = Topology(DOUBLE_WISHBONE), Topology(freed())
    assert free.mobility == fixed.mobility + 6
    assert free.loop_count == fixed.loop_count
    assert {c.key for c in free.candidate_cycles} == {c.key for c in fixed.candidate_cycles}
    assert freed().moving[0].name == "chassis"
    assert len(DOUBLE_WISHBONE.moving) == len(DOUBLE_WISHBONE.bodies) - 1


def test_its_loops_are_solved_as_on_a_fixed_body():
    fixed, free = Plan.of(FIXED), Plan.of(free_model())
    assert [t.step for t in free.transformers] == [t.step for t in fixed.transformers]
    first, *rest = free.steps
    assert first == PlaceFree(BODY)
    assert rest == fixed.steps


def test_all_that_is_driven_can_move_whatever_the_others_do():
    model = free_model()
    driven = (*model.independent, *model.prescribed)
    mobility = Mobility(Topology(model.mechanism), driven)
    assert mobility.is_known
    assert mobility.driven_move()


def test_its_tables_name_the_world():
    topology = Topology(freed())
    assert joint_rows(topology)[-1] == ("body", "free", "world", "1 chassis", "6", "nothing")
    assert mobility_line(topology).endswith(f"= {topology.mobility}")


def test_proposals_keep_the_free_body():
    found = next(proposals(free_model()))
    assert set(found.independent) == set(FIXED.independent)
    search = Search(free_model())
    assert search.model(found.independent).independent == ("body", *found.independent)


def test_its_equations_are_refused_for_now():
    with pytest.raises(DeclarationError, match="'chassis' moves freely in the world") as refused:
        generate(free_model())
    assert "no equations for that yet" in str(refused.value)
    assert "fixed='chassis'" in str(refused.value)


def test_a_free_body_that_nobody_drives_has_no_pose():
    with pytest.raises(DeclarationError, match="nothing else says where 'chassis' is; make it"):
        free_model(independent=FIXED.independent)


def test_a_free_body_cannot_be_prescribed():
    with pytest.raises(DeclarationError, match="prescribed joint 'body' is free, with 6 coord"):
        replace(FIXED, mechanism=freed(), prescribed={"body": "rack"})


def test_a_pair_of_copies_shares_the_free_body():
    free = freed()
    sides = [
        copy(free, prefix, mirrored=prefix == "left_", shared=("chassis",))
        for prefix in ("right_", "left_")
    ]
    whole = combined("pair", "two sides", sides)
    assert whole.fixed is None
    assert [j for j in whole.joints if isinstance(j, Free)] == [BODY]
    assert Topology(whole).mobility == 6 + 2 * Topology(DOUBLE_WISHBONE).mobility


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"joints": DOUBLE_WISHBONE.joints}, "nothing says where it is in the world: .*'chassis'"),
        ({"fixed": "chassis"}, "joint 'body' is free, .* while 'chassis' is fixed there"),
        ({"fixed": "chasis", "joints": DOUBLE_WISHBONE.joints}, "did you mean 'chassis'"),
        (
            {"bodies": (replace(DOUBLE_WISHBONE.bodies[0], name="world"),)},
            "body 'world' has the name of the world",
        ),
    ],
)
def test_a_mechanism_is_somewhere_in_the_world_once(changes, words):
    with pytest.raises(DeclarationError, match=words):
        freed(**changes)


def test_a_free_joint_begins_at_the_world():
    with pytest.raises(DeclarationError, match="must be the world; leave first out"):
        Free(name="body", first="rack", second="chassis")


def test_any_body_can_rest_in_the_world():
    """What is fixed need not be declared first: the same mechanism held at its knuckle."""
    bench = replace(DOUBLE_WISHBONE, fixed="knuckle")
    assert "chassis" in [b.name for b in bench.moving]
    assert Topology(bench).mobility == Topology(DOUBLE_WISHBONE).mobility
    ball = next(j for j in bench.joints if isinstance(j, Spherical))
    assert "knuckle" in ball.bodies
    assert np.isfinite(Topology(bench).loop_count)
