"""A rigid axle: a beam on four rods, as a file, its characteristics and its motion.

`test_mechanisms` compares its equations with maximal coordinates, like those of every model. Here a
root finder puts the beam where six equations say, and differences of what it finds are the oracle
of all first and second derivatives.
"""

import math
import shlex
from pathlib import Path

import numpy as np
import pytest
from cars.rigid_axles import AXLE, LEFT, LOPSIDED, MODEL, TRIANGULATED, Found, each_axle, slopes
from kintrafo import (
    Axle,
    InputError,
    PositionError,
    RigidAxle,
    RigidAxleModel,
    Suspension,
    characteristics,
    compare,
    equilibrium,
    roads,
)
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.measures import rigid_axle as formulas
from kintrafo.vehicle.assembly.measures.whole_axle import wheel_rate, wheel_rate_alone
from kintrafo.vehicle.assembly.rigid_axle_parts import RigidAxleParts
from kintrafo.vehicle.assembly.whole_axle_kinematics import RigidAxleKinematics
from scipy.interpolate import PchipInterpolator
from support.folders import ROOT

PAGE = ROOT / "docs/suspension/types.md"
PLACES = [(0.0, 0.0), (0.06, 0.0), (-0.05, 0.08), (0.03, -0.1), (-0.08, -0.03)]


def beam_at(axle, heave, roll):
    """Return an axle in one position."""
    model = RigidAxleModel(axle)
    return RigidAxleKinematics(RigidAxleParts.of(model, model.state(heave=heave, roll=roll)[None]))


# -- where the axle is ----------------------------------------------------------------------------


@each_axle
def test_the_axle_is_where_a_root_finder_puts_it(axle):
    found = Found(axle)
    for heave, roll in PLACES:
        middle, turn = found.pose(heave, roll)
        beam = beam_at(axle, heave, roll)
        # rounding over a condition of some ten
        np.testing.assert_allclose(
            beam.parts.points["axle_middle"][0], middle, rtol=0.0, atol=2e-13
        )
        for side, sign in (("left", 1.0), ("right", -1.0)):
            place = middle + turn.apply(sign * axle.half_track * LEFT)
            signals = [beam.signal(f"{side}_axle_wheel_center_{x}")[0] for x in "xyz"]
            np.testing.assert_allclose(signals, place, rtol=0.0, atol=2e-13)
            np.testing.assert_allclose(beam.wheel_center(side)[0], place, rtol=0.0, atol=2e-13)
        yaw, roll_, pitch = turn.as_euler("ZXY")
        shown = [beam.coordinate(name)[0] for name in ("yaw", "roll", "pitch")]
        np.testing.assert_allclose(shown, [yaw, roll_, pitch], rtol=0.0, atol=2e-12)


# -- springs --------------------------------------------------------------------------------------


@each_axle
def test_forces_are_the_slopes_of_the_energy(axle):
    """And their derivatives are its second ones."""
    found = Found(axle)
    model = RigidAxleModel(axle.with_changes({"tyre.rate_N_per_m": 0.0}))
    weightless = axle.with_changes({"gravity.acceleration_m_per_s2": 0.0})
    springs = Found(weightless)
    for at in PLACES[:3]:
        forces = model.evaluate("forces", model.state(heave=at[0], roll=at[1]))[:2]
        by = slopes(found.energy, at)
        # 1e-13 m of the root finder, by forces of 1e4 N, over the step of 1e-3, some of them
        np.testing.assert_allclose(forces, -by, rtol=0.0, atol=5e-5)
        beam = beam_at(axle, *at)
        heave_and_roll = beam.of_springs[0] + beam.of_bar[0]
        np.testing.assert_allclose(
            heave_and_roll[0], -slopes(springs.energy, at), rtol=0.0, atol=5e-5
        )
        second = slopes(lambda h, r: slopes(springs.energy, (h, r)), at)
        stiffness = beam.of_springs[1] + beam.of_bar[1]
        # the same over the step once more
        np.testing.assert_allclose(stiffness[0], -second, rtol=0.0, atol=1e-2)


