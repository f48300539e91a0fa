"""Gears: joints that follow others, by hand, and in every kind of loop that reads a driven joint.

In a shaft on two crosses, and as a telescope of known length, they are looked at with everything
else in `test_mechanisms`.
"""

from dataclasses import replace
from math import pi

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.backends.report.markdown import markdown
from kintrafo.generator.closed_forms.coupled_loops import CoupledLoops
from kintrafo.generator.closed_forms.elbow import PlaceElbow
from kintrafo.generator.closed_forms.ups import StrutLeg
from kintrafo.generator.declare.declared import DeclarationError
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.planning.proposal import model_of
from mechanisms.every_closed_form import geared, moving_slider_crank, oblique_four_bar, turret
from mechanisms.iterated_loops import FIVE_BAR, planar
from oracle.random_states import check_with_the_oracle
from support.changes import changed
from support.models import derive


def five_bar_at_its_pin():
    """Return a five-bar that is driven by its left crank and the pin of both couplers."""
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
    return replace(bars, allow_iteration=False, massive=bars.mechanism.bodies[1:])


def counted_from_design(model, joint):
    """Return a model one of whose hinges counts its angle from the design position."""
    hinge = model.mechanism.joint(joint)
    return changed(model, (hinge, replace(hinge, angle_to=None)))


