"""Positions from a wheel height, the reachable range, static equilibrium."""

import copy
import pickle

import kintrafo
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo import (
    Axle,
    ClosureError,
    InputError,
    Model,
    PositionError,
    RigidAxle,
    characteristics,
    equilibrium,
    linearise,
    simulate,
    state_at_height,
    sweep,
    travel_range,
)
from kintrafo.systems.state import inputs_of
from kintrafo.vehicle.assembly.rest import nearest
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.positions import arm_angles, design_height, road_under_load
from kintrafo.vehicle.models.reach import at_rest, branch, height_and_slope
from oracle import newton
from oracle.multipliers import solve_prescribed
from oracle.reference import reference_parameters
from support.folders import ROOT

MODEL = Model("reference_car")


def height(state, rack=0.0):
    inputs = MODEL.inputs({"rack_position": rack})
    return float(MODEL.signal("wheel_center_z", state, inputs))


@pytest.mark.parametrize("wanted", np.linspace(0.15, 0.45, 7))
@pytest.mark.parametrize("rack", [-0.06, 0.0, 0.06])
def test_state_at_height_is_that_of_a_newton_solve(wanted, rack):
    state = state_at_height(MODEL, wanted, rack_position=rack)
    mechanism = newton.Mechanism(reference_parameters())
    pose = newton.solve_pose_at_height(mechanism, wanted, rack)
    # both roots are good to round-off in the height, 1e-16 m, over |dz/d beta1| of 0.36 m
    assert state[0] == pytest.approx(newton.observe(mechanism, pose).beta1, abs=1e-13)
    assert height(state, rack) == pytest.approx(wanted, abs=1e-15)
    assert np.all(state[1:] == 0.0)


def test_range_ends_where_the_loop_or_the_wheel_turns_back():
    reach = travel_range(MODEL)
    low, high = reach.height
    assert low < 0.15
    assert high > 0.45
    assert "dead point" in reach.upper_limit
    for wanted in reach.height:
        # beside the dead point the height changes by 300 m/rad; angles are rounded to 1e-16 rad
        assert height(state_at_height(MODEL, wanted)) == pytest.approx(wanted, abs=1e-13)


@pytest.mark.parametrize("beyond", [-0.5, 0.7])
def test_height_out_of_reach_names_range_and_remedy(beyond, refused):
    refused(PositionError, lambda: state_at_height(MODEL, beyond))


def test_equilibrium_of_the_reference_car_is_at_300_mm():
    state = equilibrium(MODEL)
    # l10 of the data is given to 17 digits for this height; the moment is flat to 1e-16 / 2e3 N
    assert height(state) == pytest.approx(0.3, abs=1e-12)
    assert np.abs(MODEL.evaluate("rhs", state)).max() < 1e-9
    assert MODEL.eigenvalues(state)[0] == pytest.approx(-18.08249105 + 75.48161914j, abs=1e-7)


def test_equilibrium_follows_road_and_actuator():
    raised = equilibrium(MODEL, road_height=0.02)
    pushed = equilibrium(MODEL, strut_force=500.0)
    assert height(raised) > 0.3 > height(pushed)
    inputs = MODEL.inputs({"road_height": 0.02})
    assert np.abs(MODEL.evaluate("rhs", raised, inputs)).max() < 1e-9


def test_equilibrium_with_a_free_rack_holds_the_rack():
    free = Model("reference_car", free_rack=True)
    state = equilibrium(free, rack_position=0.01)
    held = equilibrium(MODEL, rack_position=0.01)
    assert state[0] == pytest.approx(held[0], abs=1e-12)
    holding = -free.evaluate("forces", state)[2]
    accelerations = free.evaluate("rhs", state, free.inputs({"rack_force": holding}))
    assert np.abs(accelerations).max() < 1e-8


def test_no_equilibrium_says_what_the_moments_are(refused):
    refused(
        PositionError, lambda: equilibrium(MODEL, strut_force=1e7)
    )  # 1e6 N rests just before a dead point


