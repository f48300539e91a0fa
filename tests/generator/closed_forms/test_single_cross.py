"""A single cross between two hinges whose axes meet in it, against Hooke's formula by hand."""

from dataclasses import replace
from math import atan2, cos, pi, radians, sin

import numpy as np
import pytest
from kintrafo import System
from kintrafo.equations.errors import ClosureError, ParameterError
from kintrafo.generator import Line, Point
from kintrafo.generator.closed_forms.single_cross import SingleCross
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms.every_closed_form import shaft_angles
from mechanisms.iterated_loops import CROSSED_RING
from mechanisms.steering_shafts import column, crosses_in_a_row
from oracle.random_states import check_with_the_oracle
from support.changes import changed, with_default
from support.models import Built, own

TURNS = np.linspace(-pi, pi, 25)


@pytest.mark.parametrize("bend", [35, -50])
def test_it_turns_as_hooke_says(bend):
    model = column("one_cross", radians(bend), 0.0, 0.0, links="one")
    module = own(model, derivatives=False)
    built, row = Built.of(model, module), list(module.RELATIVE_COORDINATES).index("rolling_angle")
    for turn in TURNS:
        found = built("relative_coordinates", np.array([turn, 0.0]))[row]
        angle = atan2(cos(radians(bend)) * sin(turn), cos(turn))
        # some thirty roundings, times 1 / cos(50 degrees)
        assert abs((found - angle + pi) % (2 * pi) - pi) < 1e-14


def test_crosses_in_a_row_on_bodies_that_move(tmp_path):
    model = crosses_in_a_row()
    plan = CataloguePlan.of(model)
    assert [type(t.step) for t in plan.transformers] == [SingleCross, SingleCross]
    assert plan.topology.mobility == len(model.independent)
    check_with_the_oracle(model, tmp_path, 0.4)


def test_beyond_a_right_angle_it_is_refused(refused):
    model = crosses_in_a_row()
    built = Built.of(model, own(model, derivatives=False))
    refused(ClosureError, lambda: built("rhs", np.array([0.0, 1.0, 1.5, 0.0, 0.0, 0.0])))


def test_a_hinge_that_misses_the_center_is_refused():
    """Two axes that do not meet leave nothing to move."""
    model = crosses_in_a_row()
    rolling = model.mechanism.joint("rolling")
    beside = Point("beside", (0.6, 0.21, 0.3))
    moved = replace(rolling, axis=Line(beside, rolling.axis.towards))
    with pytest.raises(NoClosedFormError):
        CataloguePlan.of(changed(model, (rolling, moved)))


def test_numbers_that_take_a_hinge_off_the_center_are_refused(refused):
    """The point of the hinge is one of its own, at the same place."""
    model = crosses_in_a_row()
    rolling = model.mechanism.joint("rolling")
    own_point = Point("own_point", (0.6, 0.2, 0.3))
    meeting = replace(rolling, axis=Line(own_point, rolling.axis.towards))
    same = replace(changed(model, (rolling, meeting)), name="meeting_by_numbers")
    built = own(same, arrays=True, derivatives=False)
    refused(ParameterError, lambda: System(built, {"own_point_y": 0.22}))


def with_crosses(model, name):
    """Report the angles of the shafts as well, and give every body mass."""
    mechanism = model.mechanism
    coordinates = (*mechanism.coordinates, *shaft_angles(mechanism.joints))
    whole = replace(mechanism, coordinates=coordinates)
    return replace(model, name=name, mechanism=whole, massive=whole.moving)


def through_its_cross():
    """Return two shafts whose second one is reached through the cross alone, which is oblique."""
    model = with_default(column("reached", 0.6, 0.0, 0.0, links="one"), plane_x=0.4, plane_z=0.2)
    rolling = model.mechanism.joint("rolling")
    turned = replace(rolling, first=rolling.second, second=rolling.first)
    return with_crosses(changed(model, (rolling, turned)), "reached")


@pytest.mark.parametrize(
    "model",
    [through_its_cross(), with_crosses(CROSSED_RING, "reported_ring")],
    ids=["closed", "iterated"],
)
def test_what_turns_with_a_reported_cross(model):
    """The absolute Jacobian along the chain of reported angles, times the relative one (Eq. 16)."""
    built = Built.of(model, own(model, derivatives=False))
    random = np.random.default_rng(3)
    for _ in range(5):
        away = random.uniform(-0.2, 0.2, built.size)
        state = np.concatenate((built.design + away, np.zeros(built.size)))
        product = built("absolute_jacobian", state) @ built("relative_jacobian", state)
        np.testing.assert_allclose(product, built("global_jacobian", state), atol=1e-11)
