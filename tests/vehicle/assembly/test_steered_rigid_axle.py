"""Steered rigid axles, against formulations that share nothing with the equations.

`test_mechanisms` compares the equations with maximal coordinates and watches the energy, like those
of every mechanism. Here the poses of beam and knuckles are the root of all distances at once, and
forces of the steering follow from virtual work on these poses.
"""

import math

import kintrafo
import numpy as np
import pytest
from kintrafo import (
    InputError,
    PositionError,
    characteristics,
    compliance,
    equilibrium,
    load,
    loads,
)
from kintrafo.generator.mechanisms import model_named
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.files.schema import schema
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.equations import _parameters, declared
from kintrafo.vehicle.studies.design_variables import places_of
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

AXLE = load("steered_rigid_axle")
MODEL = kintrafo.model_of(AXLE)
SIDES = ("left", "right")
MIRROR = np.array([1.0, -1.0, 1.0])
TURNED = AXLE.with_changes({"wheel": {"camber_deg": 0.5, "toe_deg": 0.1}})


# -- an independent formulation: poses of beam and both knuckles ----------------------------------


class Poses:
    """Poses of beam, left and right knuckle, which fulfil all distances: 18 unknowns.

    `longer` are elongations of drag link and track rod [m].
    """

    BODIES = ("beam", *SIDES)

    def __init__(self, axle, longer=None):
        self.axle, unit = axle, 1e-3
        self.longer = {"drag": 0.0, "track": 0.0} | (longer or {})
        right = {n: unit * np.array(getattr(axle.hardpoints, n)) for n in
                 ("wheel_center", "kingpin_lower", "kingpin_upper", "track_rod")}  # fmt: skip
        self.points = {"right": right, "left": {n: p * MIRROR for n, p in right.items()}}
        self.arm_end = unit * np.array(axle.drag_link.knuckle)
        gear = axle.pitman_arm
        self.pivot, self.ball = (unit * np.array(p) for p in (gear.pivot_mm, gear.ball_mm))
        self.axis = np.array(gear.axis) / np.linalg.norm(gear.axis)
        arm = self.ball - self.pivot
        self.length = float(np.linalg.norm(arm - self.axis * (arm @ self.axis)))
        self.rods = [
            (unit * np.array(r.chassis), unit * np.array(r.axle)) for r in axle.rods.values()
        ]

    def pitman(self, rack):
        """Return where the ball of the Pitman arm is."""
        turn = Rotation.from_rotvec(self.axis * rack / self.length)
        return self.pivot + turn.apply(self.ball - self.pivot)

    def at(self, x, body, point):
        """Return where a point of a body is, of its place at design."""
        own = x.reshape(3, 6)[self.BODIES.index(body)]
        return np.asarray(point + own[:3] + Rotation.from_rotvec(own[3:]).apply(point) - point)

    def misfit(self, x, rack, heights, beam):
        near = self.axle.drag_link.side
        off = [
            np.linalg.norm(self.at(x, "beam", end) - start) - np.linalg.norm(end - start)
            for start, end in self.rods
        ]
        for side in SIDES:
            for name in ("kingpin_lower", "kingpin_upper"):
                point = self.points[side][name]
                off += [*(self.at(x, side, point) - self.at(x, "beam", point))]
        drag = np.linalg.norm(self.at(x, near, self.arm_end) - self.pitman(rack))
        off.append(drag - np.linalg.norm(self.arm_end - self.ball) - self.longer["drag"])
        ends = {side: self.points[side]["track_rod"] for side in SIDES}
        track = np.linalg.norm(np.subtract(*(self.at(x, s, ends[s]) for s in SIDES)))
        off.append(track - np.linalg.norm(ends["left"] - ends["right"]) - self.longer["track"])
        if beam is not None:
            return np.array([*off, *(x[:6] - beam)])
        wheels = [self.at(x, s, self.points[s]["wheel_center"])[2] for s in SIDES]
        centre = self.points["left"]["wheel_center"][2]
        return np.array([*off, *(np.array(wheels) - centre - heights)])

    def found(self, rack, heights=(0.0, 0.0), beam=None):
        """Return the poses at heights of both wheel centres, or with the pose of the beam."""
        given = (rack, np.array(heights), beam)
        root = least_squares(
            self.misfit, np.zeros(18), args=given, xtol=1e-15, ftol=1e-15, gtol=1e-15
        )
        # roundings of lengths below 1.5 m
        assert np.abs(root.fun).max() < 2e-14
        return np.asarray(root.x)

    def direction(self, x, side, way):
        """Return a direction of a knuckle."""
        turn = x.reshape(3, 6)[self.BODIES.index(side), 3:]
        return np.asarray(Rotation.from_rotvec(turn).apply(way))


