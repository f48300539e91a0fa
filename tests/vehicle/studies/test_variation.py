"""Values that move: derivatives, tolerances and optima against oracles of their own."""

import importlib
import math

import numpy as np
import pytest
from kintrafo import (
    InputError,
    Model,
    RigidAxle,
    Suspension,
    arm_angles,
    roads,
    scenario,
    variation,
)
from kintrafo.core.quantities import display_of
from kintrafo.vehicle.assembly.corner_kinematics import gaps
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.studies.curves import Curves, changed
from kintrafo.vehicle.studies.design_variables import places_of
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

CAR = Suspension.load("reference_car")
WISHBONES = Suspension.load("double_wishbone_car")
ROD = "hardpoints.tie_rod_inner.z"


def curve(suspension, name, at):
    return Curves("travel", np.atleast_1d(at), (name,)).of(assembly_of(suspension))[0]


# -- sensitivity --------------------------------------------------------------------------------


def test_the_steering_axis_turns_as_its_two_points_say():
    """Caster is atan2(-k_x, k_z) of the line through two points that move with the file."""
    points = CAR.hardpoints
    along = points.metres("strut_top") - points.metres("ball_joint")
    size = along[0] ** 2 + along[2] ** 2
    found = variation.sensitivity(CAR, positions=[0.0], names=["caster"])["caster"][:, 0]
    expected = {
        "hardpoints.strut_top.x": -along[2] / size,
        "hardpoints.ball_joint.x": along[2] / size,
        "hardpoints.strut_top.z": along[0] / size,
        "hardpoints.ball_joint.z": -along[0] / size,
    }
    for place in found["place"].values:
        # the error of fourth order, (1 mm / 640 mm)^4, and rounding, 1e-16 / 0.5 mm, are below
        assert float(found.sel(place=place)) == pytest.approx(expected.get(place, 0.0), rel=1e-9)


@pytest.mark.parametrize(
    ("car", "place"),
    [
        (CAR, ROD),
        (CAR, "hardpoints.ball_joint.z"),
        (CAR, "wheel.camber_deg"),
        (WISHBONES, "hardpoints.upper_ball_joint.y"),
    ],
)
@pytest.mark.parametrize("name", ["bump_steer", "camber", "roll_center_height_kinematic"])
def test_derivatives_are_those_of_a_polynomial_through_many_neighbours(car, place, name):
    at = np.array([-0.05, 0.0, 0.04])
    where = places_of(car)[place]
    reach = 4.0 * where.to_si  # 4 mm or degrees to either side
    nodes = reach * np.cos(np.pi * (np.arange(9) + 0.5) / 9.0)
    curves = np.array([curve(changed(car, where.moved(by)), name, at) for by in nodes])
    expected = [
        Chebyshev.fit(nodes, column, 8, domain=[-reach, reach]).deriv()(0.0) for column in curves.T
    ]
    found = variation.sensitivity(car, [place], positions=at, names=[name])[name][0]
    # of both: some 1e-10 of what the curve is in a step
    size = np.abs(curves).max() / 0.3
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-8 * size)


def test_there_is_no_derivative_where_a_stop_begins_to_act():
    stopped = CAR.with_changes({"bump_stop": {"clearance_mm": 30.0, "rate_N_per_m": 3e4}})
    touches = start_of_the_stop(stopped)
    at = [touches - 1e-3, touches, touches + 1e-3]
    found = variation.sensitivity(stopped, ["hardpoints.strut_top.z"], positions=at)
    assert np.isnan(found["wheel_rate"].values).tolist() == [[False, True, False]]
    assert np.isfinite(found["camber"].values).all()


def start_of_the_stop(suspension):
    """Return the wheel travel at which the bump stop touches."""
    model = Model(suspension)

    def gap(travel):
        return float(gaps(model, arm_angles(model, 0.3 + travel))[0])

    return float(brentq(gap, 0.02, 0.05, xtol=1e-9))


def test_the_unit_of_the_file_does_not_matter():
    data = CAR.to_dict()
    points = data["hardpoints"]
    assert points.pop("unit") == "mm"
    data["hardpoints"] = {name: [v / 1e3 for v in point] for name, point in points.items()}
    metres = Suspension.from_dict(data | {"hardpoints": data["hardpoints"] | {"unit": "m"}})
    one, other = (
        variation.sensitivity(car, [ROD], positions=[0.02], names=["toe"])["toe"].values
        for car in (CAR, metres)
    )
    # hardpoints differ by a rounding, which a step of 0.5 mm enlarges
    np.testing.assert_allclose(one, other, rtol=1e-9)


