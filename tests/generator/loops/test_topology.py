"""Mobility, shortest paths, cycles and characteristic pairs, against the paper and at large."""

from dataclasses import replace
from itertools import combinations, pairwise

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import generator as g
from kintrafo.generator.closed_forms.prismatic import PrismaticByLength
from kintrafo.generator.closed_forms.revolute import RevoluteByLength
from kintrafo.generator.closed_forms.telescope import Telescope
from kintrafo.generator.closed_forms.turn import TurnByLength
from kintrafo.generator.loops.errors import NoClosedFormError, TopologyError
from kintrafo.generator.loops.graph import JointGraph, MinimalBasis
from kintrafo.generator.loops.tilted import tilted
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.mechanisms.n_four_bar import n_four_bar
from kintrafo.generator.planning.plan import CataloguePlan
from support.changes import changed

MODEL = MODELS[0]
PAPER = MODELS[:2]  # the paper's suspension, its rack prescribed and free
BY_NAME = {model.name: model for model in MODELS}
SUSPENSION = MODEL.mechanism


@pytest.fixture(scope="module")
def topology():
    return JointGraph(SUSPENSION)


@pytest.fixture(scope="module", params=PAPER, ids=lambda model: model.name)
def plan(request):
    return CataloguePlan.of(request.param)


def numbers(cycle):
    return {SUSPENSION.numbers[name] for name in cycle.bodies}


# -- the paper's suspension -----------------------------------------------------------------------


def test_mobility_and_loops(topology):
    """Eq. 1, f = 6 x 6 - (5 + 3 + 4 + 4 + 3 + 4 + 5 + 5) = 3, and section 4, 8 - (7 - 1) = 2."""
    freedoms = {joint.name: joint.freedoms for joint in SUSPENSION.joints}
    assert freedoms == {"OA": 1, "B": 3, "BC": 2, "C": 2, "D": 3, "E": 2, "y": 1, "HG": 1}
    assert topology.mobility == 3
    assert topology.loop_count == 2


# Table 2, row by row: the edges of one shortest path, from each body to the bodies 1 to 7
TABLE_2 = """
-         12        12,23     15,54     15        16        16,63,37
21        -         23        21,15,54  21,15     21,16     23,37
32,21     32        -         34        34,45     36        37
45,51     45,51,12  43        -         45        43,36     43,37
51        51,12     54,43     54        -         51,16     54,43,37
61        61,12     63        63,34     61,15     -         63,37
73,36,61  73,32     73        73,34     73,34,45  73,36     -
"""
PATHS = {
    (start, end): edges
    for start, row in enumerate(TABLE_2.split("\n")[1:-1], 1)
    for end, edges in enumerate(row.split(), 1)
    if start != end
}


@pytest.mark.parametrize(("ends", "edges"), PATHS.items(), ids=str)
def test_table_2(topology, ends, edges):
    """The paper shows one shortest path of each pair; it must be among all that we find."""
    by_number = {number: name for name, number in SUSPENSION.numbers.items()}
    steps = edges.split(",")
    path = [by_number[int(steps[0][0])], *(by_number[int(step[1])] for step in steps)]
    start, end = (by_number[number] for number in ends)
    paths = topology.shortest_paths(start, end)
    assert (path[0], path[-1]) == (start, end)
    assert tuple(path) in paths
    assert len({length_of(topology, p) for p in paths}) == 1
    # no simple path of the graph is shorter, and none of that length is missing
    simple = list(nx.all_simple_paths(topology.graph, start, end))
    least = min(length_of(topology, p) for p in simple)
    assert sorted(paths) == sorted(tuple(p) for p in simple if length_of(topology, p) == least)


def length_of(topology, path):
    """Return the sum of the joint degrees of freedom along a path."""
    return sum(topology.joint_between(a, b).freedoms for a, b in pairwise(path))