@pytest.mark.parametrize(
    ("left", "right", "rack"),
    [(0.0, 0.0, 0.05), (0.07, 0.06, 0.0), (0.06, -0.05, -0.07), (-0.08, 0.04, 0.09)],
)
def test_poses_are_the_root_of_all_distances(left, right, rack):
    states, inputs = MODEL.states_at(left, right, rack), MODEL.inputs_at(rack)
    parts = assembly_of(TURNED).PARTS.of(kintrafo.model_of(TURNED), states[None], inputs[None])
    oracle = Poses(AXLE)
    x = oracle.found(rack, (left, right))
    for side in SIDES:
        for name in ("wheel_center", "track_rod"):
            place = oracle.at(x, side, oracle.points[side][name])
            # the angle of a knuckle is a root: 1e-15 m over its lever of 0.17 m, at 0.8 m
            np.testing.assert_allclose(parts.points[f"{name}_{side}"][0], place, atol=1e-12)
        spin = TURNED.wheel.spin_axis(1.0 if side == "left" else -1.0)
        axis = oracle.direction(x, side, spin)
        np.testing.assert_allclose(parts.wheel_axis(side)[0], axis, atol=1e-12)
    heights = [parts.points[f"wheel_center_{side}"][0, 2] - AXLE.center[2] for side in SIDES]
    np.testing.assert_allclose(heights, [left, right], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.4, 0.2, 0.5)])
def test_the_axis_of_the_arm_has_any_direction(axis):
    """An upright one, too: the ball moves on a level circle."""
    pivot = [-730.0, 600.0, 445.0]
    axle = AXLE.with_changes({"pitman_arm.axis": [*axis], "pitman_arm.pivot_mm": pivot})
    model, rack = kintrafo.model_of(axle), 0.04
    states, inputs = model.states_at(0.03, -0.02, rack), model.inputs_at(rack)
    parts = assembly_of(axle).PARTS.of(model, states[None], inputs[None])
    oracle = Poses(axle)
    x = oracle.found(rack, (0.03, -0.02))
    # roundings, those at the knuckles by a lever of 0.17 m
    np.testing.assert_allclose(parts.points["pitman_ball"][0], oracle.pitman(rack), atol=1e-15)
    for side in SIDES:
        place = oracle.at(x, side, oracle.points[side]["track_rod"])
        np.testing.assert_allclose(parts.points[f"track_rod_{side}"][0], place, atol=1e-12)


def test_both_knuckles_are_turned_in_closed_form():
    """The drag link turns the one, then the track rod the other one, for either side."""
    for name in ("steered_rigid_axle", "steered_rigid_axle_right"):
        plan = CataloguePlan.of(model_named(name))
        words = [" ".join(t.step.words(t.closing)) for t in plan.transformers[-2:]]
        assert all("a cos x + b sin x = c" in each for each in words), words


# -- loads ----------------------------------------------------------------------------------------

CASES = {
    "turn": {"left": {"contact_N": [-500, 2000, 6000]}, "right": {"contact_N": [0, 4000, 9000]}},
    "brake": {"left": {"contact_N": [-4000, 0, 8000]}, "right": {"contact_N": [-2000, 0, 8000]}},
}


def work(axle, case, poses, oracle):
    """Return the work of contact forces and weights between two poses with the same beam."""
    total = 0.0
    g, body, wheel = 9.81, axle.bodies.knuckle, axle.bodies.wheel
    com = 1e-3 * np.array(body.com_mm)
    for i, side in enumerate(SIDES):
        center = oracle.points[side]["wheel_center"]
        middle = 0.5 * sum(oracle.at(x, side, center) for x in poses)
        spin = axle.wheel.spin_axis(1.0 if side == "left" else -1.0)
        axis = sum(oracle.direction(x, side, spin) for x in poses)
        axis /= np.linalg.norm(axis)
        upward = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
        contact = middle - axle.tyre_radius() * upward / np.linalg.norm(upward)
        forward = np.cross(axis, [0.0, 0.0, 1.0])
        forward /= np.linalg.norm(forward)
        along, across, up = case[side]["contact_N"]
        force = along * forward + across * np.cross([0.0, 0.0, 1.0], forward) + [0.0, 0.0, up]
        # the contact moves with the knuckle, with a locked wheel
        fixed = [oracle.at(x, side, np.zeros(3)) for x in poses]
        turn = [Rotation.from_rotvec(x.reshape(3, 6)[1 + i, 3:]) for x in poses]
        mean = Rotation.concatenate(turn).mean()
        at_design = mean.inv().apply(contact - 0.5 * (fixed[0] + fixed[1]))
        moved = np.subtract(*(oracle.at(x, side, at_design) for x in poses))
        own = com if side == "right" else com * MIRROR
        total += force @ moved
        for mass, point in ((body.mass_kg, own), (wheel.mass_kg, center)):
            total -= mass * g * np.subtract(*(oracle.at(x, side, point)[2] for x in poses))
    return float(total)