def test_rates_at_the_wheels_are_those_of_the_energy():
    """By the travels of both wheels, in place of heave and roll."""
    weightless = LOPSIDED.with_changes({"gravity.acceleration_m_per_s2": 0.0})
    found, half = Found(weightless), LOPSIDED.half_track

    def energy(left, right):
        return found.energy(0.5 * (left + right), math.asin(0.5 * (left - right) / half))

    at = (0.05, -0.02)
    shown = flat(characteristics.over(LOPSIDED, "left", [0.05]))
    assert set(shown.sizes) == {"wheel_travel"}
    model = RigidAxleModel(LOPSIDED)
    beam = RigidAxleKinematics(RigidAxleParts.of(model, model.states_at(*at)[None]))
    forces = [beam.wheel_force(side)[0] for side in ("left", "right")]
    np.testing.assert_allclose(forces, slopes(energy, at), rtol=0.0, atol=5e-5)
    second = slopes(lambda a, b: slopes(energy, (a, b)), at)
    np.testing.assert_allclose((beam.springs + beam.bar)[0], second, rtol=0.0, atol=1e-2)
    rates = [wheel_rate(beam, side)[0] for side in ("left", "right")]
    np.testing.assert_allclose(rates, second.sum(axis=1), rtol=0.0, atol=1e-2)
    alone = [wheel_rate_alone(beam, side)[0] for side in ("left", "right")]
    np.testing.assert_allclose(alone, np.diag(second), rtol=0.0, atol=1e-2)


# -- hand formulas of the guidance ----------------------------------------------------------------


def planar(slope, height):
    """Return an axle with links along x, its Panhard rod in the plane of the wheels."""
    rise = 600.0 * slope
    return AXLE.with_changes(
        {
            "rods.left_link": {
                "chassis": [620.0, 500.0, 310.0 + rise],
                "axle": [20.0, 500.0, 310.0],
            },
            "rods.right_link": {
                "chassis": [620.0, -500.0, 310.0 + rise],
                "axle": [20.0, -500.0, 310.0],
            },
            "rods.upper_link": {"chassis": [480.0, 0.0, 490.0], "axle": [-20.0, 0.0, 530.0]},
            "rods.panhard_rod": {
                "chassis": [0.0, -460.0, height + 30.0],
                "axle": [0.0, 460.0, height - 30.0],
            },
        }
    )


@pytest.mark.parametrize("torque_on", ["carrier", "body"])
def test_anti_squat_is_that_of_the_side_view(torque_on):
    """The pole of the links in side view, seen from the contact or from the wheel centre."""
    axle = planar(0.04, 400.0).with_changes(
        {"drive.torque_on": torque_on, "brakes.torque_on": torque_on}
    )
    shown = characteristics.over(axle, "bump", [0.0])
    lower, upper = 0.04, (490.0 - 530.0) / 500.0
    # z = 310 + lower (x - 20) and z = 530 + upper (x + 20)
    x = (530.0 + 20.0 * upper - 310.0 + 20.0 * lower) / (lower - upper)
    z = 310.0 + lower * (x - 20.0)
    rise = (z - (0.0 if torque_on == "carrier" else 360.0)) / x
    whole = rise * 3000.0 / 720.0
    assert float(shown["anti_squat"][0]) == pytest.approx(whole, rel=1e-10)
    assert float(shown["anti_lift_braked"][0]) == pytest.approx((1.0 - 0.65) * whole, rel=1e-10)
    # in front, the same path dives and lifts the other way
    front = flat(characteristics.over(axle.with_changes({"rigid_axle": "front"}), "bump", [0.0]))
    assert float(front["anti_lift_driven"][0]) == pytest.approx(-whole, rel=1e-10)
    assert float(front["anti_dive"][0]) == pytest.approx(-0.65 * whole, rel=1e-10)
    assert "anti_squat" not in front
    # the axle turns about the pole as it rises: its nose, which points to the pole, down
    travel = 1e-5
    nose = characteristics.over(axle, "bump", [-travel, travel])["pinion_angle"].values
    by = (nose[1] - nose[0]) / (2.0 * travel)
    assert by == pytest.approx(-1e3 / x, rel=1e-6)  # the square of the travel
    turned = axle.with_changes({"rigid_axle": "front"})
    other = characteristics.over(turned, "bump", [-travel, travel])["pinion_angle"].values
    np.testing.assert_allclose(other, -nose, rtol=0.0, atol=1e-15)