def test_units_of_values_are_reported():
    found = variation.sensitivity(CAR, [ROD, "wheel.toe_deg"], positions=[0.0], names=["toe"])
    assert found["place_unit"].values.tolist() == ["m", "rad"]
    # the toe of the file is that of the car
    assert float(found["toe"].sel(place="wheel.toe_deg")[0]) == pytest.approx(1.0, rel=1e-9)
    assert [effect.unit for effect in variation.effects(found, "toe")] == [
        "deg per mm",
        "deg per deg",
    ]
    alone = variation.sensitivity(CAR, [ROD], positions=[0.0], names=["bump_steer"])
    assert alone["bump_steer"].attrs["units"] == "rad/m/m"
    assert display_of(alone["bump_steer"].attrs).units == "deg/mm per mm"
    ((_, shown, unit),) = variation.effects(alone, "bump_steer")
    assert unit == "deg/mm per mm"
    neighbours = [
        math.degrees(curve(CAR.with_changes({ROD: 280.0 + by}), "bump_steer", 0.0)[0]) * 1e-3
        for by in (-0.5, 0.5)
    ]
    assert shown == pytest.approx(neighbours[1] - neighbours[0], rel=1e-4)


def test_values_at_the_end_of_their_range_have_neighbours_on_one_side():
    """A clearance of zero, of a stop that acts anyway: the force is the area under its curve."""
    stop = {"clearance_mm": 0.0, "rate_N_per_m": 3e4, "progression_N_per_mm3": 0.0}
    car = CAR.with_changes({"bump_stop": stop})
    places = [f"bump_stop.{key}" for key in stop]
    found = variation.sensitivity(car, places, positions=[0.05], names=["wheel_rate"])
    found = found["wheel_rate"][:, 0]
    assert np.isfinite(found.values).all()
    for place, change in zip(places[1:], (1.0, 1e-3), strict=True):
        rates = [curve(car.with_changes({place: stop_of(car, place) + b}), "wheel_rate", 0.05)[0]
                 for b in (0.0, change)]  # fmt: skip
        # the rate is linear in both; roundings of 1e-16 of it by a change of 1e-5 of it
        by = change * places_of(car)[place].to_si
        assert float(found.sel(place=place)) == pytest.approx(np.diff(rates)[0] / by, rel=1e-6)


def stop_of(car, place):
    return places_of(car)[place].value


def test_masses_move_no_curve():
    found = variation.sensitivity(
        CAR, ["bodies.wheel"], positions=[-0.03, 0.03], names=["toe", "camber"]
    )
    assert found.sizes["place"] == 4, "mass, spin and diametral inertia, and that of a shaft"
    assert not found["toe"].values.any()


# -- tolerance ----------------------------------------------------------------------------------


def test_what_varies_little_varies_as_derivatives_say():
    at = np.array([-0.05, 0.05])
    tolerances = {"hardpoints": 0.3, ROD: 0.6}
    names = ["toe"]
    found = variation.tolerance(CAR, tolerances, count=400, positions=at, names=names, seed=7)
    slopes = variation.sensitivity(CAR, positions=at, names=names)["toe"]
    sigma = np.where(slopes["place"] == ROD, 0.6e-3, 0.3e-3) / 3.0
    parts = (slopes.values * sigma[:, None]) ** 2
    width = found["toe"].sel(quantile=0.95) - found["toe"].sel(quantile=0.05)
    # a normal distribution has 90 % within 1.645 sigma; 400 cars tell quantiles to 8 % or so
    expected = 2.0 * 1.645 * np.sqrt(parts.sum(axis=0))
    np.testing.assert_allclose(width, expected, rtol=0.25)
    share = found["toe_share"]
    assert share.dims == ("place", "wheel_travel")
    np.testing.assert_allclose(share, parts / parts.sum(axis=0), rtol=1e-6, atol=1e-12)
    # the cars themselves deviate as derivatives say, to the 1 / sqrt(800) of 400 drawn ones
    np.testing.assert_allclose(found["toe_first_order"], 1.0, atol=4.0 / math.sqrt(800.0))
    np.testing.assert_allclose(found["toe_nominal"], curve(CAR, "toe", at), rtol=1e-14)


