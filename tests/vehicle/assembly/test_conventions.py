"""The signs of docs/reference/conventions.md, on both sides: from points that move, not formulas.

Points of the wheel are carried along as a person would watch them: its top, its foremost point,
where the steering axis pierces the ground. Nothing here knows the definitions of the angles.
"""

from collections import defaultdict

import numpy as np
import pytest
from kintrafo import Model, Suspension, state_at_height
from kintrafo.vehicle.analysis.characteristics import over
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import design_height
from kintrafo.vehicle.models.reach import at_rest

RIGHT = Suspension.load("reference_car")
CARS = {"right": RIGHT, "left": RIGHT.mirrored()}
OUTBOARD = {"right": -1.0, "left": 1.0}  # in y

side = pytest.mark.parametrize("side", CARS)


def one(dataset, name):
    return float(dataset[name].values[0])


def at_design(car, name):
    return one(over(Model(car), "travel", [0.0]), name)


def wheel_plane(car):
    """Return the directions to the wheel's top and to its foremost point at design."""
    spin = car.wheel.spin_axis(car.vehicle.sign)
    up = np.array([0.0, 0.0, 1.0]) - spin * spin[2]
    return up / np.linalg.norm(up), np.cross(spin, up)


@side
@pytest.mark.parametrize("sign", [1.0, -1.0])
class TestWheel:
    def test_camber_is_positive_with_the_top_outboard(self, side, sign):
        car = CARS[side].with_changes({"wheel.camber_deg": 3.0 * sign})
        up, _ = wheel_plane(car)
        assert np.sign(up[1]) == sign * OUTBOARD[side]
        assert at_design(car, "camber") == pytest.approx(np.deg2rad(3.0 * sign), abs=1e-14)

    def test_toe_is_positive_with_the_front_inboard(self, side, sign):
        car = CARS[side].with_changes({"wheel.toe_deg": 2.0 * sign})
        _, front = wheel_plane(car)
        assert front[0] > 0.9
        assert np.sign(front[1]) == -sign * OUTBOARD[side]
        assert at_design(car, "toe") == pytest.approx(np.deg2rad(2.0 * sign), abs=1e-14)

    def test_steer_is_positive_with_the_front_to_the_left(self, side, sign):
        model = Model(CARS[side])
        steered = over(model, "rack", [sign * 0.03])
        states, inputs = at_rest(model, model.design_state[0], sign * 0.03)
        knuckle = model.evaluate("orientations", states, inputs)[
            model.equations.BODIES.index("knuckle")
        ]
        _, front = wheel_plane(CARS[side])
        assert np.sign(one(steered, "steer")) == np.sign((knuckle @ front)[1])


@side
@pytest.mark.parametrize("sign", [1.0, -1.0])
class TestSteeringAxis:
    def leaning(self, side, x=0.0, y=0.0):
        """Return the car with its strut top moved from right above the ball joint."""
        foot = CARS[side].hardpoints.ball_joint
        changes = {"hardpoints.strut_top.x": foot[0] + x, "hardpoints.strut_top.y": foot[1] + y}
        return CARS[side].with_changes(changes)

    def test_caster_is_positive_with_the_top_rearward(self, side, sign):
        car = self.leaning(side, x=-40.0 * sign)
        assert np.sign(at_design(car, "caster")) == sign

    def test_kingpin_inclination_is_positive_with_the_top_inboard(self, side, sign):
        car = self.leaning(side, y=-OUTBOARD[side] * 60.0 * sign)
        assert np.sign(at_design(car, "kingpin_inclination")) == sign

    def test_trail_is_positive_with_the_axis_ahead(self, side, sign):
        # upright, the axis stands where the ball joint is
        ball = self.leaning(side).hardpoints.wheel_center[0] + 30.0 * sign
        upright = {"hardpoints.ball_joint.x": ball, "hardpoints.strut_top.x": ball}
        car = self.leaning(side).with_changes(upright)
        assert at_design(car, "trail") == pytest.approx(0.030 * sign, abs=1e-12)
        assert at_design(car, "hub_trail") == pytest.approx(0.030 * sign, abs=1e-12)

    def test_offset_is_positive_with_the_axis_inboard(self, side, sign):
        car = self.leaning(side)
        wheel = car.hardpoints.ball_joint[1] + OUTBOARD[side] * 50.0 * sign
        car = car.with_changes({"hardpoints.wheel_center.y": wheel})
        assert at_design(car, "steering_axis_offset") == pytest.approx(0.050 * sign, abs=1e-12)
        assert at_design(car, "spindle_offset") == pytest.approx(0.050 * sign, abs=1e-12)
        # the upright axis stands 5 mm ahead of the contact, too
        assert at_design(car, "scrub_radius") == pytest.approx(np.hypot(0.050, 0.005), abs=1e-12)