CASES = {
    "strut": (geared(turret("strut", "stroke"), "stroke", "slew", 0.13), StrutLeg),
    "behind a rotor": (geared(oblique_four_bar(), "drive", "spinning", 0.4), None),
    "behind what is given": (
        geared(moving_slider_crank("given", prescribed=True), "drive", "tilt", -0.7),
        None,
    ),
    "elbow": (geared(five_bar_at_its_pin(), "pin", "left", 0.8), PlaceElbow),
    "iteration": (
        geared(counted_from_design(FIVE_BAR, "elbow"), "elbow", "knee", 0.5),
        CoupledLoops,
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_what_follows_moves_as_the_oracle_says(case, tmp_path):
    model, form = CASES[case]
    if form is not None:
        plan = CataloguePlan.of(model)
        steps = [*plan.steps, *(t.step for t in plan.transformers)]
        assert any(isinstance(part, form) for s in steps for part in (s, getattr(s, "leg", s)))
    check_with_the_oracle(model, tmp_path, 0.05)


# -- by hand ---------------------------------------------------------------------------------------

AXIS = g.Direction("axis", (1.0, 0.2, 0.0))
FRAME = g.Ground("frame")
INERTIA = {"motor": 0.02, "wheel": 0.3}


def shaft(name, place):
    """Return a body of revolution, and the line about which it turns."""
    at = g.Point(f"{name}_at", place)
    tensor = tuple(INERTIA.get(name, 0.1) * np.eye(3)[[0, 1, 2], [0, 1, 2]])
    return g.Body(name, 3.0, at, tensor), g.Line(at, AXIS)


MOTOR, MOTOR_LINE = shaft("motor", (0.0, 0.0, 0.0))
WHEEL, WHEEL_LINE = shaft("wheel", (0.0, 0.4, 0.1))
DRIVE = g.Revolute("drive", FRAME, MOTOR, MOTOR_LINE)
RATIO = g.Ratio("ratio", -0.25, "teeth of the motor over those of the wheel")
TORQUE = g.Input("torque", "N m", "torque of the motor")
LOAD = g.Input("load", "N m", "moment on the wheel")


def train():
    """Return a motor that turns a wheel, and one more behind it by a belt."""
    turning = g.Revolute("turning", FRAME, WHEEL, WHEEL_LINE, follows=g.Gear(DRIVE, RATIO))
    third, line = shaft("third", (0.0, 0.9, 0.1))
    belt = g.Gear(turning, g.Ratio("belt", 2.0, "of the diameters"))
    last = g.Revolute("last", FRAME, third, line, follows=belt)
    mechanism = g.Mechanism(
        "train",
        "Two wheels behind a motor",
        (DRIVE, turning, last),
        (g.JointForce(DRIVE, TORQUE), g.AppliedMoment(WHEEL, AXIS, LOAD)),
        tuple(joint.angle(f"{joint.name}_angle", joint.name) for joint in (DRIVE, turning, last)),
    )
    return kintrafo.System(kintrafo.compile(mechanism))


def test_a_train_of_gears_has_the_inertia_that_the_motor_feels():
    system = train()
    for ratio, belt in ((-0.25, 2.0), (0.7, -3.0), (0.0, 1.0)):
        numbers = kintrafo.System(system.equations, {"ratio": ratio, "belt": belt})
        felt = 0.02 + ratio**2 * (0.3 + belt**2 * 0.1)
        inputs = [5.0, -8.0]  # torque and load
        angle, rate = 400.3, 12.0  # many turns: angles are not counted from the poses
        change = numbers.evaluate("rhs", [angle, rate], inputs)
        assert change[1] == pytest.approx((5.0 - 8.0 * ratio) / felt, rel=1e-14)
        angles = numbers.evaluate("relative_coordinates", [angle, rate])
        np.testing.assert_allclose(angles, [angle, ratio * angle, belt * ratio * angle], rtol=1e-15)
        rates = numbers.evaluate("relative_jacobian", [angle, rate])
        np.testing.assert_allclose(rates[:, 0], [1.0, ratio, belt * ratio], rtol=1e-14, atol=1e-16)


def screw_press(name="press"):
    """Return a spindle that a nut turns, and a spring under the ram that it drives."""
    nut, line = shaft("nut", (0.2, 0.0, 0.5))
    turning = g.Revolute("turning", FRAME, nut, line)
    ram = g.Body("ram", 4.0, (0.3, 0.02, 0.5), (0.1, 0.1, 0.1))
    thread = g.Gear(turning, g.Lead("lead", 0.012, "of the thread"))
    way = g.Direction("way", (1.0, 0.2, 0.0))  # a mirror turns the axis round, and not the way
    sliding = g.Prismatic("sliding", FRAME, ram, way, follows=thread)
    spring = g.LinearSpring(
        g.SpringRate("rate", 900.0, "of the spring"),
        free_length=g.Displacement("free_slide", 0.01, "slide at which the spring has no force"),
    )
    return g.Mechanism(
        name,
        "Screw press",
        (turning, sliding),
        (g.ForceElement("spring", g.AlongGuide(sliding), (spring,)),),
        (turning.angle("nut_angle", "nut"), sliding.slide("ram_slide", "ram")),
    )


def test_a_thread_swings_on_its_spring_as_a_pendulum_of_torsion():
    system = kintrafo.System(kintrafo.compile(screw_press()))
    inertia, rate = 0.1 + 4.0 * 0.012**2, 900.0 * 0.012**2
    (mode,) = kintrafo.linearise(system, [0.01 / 0.012, 0.0]).modes
    # the matrix has rounding in it, and is no more than 2 x 2
    assert mode.natural_frequency == pytest.approx((rate / inertia) ** 0.5 / (2 * pi), rel=1e-12)
    start = [0.01 / 0.012 + 2.0, 0.0]
    found = kintrafo.simulate(system, (0.0, 3.0), start, rtol=1e-10, atol=1e-12)
    angle = 0.01 / 0.012 + 2.0 * np.cos((rate / inertia) ** 0.5 * found.t)
    np.testing.assert_allclose(found.y[0], angle, atol=1e-8)


# -- with other forces and joints ------------------------------------------------------------------


def test_what_follows_is_no_candidate_and_what_is_followed_must_be():
    press = screw_press()
    assert [p.independent for p in kintrafo.proposals(press)] == [("turning",)]


def test_tables_say_what_follows_what():
    report = markdown(derive(model_of(screw_press()), derivatives=False))
    assert report.count("slide = lead x angle of turning") == 2, "joints and coordinates"


def test_a_mirror_image_turns_with_its_original():
    left = g.Copy(screw_press(), "left_")
    right = g.Copy(screw_press(), "right_", mirrored=True)
    both = g.combined("presses", "Two presses", (left, right))
    system = kintrafo.System(kintrafo.compile(both))
    assert set(system.parameters) >= {"lead"}
    assert not any(name.endswith("_lead") for name in system.parameters)
    angle, slide = "nut_angle", "ram_slide"
    names = [f"{side}_{name}" for side in ("left", "right") for name in (angle, slide)]
    found = system.evaluate("relative_coordinates", [2.0, 2.0, 0.0, 0.0])
    assert dict(zip(system.equations.RELATIVE_COORDINATES, found, strict=True)) == pytest.approx(
        dict(zip(names, [2.0, 0.024] * 2, strict=True)), rel=1e-15
    )


# -- errors ----------------------------------------------------------------------------------------


def test_a_number_alone_is_no_ratio(refused):
    refused(DeclarationError, lambda: g.Gear(DRIVE, 0.25))


@pytest.mark.parametrize(
    ("kind", "ratio"), [(g.Revolute, g.Lead("r", 1.0, "")), (g.Prismatic, g.Ratio("r", 1.0, ""))]
)
def test_a_ratio_in_wrong_units_is_refused(kind, ratio, refused):
    along = WHEEL_LINE if kind is g.Revolute else AXIS
    refused(
        DeclarationError, lambda: kind("turning", FRAME, WHEEL, along, follows=g.Gear(DRIVE, ratio))
    )


def test_an_angle_that_counts_to_a_point_is_refused(refused):
    mark = g.Point("mark", (0.0, 0.0, 0.3))
    counted = g.Revolute("counted", FRAME, MOTOR, MOTOR_LINE, angle_to=mark)
    refused(
        DeclarationError,
        lambda: g.Revolute("turning", FRAME, WHEEL, WHEEL_LINE, follows=g.Gear(counted, RATIO)),
    )


def test_only_hinges_and_guides_are_followed(refused):
    ball = g.Spherical("ball", FRAME, MOTOR, MOTOR.center)
    refused(
        DeclarationError,
        lambda: g.Revolute("turning", FRAME, WHEEL, WHEEL_LINE, follows=g.Gear(ball, RATIO)),
    )


def two_shafts():
    """Return two wheels in mesh, and the joint of the one that follows."""
    turning = g.Revolute("turning", FRAME, WHEEL, WHEEL_LINE, follows=g.Gear(DRIVE, RATIO))
    angles = DRIVE.angle("drive_angle", "motor"), turning.angle("turning_angle", "wheel")
    return g.Mechanism("mesh", "Two wheels", (DRIVE, turning), (), angles), turning


def test_what_follows_cannot_be_driven(refused):
    mechanism, turning = two_shafts()
    refused(DeclarationError, lambda: g.Formulation("mesh", "Two wheels", mechanism, (turning,)))


def test_what_is_followed_must_be_driven(refused):
    model = geared(oblique_four_bar(), "spinning", "drive", 3.0)
    swing, drive = model.independent
    knuckle = model.mechanism.joint("knuckle")
    forces = tuple(f for f in model.mechanism.forces if f.along != drive)
    mechanism = replace(model.mechanism, forces=forces)
    refused(
        DeclarationError, lambda: replace(model, mechanism=mechanism, independent=(swing, knuckle))
    )


def test_a_gear_that_would_lock_what_it_joins_is_refused():
    """Crank and rocker of a four-bar in mesh: the loop has no freedom left."""
    model = oblique_four_bar()
    drive, pivot = (model.mechanism.joint(name) for name in ("drive", "pivot"))
    gear = g.Gear(drive, g.Ratio("pivot_ratio", 1.3, "ratio"))
    with pytest.raises(NoClosedFormError):
        CataloguePlan.of(changed(model, (pivot, replace(pivot, follows=gear))))
