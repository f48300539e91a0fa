"""A steering shaft that telescopes between two crosses, against Hooke's formula by hand."""

from dataclasses import replace
from math import atan2, cos, degrees, pi, radians, sin

import numpy as np
import pytest
from kintrafo.equations.errors import ParameterError
from kintrafo.generator import DeclarationError, Direction, Input, JointForce, Motion, Universal
from kintrafo.generator.closed_forms.cardan_shaft import CardanShaft
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.mechanisms import held_by_rods
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms.every_closed_form import cross, declare, guide, hinge, steering_shaft
from mechanisms.steering_shafts import column
from oracle.random_states import check_with_the_oracle
from scipy.optimize import brentq
from support.changes import changed
from support.models import Built, own

TURNS = np.linspace(-pi, pi, 25)


def answers(model):
    """Return a model and the names of its relative coordinates.

    All columns in a plane are one model with other parameters.
    """
    swinging = len(model.independent) > 1
    module = own(column("columns", 0.3, 0.3, 0.0, swinging=swinging), derivatives=False)
    return Built.of(model, module), list(module.RELATIVE_COORDINATES)


def off(found, expected):
    """Return how far an angle is from another, without whole turns."""
    return abs((found - expected + pi) % (2 * pi) - pi)


@pytest.mark.parametrize("bends", [(35, 35), (35, -35), (20, 50), (-40, 15)])
@pytest.mark.parametrize("phase", [0, 90, 37])
def test_both_crosses_turn_as_hooke_says(bends, phase):
    """Both angles count from the fork across the plane; the shaft's is in between."""
    first, second, lead = (radians(angle) for angle in (*bends, phase))
    built, names = answers(column("hooke", first, second, lead))
    start = atan2(sin(lead), cos(second) * cos(lead))
    for turn in TURNS:
        state = np.array([turn, 0.7])
        found = dict(zip(names, built("relative_coordinates", state), strict=True))
        shaft = atan2(cos(first) * sin(turn), cos(turn))
        pinion = atan2(sin(shaft + lead), cos(second) * cos(shaft + lead)) - start
        # some thirty roundings, times 1 / cos(50 degrees)
        assert off(found["rolling_angle"], pinion) < 1e-14
        assert abs(found["spline_slide"]) < 1e-15
        axes = built("orientations", state).reshape(-1, 3, 3)[1]
        assert off(turn_about_x(axes), shaft) < 1e-14


def turn_about_x(axes):
    """Return the turn of a body about x, along which the shaft lies."""
    return atan2(axes[2, 1], axes[1, 1])


def test_a_shaft_at_a_right_angle_to_the_pinion_is_refused(refused):
    """The bracket swings until the shaft is there, from a bend of 80 degrees on."""
    model = column("swung", 0.0, radians(-80), 0.0, swinging=True)
    built, _ = answers(model)
    axis = np.array([cos(radians(80)), 0.0, sin(radians(80))])

    def bend(swing):
        arm = np.array([0.2, 0.0, -0.3])  # from the bracket's bearing to the upper cross
        x = arm[0] * cos(swing) + arm[2] * sin(swing)
        z = arm[2] * cos(swing) - arm[0] * sin(swing)
        return float(axis @ np.array([0.6 - x, 0.0, -0.3 - z]))

    there = brentq(bend, -0.5, 0.0, xtol=1e-15)
    assert np.isfinite(built("relative_coordinates", np.array([0.9 * there, 0, 0, 0]))).all()
    refused(ValueError, lambda: built("relative_coordinates", np.array([there, 0.0, 0.0, 0.0])))


def test_a_shaft_along_the_fork_of_the_column_is_refused(refused):
    built, _ = answers(column("square", radians(90), 0.2, 0.0))
    assert np.isfinite(built("relative_coordinates", np.array([1.5, 0.0]))).all()
    refused(ValueError, lambda: built("relative_coordinates", np.array([pi / 2, 0.0])))


def test_a_pinion_across_its_shaft_is_refused_at_the_design_position(refused):
    built, _ = answers(column("stopped", 0.2, radians(90), 0.0))
    refused(ParameterError, lambda: built("relative_coordinates", np.zeros(2)))


def test_a_bearing_that_moves_as_given_moves_the_pinion(tmp_path):
    model = steering_shaft("given_shaft")
    tilt, steer, shake = model.independent
    forces = tuple(f for f in model.mechanism.forces if f.along != shake)
    given = replace(
        model,
        mechanism=replace(model.mechanism, forces=forces),
        independent=(tilt, steer),
        prescribed={shake: Motion("shaking", "rad", "turn of the box")},
    )
    check_with_the_oracle(given, tmp_path, 0.3)