def test_three_cycles(topology):
    found = [(numbers(cycle), cycle.length) for cycle in topology.candidate_cycles]
    assert found[0] == ({1, 2, 3, 6}, 8)
    assert len(found) == 3
    assert ({1, 6, 3, 4, 5}, 10) in found
    assert ({1, 2, 3, 4, 5}, 10) in found


def test_basis(plan):
    assert [(numbers(t.cycle), t.cycle.length) for t in plan.transformers] == [
        ({1, 6, 3, 2}, 8),
        ({1, 6, 3, 4, 5}, 10),
    ]


def test_why_the_second_loop_is_preferred(plan):
    """Of the two loops of length 10 the one with the strut has two unknowns fewer by then."""
    first, second = plan.transformers
    assert first.rivals == ()
    ((rival, unknowns),) = second.rivals
    assert (numbers(rival), rival.length) == ({1, 2, 3, 4, 5}, 10)
    assert (second.unknowns, unknowns) == (6, 8)


def test_characteristic_pairs(plan):
    pairs = [{joint.name for joint in t.pair.joints} for t in plan.transformers]
    assert pairs == [{"B", "C"}, {"D", "E"}]
    for transformer in plan.transformers:
        assert transformer.pair.equations == 1
        # the pair is the one that eliminates most
        assert transformer.pair.eliminated == max(c.eliminated for c in transformer.candidates)


def test_blocks_hand_on_what_they_solve(plan):
    """Figure 3: the strut's slide and direction go from the first transformer to the second."""
    first, second = plan.transformers
    assert first.inputs == ("OA.angle",)
    assert first.outputs == ("BC.slide", "C.azimuth", "C.elevation")
    assert second.inputs == (*first.outputs, "y.slide")
    assert "BC.angle" in second.outputs
    assert not set(first.outputs) & set(second.outputs)


# -- the other mechanisms -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "mobility", "loops", "solutions"),
    [
        ("macpherson_general", 3, 0, [Telescope, TurnByLength]),
        ("double_wishbone", 3, 0, [RevoluteByLength, TurnByLength]),
        ("four_bar", 1, 1, [RevoluteByLength]),
        ("slider_crank", 1, 1, [PrismaticByLength]),
        ("andrews", 1, 3, [RevoluteByLength, RevoluteByLength, RevoluteByLength]),
        ("excavator", 3, 4, [RevoluteByLength] * 4),
    ],
)
def test_loops_are_found_and_solved(name, mobility, loops, solutions):
    """The spatial count of Eq. 1 would give planar loops minus two freedoms each."""
    plan = CataloguePlan.of(BY_NAME[name])
    assert plan.topology.mobility == mobility
    assert plan.topology.planar_loop_count == loops
    assert [type(t.step) for t in plan.transformers] == solutions
    assert all(t.pair.equations == 1 for t in plan.transformers)


def test_strut_that_misses_the_ball_joint_gets_its_direction_from_the_rod():
    first, second = CataloguePlan.of(BY_NAME["macpherson_general"]).transformers
    assert first.outputs == ("BC.slide",)
    assert {"BC.angle", "C.azimuth", "C.elevation"} <= set(second.outputs)


def test_two_ball_joints_leave_the_turn_of_the_link_between_them_out():
    first, _ = CataloguePlan.of(BY_NAME["double_wishbone"]).transformers
    assert {joint.name for joint in first.pair.joints} == {"lower_ball", "upper_ball"}
    assert (first.pair.eliminated, first.unknowns) == (6, 7)
    assert first.outputs == ("upper_hinge.angle",)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_chain_of_four_bars_has_one_freedom(count):
    plan = CataloguePlan.of(n_four_bar(count))
    assert plan.topology.mobility == 1
    assert len(plan.transformers) == plan.topology.planar_loop_count == count


def test_hinges_along_lines_between_points_are_not_taken_for_parallel():
    cycle = MinimalBasis(JointGraph(loop_of(*[g.Revolute] * 4).mechanism)).options()[0]
    assert not cycle.planar
    planar = MinimalBasis(JointGraph(BY_NAME["four_bar"].mechanism)).options()[0]
    assert planar.planar


