"""Positions from a wheel height, the reachable range, static equilibrium."""

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, PositionError, equilibrium, state_at_height, travel_range
from oracle import newton
from oracle.reference import reference_parameters

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
        # at the dead point the height has a vertical tangent: 3e4 m/rad at the last angle, which
        # is rounded to 5e-17 rad
        assert height(state_at_height(MODEL, wanted)) == pytest.approx(wanted, abs=2e-11)


@pytest.mark.parametrize("beyond", [-0.5, 0.7])
def test_height_out_of_reach_names_range_and_remedy(beyond):
    with pytest.raises(
        PositionError, match=r"out of reach: from -?\d.* mm .* to \d.* mm"
    ) as caught:
        state_at_height(MODEL, beyond)
    assert f"{beyond * 1e3:g} mm" in str(caught.value)
    assert "Choose a height within this range" in str(caught.value)


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


def test_no_equilibrium_says_what_the_moments_are():
    with pytest.raises(PositionError, match=r"no stable equilibrium .* N m"):
        equilibrium(MODEL, strut_force=1e6)


def test_rack_beyond_the_dead_point_is_refused():
    with pytest.raises(PositionError, match=r"rack cannot be at 500 mm.*cannot reach"):
        travel_range(MODEL, rack_position=0.5)


def test_left_and_right_are_mirror_images():
    left = Model(MODEL.suspension.mirrored())
    for wanted in (0.2, 0.3, 0.4):
        a = MODEL.signals(state_at_height(MODEL, wanted))
        b = left.signals(state_at_height(left, wanted))
        for name in ("wheel_center_x", "camber", "toe", "strut_length", "tyre_force"):
            assert b[name] == pytest.approx(a[name], abs=1e-10), name
        for name in ("wheel_center_y", "steer"):
            assert b[name] == pytest.approx(-a[name], abs=1e-12), name


def test_hardpoints_agree_with_the_oracle():
    from kintrafo.hardpoints import hardpoints

    mechanism = newton.Mechanism(reference_parameters())
    pose = newton.solve_pose(mechanism, MODEL.design_state[0] - 0.2, 0.03)
    state = MODEL.state(beta1=MODEL.design_state[0] - 0.2)
    points = hardpoints(MODEL, state, MODEL.inputs({"rack_position": 0.03}))
    for name, body in (
        ("ball_joint", 1),
        ("tie_rod_outer", 2),
        ("tie_rod_inner", 4),
        ("wheel_center", 6),
    ):
        assert points[name] == pytest.approx(mechanism.point(pose, name, body), abs=1e-13), name
    assert points["strut_top"].tolist() == [-0.028, -0.585, 0.82]


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
    from pathlib import Path

    path = Path(__file__).parent.parent / "runtime/data/reference_car.toml"
    assert np.array_equal(Model(path).constants, MODEL.constants)
    with pytest.raises(kintrafo.InputError, match="not dict"):
        Model({})


def test_one_class_catches_all_errors():
    for error in (kintrafo.ClosureError, kintrafo.ModelError, PositionError, kintrafo.InputError):
        assert issubclass(error, kintrafo.KintrafoError)
