"""Loops that are solved by iteration are on the branch that the way from the design position leads.

The oracles: the closed forms of a Hooke joint and of a spherical four-bar linkage, and paths that
are followed in maximal coordinates (`following`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import following
import numpy as np
import own_loops
import pytest
from following import FAMILIES, Judged, judged
from placements import Placements
from scipy.spatial.transform import Rotation

if TYPE_CHECKING:
    from kintrafo.generator import Formulation
    from oracle.constraints import Array


def turned(model: Formulation, inputs: Array) -> tuple[Array, Array]:
    """Return where the first hinge of a ring is answered, and how far its last body has turned.

    The turn is that about the axis of the last hinge, which is on the ground.
    """
    parameters = {p.name: p.default for p in model.mechanism.parameters}
    answered, _, rotations = Placements.of(model).at(parameters, inputs[:, None])
    last = len(model.mechanism.joints) - 1
    axis = np.array([parameters[f"axis_{last}_{a}"] for a in "xyz"])
    vectors = Rotation.from_matrix(rotations[:, -1]).as_rotvec()
    return answered, vectors @ axis / np.linalg.norm(axis)


def assert_same_turns(found: Array, expected: Array) -> None:
    """See that angles are equal but for whole turns.

    1e-13: rounding of angles, hundredfold for the least determinant on the way.
    """
    np.testing.assert_allclose((found - expected + np.pi) % (2 * np.pi), np.pi, atol=1e-13)


def test_a_hooke_joint_goes_all_the_way_round() -> None:
    """tan(out) = tan(in) / cos(bend), for more than three turns in either sense."""
    inputs = np.linspace(-20.0, 20.0, 161)
    answered, found = turned(own_loops.HOOKE, inputs)
    assert answered.all()
    assert_same_turns(found, np.arctan2(np.sin(inputs), np.cos(inputs) * np.cos(own_loops.BEND)))


def test_a_spherical_four_bar_goes_all_the_way_round() -> None:
    """A cos(out) + B sin(out) = C, with the arc of the coupler; the branch is that at design."""
    ground, crank, rocker, last = (
        np.array(a) / np.linalg.norm(a) for a in own_loops.SPHERICAL_AXES
    )
    inputs = np.linspace(-7.0, 7.0, 141)
    pin = Rotation.from_rotvec(inputs[:, None] * ground).apply(crank)
    level = (rocker @ last) * (pin @ last)
    a, b = pin @ rocker - level, pin @ np.cross(last, rocker)
    middle, half = np.arctan2(b, a), np.arccos((crank @ rocker - level) / np.hypot(a, b))
    design = len(inputs) // 2
    side = -np.sign(middle[design])  # the rocker has not turned there
    assert middle[design] + side * half[design] == pytest.approx(0.0, abs=1e-14)
    answered, found = turned(own_loops.SPHERICAL, inputs)
    assert answered.all()
    assert_same_turns(found, middle + side * half)


PLANAR = [
    family
    for family in FAMILIES
    if family.model in (own_loops.STEPHENSON, own_loops.IN_A_ROW, own_loops.THREE_RRR)
]


@pytest.mark.parametrize("family", PLANAR, ids=[f.model.name for f in PLANAR])
def test_regular_positions_of_planar_linkages_are_answered(family: following.Family) -> None:
    found = sum((judged(family, np.random.default_rng(seed)) for seed in range(3)), Judged())
    assert found.regular > 3
    assert found.answered == found.regular
    assert found.wrong == 0


def test_behind_a_dead_point_is_no_answer() -> None:
    """The knee of a four-bar opens until coupler and crank are in line with the rocker's reach.

    The law of cosines says when: the distance of the far pins is at most rocker and ground in line.
    """
    model = own_loops.FOUR_BAR_AT_ITS_KNEE
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


def _around(place: int, holds: Array) -> Array:
    """Return where something holds without a gap from a place on."""
    gaps = np.flatnonzero(~holds)
    low = max(gaps[gaps < place], default=-1)
    high = min(gaps[gaps > place], default=len(holds))
    return (np.arange(len(holds)) > low) & (np.arange(len(holds)) < high)