def test_rack_beyond_the_dead_point_is_refused(refused):
    refused(PositionError, lambda: travel_range(MODEL, rack_position=0.5))


def test_unknown_state_element_is_refused():
    with pytest.raises(kintrafo.InputError, match="beta3"):
        MODEL.state(beta3=1.0)
    with pytest.raises(kintrafo.InputError, match="wheel_centre"):
        MODEL.signal("wheel_centre", MODEL.design_state)


def test_mass_that_the_equations_neglect_is_refused():
    heavy = MODEL.suspension.with_changes({"bodies.rack.mass_kg": 3.0})
    with pytest.raises(kintrafo.InputError, match=r"\[bodies.rack\].*free_rack=True"):
        Model(heavy)
    assert Model(heavy, free_rack=True).free_rack


def test_models_travel_between_processes():
    import pickle

    copy = pickle.loads(pickle.dumps(Model("reference_car", free_rack=True)))
    assert copy.free_rack
    assert np.array_equal(copy.constants, Model("reference_car", free_rack=True).constants)


def test_model_takes_a_path_and_refuses_what_is_none():

    path = ROOT / "vehicle/data/reference_car.toml"
    assert np.array_equal(Model(path).constants, MODEL.constants)
    with pytest.raises(kintrafo.InputError, match=r"not \{\}"):
        Model({})


def test_one_class_catches_all_errors():
    for error in (kintrafo.ClosureError, kintrafo.ModelError, PositionError, kintrafo.InputError):
        assert issubclass(error, kintrafo.KintrafoError)


# -- many heights at once -------------------------------------------------------------------------

REACH = travel_range(MODEL)


def test_many_heights_are_those_one_by_one():
    heights = np.linspace(0.0, 0.55, 12)[:, None]
    racks = np.array([-0.05, 0.0, 0.02])
    angles = arm_angles(MODEL, heights, racks)
    assert angles.shape == (12, 3)
    for index in np.ndindex(angles.shape):
        alone = state_at_height(MODEL, heights[index[0], 0], rack_position=racks[index[1]])
        assert angles[index] == alone[0]


@settings(max_examples=30)
@given(st.lists(st.floats(0.0, 1.0), min_size=1, max_size=20), st.floats(-0.06, 0.06))
def test_heights_within_reach_are_met_to_rounding(parts, rack):
    low, high = travel_range(MODEL, rack).height
    heights = low + (high - low) * np.array(parts)
    angles = arm_angles(MODEL, heights, rack)
    found, _ = height_and_slope(MODEL, angles, rack)
    # some roundings of the height, more towards the dead point, where a rounding of the margin is
    # divided by its root; and of the angle, where the height's tangent is nearly vertical
    near = np.minimum(angles + 5 * np.spacing(angles), travel_range(MODEL, rack).arm_angle[0])
    allowed = 1e-14 + np.abs(height_and_slope(MODEL, near, rack)[0] - found)
    assert (np.abs(found - np.clip(heights, low, high)) <= allowed).all()
    assert (np.diff(angles[np.argsort(heights)]) <= 0.0).all()


def test_the_range_in_the_message_is_within_reach():
    with pytest.raises(PositionError) as caught:
        arm_angles(MODEL, 1.0)
    words = str(caught.value).split()
    low, high = (float(words[i + 1]) * 1e-3 for i in (words.index("from"), words.index("to")))
    assert arm_angles(MODEL, [low, high]).shape == (2,)


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_heights_and_racks_that_are_no_numbers_are_refused(wrong, refused):
    refused(
        InputError, lambda: arm_angles(MODEL, [0.3, wrong]), lambda: arm_angles(MODEL, 0.3, wrong)
    )


def test_no_heights_make_no_angles():
    assert arm_angles(MODEL, np.empty((0, 3))).shape == (0, 3)


