"""Loops that are solved by iteration are on the branch that the way from the design position leads.

The oracles: the closed forms of a Hooke joint and of a spherical four-bar linkage, and paths that
are followed in maximal coordinates (`following`).
"""

from functools import cache

import numpy as np
import pytest
from kintrafo import Model, PositionError, characteristics, loads, state_at_height, travel_range
from kintrafo.vehicle.models.model_batch import ModelBatch
from kintrafo.vehicle.models.positions import arm_angles_of_batch, design_height
from mechanisms import iterated_loops, random_multi_links, random_rigid_axles
from mechanisms.random_loops import FAMILIES, Judged, judged
from scipy.spatial.transform import Rotation
from support.placements import Placements


def turned(model, inputs):
    """Return where the first hinge of a ring is answered, and how far its last body has turned.

    The turn is that about the axis of the last hinge, which is on the ground.
    """
    parameters = {p.name: p.default for p in model.mechanism.parameters}
    answered, _, rotations = Placements.of(model).at(parameters, inputs[:, None])
    last = len(model.mechanism.joints) - 1
    axis = np.array([parameters[f"axis_{last}_{a}"] for a in "xyz"])
    vectors = Rotation.from_matrix(rotations[:, -1]).as_rotvec()
    return answered, vectors @ axis / np.linalg.norm(axis)


def assert_same_turns(found, expected):
    """See that angles are equal but for whole turns.

    1e-13: rounding of angles, hundredfold for the least determinant on the way.
    """
    np.testing.assert_allclose((found - expected + np.pi) % (2 * np.pi), np.pi, atol=1e-13)


def test_a_hooke_joint_goes_all_the_way_round():
    """tan(out) = tan(in) / cos(bend), for more than three turns in either sense."""
    inputs = np.linspace(-20.0, 20.0, 161)
    answered, found = turned(iterated_loops.HOOKE, inputs)
    assert answered.all()
    assert_same_turns(
        found, np.arctan2(np.sin(inputs), np.cos(inputs) * np.cos(iterated_loops.BEND))
    )


def test_a_spherical_four_bar_goes_all_the_way_round():
    """A cos(out) + B sin(out) = C, with the arc of the coupler; the branch is that at design."""
    ground, crank, rocker, last = (
        np.array(a) / np.linalg.norm(a) for a in iterated_loops.SPHERICAL_AXES
    )
    inputs = np.linspace(-7.0, 7.0, 141)
    pin = Rotation.from_rotvec(inputs[:, None] * ground).apply(crank)
    level = (rocker @ last) * (pin @ last)
    a, b = pin @ rocker - level, pin @ np.cross(last, rocker)
    middle, half = np.arctan2(b, a), np.arccos((crank @ rocker - level) / np.hypot(a, b))
    design = len(inputs) // 2
    side = -np.sign(middle[design])  # the rocker has not turned there
    assert middle[design] + side * half[design] == pytest.approx(0.0, abs=1e-14)
    answered, found = turned(iterated_loops.SPHERICAL, inputs)
    assert answered.all()
    assert_same_turns(found, middle + side * half)


PLANAR = [
    family
    for family in FAMILIES
    if family.model
    in (iterated_loops.STEPHENSON, iterated_loops.IN_A_ROW, iterated_loops.THREE_RRR)
]


@pytest.mark.parametrize("family", PLANAR, ids=[f.model.name for f in PLANAR])
def test_regular_positions_of_planar_linkages_are_answered(family):
    found = sum((judged(family, np.random.default_rng(seed)) for seed in range(3)), Judged())
    assert found.regular > 3
    assert found.answered == found.regular
    assert found.wrong == 0


