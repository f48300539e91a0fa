"""Axles: against their own compiled equations, differences, and formulas by hand."""

import re

import numpy as np
import pytest
from cars.axles import AXLE, BENT, LOPSIDED, WISHBONES, placed
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import (
    Axle,
    AxleModel,
    InputError,
    Model,
    PositionError,
    RigidAxle,
    Suspension,
    characteristics,
    compare,
    compliance,
    equilibrium,
    roads,
)
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.analysis.compare import differences
from kintrafo.vehicle.analysis.scenario import Scenario, by_wheel, run
from kintrafo.vehicle.assembly import motions, wheel
from kintrafo.vehicle.assembly.axle import AxleAssembly
from kintrafo.vehicle.assembly.axle_kinematics import AxleKinematics
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.measures import axle_rolling as formulas
from kintrafo.vehicle.models.axle.bar import AntiRollBar
from kintrafo.vehicle.models.axle.steering import SteeringCurve
from kintrafo.vehicle.models.positions import arm_angles, design_height
from kintrafo.vehicle.models.reach import at_rest, travel_range
from kintrafo.vehicle.report import axle_chapter
from kintrafo.vehicle.studies.evaluation import values_of
from scipy.optimize import brentq

CAR = Suspension.load("reference_car")
BAR = AXLE.bar.model_dump(exclude_none=True)


def somewhere(seed, count=20, size=0.05):
    """Return travels of both wheels and displacements of the rack [m]."""
    random = np.random.default_rng(seed)
    left, right = random.uniform(-size, size, (2, count))
    return left, right, random.uniform(-0.02, 0.02, count)


# -- the anti-roll bar --------------------------------------------------------------------------


@settings(max_examples=60)
@given(st.integers(0, 10**6))
def test_the_half_of_a_bar_turns_to_where_its_link_fits(seed):
    """The angle against a search for the length of the link, its rate against a difference."""
    random = np.random.default_rng(seed)
    half = BENT.bar.half(mirrored=bool(seed % 2))
    foot = half.foot + random.uniform(-0.03, 0.03, 3)
    length = np.linalg.norm(half.top - half.foot)

    def misfit(turn):
        return float(np.linalg.norm(half.top_at(np.array(turn)) - foot) - length)

    found = float(half.turn(foot))
    # the branch of design: the nearest change of sign to zero
    assert abs(found) < np.pi / 4
    near = brentq(misfit, found - 0.05, found + 0.05, xtol=1e-14)
    assert found == pytest.approx(near, abs=1e-12)
    velocity = random.uniform(-1.0, 1.0, 3)
    by = 1e-6
    slope = (half.turn(foot + by * velocity) - half.turn(foot - by * velocity)) / (2.0 * by)
    rate = half.rate_of_turn(foot, np.array(found), velocity)
    assert rate == pytest.approx(slope, rel=1e-6, abs=1e-8)  # rounding 1e-16 over the step


def test_a_bar_by_its_dimensions():
    """The twist of a round bar, and the bending of its arms as those of cantilevers."""
    given = BAR | {"rate_Nm_per_deg": None, "diameter_mm": 22.0, "length_mm": 900.0}
    bar = AntiRollBar(**given)
    polar = np.pi * 0.022**4 / 32.0
    lever = 0.01**2 + 0.21**2  # of link_top about the bush, across y
    twist = 79.3e9 * polar / 0.9
    arm = 3.0 * (2.6 * 79.3e9) * (polar / 2.0) / np.sqrt(lever)  # torque by the angle of one arm
    assert bar.rate() == pytest.approx(1.0 / (1.0 / twist + 2.0 / arm), rel=1e-12)
    tube = AntiRollBar(**given | {"inner_diameter_mm": 14.0})
    assert tube.rate() / bar.rate() == pytest.approx(1.0 - (14.0 / 22.0) ** 4, rel=1e-12)


# -- against the equations of the whole axle ----------------------------------------------------


@pytest.fixture(scope="module", params=["reference", "bent"])
def compiled(request):
    if find_compiler() is None:
        pytest.skip("no C compiler")
    return AxleModel({"reference": AXLE, "bent": BENT}[request.param])


def without_weight(model):
    """Return the axle on which springs, stops and bar act alone."""
    zero = {n: 0.0 for n in model.parameters if n.endswith(("tyre_rate", "gravity"))}
    other = AxleModel.__new__(AxleModel)
    super(AxleModel, other).__init__(model.equations, model.parameters | zero)
    return other