@pytest.mark.parametrize("case", CASES)
def test_forces_of_the_steering_do_the_work_of_the_wheels(case):
    """With the beam at rest, a motion of the steering or an elongation of a link does none."""
    found = loads.static(AXLE, {case: CASES[case]}).isel(case=0)
    travels = tuple(found["travel"].values.tolist())
    beam = Poses(AXLE).found(0.0, travels)[:6]
    h = 2e-5

    def slope(one, other):
        poses = tuple(oracle.found(rack, beam=beam) for rack, oracle in (one, other))
        return work(AXLE, CASES[case], poses, one[1]) / (2.0 * h)

    same = Poses(AXLE)
    # differences of second order: 4e-10 m^2 of the step over a lever's square, 0.17 m; and 1e-14 m
    # of rounding over the step, times 8 kN
    assert found["rack_force"].item() == pytest.approx(
        -slope((h, same), (-h, same)), rel=2e-7, abs=1e-3
    )
    arm = AXLE.pitman_arm.length()
    assert found["pitman_moment"].item() == pytest.approx(arm * found["rack_force"].item())
    for name in ("drag", "track"):
        longer, shorter = (Poses(AXLE, {name: sign * h}) for sign in (1.0, -1.0))
        full = {"drag": "drag_link_force", "track": "track_rod_force"}[name]
        pull = slope((0.0, longer), (0.0, shorter))
        assert found[full].item() == pytest.approx(pull, rel=2e-7, abs=1e-3), name


# -- plane geometry -------------------------------------------------------------------------------

PLANE = AXLE.with_changes(
    {
        "hardpoints.kingpin_lower": [0.0, -720.0, 260.0],
        "hardpoints.kingpin_upper": [0.0, -720.0, 480.0],
        "rods.left_link": {"chassis": [-780.0, 450.0, 320.0], "axle": [0.0, 450.0, 300.0]},
        "rods.right_link": {"chassis": [-780.0, -450.0, 320.0], "axle": [0.0, -450.0, 300.0]},
        "rods.upper_link": {"chassis": [-640.0, 0.0, 470.0], "axle": [-20.0, 0.0, 480.0]},
        "rods.panhard_rod": {"chassis": [140.0, 470.0, 410.0], "axle": [140.0, -470.0, 410.0]},
    }
)
"""With upright kingpins and a level Panhard rod, so that the steering is one in a plane."""


def test_a_soft_track_rod_lets_the_far_knuckle_turn():
    soft = 2e4
    found = compliance.linear(PLANE, {"track_rod": {"axial_N_per_mm": soft}}, [0.0])
    flexibility = found["flexibility"].isel(wheel_travel=0)
    lever = 1e-3 * 170.0  # of a rod across the car, at arms this far behind the kingpins
    # the bush is at both ends of the rod
    expected = 2.0 / (1e3 * soft * lever**2)
    moved = flexibility.sel(moved="rz_right", by="mz_right").item()
    assert moved == pytest.approx(expected, rel=1e-9)
    assert abs(flexibility.sel(moved="rz_left", by="mz_left").item()) < 1e-9 * expected
    # no steer angle is that of the axle
    assert not [name for name in map(str, found) if name.startswith("axle_steer")]


def test_kingpins_are_lines_of_the_file():
    found = characteristics.over(AXLE, "bump", [0.0])
    for name, aside in (("caster", 16.0), ("kingpin_inclination", 20.0)):
        angle = math.atan2(aside, 220.0)
        np.testing.assert_allclose(found[name].values, angle, rtol=1e-13)
    down = 260.0 / 220.0
    trail, offset = 10.0 + 16.0 * down, 820.0 - 735.0 - 20.0 * down
    np.testing.assert_allclose(1e3 * found["trail"].values, trail, rtol=1e-12)
    np.testing.assert_allclose(1e3 * found["steering_axis_offset"].values, offset, rtol=1e-12)


def test_gradients_are_slopes_of_curves():
    h = 1e-4
    for motion, name, of, along in (
        ("bump", "bump_steer", "toe", 0.03), ("roll", "roll_steer", "steer", 0.02),
        ("rack", "steer_gradient", "steer", 0.04), ("bump", "caster_gradient", "caster", -0.02),
    ):  # fmt: skip
        found = characteristics.over(AXLE, motion, along + h * np.arange(-2.0, 3.0))
        values = found[of].values
        slope = (8.0 * (values[:, 3] - values[:, 1]) - values[:, 4] + values[:, 0]) / (12.0 * h)
        # 1e-15 rad over the step
        np.testing.assert_allclose(found[name].values[:, 2], slope, rtol=1e-8, atol=1e-10)