def test_the_pinion_may_turn_the_column(tmp_path):
    model = column("backwards", 0.3, 0.5, 0.4)
    rolling = model.mechanism.joint("rolling")
    forces = (JointForce(rolling, Input("torque", "N m", "torque on the pinion")),)
    mechanism = replace(model.mechanism, forces=forces)
    check_with_the_oracle(replace(model, mechanism=mechanism, independent=(rolling,)), tmp_path, pi)


# -- several in a row ------------------------------------------------------------------------------


def series():
    """Return two shafts with a bearing between them, and a pinion behind the second."""
    return declare(
        "two_shafts",
        {
            "column": (0.1, 0.0, 0.6),
            "upper": (0.3, 0.02, 0.5),
            "sleeve": (0.4, 0.03, 0.45),
            "middle": (0.52, 0.05, 0.4),
            "lower": (0.6, 0.04, 0.3),
            "tube": (0.65, 0.03, 0.2),
            "pinion": (0.75, 0.02, 0.1),
        },
        (
            hinge("steer", "ground", "column", "first_center", "column_line"),
            cross("cross_1", "column", "upper", "first_center", "second_center", "fork_1"),
            guide("spline_1", "upper", "sleeve", ("first_center", "second_center")),
            cross("cross_2", "middle", "sleeve", "second_center", "first_center", "fork_2"),
            hinge("bearing", "ground", "middle", "second_center", "middle_line"),
            cross("cross_3", "middle", "lower", "third_center", "fourth_center", "fork_3"),
            guide("spline_2", "lower", "tube", ("third_center", "fourth_center")),
            cross("cross_4", "pinion", "tube", "fourth_center", "third_center", "fork_4"),
            hinge("rolling", "ground", "pinion", "fourth_center", "pinion_line"),
        ),
        {
            "first_center": (0.2, 0.0, 0.55),
            "second_center": (0.5, 0.05, 0.42),
            "third_center": (0.55, 0.05, 0.38),
            "fourth_center": (0.7, 0.02, 0.15),
            "ground_seat": (0.3, 0.3, 0.4),
            "column_seat": (0.1, 0.1, 0.6),
        },
        {
            "column_line": (0.9, 0.1, -0.2),
            "middle_line": (0.7, 0.0, -0.4),
            "pinion_line": (0.7, 0.1, -0.5),
            "fork_1": (0.1, 0.2, 1.0),
            "fork_2": (0.3, 1.0, 0.2),
            "fork_3": (0.2, -0.3, 1.0),
            "fork_4": (0.1, 1.0, 0.4),
        },
        ("steer",),
        spring=("ground_seat", "column_seat"),
    )


def test_shafts_in_a_row_go_round_as_the_oracle_says(tmp_path):
    model = series()
    steps = [type(transformer.step) for transformer in CataloguePlan.of(model).transformers]
    assert steps == [CardanShaft, CardanShaft]
    check_with_the_oracle(model, tmp_path, pi)


# -- errors ----------------------------------------------------------------------------------------


def test_a_guide_beside_the_line_of_the_crosses_is_reported_by_how_much():
    model = column("askew", 0.3, 0.3, 0.0, along=(1.0, 0.0, 0.02))
    with pytest.raises(DeclarationError, match=f"spline .*{degrees(np.arctan(0.02)):.3g} degrees"):
        generate(model, derivatives=False)


@pytest.mark.parametrize("sense", [1.0, -2.0])
def test_a_guide_of_its_own_direction_counts_along_it(sense, tmp_path):
    model = column("own_way", 0.3, 0.4, 0.2, along=(sense, 0.0, 0.0), swinging=True)
    check_with_the_oracle(model, tmp_path, 0.5)


def test_a_hinge_beside_its_cross_is_reported_by_how_much(refused):
    model = column("beside", 0.3, 0.3, 0.0, beside=0.004)
    refused(DeclarationError, lambda: generate(model, derivatives=False))


@pytest.mark.parametrize("allowed", [False, True], ids=["closed form", "iteration"])
@pytest.mark.parametrize("links", ["rigid", "turned"])
def test_what_is_no_such_shaft_is_refused_with_a_remedy(links, refused, *, allowed):
    """A shaft that cannot telescope, and a cross whose second body is not the shaft."""
    model = replace(column("other", 0.3, 0.3, 0.0, links=links), allow_iteration=allowed)
    refused(NoClosedFormError, lambda: CataloguePlan.of(model))


def test_a_rod_with_two_crosses_holds_no_carrier_by_iteration(refused):
    """Its second cross would be one equation more, which used to be left out."""
    model = next(m for m in held_by_rods.MODELS if m.name == "control_arm_multi_link")
    ball = model.mechanism.joint("toe_link_ball")
    way = model.mechanism.joint("toe_link_cross").shaft
    crossed = Universal(ball.name, ball.first, ball.second, ball.at, way, Direction("z", (0, 0, 1)))
    CataloguePlan.of(model)
    refused(NoClosedFormError, lambda: CataloguePlan.of(changed(model, (ball, crossed))))