@each_axle
def test_guidance_is_that_of_the_root_finder(axle):
    """Away from design, where no formula by hand holds."""
    found, (heave, roll) = Found(axle), PLACES[2]
    beam = beam_at(axle, heave, roll)
    middle, turn = found.pose(heave, roll)
    left, right = (beam.contact(side)[0] for side in ("left", "right"))
    between = 0.5 * (left + right)
    # back to the place in the beam
    local = turn.inv().apply(between - middle) + axle.center
    by = slopes(lambda h, r: found.place(local, h, r), (heave, roll))
    line = (left - right)[1:] / np.linalg.norm((left - right)[1:])
    across = np.array([-line[1], line[0]])
    times = -(across @ by[1:, 1]) / (across @ by[1:, 0])
    height = float(formulas.roll_center_height(beam)[0])
    center = between + height * np.array([0.0, *across])
    still = turn.inv().apply(center - middle) + axle.center
    moves = slopes(lambda h, r: found.place(still, h, r), (heave, roll)) @ [times, 1.0]
    # the roll centre does not move along the line through the contacts
    assert line @ moves[1:] == pytest.approx(0.0, abs=1e-9)
    assert float(formulas.jacking(beam)[0]) == pytest.approx(-by[1, 0] / by[2, 0], abs=1e-9)
    assert float(beam.path_slope("carrier")[0]) == pytest.approx(by[0, 0] / by[2, 0], abs=1e-9)


def test_contacts_are_the_lowest_points_of_the_wheels():
    beam = beam_at(LOPSIDED, 0.03, 0.05)
    found = Found(LOPSIDED)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        hub = LOPSIDED.center + sign * LOPSIDED.half_track * LEFT
        axis = LOPSIDED.wheel.spin_axis(sign)
        one = np.cross(axis, [1.0, 0.0, 0.0]) / np.linalg.norm(np.cross(axis, [1.0, 0.0, 0.0]))
        two = np.cross(axis, one)
        turns = np.linspace(0.0, 2.0 * np.pi, 20001)
        rim = hub + 0.36 * (np.outer(np.cos(turns), one) + np.outer(np.sin(turns), two))
        middle, turn = found.pose(0.03, 0.05)
        lowest = (middle + turn.apply(rim - LOPSIDED.center))[:, 2].min()
        # the square of half a step on the rim
        assert float(beam.contact(side)[0, 2]) == pytest.approx(lowest, abs=1e-8)
        camber = float(beam.signal(f"{side}_axle_camber")[0])
        assert camber == pytest.approx(math.radians(-0.5) - sign * 0.05, abs=1e-4)


# -- at rest and over a road ----------------------------------------------------------------------


@pytest.mark.parametrize("road", [0.0, 0.06])
def test_it_stands_on_its_wheels(road):
    """The tyre forces, in the planes of their wheels, balance springs and weight."""
    rest = equilibrium(MODEL, road_height={"left": road})
    at, found, up = rest[:2], Found(AXLE), np.array([0.0, 0.0, 1.0])
    turn = found.pose(*at)[1]
    axis = turn.apply([0.0, 1.0, 0.0])
    pull = (up - axis * axis[2]) / (1.0 - axis[2] ** 2)
    work = np.zeros(2)
    for sign, ground in ((1.0, road), (-1.0, 0.0)):
        hub = AXLE.center + sign * AXLE.half_track * LEFT
        load = 230000.0 * (0.3876 + ground - found.place(hub, *at)[2])
        work += load * pull @ slopes(lambda h, r, hub=hub: found.place(hub, h, r), at)
    # 1e-13 m of the root finder, by forces of 1e4 N, over the step of 1e-3, some of them
    np.testing.assert_allclose(work, slopes(found.energy, at), rtol=0.0, atol=5e-5)
    # the packaged file says that it rests at design
    assert road or abs(at[0]) < 1e-6