def test_behind_a_dead_point_is_no_answer():
    """The knee of a four-bar opens until coupler and crank are in line with the rocker's reach.

    The law of cosines says when: the distance of the far pins is at most rocker and ground in line.
    """
    model = iterated_loops.FOUR_BAR_AT_ITS_KNEE
    parameters = {p.name: p.default for p in model.mechanism.parameters}
    hinge, knee, knuckle, rocker = (
        np.array([parameters[f"{name}_at_{a}"] for a in "xyz"])
        for name in ("crank_hinge", "knee", "knuckle", "rocker_hinge")
    )
    crank, coupler = np.linalg.norm(knee - hinge), np.linalg.norm(knuckle - knee)
    ground, arm = np.linalg.norm(rocker - hinge), np.linalg.norm(knuckle - rocker)
    inputs = np.linspace(-2 * np.pi, 2 * np.pi, 2001)
    start = np.arccos((hinge - knee) @ (knuckle - knee) / (crank * coupler))
    reach = [
        np.sqrt(crank**2 + coupler**2 - 2 * crank * coupler * np.cos(start + sense * inputs))
        for sense in (1, -1)
    ]
    open_ = [(abs(ground - arm) < r) & (r < ground + arm) for r in reach]
    answered, _, _ = Placements.of(model).at(parameters, inputs[:, None])
    runs = [_around(len(inputs) // 2, o) for o in open_]
    assert any(np.array_equal(answered, run) for run in runs)


def _around(place, holds):
    """Return where something holds without a gap from a place on."""
    gaps = np.flatnonzero(~holds)
    low = max(gaps[gaps < place], default=-1)
    high = min(gaps[gaps > place], default=len(holds))
    return (np.arange(len(holds)) > low) & (np.arange(len(holds)) < high)


# -- suspensions: two branches over one range ------------------------------------------------------

# Of this multi-link with its rack at 15.4 mm the path ends 12 mm below design, where the knuckle is
# turned by 7 degrees. Straight ways from design in arm angle and rack pass the point where branches
# meet on its other side, and lead to positions from 14 mm down, turned by 55 degrees and more.
TWO_BRANCHES = {
    "hardpoints.front_upper_link_outer": (5.8291, -651.5736, 381.7929),
    "hardpoints.rear_upper_link_inner": (-27.6545, -537.7088, 377.9391),
    "hardpoints.rear_upper_link_outer": (-106.9648, -766.6553, 407.3238),
    "hardpoints.rear_lower_link_inner": (-124.8435, -297.8632, 263.9591),
    "hardpoints.tie_rod_outer": (-14.6524, -720.9270, 276.2209),
    "hardpoints.tie_rod_inner": (-291.5356, -381.9909, 348.5438),
    "hardpoints.spring_top": (-195.1493, -539.1526, 647.3372),
    "hardpoints.spring_seat": (-42.2122, -430.5769, 228.7709),
    "hardpoints.damper_top": (-96.9884, -640.2860, 716.3436),
    "hardpoints.wheel_center": (-123.6057, -603.1030, 298.5333),
}
RACK = 0.015403


@cache
def two_branches():
    return Model(random_multi_links.CAR.with_changes(TWO_BRANCHES))


def test_a_range_ends_where_its_branch_does():
    model = two_branches()
    ways = random_multi_links.Ways([model.suspension], RACK)
    reach = travel_range(model, RACK)
    assert ways.compared(0, model, np.array(reach.arm_angle)).wrong == []
    swung = abs(reach.arm_angle[0] - model.design_state[0])
    assert swung == pytest.approx(ways.monotone(0, 1.0), abs=1e-3)
    assert design_height(model) - reach.height[0] == pytest.approx(0.0119, abs=1e-4)


@pytest.mark.parametrize("travel", [-0.012, -0.0135, -0.015, -0.04, -0.08])
def test_positions_on_another_branch_are_refused(travel, refused):
    model = two_branches()
    refused(
        PositionError,
        lambda: state_at_height(model, design_height(model) + travel, rack_position=RACK),
        lambda: characteristics.over(model, "travel", [0.0, travel], rack_position=RACK),
    )
    case = {"travel_mm": 1e3 * travel, "rack_mm": 1e3 * RACK}
    refused(PositionError, lambda: loads.static(model, {"case": case}))


def test_positions_on_another_branch_are_no_part_of_a_batch():
    model = two_branches()
    values = {"hardpoints.tie_rod_inner.x": np.array([TWO_BRANCHES["hardpoints.tie_rod_inner"][0]])}
    batch = ModelBatch(model.suspension, values, free_rack=False)
    for travel, reached in ((-0.01, True), (-0.015, False), (-0.08, False)):
        assert arm_angles_of_batch(batch, np.array([travel]), np.array([RACK]))[1] == reached


def test_multi_links_are_on_the_branch_of_their_path():
    random = np.random.default_rng([1, 0])
    found = random_multi_links.judged(
        random_multi_links.some_cars(random, 12), random.uniform(-0.06, 0.06), random
    )
    assert found.positions > 50
    assert found.in_batches > 3
    assert found.wrong == []


def test_rigid_axles_are_on_the_branch_of_their_path():
    random = np.random.default_rng(2)
    found = random_rigid_axles.judged(random_rigid_axles.some_axles(random, 24), random)
    assert found.wrong == found.short == []
    assert found.positions > 100