def test_a_turn_of_the_steering_wheel_to_the_left_steers_to_the_left():
    for axis in (1.0, -1.0):
        axle = AXLE.with_changes({"pitman_arm.axis": [0.0, axis, 0.0]})
        found = characteristics.over(axle, "steer", [0.5])
        assert (found["steer"].values > 0.0).all()
        ratio = found["steering_ratio"].item()
        assert 0.5 / found["steer"].values.mean() == pytest.approx(ratio, rel=0.05)


def test_it_rests_at_its_design():
    state = equilibrium(MODEL)
    assert np.abs(np.asarray(state)[:2]).max() < 1e-6


# -- errors ---------------------------------------------------------------------------------------


def test_what_cannot_steer_is_refused(refused):
    for changes in (
        {"drag_link.knuckle": [2.0, 725.0, 370.0]},
        {"hardpoints.track_rod": [2.0, -725.0, 370.0]},
        {"hardpoints.kingpin_upper": [10.0, -735.0, 240.0]},
        {"hardpoints.kingpin_upper": [10.0, -735.0, 260.0]},
        {"drag_link.knuckle": [-730.0, 470.0, 445.0]},
        {"pitman_arm.ball_mm": [-10.0, 530.0, 300.0]},
        {"pitman_arm.ball_mm": [-730.0, 400.0, 645.0]},
        {"pitman_arm.axis": [0.0, 0.0, 0.0]},
        {"pitman_arm.pivot_mm": [-930.0, 470.0, 445.0]},
        {"pitman_arm.ball_mm": [-1e9, 470.0, 445.0]},
        {"drag_link.knuckle": [-1e6, 530.0, 445.0]},
        {"hardpoints.track_rod": [-170.0, 697.0, 300.0]},
        {"brakes.torque_on": "body"},
        {"drive": {"share": 1.0}},
        {"drive": {"torque_on": "body"}},
        {"rods.track_rod": {"chassis": [1, 2, 3], "axle": [4, 5, 6]}},
        {"steered_rigid_axle": "rear"},
    ):
        with refused(InputError):
            AXLE.with_changes(changes)


def test_its_schema_has_no_drive_and_brakes_on_the_knuckles_alone():
    sections = schema({})["$defs"]
    assert "drive" not in sections["SteeredRigidAxle"]["properties"]
    assert sections["KnuckleBrakes"]["properties"]["torque_on"]["const"] == "carrier"


@pytest.mark.parametrize(
    "place", ["hardpoints.track_rod", "drag_link", "pitman_arm.ball_mm", "steered_rigid_axle"]
)
def test_what_is_missing_is_named(place, refused):
    data = AXLE.to_dict()
    *sections, key = place.split(".")
    del (data[sections[0]] if sections else data)[key]
    refused(InputError, lambda: type(AXLE).from_dict(data))


def test_positions_out_of_reach_are_refused(refused):
    refused(
        PositionError,
        lambda: characteristics.over(AXLE, "rack", [-0.3]),
        lambda: MODEL.states_at(0.0, 0.0, -0.3),
    )
    refused(
        InputError,
        lambda: characteristics.over(
            AXLE.with_changes({"pitman_arm.gear_ratio": None}), "steer", [0.1]
        ),
    )


# -- in a car -------------------------------------------------------------------------------------

BODY = {
    "mass_kg": 2407.0,
    "com_mm": [-1473.0, 0.0, 773.0],
    "inertia_xx_kg_m2": 1100.0,
    "inertia_yy_kg_m2": 3900.0,
    "inertia_zz_kg_m2": 4100.0,
}
CAR = {"front": "steered_rigid_axle", "rear": "rigid_axle", "wheelbase_mm": 3000.0,
       "rear_origin_mm": -3000.0, "body": BODY}  # fmt: skip


def test_equations_of_a_car_have_every_number_of_its_file():
    car = Car.from_dict(CAR | {"car": "roll"})
    formulation = declared(car)
    needed = {p.name: {"unit": p.unit} for p in formulation.mechanism.parameters}
    found = _parameters(car, needed)
    bodies = formulation.mechanism.bodies
    light = tuple(f"{body.name}_" for body in bodies if not formulation.has_mass(body.name))
    missing = {name for name in needed if name not in found and not name.startswith(light)}
    assert missing <= {"front_bar_free_angle", "rear_bar_free_angle"}
    assert found["front_left_kingpin_lower_y"] == 0.735
    (motion,) = formulation.prescribed.values()
    assert motion.inputs[0].name == "rack_position"


def test_points_of_the_steering_are_design_variables():
    places = places_of(AXLE)
    for name, value in (("drag_link.knuckle.z", 445.0), ("pitman_arm.ball_mm.x", -730.0)):
        assert (places[name].unit, places[name].value) == ("mm", value)
        assert places[name].moved(1e-3) == {name: value + 1.0}