def test_hop_and_tramp_are_those_of_the_book():
    """Links and Panhard rod level, nothing loaded: the axle heaves, and turns about its rod."""
    plain = planar(0.0, 400.0).with_changes(
        {
            "rods.upper_link": {"chassis": [480.0, 0.0, 530.0], "axle": [-20.0, 0.0, 530.0]},
            "rods.panhard_rod": {"chassis": [0.0, -460.0, 400.0], "axle": [0.0, 460.0, 400.0]},
            "hardpoints.spring_top": [0.0, -500.0, 700.0],
            "hardpoints.spring_seat": [0.0, -500.0, 360.0],
            "spring.force_at_design_N": 0.0,
            "tyre.free_height_mm": 360.0,
            "gravity.acceleration_m_per_s2": 0.0,
            "damper.rate_N_s_per_m": 0.0,
        }
    )
    found = checkup(plain).axle.values
    hop = math.sqrt(2.0 * (48000.0 + 230000.0) / (80.0 + 2.0 * 26.0)) / (2.0 * math.pi)
    assert found["heave_frequency"] == pytest.approx(hop, rel=1e-9)
    stiffness = 0.5 * 48000.0 * 1.0**2 + 0.5 * 230000.0 * 1.56**2 + math.degrees(180.0)
    wheels = 2.0 * (0.85 + 26.0 * (0.78**2 + (0.4 - 0.36) ** 2))
    inertia = 14.0 + 80.0 * (0.4 - 0.37) ** 2 + wheels
    tramp = math.sqrt(stiffness / inertia) / (2.0 * math.pi)
    assert found["roll_frequency"] == pytest.approx(tramp, rel=1e-9)


def test_a_step_under_one_wheel_ends_where_it_rests():
    step = roads.step(0.02, at=0.05, end=1.5)
    scenario = Scenario(duration=1.5, inputs={"road_height": step})
    result, motion = run(MODEL, scenario, wheels="left", rtol=1e-8, atol=1e-10)
    rest = equilibrium(MODEL, road_height={"left": 0.02})
    # what is left of a tramp of 13 Hz with a damping of 0.23 after 1.4 s
    np.testing.assert_allclose(result.y[:2, -1], rest[:2], rtol=0.0, atol=1e-7)
    assert motion["left_axle_camber"].attrs["long_name"] == "camber, left"
    assert float(motion["roll"][-1]) > 0.005


def test_a_wheel_leaves_the_ground_if_it_may():
    free = RigidAxleModel(AXLE.with_changes({"tyre.lifts_off": True}))
    step = roads.step(-0.06, at=0.05, end=0.5)
    result, motion = run(free, Scenario(duration=0.5, inputs={"road_height": step}), wheels="right")
    leaves, touches = result.t_events[2], result.t_events[3]
    assert len(leaves) > 0
    assert len(touches) == len(leaves)
    assert float(motion["right_axle_tyre_force"].min()) >= 0.0


def test_stops_and_the_curve_of_the_damper_act_on_both_sides():
    axle = AXLE.with_changes(
        {
            "bump_stop": {"clearance_mm": 20.0, "rate_N_per_m": 1e5},
            "damper.rate_N_s_per_m": None,
            "damper.velocity_m_per_s": [-1.0, 0.0, 1.0],
            "damper.force_N": [-3000.0, 0.0, 1000.0],
        }
    )
    model = RigidAxleModel(axle)
    state = model.states_at(0.05, 0.05)
    state[model.state_names.index("heave_rate")] = 0.5
    signals = model.signals(state)
    for side in ("left", "right"):
        points = axle.points(side)
        length = np.linalg.norm(points["damper_top"] - points["damper_seat"])
        pressed = length - 0.02 - float(signals[f"{side}_damper_length"])
        force = float(signals[f"{side}_damper_bump_stop_force"])
        assert force == pytest.approx(1e5 * pressed, rel=1e-9)
        curve = PchipInterpolator([-1.0, 0.0, 1.0], [-3000.0, 0.0, 1000.0])
        resists = curve(-float(signals[f"{side}_damper_velocity"]))
        assert float(signals[f"{side}_damper_damper_force"]) == pytest.approx(resists, rel=1e-12)
    rates = flat(characteristics.over(axle, "bump", [0.0, 0.05]))["wheel_rate_left"].values
    assert rates[1] > rates[0] + 9e4


def test_the_damper_ends_the_travel(refused):
    short = AXLE.with_changes({"damper.length_min_mm": 450.0, "damper.length_max_mm": 540.0})
    curves = characteristics.over(short, "bump")
    model = RigidAxleModel(short)
    for end, part, limit in ((0.3, 1, 0.45), (-0.3, 0, 0.54)):
        at = end * model.farthest(end, end)
        lengths = [
            float(model.signal(f"{s}_damper_length", model.states_at(at, at)))
            for s in ("left", "right")
        ]
        near = min(lengths) if part else max(lengths)
        # halved forty times
        assert near == pytest.approx(limit, abs=1e-10)
        assert float(curves["wheel_travel"][-part]) == pytest.approx(0.98 * at, rel=1e-9)
    refused(PositionError, lambda: model.states_at(0.3, 0.3))