def test_what_does_not_vary_is_caused_by_nothing():
    found = variation.tolerance(
        CAR, {"bodies.wheel.mass_kg": 1.0}, count=3, positions=[0.0, 0.02], names=["toe"]
    )
    assert np.isnan(found["toe_share"].values).all()


def test_shares_where_a_stop_begins_to_act_are_not_told():
    """Without a derivative a value is no value that moves nothing."""
    stopped = CAR.with_changes({"bump_stop": {"clearance_mm": 30.0, "rate_N_per_m": 3e4}})
    touches = start_of_the_stop(stopped)
    found = variation.tolerance(
        stopped,
        {"bump_stop.clearance_mm": 1.0, "hardpoints.arm_front.z": 1.0},
        count=60,
        positions=[touches - 5e-3, touches - 3e-4, touches, touches + 5e-3],
        names=["wheel_rate"],
    )
    share = found["wheel_rate_share"]
    assert np.isnan(share.values[0]).tolist() == [False, True, True, False]
    np.testing.assert_allclose(share.values[:, [0, 3]].sum(axis=0), 1.0, rtol=1e-12)
    # 3 mm before the stop derivatives know nothing of it, and the cars do
    near = variation.tolerance(
        stopped, {"bump_stop.clearance_mm": 6.0}, count=60, positions=[touches - 3e-3],
        names=["wheel_rate"],
    )  # fmt: skip
    assert float(near["wheel_rate_first_order"][0]) < 0.2


def test_points_that_are_off_together_turn_no_axis():
    both = {"hardpoints.strut_top.x": 1.0, "hardpoints.ball_joint.x": 1.0}
    options = {"count": 20, "positions": [0.0], "names": ["caster"]}
    apart = variation.tolerance(CAR, both, **options)
    together = variation.tolerance(CAR, both, correlation=np.ones((2, 2)), **options)
    spread = [np.ptp(found["caster"].values) for found in (apart, together)]
    assert spread[0] > 1e-4
    assert spread[1] < 1e-12  # of an angle of 0.05 rad


def test_correlation_is_in_the_order_of_the_file():
    tied = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    places = [ROD, "hardpoints.ball_joint.z", "hardpoints.arm_front.z"]
    found = variation.tolerance(
        CAR, dict.fromkeys(places, 1.0), correlation=tied, count=5, positions=[0.0], names=["toe"]
    )
    assert found["place"].values.tolist() == places[::-1]
    off = found["value_of"].values - [0.205, 0.18, 0.28]
    np.testing.assert_allclose(off[:, 0], off[:, 1], atol=1e-12)
    assert abs(off[:, 2] - off[:, 1]).max() > 1e-5


def test_the_same_seed_makes_the_same_cars():
    options = {"count": 5, "positions": [0.03], "names": ["toe"]}
    one, same, other = (
        variation.tolerance(CAR, {ROD: 1.0}, seed=seed, **options) for seed in (1, 1, 2)
    )
    assert one.identical(same)
    assert not (one["toe"] == other["toe"]).any()


def test_uniform_values_keep_their_tolerance_and_limits_are_counted():
    limit = {"bump_steer": {"least": 0.0061662}}  # that of the car itself
    found = variation.tolerance(
        CAR,
        {ROD: 1.0},
        distribution="uniform",
        limits=limit,
        count=60,
        positions=[0.0],
        names=["bump_steer"],
    )
    heights = found["value_of"].values[:, 0]
    assert 0.279 <= heights.min() < 0.2791
    assert 0.2809 < heights.max() <= 0.281
    # bump steer grows with the height, so the limit is kept above the design position
    assert found["within_limits"].values.tolist() == (heights >= 0.28).tolist()
    assert found.attrs["yield"] == found["within_limits"].values.mean()


def test_cars_that_cannot_be_say_why_and_are_within_no_limit():
    wild = {"hardpoints.tie_rod_outer": 400.0}
    found = variation.tolerance(CAR, wild, count=40, positions=[-0.05, 0.05], names=["toe"])
    failed = found["reason"].values != ""
    assert 0 < failed.sum() < 40
    assert not found["within_limits"].values[failed].any()
    assert found["within_limits"].values[~failed].all()
    assert np.isfinite(found["toe"].values).all()