# -- any mechanism --------------------------------------------------------------------------------

P, Q = g.Point("p", (0.0, 0.0, 0.0)), g.Point("q", (1.0, 0.0, 0.0))
BODIES = (g.Ground("body_0"), *(g.Body(f"body_{i}", 1.0, (0.0, 0.0, 0.0)) for i in range(1, 8)))
LENGTH = g.Distance("length", 1.0, "length")


def joint_between(kind, name, first, second):
    """Return a joint of a kind; topology does not ask where it is."""
    random = np.random.default_rng([*name.encode()])
    ends = (g.Point(f"{name}_{i}", tuple(random.normal(size=3).tolist())) for i in (1, 2))
    geometry = {
        g.Revolute: {"axis": g.Line(*ends)},
        g.Prismatic: {"direction": g.FORWARD},
        g.Cylindrical: {"axis": g.Line(P, Q), "length_at_zero_slide": LENGTH, "angle_to": Q},
        g.Universal: {"at": P, "shaft": g.Line(P, Q)},
        g.Spherical: {"at": P},
    }
    return kind(name=name, first=first, second=second, **geometry[kind])


def mechanism_of(joints):
    return g.Mechanism(name="any", title="any", joints=tuple(joints))


KINDS = (g.Revolute, g.Prismatic, g.Cylindrical, g.Universal, g.Spherical)


@st.composite
def mechanisms(draw):
    """Connected joint graphs with up to eight bodies and five loops."""
    count = draw(st.integers(2, 8))
    tree = [(draw(st.integers(0, i - 1)), i) for i in range(1, count)]
    others = [edge for edge in combinations(range(count), 2) if edge not in tree]
    extra = draw(st.lists(st.sampled_from(others), max_size=5, unique=True)) if others else []
    joints = [
        joint_between(draw(st.sampled_from(KINDS)), f"j{k}", BODIES[a], BODIES[b])
        for k, (a, b) in enumerate([*tree, *extra])
    ]
    return mechanism_of(joints)


@given(mechanisms(), st.randoms(use_true_random=False))
@settings(deadline=None, max_examples=60)
def test_minimal_cycle_basis(mechanism, choice):
    """Any choice among the shortest extensions ends at a basis as short as networkx's."""
    topology = JointGraph(mechanism)
    chosen = []
    while options := MinimalBasis(topology, chosen).options():
        chosen.append(choice.choice(options))
    assert len(chosen) == topology.loop_count
    assert topology.independent(chosen)
    reference = nx.minimum_cycle_basis(topology.graph, weight="length")
    lengths = [topology.cycle(nodes).length for nodes in in_order(topology.graph, reference)]
    assert sorted(c.length for c in chosen) == sorted(lengths)


def in_order(graph, cycles):
    """Return networkx's cycles with their bodies in the order of a walk."""
    ordered = []
    for nodes in cycles:
        inside = graph.subgraph(nodes)
        best = min(
            (c for c in nx.simple_cycles(inside) if len(c) == len(nodes)),
            key=lambda c: sum(
                inside.edges[a, b]["length"] for a, b in zip(c, [*c[1:], c[0]], strict=True)
            ),
        )
        ordered.append(best)
    return ordered


@given(mechanisms())
@settings(deadline=None, max_examples=60)
def test_sum_of_two_cycles_is_dependent(mechanism):
    """Independence is that of the edges modulo two."""
    topology = JointGraph(mechanism)
    for a, b in combinations(topology.candidate_cycles, 2):
        both = a.key ^ b.key
        third = [c for c in topology.candidate_cycles if c.key == both]
        assert topology.independent([a, b])
        for c in third:
            assert not topology.independent([a, b, c])


# -- mechanisms without an analysis ---------------------------------------------------------------