# -- the ends of the reach ------------------------------------------------------------------------


def test_upper_end_is_the_dead_point_of_the_tie_rod(refused):
    """There the rod lies in the plane of strut axis and steering arm."""
    states, inputs = at_rest(MODEL, REACH.arm_angle[1])
    points = hardpoints(MODEL, states, inputs)
    strut = points["strut_top"] - points["ball_joint"]
    arm = points["tie_rod_outer"] - points["ball_joint"]
    rod = points["tie_rod_outer"] - points["tie_rod_inner"]
    volume = np.cross(strut, arm) @ rod / np.linalg.norm(np.cross(strut, arm))
    # its square is what has to be positive; it changes by some 0.1 m^2/rad, and the end is 1e-12
    # rad before the dead point
    assert abs(volume) < 1e-6
    refused(ClosureError, lambda: MODEL.signals(*at_rest(MODEL, REACH.arm_angle[1] - 1e-9)))


def test_lower_end_is_where_the_wheel_turns_back():
    assert "turns back" in REACH.lower_limit
    _, slopes = height_and_slope(MODEL, REACH.arm_angle[0] + np.array([-1e-9, 0.0, 1e-9]))
    assert slopes[0] < 0.0
    assert slopes[2] > 0.0
    # slope of 0.3 m/rad^2 at 1e-12 rad
    assert -1e-12 < slopes[1] < 0.0


def test_an_arm_that_nothing_stops_swings_by_a_right_angle():
    reach = travel_range(Model("chrono_generic"))
    assert "right angle" in reach.lower_limit
    design = Model("chrono_generic").design_state[0]
    assert reach.arm_angle[0] - design == pytest.approx(np.pi / 2, rel=1e-12)


def test_table_of_the_reach_rises_and_ends_at_its_ends():
    racks = np.linspace(-0.06, 0.06, 7)
    coarse, full = branch(MODEL, racks), branch(MODEL, racks, to_the_end=True)
    for table in (coarse, full):
        assert (np.diff(table.height, axis=1) >= 0.0).all()
        assert (np.diff(table.angle, axis=1) <= 0.0).all()
    for row, rack in enumerate(racks):
        reach = travel_range(MODEL, rack)
        assert full.angle[row, [0, -1]].tolist() == list(reach.arm_angle)
        # the coarse table ends where the height gets steep, here less than three steps before
        assert np.abs(coarse.angle[row, [0, -1]] - reach.arm_angle).max() < np.deg2rad(6.0)


# -- under a wheel load ---------------------------------------------------------------------------


@pytest.mark.parametrize("load", [0.0, 2500.0, 4000.0])
@pytest.mark.parametrize("rack", [0.0, 0.02])
def test_equilibrium_under_a_wheel_load(load, rack):
    """The oracle stays at rest on the road that carries the load."""
    state = equilibrium(MODEL, wheel_load=load, rack_position=rack)
    inputs = MODEL.inputs({"rack_position": rack})
    road = float(road_under_load(MODEL, load, state, inputs))
    parameters = reference_parameters()
    deflection = parameters["tyre_free_height"] + road - height(state, rack)
    # loads of 4 kN from heights that are rounded to 1e-16 m, times 2e5 N/m
    assert deflection * parameters["tyre_rate"] == pytest.approx(load, abs=1e-9)
    car = newton.Mechanism(parameters)
    pose = newton.solve_pose(car, state[0], rack)
    rest = solve_prescribed(car, pose, 0.0, 0.0, road_height=road)
    assert rest.beta1_acceleration == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("load", [-1.0, np.nan, np.inf])
def test_loads_that_no_road_exerts_are_refused(load, refused):
    refused(InputError, lambda: equilibrium(MODEL, wheel_load=load))


def test_a_tyre_without_stiffness_carries_no_load(refused):
    soft = Model(MODEL.suspension.with_changes({"tyre.rate_N_per_m": 0.0}))
    refused(InputError, lambda: equilibrium(soft, wheel_load=3000.0))