@side
class TestMotion:
    def test_travel_is_up_and_the_arm_angle_falls(self, side):
        model = Model(CARS[side])
        state = state_at_height(model, design_height(model) + 0.02)
        assert float(model.signal("wheel_center_z", state)) > design_height(model)
        assert state[0] < model.design_state[0]

    def test_arm_angle_counts_from_upright_to_the_arm(self, side):
        """An arm that points outboard and level has a right angle."""
        model = Model(CARS[side])
        level = np.arange(0.0, np.pi, 0.001)
        points = hardpoints(model, *at_rest(model, level[1400:1750], 0.0))
        rise = points["ball_joint"][:, 2] - CARS[side].hardpoints.metres("arm_rear")[2]
        assert np.interp(0.0, -rise, level[1400:1750]) == pytest.approx(np.pi / 2, abs=1e-6)

    def test_rack_moves_to_the_left(self, side):
        model = Model(CARS[side])
        ends = [
            hardpoints(model, *at_rest(model, model.design_state[0], rack))["tie_rod_inner"][1]
            for rack in (0.0, 0.01)
        ]
        assert ends[1] - ends[0] == pytest.approx(0.01, abs=1e-15)

    def test_spin_is_positive_rolling_forward(self, side):
        """The lowest point of the wheel moves rearward relative to its centre."""
        model = Model(CARS[side])
        state = model.state(beta5_rate=1.0)
        twist = model.evaluate("velocities", state)[model.equations.BODIES.index("wheel")]
        lowest = np.cross(twist[:3], [0.0, 0.0, -0.3])
        assert lowest[0] == pytest.approx(-0.3, abs=1e-12)

    def test_bump_compresses_the_spring_with_a_positive_motion_ratio(self, side):
        model = Model(CARS[side])
        lengths = [
            float(model.signal("strut_length", state_at_height(model, design_height(model) + rise)))
            for rise in (0.0, 0.001)
        ]
        assert lengths[1] < lengths[0]
        assert at_design(CARS[side], "motion_ratio") > 0.5


STEP = 1e-5  # of the wheel's travel, to either side of design [m]


def shift_in_bump(car, offset):
    """Return how a point of the wheel carrier moves for a metre of wheel travel at design.

    The point is so far from the wheel centre [m].
    """
    model = Model(car)
    knuckle = model.equations.BODIES.index("knuckle")
    center = car.hardpoints.metres("wheel_center")
    arm = center + offset - model.evaluate("positions", model.design_state)[knuckle]
    ends = []
    for rise in (STEP, -STEP):
        state = state_at_height(model, design_height(model) + rise)
        origin = model.evaluate("positions", state)[knuckle]
        ends.append(origin + model.evaluate("orientations", state)[knuckle] @ arm)
    return (ends[0] - ends[1]) / (2.0 * STEP)


TO_TOP = np.array([0.0, 0.0, RIGHT.hardpoints.metres("wheel_center")[2]])
OFFSETS = (TO_TOP, -TO_TOP, np.zeros(3), np.array([0.3, 0.0, 0.0]))


def tilted(hinge, *, rear=0.0, tie_rod=300.0):
    """Return changes: heights of the hinge of the arm, the rear so much more, and tie rod [mm]."""
    return {
        "hardpoints.arm_front.z": hinge,
        "hardpoints.arm_rear.z": hinge + rear,
        "hardpoints.tie_rod_inner.z": tie_rod,
    }


TILTED = (tilted(205.0), tilted(60.0), tilted(205.0, rear=60.0), tilted(205.0, rear=-60.0),
          tilted(205.0, tie_rod=250.0))  # fmt: skip


@side
def test_what_a_wheel_does_in_bump_has_the_sign_of_its_points(side):
    """Of each there is either sign in some of the cars."""
    signs = defaultdict(set)
    for changes in TILTED:
        car = CARS[side].with_changes(changes)
        top, ground, hub, front = (shift_in_bump(car, offset) for offset in OFFSETS)
        leans_inboard = -OUTBOARD[side] * (top - ground)[1]
        goes_outboard = OUTBOARD[side] * ground[1]
        found = over(Model(car), "travel", [-STEP, 0.0, STEP])
        values = {name: found[name].values[1] for name in found}
        for name in ("wheelbase_change", "half_track_change"):
            values[name] = found[name].values[2] - found[name].values[0]
        expected = {
            "swing_arm_length_kinematic": leans_inboard,
            "swing_arm_length_geometric": leans_inboard,
            "camber_gradient": -leans_inboard,
            "roll_center_height_kinematic": goes_outboard,
            "roll_center_height_geometric": goes_outboard,
            "half_track_change": goes_outboard,
            "side_view_swing_arm_angle": ground[0],
            "anti_dive": ground[0],
            "side_view_hub_angle": hub[0],
            "wheelbase_change": hub[0],
            "bump_steer": -OUTBOARD[side] * (front - hub)[1],
        }
        for name, value in expected.items():
            assert np.sign(values[name]) == np.sign(value), name
            signs[name].add(np.sign(value))
    assert all(found == {-1.0, 1.0} for found in signs.values()), signs
