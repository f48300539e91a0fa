"""Two links with a driven hinge between them, as a leg: a four-bar driven at its coupler's pin."""

from dataclasses import replace

import numpy as np
import pytest
from kintrafo.equations.errors import ClosureError
from kintrafo.generator import Motion, Point
from kintrafo.generator.closed_forms.elbow import Elbow, PlaceElbow
from kintrafo.generator.closed_forms.prismatic import PrismaticByLength
from kintrafo.generator.closed_forms.revolute import RevoluteByLength
from kintrafo.generator.mechanisms.slider_crank import MODELS as SLIDER_CRANKS
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms.iterated_loops import KNEE, planar
from oracle.random_states import check_with_the_oracle
from support.changes import changed, named


def other_way_round(model):
    """Declare the driven hinge from the coupler to the crank, which the coupler then carries."""
    knee = model.mechanism.joint("knee")
    turned = replace(knee, first=knee.second, second=knee.first)
    return replace(changed(model, (knee, turned)), name="turned_knee")


def driven_slider():
    """Push the piston of a slider-crank by the hinge between crank and rod."""
    (model,) = SLIDER_CRANKS
    mechanism = replace(model.mechanism, forces=())
    driving = mechanism.joint("B")
    return replace(model, name="knee_slider", mechanism=mechanism, independent=(driving,))


def counted_to_a_point():
    """Count the angle of the driven hinge from a direction of the crank to the rocker's pin."""
    knee = KNEE.mechanism.joint("knee")
    counted = replace(knee, angle_to=named(KNEE, Point, "knuckle_at"))
    return replace(changed(KNEE, (knee, counted)), name="counted_knee")


@pytest.mark.parametrize(
    ("model", "form"),
    [
        (KNEE, RevoluteByLength),
        (other_way_round(KNEE), RevoluteByLength),
        (counted_to_a_point(), RevoluteByLength),
        (driven_slider(), PrismaticByLength),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_it_moves_as_the_oracle_says(model, form, tmp_path):
    plan = CataloguePlan.of(model)
    (transformer,) = plan.transformers
    assert isinstance(transformer.step, form)
    assert isinstance(transformer.step.leg, Elbow)
    assert PlaceElbow in map(type, plan.steps)
    built = check_with_the_oracle(model, tmp_path, 0.3)
    names = list(built.module.RELATIVE_COORDINATES)
    for angle in built.design[0] + np.linspace(-0.3, 0.3, 7):
        state = np.array([angle, 0.4])
        given = built("relative_coordinates", state)
        assert len(given) == len(names)
        inputs = np.zeros(len(built.module.INPUTS))
        np.testing.assert_allclose(built.residuals(given, state, inputs), 0.0, atol=1e-14)


def test_a_driven_elbow_may_hang_at_moving_bodies(tmp_path):
    """A five-bar, two coordinates: its left crank, and the pin between the two couplers."""
    bars = planar(
        "five_bar_at_its_pin",
        [
            ("left", "ground", "leftcrank", (0.0, 0.0)),
            ("left_pin", "leftcrank", "leftrod", (0.02, 0.15)),
            ("pin", "leftrod", "rightrod", (0.2, 0.3)),
            ("right_pin", "rightrod", "rightcrank", (0.42, 0.16)),
            ("right", "ground", "rightcrank", (0.4, 0.0)),
        ],
        ("left", "pin"),
        ("leftrod", (0.1, 0.25)),
    )
    bars = replace(bars, allow_iteration=False, massive=bars.mechanism.bodies[1:])
    assert PlaceElbow in map(type, CataloguePlan.of(bars).steps)
    check_with_the_oracle(bars, tmp_path, 0.2)
    left, pin = bars.independent
    given = replace(
        bars,
        name="five_bar_with_a_given_pin",
        independent=(left,),
        prescribed={pin: Motion("pin", "rad", "turn of the pin")},
    )
    check_with_the_oracle(given, tmp_path, 0.2)


def test_links_that_cannot_reach_are_refused(tmp_path, refused):
    far = planar(
        "far_knee",
        [
            ("crank_hinge", "ground", "crank", (0.0, 0.0)),
            ("knee", "crank", "coupler", (0.0, 0.12)),
            ("knuckle", "coupler", "rocker", (0.3, 0.25)),
            ("rocker_hinge", "rocker", "ground", (0.55, 0.2)),
        ],
        ("knee",),
        ("coupler", (0.15, 0.3)),
    )
    built = check_with_the_oracle(replace(far, allow_iteration=False), tmp_path, 0.1, count=1)
    refused(ClosureError, lambda: built("rhs", np.array([-2.0, 0.0])))
