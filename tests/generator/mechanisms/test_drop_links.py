"""The drop link of an anti-roll bar joins each part of each suspension that its file may name."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.mechanisms import MODELS, axle
from kintrafo.generator.planning.plan import CataloguePlan
from support.placements import Placements

CORNERS = {model.name: model for model in MODELS}
PARTS = [
    ("macpherson_general", "upper_strut"),
    *(("double_wishbone_general", part) for part in ("upper_arm", "knuckle")),
    ("multi_link", "knuckle"),
    *(("multi_link", f"{end}_link") for end in ("front_upper", "rear_upper", "front_lower")),
    *(("push_rod", part) for part in ("rocker", "push_rod")),
    *(("pull_rod", part) for part in ("rocker", "pull_rod")),
    ("trailing_arm", "trailing_arm"),
]


def on_bar(corner, part):
    declared = axle.mechanism(f"{corner}_by_{part}", "", CORNERS[corner], pulls=part)
    return axle.model(CORNERS[corner], declared)


@pytest.mark.parametrize(("corner", "part"), PARTS)
def test_each_loop_of_a_drop_link_has_a_solution(corner, part):
    plan = CataloguePlan.of(on_bar(corner, part))
    assert {"right_bar", "left_drop_link"} <= {b for t in plan.transformers for b in t.cycle.bodies}


def test_a_drop_link_on_one_of_five_links_joins_both():
    """Joints keep their points: the link at chassis, knuckle and drop link, this at the bar."""
    corner = CORNERS["multi_link"]
    chassis, link, knuckle = map(corner.mechanism.body, ("chassis", "rear_lower_link", "knuckle"))
    bar, drop = g.Body("bar", 0.0, (0.2, -0.3, 0.3)), g.Body("drop_link", 0.0, (0.0, -0.6, 0.25))
    bush, top, foot = (
        g.Point("bush", (0.24, -0.4, 0.32)),
        g.Point("top", (0.03, -0.58, 0.33)),
        g.Point("foot", (-0.06, -0.6, 0.19)),
    )
    joints = (
        g.Revolute(
            "bar_hinge", chassis, bar, axis=g.Line(bush, g.Direction("bar_axis", (0.0, 1.0, 0.0)))
        ),
        g.Spherical("link_ball", bar, drop, at=top),
        g.Universal(
            "link_cross", link, drop, at=foot, shaft=g.Line(foot, top), first_axis=g.FORWARD
        ),
    )
    mechanism = replace(corner.mechanism, joints=(*corner.mechanism.joints, *joints))
    model = replace(corner, name="half_a_bar", mechanism=mechanism)
    parameters = {p.name: p.default for p in mechanism.parameters}
    driven = np.zeros((5, len(model.driven)))
    driven[:, 0] = np.pi / 2 + np.linspace(-0.06, 0.06, 5)
    answered, places, rotations = Placements.of(model).at(parameters, driven)
    assert answered.all()
    bodies = [body.name for body in mechanism.bodies[1:]]

    def place(body, point):
        where = np.array([parameters[f"{point}_{axis}"] for axis in "xyz"])
        if body == chassis:
            return np.broadcast_to(where, (5, 3))
        number = bodies.index(body.name)
        start = body.center.position
        start = np.array([parameters[str(value)] for value in (start.x, start.y, start.z)])
        return places[:, number] + rotations[:, number] @ (where - start)

    for point, one, other in (
        ("rear_lower_link_inner", chassis, link),
        ("rear_lower_link_outer", knuckle, link),
        ("foot", link, drop),
        ("top", bar, drop),
        ("bush", chassis, bar),
    ):
        # 1e-13 m: rounding of coordinates of 1 m
        np.testing.assert_allclose(place(one, point), place(other, point), atol=1e-13)
    assert np.ptp(place(drop, "top")[:, 2]) > 0.01