# -- optimise -----------------------------------------------------------------------------------


def test_a_car_finds_back_to_its_curves():
    off = CAR.with_changes({ROD: 286.0, "hardpoints.tie_rod_outer.z": 255.0})
    at = np.linspace(-60.0, 60.0, 7)
    wanted = np.rad2deg(curve(CAR, "toe", at / 1e3))
    found = variation.optimise(
        off,
        {ROD: 20.0, "hardpoints.tie_rod_outer.z": 20.0},
        {"toe": {"at_mm": at.tolist(), "value": wanted.tolist(), "within": 1e-4}},
    )
    assert found.success, found.message
    # to move is reckoned as a hundredth of what matters, and that is 1e-4 degrees
    assert found.moved[ROD] == pytest.approx(-6.0, abs=0.02)
    assert found.moved["hardpoints.tie_rod_outer.z"] == pytest.approx(5.0, abs=0.02)
    assert found.start is off
    np.testing.assert_allclose(
        np.rad2deg(curve(found.suspension, "toe", at / 1e3)), wanted, atol=1e-4
    )


def test_a_limit_in_the_way_is_where_it_ends():
    """Toe wants the rod low, bump steer may fall to a half of what it is."""
    aims = {"toe": {"at_mm": [-50.0, 50.0], "value": 0.0, "within": 0.01}}
    least = 0.003
    found = variation.optimise(CAR, {ROD: 20.0}, aims, {"bump_steer": {"least": least}})
    assert found.success, found.message

    def above(height):
        slope = curve(CAR.with_changes({ROD: height}), "bump_steer", 0.0)[0]
        return math.degrees(slope) * 1e-3 - least

    # it keeps 1e-7 of the limit away from it and ends with 1e-8 of the cost: some 1e-6 mm of 7
    assert 280.0 + found.moved[ROD] == pytest.approx(brentq(above, 260.0, 280.0), abs=1e-4)
    free = variation.optimise(CAR, {ROD: 20.0}, aims)
    assert free.moved[ROD] < found.moved[ROD] - 1.0


def test_what_cannot_be_kept_is_no_success():
    found = variation.optimise(
        CAR,
        {ROD: 1.0},
        {"toe": {"at_mm": 50.0, "value": 0.0, "within": 0.01}},
        {"bump_steer": {"most": -0.01}},
    )
    assert not found.success
    assert "not within its limits: bump_steer" in found.message


def test_what_was_not_reached_is_reported(refused):
    """A millimetre cannot bring toe to half a degree."""
    far = {"toe": {"at_mm": 50.0, "value": 0.5, "within": 0.01}}
    found = variation.optimise(CAR, {ROD: 1.0, "hardpoints.strut_top.x": 1.0, "wheel": 0.1}, far)
    assert found.success
    assert "targets missed by more than within: toe" in found.message
    assert f"at the end of its range: hardpoints.strut_top.x, {ROD}, wheel." in found.message
    idle = variation.optimise(CAR, {ROD: 1.0, "bodies.wheel.mass_kg": 1.0}, far)
    assert "without effect on a target: bodies.wheel.mass_kg" in idle.message
    refused(InputError, lambda: variation.optimise(CAR, {"bodies.wheel.mass_kg": 1.0}, far))


@pytest.mark.parametrize("least", [0.0005, 0.002, 0.004, 0.0055])
def test_limits_anywhere_are_kept_and_found(least):
    """Wherever the limit is, what cannot be better says success."""
    aims = {"toe": {"at_mm": [-60.0, -30.0, 30.0, 60.0], "value": 0.0, "within": 0.01}}
    free = {"hardpoints.tie_rod_inner": 20.0, "hardpoints.tie_rod_outer.z": 20.0}
    limit = {"bump_steer": {"at_mm": [-20.0, 0.0, 20.0], "least": least}}
    found = variation.optimise(CAR, free, aims, limit)
    assert found.success, found.message
    slopes = curve(found.suspension, "bump_steer", [-0.02, 0.0, 0.02])
    assert least <= math.degrees(slopes.min()) * 1e-3 < least + 1e-4