def test_unreachable_body(refused):
    caliper, piston = (g.Body(name, 1.0, (0.0, 0.0, 0.0)) for name in ("caliper", "piston"))
    loose = joint_between(g.Spherical, "loose", caliper, piston)
    refused(
        TopologyError, lambda: JointGraph(replace(SUSPENSION, joints=(*SUSPENSION.joints, loose)))
    )


def test_two_joints_between_the_same_bodies(refused):
    bodies = (SUSPENSION.body(name) for name in ("control_arm", "chassis"))
    second = joint_between(g.Spherical, "second", *bodies)
    refused(
        TopologyError, lambda: JointGraph(replace(SUSPENSION, joints=(*SUSPENSION.joints, second)))
    )


def loop_of(*kinds):
    """Return a single loop whose first joint is driven."""
    count = len(kinds)
    joints = [
        joint_between(kind, f"j{i}", BODIES[i], BODIES[(i + 1) % count])
        for i, kind in enumerate(kinds)
    ]
    driven = joints[0]
    mechanism = replace(mechanism_of(joints), coordinates=(driven.angle("q", "drive"),))
    return g.Formulation("loop", "loop", mechanism, independent=(driven,), massive=())


def test_loop_without_closed_form(refused):
    """Two universal joints leave two equations with three revolute joints: none in general."""
    loop = loop_of(g.Revolute, g.Revolute, g.Universal, g.Universal, g.Revolute)
    refused(NoClosedFormError, lambda: CataloguePlan.of(loop))


def test_loop_of_hinges_has_no_closed_form(refused):
    """The seven hinges of a general loop are a polynomial of degree 16: nothing to cut at."""
    refused(NoClosedFormError, lambda: CataloguePlan.of(loop_of(*[g.Revolute] * 7)))


def test_undetermined_body(refused):
    """Without the spin coordinate nothing determines the turn of the wheel."""
    model = replace(MODEL, independent=MODEL.independent[:1])
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


def test_too_few_coordinates_for_a_loop(refused):
    """Without the rack coordinate the steering loop cannot be solved, and is named."""
    free = replace(SUSPENSION, forces=())  # none along the rack
    model = replace(MODEL, mechanism=free, prescribed={}, held={})
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


@pytest.mark.parametrize("independent", [("A", "D"), ()])
def test_number_of_coordinates_is_compared_with_the_mobility(independent, refused):
    four_bar = BY_NAME["four_bar"]
    free = replace(four_bar.mechanism, forces=())  # none along the crank
    joints = tuple(map(free.joint, independent))
    refused(
        NoClosedFormError,
        lambda: CataloguePlan.of(replace(four_bar, mechanism=free, independent=joints)),
    )


def test_driven_joint_declared_the_wrong_way_round(refused):
    bearing = SUSPENSION.joint("HG")
    turned = replace(bearing, first=bearing.second, second=bearing.first)
    model = changed(MODEL, (bearing, turned))
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


def test_directions_and_points_are_values():
    """The same declaration twice is the same geometry, so joints may be declared on other pages."""
    assert g.Point("p", (0.0, 0.0, 0.0)) == P
    assert g.Direction("d", (1, 2, 3)) == g.Direction("d", (1.0, 2.0, 3.0))
    assert g.Line(P, Q).contains(Q)
    assert not g.Line(P, Q).contains(g.Point("r", (2.0, 0.0, 0.0)))


@pytest.mark.parametrize("degrees", [0.06, 1e-6])
def test_a_hinge_that_is_nearly_parallel_is_named(degrees, refused):
    bar = BY_NAME["four_bar"].mechanism
    line = g.Direction("off", (np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees))))
    (c,) = (joint for joint in bar.joints if joint.name == "C")
    other = changed(bar, (c, replace(c, axis=replace(c.axis, towards=line))))
    text = tilted(other)
    assert text.startswith(f"Joint 'C' is tilted by {degrees:.3g} degrees from A, B, D")
    refused(
        NoClosedFormError, lambda: CataloguePlan.of(replace(BY_NAME["four_bar"], mechanism=other))
    )
    assert tilted(bar) == ""