def test_a_load_without_equilibrium_is_refused(refused):
    refused(PositionError, lambda: equilibrium(MODEL, wheel_load=3000.0, strut_force=1e6))


@pytest.mark.parametrize("name", ["reference_car", "offset_strut_car", "double_wishbone_car"])
def test_many_racks_are_as_each_of_them(name):
    """A table of many racks leaves out what no height asks for; positions are the same bits."""
    model = Model(name)
    random = np.random.default_rng(3)
    racks = random.uniform(-0.06, 0.06, 1200)
    heights = design_height(model) + random.uniform(-0.05, 0.05, racks.size)
    together = arm_angles(model, heights, racks)
    some = [*range(60), 499, 500, 1199]  # of parts of 500
    alone = [float(arm_angles(model, heights[k], racks[k])) for k in some]
    np.testing.assert_array_equal(together[some], alone)


def test_one_of_many_out_of_reach_is_refused_by_name(refused):
    racks = np.linspace(-0.06, 0.06, 1001)
    heights = np.full(racks.size, 0.3)
    heights[500] = 1.0
    refused(PositionError, lambda: arm_angles(Model("reference_car"), heights, racks))


LOADED = {"wheel_load": 3000.0, "rack_position": 0.01, "strut_force": 200.0}


class TestStatesOfRestKnowTheirInputs:
    def test_signals_are_those_of_rest(self):
        rest = equilibrium(MODEL, **LOADED)
        signals = MODEL.signals(rest)
        # the tyre's force lies in the plane of the wheel, the load is what it has upright; both
        # are as close as the arm's angle is to rest, some 1e-15 of it
        slopes = np.tan([signals["camber"], signals["toe"]])
        lean = slopes[0] / np.sqrt(1.0 + slopes @ slopes)
        upright = signals["tyre_force"] * np.sqrt(1.0 - lean**2)
        assert upright == pytest.approx(3000.0, rel=1e-9)
        assert abs(signals["wheel_acceleration"]) < 1e-6
        assert linearise(MODEL, rest).steady
        assert linearise(MODEL, rest).inputs == pytest.approx(rest.inputs)

    def test_a_simulation_stays_at_rest(self):
        rest = equilibrium(MODEL, **LOADED)
        result = simulate(MODEL, (0.0, 0.2), rest)
        assert np.abs(result.y - rest[:, None]).max() < 1e-8
        # what is given is taken instead; the others stay
        raised = simulate(MODEL, (0.0, 0.2), rest, inputs={"road_height": 0.05})
        assert np.ptp(raised.y[0]) > 0.01
        assert raised.inputs[:, 0] == pytest.approx(0.01, abs=0.0)
        assert raised.inputs[:, 4] == pytest.approx(0.05, abs=0.0)

    def test_a_height_goes_with_its_rack(self):
        state = state_at_height(MODEL, 0.32, rack_position=0.02)
        assert MODEL.signal("wheel_center_z", state) == pytest.approx(0.32, abs=1e-12)
        assert abs(MODEL.signal("steer", state)) > 0.1

    def test_copies_keep_their_inputs_and_other_arrays_have_none(self):
        rest = equilibrium(MODEL, **LOADED)
        kept = [rest.copy(), rest + 0.0, copy.deepcopy(rest), pickle.loads(pickle.dumps(rest))]
        assert all(np.array_equal(state.inputs, rest.inputs) for state in kept)
        for other in (np.array(rest), rest[:2], [*rest]):
            assert inputs_of(other, MODEL.names_of_states) is None

    def test_another_model_refuses_them(self, refused):
        """Its coordinates mean something else, however many they are."""
        other = Model("double_wishbone_car")
        rest = equilibrium(MODEL, **LOADED)
        assert rest.shape == other.design_state.shape
        for use in (
            lambda: other.signals(rest),
            lambda: other.evaluate("rhs", rest, other.inputs()),
            lambda: simulate(other, (0.0, 0.1), rest),
            lambda: linearise(other, rest),
        ):
            with refused(InputError):
                use()
        assert simulate(other, (0.0, 1e-3), np.array(other.design_state)).success

    def test_an_arm_has_one_angle(self):
        """States, positions and kinematics count from upright; characteristics from design."""
        travels = np.array([-0.05, 0.0, 0.04])
        positions = sweep.positions(MODEL, travels)
        over_travel = characteristics.over(MODEL, "travel", travels)
        angles = positions["arm_angle"].values.ravel()
        assert angles == pytest.approx(arm_angles(MODEL, design_height(MODEL) + travels), rel=1e-14)
        turned = MODEL.design_state[0] - angles
        assert over_travel["arm_rotation"].values == pytest.approx(turned, abs=1e-12)
        assert turned[2] > 0.0 > turned[0]