def test_a_characteristic_may_have_several_targets():
    aims = {
        "camber": [
            {"at_mm": [-40.0, 40.0], "value": -0.5, "within": 0.1},
            {"over": "rack", "at_mm": [-30.0, 30.0], "value": -0.5, "within": 0.1},
        ]
    }
    found = variation.optimise(CAR, {"wheel.camber_deg": 2.0}, aims)
    assert [(t.name, t.over) for t in found.targets] == [("camber", "travel"), ("camber", "rack")]
    missed = [t.curves.of(assembly_of(found.suspension))[0] - t.value for t in found.targets]
    # the camber of the file is added to all of them: their mean becomes zero
    assert abs(np.concatenate(missed).mean()) < math.radians(0.01)


def test_of_equal_ways_the_shortest_is_taken():
    """Two heights do the same to bump steer, nearly: neither runs to the end of its range."""
    heights = {ROD: 50.0, "hardpoints.tie_rod_outer.z": 50.0}
    found = variation.optimise(CAR, heights, {"bump_steer": {"value": 0.0, "within": 1e-3}})
    assert found.success
    assert found.message.startswith("found")
    assert max(abs(by) for by in found.moved.values()) < 10.0


# -- sweep --------------------------------------------------------------------------------------

BUMP = scenario.Scenario(
    duration=0.4, output_step=0.01, inputs={"road_height": roads.step(0.01, at=0.05, end=0.4)}
)


def test_each_of_a_grid_moves_as_it_does_alone():
    rates = {"strut.damper_rate_N_s_per_m": [800.0, 2000.0], "hardpoints.ball_joint.z": [170, 190]}
    found = variation.sweep(CAR, rates, BUMP, signals=["camber"], reductions={"tyre_force": "min"})
    assert found["camber"].dims == (*rates, "time")
    assert found["hardpoints.ball_joint.z"].values.tolist() == [0.17, 0.19]
    assert found["success"].values.all()
    assert not found["reason"].values.any()
    for i, rate in enumerate(rates["strut.damper_rate_N_s_per_m"]):
        for j, height in enumerate(rates["hardpoints.ball_joint.z"]):
            car = CAR.with_changes(dict(zip(rates, (rate, float(height)), strict=True)))
            _, alone = scenario.run(Model(car), BUMP, method="DOP853", rtol=1e-9, atol=1e-12)
            # both within some times rtol, 1e-6, of what swings
            np.testing.assert_allclose(found["camber"][i, j], alone["camber"], atol=1e-6)
            least = float(alone["tyre_force"].min())
            assert float(found["tyre_force_min"][i, j]) == pytest.approx(least, rel=1e-4)


def test_what_cannot_be_is_beside_what_can(refused):
    rates = [25e3, -1.0, 30e3]
    found = variation.sweep(
        CAR, {"strut.spring_rate_N_per_m": rates}, BUMP, reductions={"camber": "max"}
    )
    assert found["success"].values.tolist() == [True, False, True]
    assert "out of range" in found["reason"].values[1]
    assert np.isnan(found["camber_max"].values).tolist() == [False, True, False]
    assert found.attrs["message"].startswith("2 of 3 reached the end")
    refused(InputError, lambda: variation.sweep(CAR, {"strut.spring_rate_N_per_m": [-1.0]}, BUMP))


def test_five_links_go_together():
    """They iterate, in lanes as one by one."""
    car, rates = Suspension.load("multi_link_car"), [1e3, 2e3]
    found = variation.sweep(car, {"damper.rate_N_s_per_m": rates}, BUMP, signals=["camber"])
    assert found["success"].all()
    assert found["solver"].values.tolist() == ["DormandPrince"] * len(rates)
    assert np.abs(found["camber"].diff("damper.rate_N_s_per_m")).max() > 1e-5


# -- arguments ----------------------------------------------------------------------------------

TOE = {"toe": {"value": 0.0, "within": 0.1}}