def test_no_position_is_beyond_a_gap(refused):
    """A damper that is shorter than it may be for a part of the way is upside down behind it."""
    low = AXLE.with_changes(
        {"hardpoints.damper_top": [-90.0, -560.0, 420.0], "damper.length_min_mm": 60.0}
    )
    model = RigidAxleModel(low)
    end = 0.3 * model.farthest(0.3, 0.3)
    model.states_at([0.0, end], [0.0, end])
    for travel in (0.19, 0.25):
        with refused(PositionError):
            model.states_at(travel, travel)
        with refused(PositionError):
            model.states_at([0.0, travel, -0.01], [0.0, travel, 0.01])


def test_no_gap_is_too_narrow(refused):
    """The shortest that the damper gets on its way, and a micrometre more."""
    low = AXLE.with_changes({"hardpoints.damper_top": [-90.0, -540.0, 420.0]})
    travels = np.linspace(0.11, 0.13, 2001)
    states = RigidAxleModel(low).states_at(travels, travels)
    least = RigidAxleModel(low).signals(states)["right_damper_length"].min()
    short = RigidAxleModel(low.with_changes({"damper.length_min_mm": 1e3 * least + 1e-3}))
    refused(PositionError, lambda: short.states_at(0.2, 0.2))


# -- errors ---------------------------------------------------------------------------------------


def test_four_links_and_a_panhard_rod_are_one_too_many(as_stored):
    """Five rods take five freedoms: what is left is neither heave nor roll alone."""
    right = {"chassis": [500.0, -400.0, 480.0], "axle": [-20.0, -400.0, 525.0]}
    with pytest.raises(InputError) as error:
        AXLE.with_changes(
            {
                "rods.upper_link": {
                    "chassis": [500.0, 400.0, 480.0],
                    "axle": [-20.0, 400.0, 525.0],
                },
                "rods.right_upper_link": right,
            }
        )
    (problem,) = error.value.problems
    as_stored(problem)
    # word for word on the page
    assert problem in " ".join(PAGE.read_text(encoding="utf-8").split())


def test_a_rod_that_repeats_another_is_one_too_many(refused):
    """Five rods along x in one pattern take four freedoms: one of them is not needed."""
    refused(
        InputError,
        lambda: planar(0.0, 400.0).with_changes(
            {"rods.fifth": {"chassis": [620.0, 0.0, 310.0], "axle": [20.0, 0.0, 310.0]}}
        ),
    )


@pytest.mark.parametrize(
    "changes",
    [
        {"rods.panhard_rod": None},
        # across at no place
        {
            "rods.left_link": {"chassis": [620.0, 500.0, 310.0], "axle": [20.0, 500.0, 310.0]},
            "rods.right_link": {"chassis": [620.0, -500.0, 310.0], "axle": [20.0, -500.0, 310.0]},
            "rods.panhard_rod": {"chassis": [620.0, -60.0, 525.0], "axle": [-20.0, -60.0, 525.0]},
            "rods.upper_link.chassis.y": 60.0,
        },
        {"rods.upper_link.axle": [500.0, 60.0, 480.0]},
        {"rods.upper_link.axle": [500.0, 60.0, 180.0]},
        {"rods.upper_link.axle.x": 5e5},
        {"rods.upper_link.axle.x": "far"},
        {"rods.upper_link.axel": [0.0, 1.0, 2.0]},
        {"rods.upper_link": 3.0},
        {"rods": [1.0]},
        {"hardpoints.wheel_center.y": 780.0},
        {"left_hardpoints": {"damper_top": [0.0, -400.0, 700.0]}},
        {"hardpoints.spring_seat": [50.0, -470.0, 680.0]},
        {"damper.length_min_mm": 600.0},
        {"anti_roll_bar.rate_Nm_per_deg": 0.0},
        {"bodies.beam.mass_kg": -1.0},
        {"rigid_axle": "middle"},
        {"rods.left_link.chassis": [1.0, 2.0]},
    ],
)
def test_what_cannot_be_is_refused(changes, refused):
    refused(InputError, lambda: AXLE.with_changes(changes))