@pytest.mark.parametrize("gap", [1e-3, 1e-5])
def test_two_positions_of_rest_within_a_step_are_seen(gap):
    """A stable one and an unstable one that a grid of half a degree steps over."""
    reach = travel_range(MODEL)
    low, high = reach.arm_angle
    middle = low + 0.37 * (high - low)

    def moment(angle):
        # from below to above zero as the angle goes from low to high, and back
        place = (np.asarray(angle) - middle) / (high - low)
        return place * (gap - place)

    root = nearest(moment, reach, high)
    assert root == pytest.approx(middle, abs=1e-12)


def test_a_table_that_is_remembered_is_nobodys_to_change():
    first = branch(MODEL, [0.01])
    expected = first.angle.copy(), first.height.copy()
    first.angle[:], first.height[:] = 0.0, 0.0
    again = branch(MODEL, [0.01])
    np.testing.assert_array_equal((again.angle, again.height), expected)


def test_the_mirror_image_is_made_once():
    image = MODEL.mirror_image
    assert image is MODEL.mirror_image
    assert image.suspension == MODEL.suspension.mirrored()
    free = Model("reference_car", free_rack=True).mirror_image
    assert free.free_rack


def test_positions_of_an_axle_are_those_of_its_sides():
    axle = Axle.load("reference_axle")
    found = sweep.positions(axle, [-0.03, 0.0, 0.02], [-0.01, 0.01])
    assert found["camber"].dims == ("wheel", "wheel_travel", "rack_position")
    for side, model in axle.models.items():
        alone = sweep.positions(model, [-0.03, 0.0, 0.02], [-0.01, 0.01])
        assert {*found} == {*alone}
        for name in alone:
            np.testing.assert_array_equal(found[name].sel(wheel=side), alone[name])


def test_positions_of_a_rigid_axle_keep_its_rods_lengths(refused):
    axle, travels = RigidAxle.load("rigid_axle"), np.array([-0.03, 0.0, 0.05])
    found = sweep.positions(axle, travels)
    for name, (chassis, beam) in axle.ends().items():
        side, _, stem = name.partition("_")
        of_side = side in ("left", "right")
        own = found.sel(wheel=side) if of_side else found
        end = [own[f"{stem if of_side else name}_axle_{axis}"].values for axis in "xyz"]
        lengths = np.linalg.norm(np.transpose(end) - chassis, axis=-1)
        # a metre to its rounding, some operations long
        np.testing.assert_allclose(lengths, np.linalg.norm(beam - chassis), rtol=1e-13)
    rise = found["wheel_center_z"] - found["wheel_center_z"].sel(wheel_travel=0.0)
    np.testing.assert_allclose(rise, np.stack([travels, travels]), atol=1e-13)
    camber = characteristics.over(axle, "bump", travels)["camber"]
    np.testing.assert_array_equal(found["camber"], camber)
    refused(InputError, lambda: sweep.positions(axle, travels, 0.01))