WRONG = [
    lambda: variation.sweep(CAR, {"hardpoints.ball_joint": [1.0]}, BUMP),
    lambda: variation.sweep(CAR, {ROD: [280.0, 280.0]}, BUMP),
    lambda: variation.sweep(CAR, {}, BUMP),
    lambda: variation.sweep(CAR, {ROD: [280.0], f"{ROD[:-1]}[z]": [281.0]}, BUMP),
    lambda: variation.sweep(CAR, {ROD: [280.0]}, 1.0),
    lambda: variation.sweep(CAR, {"strut.friction_N": [0.0, 50.0]}, BUMP),
    lambda: variation.sweep(CAR, {ROD: np.arange(1e6), "wheel.toe_deg": [0.0, 1.0]}, BUMP),
    lambda: variation.sensitivity(CAR, ["hardpoint"]),
    lambda: variation.sensitivity(CAR, ROD),
    lambda: variation.sensitivity(CAR, names=["camberr"]),
    lambda: variation.sensitivity(CAR, over="wheel"),
    lambda: variation.sensitivity("reference_car"),
    lambda: variation.sensitivity(CAR, positions=[0.0, np.nan]),
    lambda: variation.tolerance(CAR, {}),
    lambda: variation.tolerance(CAR, {ROD: -1.0}),
    lambda: variation.tolerance(CAR, {ROD: 1.0}, count=1),
    lambda: variation.tolerance(CAR, {ROD: 1.0}, distribution="even"),
    lambda: variation.tolerance(CAR, {ROD: 1.0}, count=100_000),
    lambda: variation.tolerance(CAR, {ROD: 1.0}, correlation=np.eye(2)),
    lambda: variation.tolerance(
            CAR, {"hardpoints.ball_joint": 1.0}, correlation=2.0 * np.ones((3, 3)) - np.eye(3)
        ),
    lambda: variation.tolerance(CAR, {ROD: 1.0}, limits={"toe": {}}),
    lambda: variation.optimise(CAR, {}, TOE),
    lambda: variation.optimise(CAR, {ROD: 1.0}, {}),
    lambda: variation.optimise(CAR, {ROD: 1.0}, {"toe": {"value": 0.0}}),
    lambda: variation.optimise(CAR, {ROD: 1.0}, {"toe": TOE["toe"] | {"at_mm": [1.0, 2.0, 3.0],
                                                                       "value": [1.0, 2.0]}}),
    lambda: variation.optimise(CAR, {ROD: 1.0}, {"toe": TOE["toe"] | {"at": 1.0}}),
    lambda: variation.optimise(
            CAR.with_changes({"vehicle.wheelbase_mm": None}),
            {ROD: 1.0},
            {"ackermann": {"over": "rack", "at_mm": 30.0, "value": 50.0, "within": 1.0}},
        ),
    lambda: variation.optimise(
            CAR, {ROD: 1.0},
            {"ackermann": {"over": "rack", "at_mm": [0.0, 30.0], "value": 50.0, "within": 1.0}},
        ),
    lambda: variation.tolerance(CAR, {ROD: 1.0}, limits={"toe": [{"least": 0.0}, {}]}),
    lambda: variation.tolerance(
            CAR.with_changes({"vehicle.wheelbase_mm": None}),
            {ROD: 1.0},
            limits={"anti_dive": {"least": 0.0}},
        ),
    lambda: variation.optimise(
            CAR, {ROD: 1.0}, TOE, {"toe": {"least": 1.0, "most": -1.0}}
        ),
    lambda: variation.cars(CAR, {ROD: [279.0]}, positions=[0.0], reductions=np.zeros(2)),
    lambda: variation.cars(CAR, {ROD: [279.0]}, positions=[0.0], reductions=0),
]  # fmt: skip


@pytest.mark.parametrize("call", WRONG)
def test_what_cannot_be_used(call, refused):
    refused(InputError, call)


def test_a_neighbour_that_cannot_be_is_named(monkeypatch, refused):
    """With steps of half a metre no bearing is where an arm can reach it."""
    module = importlib.import_module("kintrafo.vehicle.studies.sensitivity")
    monkeypatch.setattr(module, "_STEPS", {"m": 0.5})
    refused(
        InputError, lambda: variation.sensitivity(CAR, ["hardpoints.ball_joint.y"], positions=[0.0])
    )


# -- commands -----------------------------------------------------------------------------------