def test_the_bar_and_the_forces_are_those_of_the_whole_axle(compiled):
    """Twist, and the wheels' forces by virtual work, against the emitted equations."""
    left, right, racks = somewhere(1)
    pair = AxleKinematics.at(compiled.axle, left, right, racks)
    states, inputs = placed(compiled, pair.travel, racks)
    twist = compiled.signal("bar_angle", states, inputs)
    np.testing.assert_allclose(pair.twist, twist, rtol=0.0, atol=1e-12)
    moment = compiled.signal("bar_spring_moment", states, inputs)
    # 1e-12 of angles, times the rate
    np.testing.assert_allclose(pair.torque, -moment, rtol=0.0, atol=1e-8)
    forces = without_weight(compiled).evaluate("forces", states, inputs)
    for side, corner in compiled.axle.models.items():
        arm = compiled.state_names.index(f"{side}_{corner.names.arm}")
        unit = states.copy()
        unit[:, compiled.state_names.index(f"{side}_{corner.names.arm}_rate")] = 1.0
        rise = compiled.signal(f"{side}_{compiled.axle.end}_wheel_velocity", unit, inputs)
        expected = -forces[:, arm] / rise
        np.testing.assert_allclose(pair.wheel_force(side), expected, rtol=1e-9)


def test_an_axle_rests_where_nothing_pulls(compiled):
    state = equilibrium(compiled, road_height={"left": 0.02}, rack_position=0.01)
    rates = compiled.evaluate("rhs", state, state.inputs)
    assert np.abs(rates).max() < 1e-8
    assert compiled.eigenvalues(state, state.inputs).real.max() < 1e-8


def test_a_road_under_one_wheel_moves_both(compiled):
    road = roads.step(0.02, at=0.05, end=1.5)
    scenario = Scenario(duration=1.5, inputs={"road_height": road})
    result, motion = run(compiled, scenario, wheels="right", rtol=1e-9, atol=1e-11)
    rest = equilibrium(compiled, road_height={"right": 0.02})
    arms = [i for i, name in enumerate(compiled.state_names) if "arm" in name or "beta1" in name]
    # a wheel hop dies out: its damping is a fifth of the critical at 12 Hz
    np.testing.assert_allclose(result.y[arms, -1], rest[arms], atol=1e-8)
    assert motion["left_road_height"].values.max() == 0.0
    centre = motion[f"left_{compiled.axle.end}_wheel_center_z"]
    assert float(centre[-1] - centre[0]) > 1e-4
    assert centre.attrs["long_name"].endswith(", left")
    assert [len(times) for times in result.t_events] == [0, 0, 0, 0]
    drawn = by_wheel(compiled, motion)
    assert drawn["road_height"].dims == ("wheel", "time")


# -- against differences ------------------------------------------------------------------------


@pytest.mark.parametrize("axle", [AXLE, BENT], ids=["reference", "bent"])
def test_stiffness_is_the_derivative_of_the_forces(axle):
    left, right, racks = somewhere(2, size=0.04)
    pair = AxleKinematics.at(axle, left, right, racks)
    whole = pair.springs + pair.bar
    step = 1e-4
    for column, moved in enumerate(([1.0, 0.0], [0.0, 1.0])):
        ends = [
            AxleKinematics.at(
                axle, left + sign * step * moved[0], right + sign * step * moved[1], racks
            )
            for sign in (1.0, -1.0)
        ]
        for row, side in enumerate(("left", "right")):
            forward, back = (end.wheel_force(side) for end in ends)
            slope = (forward - back) / (2.0 * step)
            # the third derivative of the force times the square of the step: 1e-8 of the rate
            np.testing.assert_allclose(whole[:, row, column], slope, rtol=1e-5, atol=2.0)