def test_other_doors_refuse_it_by_name(refused):
    data = AXLE.to_dict()
    for refusing in (Suspension, Axle):
        for given in (lambda kind: kind.load("rigid_axle"), lambda kind: kind.from_dict(data)):
            with refused(InputError):
                given(refusing)
    refused(InputError, lambda: RigidAxle.from_dict({"axle": "rear"}), lambda: RigidAxleModel(3))


@pytest.mark.parametrize(
    "line",
    [
        "characteristics rigid_axle --positions --over rack",
        "sweep rigid_axle wheel.toe_deg=0,1 --rack 5",
        "export rigid_axle --to points -o a.csv",
        "compare rigid_axle reference_car",
        "simulate rigid_axle --rack 5",
        "characteristics rigid_axle --over steer",
        "characteristics rigid_axle --rack 5",
        "compare rigid_axle rigid_axle --over travel",
        "new a.toml --rigid-axle --axle",
        "new a.toml --rigid-axle --template reference_car",
    ],
)
def test_commands_that_have_nothing_for_it_say_so(kintrafo, line):
    code, out, err = kintrafo(*shlex.split(line))
    assert code != 0, out
    assert out == ""
    words = (
        "rigid axle",
        "rigid rear axle",
        "rigid-axle",
        "only for",
        "steer",
        "rack",
        "are bump",
        "one sort",
    )
    assert any(word in err for word in words), err
    assert "Traceback" not in err
    assert not Path("a.csv").exists()


@pytest.mark.parametrize(
    "changes",
    [
        {"tyre.rate_N_per_m": 230.0},
        {"bodies.beam.mass_kg": 80000.0, "bodies.wheel.mass_kg": 26000.0},
        {"spring.rate_N_per_m": 48.0, "spring.force_at_design_N": 1.0},
        {"damper.rate_N_s_per_m": 3.2},
        {"rods.upper_link": {"chassis": [-20.0, 60.0, 525.0], "axle": [500.0, 60.0, 480.0]}},
        {"rods.upper_link.chassis": [0.5, -0.06, 0.525]},
        {"hardpoints.spring_seat": [0.0, -0.5, 0.35]},
        {"vehicle.wheelbase_mm": 3.0},
        {f"bodies.beam.inertia_{axis}_kg_m2": 2e7 for axis in ("xx", "yy", "zz")},
        {"bodies.wheel.inertia_spin_kg_m2": 2e6, "bodies.wheel.inertia_diametral_kg_m2": 1e6},
    ],
)
def test_mistakes_that_can_move_are_reported(changes, as_stored):
    assert checkup(AXLE).problems == ()
    problems = checkup(AXLE.with_changes(changes)).problems
    assert problems
    as_stored(*problems)


def test_an_unusual_camber_is_noted():
    notes = checkup(AXLE.with_changes({"wheel.camber_deg": 40.0})).notes
    assert any("camber_deg = 40 deg" in note for note in notes), notes


@pytest.mark.parametrize("name", ["", "a.b", "upper link", "1st"])
def test_rods_have_names_that_files_and_tables_can_hold(name, refused):
    data = AXLE.to_dict()
    data["rods"][name] = data["rods"].pop("upper_link")
    refused(InputError, lambda: RigidAxle.from_dict(data))


def test_positions_beyond_reach_are_refused(refused):
    refused(
        PositionError,
        lambda: characteristics.over(AXLE, "bump", [0.0, 0.9]),
        lambda: characteristics.over(AXLE, "roll", [1.0]),
    )
    with pytest.raises(InputError, match="finite"):
        characteristics.over(AXLE, "bump", [math.nan])
    refused(
        PositionError,
        lambda: equilibrium(
            RigidAxleModel(
                AXLE.with_changes({"tyre.rate_N_per_m": 0.0, "spring.rate_N_per_m": 1.0})
            )
        ),
    )


def test_what_is_given_comes_back():
    assert RigidAxle.from_dict(LOPSIDED.to_dict()) == LOPSIDED


def test_two_axles_are_compared_over_the_same_positions():
    found = compare.compare({"a": AXLE, "b": TRIANGULATED}, over="roll")
    assert found.sizes == {"data_set": 2, "wheel": 2, "roll_angle": 33}
    alone = characteristics.over(TRIANGULATED, "roll")
    np.testing.assert_array_equal(found["roll_steer"].sel(data_set="b"), alone["roll_steer"])