def test_commands_refuse_and_end_as_others_do(kintrafo, tmp_path, as_stored, ends):
    (tmp_path / "a.toml").write_text("[limit.toe]\nleast = 0.0\n", encoding="utf-8")
    ends(2, "tolerance", "reference_car", "a.toml")
    (tmp_path / "b.toml").write_text(
        f'[free]\n"{ROD}" = 1.0\n[targets.toe]\nat_mm = 50\nvalue = 0.0\nwithin = 1.0\n'
        "[limits.bump_steer]\nmost = -0.01\n",
        encoding="utf-8",
    )
    code, out, _ = kintrafo("optimise", "reference_car", "b.toml")
    assert code == 1
    assert "not within its limits" in out
    for command in ("sensitivity", "tolerance"):
        files = ["reference_car", "b.toml"][: 1 + (command == "tolerance")]
        ends(2, command, *files, "--at", "nan")
    code, _, err = kintrafo("sweep", "reference_car", f"{ROD}=270", f"{ROD}=280")
    assert code == 2
    as_stored(" ".join(err.split()))
    for wrong in (f"{ROD}=1:2:1000000000", f"{ROD}=1:2", f"{ROD}=1:2:x", ROD, f"{ROD}=a"):
        code, _, err = kintrafo("sweep", "reference_car", wrong)
        assert code == 2
        assert "PLACE=FROM:TO:COUNT" in " ".join(err.split())
    kept = ["--keep", "camber:above:-0.5", "--duration", "0.01"]
    for more in ([], ["--json"]):
        code, out, _ = kintrafo("sweep", "reference_car", f"{ROD}=270,280", *kept, *more)
        words = " ".join(out.replace("┃", " ").split())
        assert (code, "camber is above -0.5 deg" in words) == (0, True)
    code, out, _ = kintrafo("sweep", "reference_car", "strut.spring_rate_N_per_m=-1,25000")
    assert code == 1
    assert "1 of 2 reached the end" in out
    ends(2, "sensitivity", "reference_car", "--of", "camberr")


@pytest.mark.parametrize(
    "name", ["reference_car", "multi_link_car", "pull_rod_car", "trailing_arm_car", "rigid_axle"]
)
def test_every_value_of_a_starter_file_may_be_meant(name):
    """Values that cannot change, or have no effect, do not stop the study of all others."""
    of = RigidAxle.load(name) if name == "rigid_axle" else Suspension.load(name)
    if "arm_rear" in of.to_dict()["hardpoints"]:
        of = of.with_changes({"bushings": {"arm_rear": {"axial_N_per_mm": 400.0}}})
    looked_at = "roll_steer" if name == "rigid_axle" else "bump_steer"
    found = variation.sensitivity(of, ["*"], positions=[0.0], names=[looked_at])
    seen = [*found["place"].values, *filter(None, found.attrs["left_out"].split(", "))]
    assert sorted(seen) == sorted(places_of(of))
    assert found.sizes["place"] > 40
    # by any other reason than these nothing is left out
    for place in filter(None, found.attrs["left_out"].split(", ")):
        assert place.startswith(("bodies.", "bushings.")), place
    assert found.to_array().notnull().all()


def test_values_that_cannot_move_are_reported(refused):
    inertia = "bodies.tie_rod.inertia_xx_kg_m2"
    refused(
        InputError,
        lambda: variation.sensitivity(CAR, [inertia, "wheel"], positions=[0.0]),
        lambda: variation.sensitivity(CAR, ["bodies.tie_rod.inertia_*"], positions=[0.0]),
    )  # and no others
    found = variation.sensitivity(CAR, ["bodies.tie_rod", ROD], names=["toe"], positions=[0.0])
    assert found["place"].values.tolist() == [ROD, "bodies.tie_rod.mass_kg"]
    assert found.attrs["left_out"].split(", ")[0] == inertia
    because = "a file with slightly different values is an error"
    assert f"and 3 more, since {because}" in found.attrs["message"]
    alone = variation.sensitivity(CAR, [ROD], names=["toe"], positions=[0.0])
    np.testing.assert_array_equal(found["toe"][:1], alone["toe"])


def test_bushes_are_refused_where_joints_are_rigid(refused):
    soft = CAR.with_changes({"bushings": {"arm_rear": {"axial_N_per_mm": 400.0}}})
    name = "bushings.arm_rear.axial_N_per_mm"
    for call in (
        lambda: variation.tolerance(soft, {name: 10.0}),
        lambda: variation.sensitivity(soft, [name]),
        lambda: variation.sweep(soft, {name: [400.0]}),
    ):
        with refused(InputError):
            call()