@pytest.mark.parametrize("axle", [AXLE, BENT], ids=["reference", "bent"])
def test_the_roll_centre_is_where_the_contacts_do_not_slide(axle):
    """At the centre of a small roll of the ground both contacts, on their paths, move along it."""
    left, right, racks = somewhere(3, size=0.03)
    pair = AxleKinematics.at(axle, left, right, racks)
    lateral, height = formulas.roll_center(pair)
    tilt = -formulas.roll_angle(pair)
    middle = 0.5 * sum(wheel.contact(corner)[:, 1:] for corner in pair.corners.values())
    along = np.stack([np.cos(tilt), np.sin(tilt)], -1)
    across = np.stack([-np.sin(tilt), np.cos(tilt)], -1)
    center = middle + lateral[:, None] * along + height[:, None] * across
    for corner in pair.corners.values():
        velocity = wheel.contact_velocity(corner)[:, 1:]
        arm = wheel.contact(corner)[:, 1:] - center
        # a path is turned about the centre: its direction stands across the arm
        np.testing.assert_allclose(np.einsum("ni,ni->n", velocity, arm), 0.0, atol=1e-9)


def test_in_the_middle_the_axle_is_what_its_sides_are():
    from kintrafo import characteristics

    travels = np.linspace(-0.05, 0.05, 11)
    whole = flat(characteristics.over(AXLE, "bump", travels))
    one = characteristics.over(Model(CAR), "travel", travels)
    for name, other in (
        ("roll_center_height", "roll_center_height_kinematic"),
        ("anti_dive_right", "anti_dive"),
        ("camber_right", "camber"),
        ("wheel_rate_left", "wheel_rate"),
    ):
        np.testing.assert_allclose(whole[name], one[other], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(whole["roll_center_lateral"], 0.0, atol=1e-9)
    # half the track squared, for each wheel
    half = 0.5 * whole["track"]
    np.testing.assert_allclose(
        whole["roll_stiffness_springs"], 2.0 * whole["wheel_rate_left"] * half**2, rtol=1e-9
    )
    np.testing.assert_allclose(whole["bar_torque"], 0.0, atol=1e-8)


def wheel_centers(axle, travels, rack):
    """Return where the wheel centres are, by the signals of each side's equations [m]."""
    found = {}
    for (side, model), travel in zip(axle.models.items(), travels, strict=True):
        angles = arm_angles(model, design_height(model) + travel, rack)
        signals = model.signals(*at_rest(model, angles, rack))
        found[side] = np.stack([signals[f"wheel_center_{axis}"] for axis in "xyz"], -1)
    return found


KINDS = {
    "struts": (AXLE, 0.02),
    "lopsided wishbones": (BENT, -0.01),
    "wheels at two heights": (
        Axle.from_dict(
            LOPSIDED
            | {"left": WISHBONES.mirrored().with_changes({"hardpoints.wheel_center.z": 315.0})}
        ),
        0.01,
    ),
    "five links": (
        Axle.from_dict({"axle": "rear", "side": Suspension.load("multi_link_car")}),
        0.005,
    ),
    "trailing arms": (
        Axle.from_dict({"axle": "rear", "side": Suspension.load("trailing_arm_car")}),
        0.0,
    ),
}


@pytest.mark.parametrize(("axle", "rack"), KINDS.values(), ids=KINDS)
def test_roll_is_the_inclination_of_the_line_through_the_wheel_centres(axle, rack):
    angles = np.deg2rad([-4.0, -0.25, 0.0, 1.5, 4.0])
    left, right = motions.opposite(axle, angles, rack)
    np.testing.assert_array_equal(left, -right)
    centers = wheel_centers(axle, (left, right), rack)
    design = wheel_centers(axle, (np.zeros(1), np.zeros(1)), 0.0)
    found, before = (
        np.arcsin(line[:, 2] / np.linalg.norm(line, axis=-1))
        for line in (each["left"] - each["right"] for each in (centers, design))
    )
    # places are rounded to 1e-16 of a metre, a track is longer
    np.testing.assert_allclose(before - found, angles, rtol=0.0, atol=1e-14)
    # all doors take these positions
    pair = AxleKinematics.at(axle, left, right, rack)
    expected = {s: wheel.camber(corner) for s, corner in pair.corners.items()}
    for side, camber in expected.items():
        shown = flat(characteristics.over(axle, "roll", angles, rack_position=rack))[
            f"camber_{side}"
        ]
        np.testing.assert_array_equal(shown, camber)
        if not rack:
            also = values_of(AxleAssembly(axle), "roll", angles)[f"camber_{side}"]
            np.testing.assert_array_equal(also, camber)


def test_on_bushes_roll_is_the_same_inclination():
    angles, bushes = np.deg2rad([-3.0, 2.0]), {"arm_rear": {"axial_N_per_mm": 500.0}}
    found = flat(compliance.elastokinematics(AXLE, bushes, "roll", angles, rack_position=0.01))
    expected = flat(characteristics.over(AXLE, "roll", angles, rack_position=0.01))
    np.testing.assert_allclose(
        found["camber_left"].sel(data_set="kinematic"), expected["camber_left"], atol=1e-15
    )


@pytest.mark.parametrize("stopped", ["left", "right"])
def test_stops_are_those_of_the_wheel(stopped):
    """The advice for a case without equilibrium depends on them."""
    stop = {"bump_stop": {"clearance_mm": 40.0, "rate_N_per_m": 1e5}}
    sides = {"right": CAR, "left": CAR.mirrored()}
    sides[stopped] = sides[stopped].with_changes(stop)
    axle = AxleAssembly(Axle.from_dict({"axle": "front", **sides}))
    for wheel_name in ("left", "right"):
        assert axle.has_stop(wheel_name, "bump_stop") == (wheel_name == stopped)
        assert not axle.has_stop(wheel_name, "rebound_stop")


def test_the_usual_roll_ends_where_a_wheel_does():
    """With a strut whose least length leaves the wheels 40 mm of bump or so."""
    length = 1e3 * float(Model(CAR).signal("strut_length", Model(CAR).design_state))
    short = CAR.with_changes({"strut.length_min_mm": length - 40.0})
    axle = Axle.from_dict({"axle": "front", "side": short})
    most = motions.rolls(axle, motions.SweepRange())[-1]
    assert most < motions.USUAL_ROLL
    assert flat(characteristics.over(axle, "roll", [-most, most])).sizes == {"roll_angle": 2}
    low, high = (1e3 * (end - 0.3) for end in travel_range(axle.models["left"]).height)
    assert 35.0 < min(-low, high) < 50.0
    with pytest.raises(PositionError, match="left") as refused:
        characteristics.over(axle, "roll", [0.0, 1.1 * most])
    shown = re.search(r"which is (\S+) deg to (\S+) deg", str(refused.value))
    assert float(shown[2]) == pytest.approx(np.degrees(most) / 0.98, rel=1e-2)


@pytest.mark.parametrize(
    "of", [AXLE, BENT, RigidAxle.load("rigid_axle")], ids=["reference", "bent", "rigid"]
)
def test_the_roll_moment_gradient_is_the_slope_of_the_roll_moment(of):
    angles, step = np.deg2rad([-3.0, 0.0, 1.0]), 1e-3
    low, high, lower, higher = (
        characteristics.over(of, "roll", angles + by * step)["roll_moment"].values
        for by in (-1, 1, -2, 2)
    )
    slope = (8.0 * (high - low) - (higher - lower)) / (12.0 * step)
    found = characteristics.over(of, "roll", angles)
    # the fourth power of the step
    np.testing.assert_allclose(found["roll_moment_gradient"], slope, rtol=1e-8)
    assert "levers" in found["roll_moment_gradient"].attrs["definition"]
    assert "constant levers y of the contacts" in found["roll_stiffness"].attrs["definition"]


def test_rates_in_roll_are_derivatives():
    angles = np.deg2rad(np.linspace(-2.0, 2.0, 401))
    curves = flat(characteristics.over(AXLE, "roll", angles))
    for side in ("left", "right"):
        for rate, angle in (("roll_steer", "steer"), ("roll_camber", "camber")):
            found = np.gradient(curves[f"{angle}_{side}"].values, angles)[200]
            assert float(curves[f"{rate}_{side}"][200]) == pytest.approx(found, rel=1e-4)


@pytest.mark.parametrize("end", ["front", "rear"])
@pytest.mark.parametrize("torque_on", ["body", "carrier"])
def test_anti_features_are_the_slopes_of_paths(end, torque_on):
    """From where the points are a little higher and a little lower."""
    data = {
        "axle": end,
        "side": CAR,
        "drive": {"share": 0.4, "torque_on": torque_on},
        "brakes": {"torque_on": torque_on},
    }
    axle, step = Axle.from_dict(data), 1e-4
    found = flat(characteristics.over(axle, "bump", [-step, 0.0, step]))
    pair = AxleKinematics.at(axle, [-step, 0.0, step], [-step, 0.0, step], 0.0)
    corner = pair.corners["right"]
    path = corner.center
    if torque_on == "carrier":  # a point that is fixed to the carrier, the contact at design
        arm = (wheel.contact(corner) - corner.center)[1]
        turn = corner.travel.turning[1]
        path = corner.center + arm + np.linspace(-step, step, 3)[:, None] * np.cross(turn, arm)
    slope = (path[2, 0] - path[0, 0]) / (path[2, 2] - path[0, 2])
    part = slope * 2.6 / 0.55
    sense = {"front": 1.0, "rear": -1.0}[end]
    names = {
        "front": ("anti_dive", "anti_lift_driven"),
        "rear": ("anti_lift_braked", "anti_squat"),
    }[end]
    shares = {"front": (0.7, 0.4), "rear": (0.3, 0.4)}[end]
    for name, share in zip(names, shares, strict=True):
        assert float(found[f"{name}_right"][1]) == pytest.approx(sense * share * part, rel=1e-5)


# -- steering -----------------------------------------------------------------------------------


def test_a_steering_curve_ends_with_its_points(refused):
    curve = SteeringCurve(angle_deg=[-90.0, 0.0, 90.0], rack_mm=[-20.0, 0.0, 21.0])
    assert curve.rack(np.deg2rad([-90.0, 90.0])) == pytest.approx([-0.02, 0.021])
    for function in (curve.rack, curve.travel_per_turn):
        with refused(InputError):
            function(np.deg2rad([0.0, 91.0]))


def test_the_steering_wheel_turns_the_wheels():
    angles = np.deg2rad([-200.0, 0.0, 100.0])
    by_ratio = flat(characteristics.over(AXLE, "steer", angles))
    assert by_ratio["steer_left"].values[2] > 0.0
    np.testing.assert_allclose(by_ratio["rack_position"], -0.05 * angles / (2.0 * np.pi))
    given = {"axle": "front", "side": "reference_car"}
    straight = {"angle_deg": [-720.0, 720.0], "rack_mm": [100.0, -100.0]}
    by_curve = flat(
        characteristics.over(Axle.from_dict(given | {"steering": straight}), "steer", angles)
    )
    for name in by_curve:
        np.testing.assert_allclose(by_curve[name], by_ratio[name], rtol=1e-9, atol=1e-12)
    curved = {"angle_deg": [-540.0, -180.0, 0.0, 180.0, 540.0], "rack_mm": [72, 25, 0, -25, -72]}
    curved["rack_mm"] = [float(value) for value in curved["rack_mm"]]
    dense = np.deg2rad(np.linspace(-90.0, 90.0, 181))
    found = flat(characteristics.over(Axle.from_dict(given | {"steering": curved}), "steer", dense))
    mean = 0.5 * (found["steer_left"] + found["steer_right"]).values
    ratio = 1.0 / np.gradient(mean, dense)[90]
    # the curve's second derivative jumps at its points: the difference is of first order there
    assert float(found["steering_ratio"][90]) == pytest.approx(ratio, rel=1e-3)
    # at the same displacements of the rack: the curve is solved for its angle, 1e-9 of its slope
    axle = Axle.from_dict(given | {"steering": curved})
    racks = characteristics.over(axle, "rack", found["rack_position"].values)
    np.testing.assert_allclose(racks["steering_ratio"], found["steering_ratio"], rtol=1e-9)
    beyond = characteristics.over(axle, "rack", [0.0, 0.0721])["steering_ratio"].values
    assert np.isnan(beyond).tolist() == [False, True]


def test_without_a_ratio_the_rack_moves():
    car = CAR.with_changes({"rack.travel_per_turn_mm": None})
    axle = Axle.from_dict({"axle": "front", "side": car})
    assert flat(characteristics.over(axle, "rack", [0.0, 0.01]))["steer_left"].dims == (
        "rack_position",
    )
    assert "rack_position" in flat(characteristics.over(axle, "steer")).dims
    with pytest.raises(InputError, match="travel_per_turn_mm"):
        characteristics.over(axle, "steer", [0.0])


# -- files and their errors ---------------------------------------------------------------------

WRONG = {
    "two ways": {"side": "reference_car", "left": "reference_car"},
    "no side": {},
    "not there": {"side": "nowhere.toml"},
    "a number": {"side": 3.0},
    "exchanged": {"right": CAR.mirrored(), "left": CAR},
    "of the other end": {"side": CAR.with_changes({"vehicle.end": "rear"})},
    "kinds": {"right": CAR, "left": WISHBONES.mirrored()},
    "racks": {"right": CAR, "left": CAR.mirrored().with_changes({"rack.axis": [0.0, 1.0, 0.1]})},
    "vehicles": {
        "right": CAR,
        "left": CAR.mirrored().with_changes({"vehicle.wheelbase_mm": 2700.0}),
    },
    "rack": {"right": CAR, "left": CAR.mirrored().with_changes({"rack.travel_per_turn_mm": None})},
    "part": {"side": CAR, "anti_roll_bar": BAR | {"link_on": "knukle"}},
    "rod": {"side": CAR, "anti_roll_bar": BAR | {"link_on": "tie_rod"}},
    "bar's side": {"side": CAR, "anti_roll_bar": BAR | {"bush": [240.0, 400.0, 320.0]}},
    "no rate": {"side": CAR, "anti_roll_bar": BAR | {"rate_Nm_per_deg": None}},
    "two rates": {"side": CAR, "anti_roll_bar": BAR | {"diameter_mm": 20.0}},
    "nothing left": {
        "side": CAR,
        "anti_roll_bar": BAR
        | {"rate_Nm_per_deg": None, "diameter_mm": 20.0, "length_mm": 800.0}
        | {"inner_diameter_mm": 20.0},
    },
    "axis": {"side": CAR, "anti_roll_bar": BAR | {"axis": [0.0, -1.0, 0.0]}},
    "lever": {"side": CAR, "anti_roll_bar": BAR | {"link_top": [240.0, -580.0, 320.0]}},
    "link": {"side": CAR, "anti_roll_bar": BAR | {"link_foot": BAR["link_top"]}},
    "dead centre": {
        "side": CAR,
        "anti_roll_bar": BAR | {"bush": [30.0, -400.0, 430.0], "link_top": [30.0, -580.0, 330.0]},
    },
    "along x": {"side": CAR, "anti_roll_bar": BAR | {"link_foot": [130.0, -580.0, 330.0]}},
    "skewed rack": {"side": CAR.with_changes({"rack.axis": [0.1, 1.0, 0.05]})},
    "mass of a rod": {"side": CAR.with_changes({"bodies.tie_rod.mass_kg": 1.0})},
    "bar's unit": {"side": CAR, "anti_roll_bar": BAR | {"unit": "m"}},
    "twist": {"side": CAR, "anti_roll_bar": BAR | {"free_twist_deg": 90.0}},
    "tube by rate": {"side": CAR, "anti_roll_bar": BAR | {"inner_diameter_mm": 5.0}},
    "curve": {"side": CAR, "steering": {"angle_deg": [0.0, 10.0], "rack_mm": [1.0]}},
    "back": {"side": CAR, "steering": {"angle_deg": [-9, 0, 9.0], "rack_mm": [1.0, 2.0, 1.0]}},
    "share": {"side": CAR, "drive": {"share": 1.5}},
    "brakes": {"side": CAR, "brakes": {"torque_on": "hub"}},
    "key": {"side": CAR, "antiroll_bar": {}},
    "a suspension": {"axle": None, "hardpoints": {}},
}


@pytest.mark.parametrize("data", WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_named(data, refused):
    refused(InputError, lambda: Axle.from_dict({"axle": "front", **data}))


def test_files_of_the_other_sort_are_reported(refused):
    for name in ("reference_axle", {"axle": "front", "side": "reference_car"}):
        read = Suspension.load if isinstance(name, str) else Suspension.from_dict
        with refused(InputError):
            read(name)
    refused(InputError, lambda: Axle.from_dict(CAR.to_dict()))
    for name in ("quarter_car", "driving_car"):
        for sort in (Suspension, Axle):
            with refused(InputError):
                sort.load(name)


def test_sides_are_found_beside_the_file(tmp_path):
    (tmp_path / "sub").mkdir()
    text = 'axle = "rear"\nside = "sub/mine.toml"\n'
    (tmp_path / "axle.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"mine\.toml"):
        Axle.load(tmp_path / "axle.toml")
    from kintrafo.vehicle.data.starter import write_starter

    write_starter(tmp_path / "sub" / "mine.toml")
    axle = Axle.load(tmp_path / "axle.toml")
    assert axle.left.vehicle.side == "left"
    assert axle.symmetric
    assert axle.bar is None
    assert "bar_torque" not in flat(characteristics.over(axle, "bump", [0.0]))


def test_what_is_out_of_reach_is_refused(refused):
    refused(PositionError, lambda: characteristics.over(AXLE, "roll", np.deg2rad([0.0, 30.0])))
    short = BAR | {"link_top": [30.0, -580.0, 215.0], "bush": [60.0, -400.0, 215.0]}
    axle = Axle.from_dict({"axle": "front", "side": CAR, "anti_roll_bar": short})
    refused(InputError, lambda: characteristics.over(axle, "bump"))
    assert any("does not reach" in text for text in checkup(axle).problems)
    steered = short | {"link_on": "knuckle", "link_foot": [150.0, -600.0, 180.0]}
    axle = Axle.from_dict({"axle": "front", "side": CAR, "anti_roll_bar": steered})
    refused(InputError, lambda: characteristics.over(axle, "steer"))
    refused(InputError, lambda: characteristics.over(AXLE, "roll", [3.0]))
    for racks in ([-10.0, 10.0], [200.0, 100.0], [100.0, 40.0]):
        wrong = {"angle_deg": [-90.0, 90.0], "rack_mm": racks}
        axle = Axle.from_dict({"axle": "front", "side": CAR, "steering": wrong})
        with refused(InputError) as caught:
            characteristics.over(axle, "steer")
        assert any(text in str(caught.value) for text in checkup(axle).problems)
    curve = {"angle_deg": [-90.0, 90.0], "rack_mm": [10.0, -10.0]}
    axle = Axle.from_dict({"axle": "front", "side": CAR, "steering": curve})
    refused(InputError, lambda: characteristics.over(axle, "steer", [2.0]))


def test_sides_with_different_equations_have_none_together(refused):
    left = CAR.mirrored().with_changes({"tyre.lifts_off": True})
    axle = Axle.from_dict({"axle": "front", "right": CAR, "left": left})
    assert float(characteristics.over(axle, "bump", [0.0])["track"][0]) == pytest.approx(1.52)
    refused(InputError, lambda: AxleModel(axle))


# -- several axles, and the commands ------------------------------------------------------------


def test_axles_are_compared():
    stiff = Axle.from_dict(
        {"axle": "front", "side": CAR, "anti_roll_bar": BAR | {"rate_Nm_per_deg": 35.0}}
    )
    bare = Axle.from_dict({"axle": "front", "side": CAR})
    found = {d.name: d for d in differences(compare.compare({"a": AXLE, "b": stiff}, over="roll"))}
    rates = characteristics.over(AXLE, "bump", [0.0])
    assert found["roll_stiffness"].at_design == pytest.approx(float(rates["roll_stiffness_bar"][0]))
    assert found["camber_left"].largest == 0.0
    rear = Axle.from_dict({"axle": "rear", "side": CAR, "drive": {"share": 1.0}})
    both = compare.compare({"a": AXLE, "b": rear})
    assert not [name for name in both if str(name).startswith("anti_")]  # not of one thing
    assert "turning_circle" not in flat(characteristics.over(rear, "steer"))
    assert "bar_torque" not in compare.compare({"a": AXLE, "b": bare}, over="left")
    assert set(compare.compare({"a": AXLE, "b": bare}, over="steer").dims) == {
        "data_set",
        "wheel",
        "steering_wheel_angle",
    }


def test_both_wheels_are_drawn_together():
    drawn = characteristics.over(AXLE, "roll", np.deg2rad([0.0, 1.0]))
    assert drawn["camber"].dims == ("wheel", "roll_angle")
    assert drawn["camber"].attrs["long_name"] == "camber"
    assert drawn["roll_moment"].dims == ("roll_angle",)
    assert not [name for name in drawn if str(name).endswith(("_left", "_right"))]


def test_usual_positions_are_within_reach(refused):
    extent = motions.SweepRange(rebound=0.04, bump=0.03, step=0.01)
    assert motions.travels(AXLE, extent)[[0, -1]].tolist() == [-0.04, 0.03]
    refused(InputError, lambda: motions.rolls(AXLE, motions.SweepRange(roll=-1.0)))


def pictured(chapter):
    """Return the motions over which a chapter has curves, in one picture or several."""
    known = {f"Curves: {words}": name for name, words in motions.MOTIONS.items()}
    return [*dict.fromkeys(known[p.words.partition(", 1 of")[0].partition(", 2 of")[0]]
                           for p in chapter.pictures)]  # fmt: skip


@pytest.mark.usefixtures("one_picture")
def test_an_axle_has_a_chapter_in_the_report():
    chapter = axle_chapter(BENT)
    wheels, whole, _ = chapter.tables
    assert pictured(chapter) == ["roll", "bump", "left", "steer"]
    assert all(picture.source.startswith("data:image/svg") for picture in chapter.pictures)
    rows = {row[0]: row for row in whole.rows}
    rate = float(characteristics.over(BENT, "bump", [0.0])["roll_stiffness"][0]) * np.pi / 180.0
    assert float(rows["roll stiffness"][1]) == pytest.approx(rate, rel=1e-4)
    assert "camber" in {row[0] for row in wheels.rows}  # the sides differ
    of_alike = axle_chapter(AXLE)
    alike = {row[0] for row in of_alike.tables[0].rows}
    assert "camber" not in alike
    assert {"roll steer", "anti-dive", "force of the drop link"} <= alike
    data = dict(of_alike.tables[2].rows)
    assert data["[anti_roll_bar] rate_Nm_per_deg"] == "17.5"


@pytest.mark.usefixtures("coarse_report", "first_page_of_curves", "one_picture")
def test_the_page_of_a_rear_axle_has_nothing_of_a_front_one(kintrafo, tmp_path):
    text = 'axle = "rear"\nside = "reference_car"\n'
    (tmp_path / "rear.toml").write_text(text, encoding="utf-8")
    case = "[cases.static]\ncontact_g = [0, 0, 1]\n"
    (tmp_path / "one.toml").write_text(case, encoding="utf-8")
    assert kintrafo("report", "rear.toml", "--cases", "one.toml")[0] == 0
    page = (tmp_path / "rear.html").read_text(encoding="utf-8")
    assert "Rear axle, MacPherson suspension, right side</title>" in page
    assert "wheel load left" in page
    assert "nti-lift under braking" in page
    for words in ("nti-dive", "Ackermann", "urning circle"):
        assert words not in page.partition('id="payload"')[0], words


@pytest.mark.usefixtures("one_picture")
def test_a_chapter_needs_no_steering_ratio():
    """Without one the rig goes over the rack, which then is no curve of its own."""
    car = CAR.with_changes({"rack.travel_per_turn_mm": None})
    page = axle_chapter(Axle.from_dict({"axle": "rear", "side": car}))
    assert pictured(page) == ["roll", "bump", "left", "steer"]


def test_commands_refuse_what_only_the_other_sort_has(kintrafo):
    for line, word in (
        ("characteristics reference_car --roll 3", "--roll is only for the file of an axle"),
        ("characteristics reference_axle --over bmp", "bump"),
        ("simulate reference_car --wheels left", "--wheels is only"),
        ("compare reference_axle reference_car", "files of one sort"),
        ("compare reference_car reference_car --over roll", "are travel, rack"),
        ("compare reference_axle reference_axle --over travel", "are bump, roll"),
        ("new x.toml --axle --template reference_car", "--template are both given"),
        ("new x.toml --axle --suspension push_rod", "--suspension are both given"),
        ("compare reference_axle nowhere.toml", "There is no such file"),
    ):
        code, _, err = kintrafo(*line.split())
        text = " ".join(err.replace("│", " ").split())
        assert code == 2, line
        assert word in text, (line, text)


# -- compliance of both wheels ------------------------------------------------------------------

PLAIN = Axle.from_dict({"axle": "front", "side": CAR})


@pytest.mark.parametrize(
    "bushes",
    [
        {},
        {"rack": {"radial_N_per_mm": 1.0}},
        {"rack": {"axial_N_per_mm": 0.0}},
        {"lower_ball": {"axial_N_per_mm": 10.0}},
        {"arm_rear": 3.0},
        {"arm_rear": {"axial_N_per_mm": 1.0, "axis": "up"}},
    ],
)
def test_bushes_that_are_none_are_refused(bushes, refused):
    refused(InputError, lambda: compliance.linear(PLAIN, bushes, [0.0]))
