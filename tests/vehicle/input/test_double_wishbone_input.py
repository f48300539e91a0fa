"""The input file of a double wishbone: what it says, and what is refused."""

import pickle
from importlib import resources

import pytest
from kintrafo import InputError, Model, Suspension, equilibrium
from kintrafo.generated import double_wishbone
from kintrafo.vehicle.kinds import KINDS
from kintrafo.vehicle.kinds.double_wishbone import DoubleWishbone
from kintrafo.vehicle.kinds.macpherson import MacPherson

CAR = Suspension.load("double_wishbone_car")
CAR_OF_THE_PAPER = Suspension.load("reference_car")


def problems(changes):
    with pytest.raises(InputError) as caught:
        CAR.with_changes(changes)
    return list(caught.value.problems)


def problems_of(data):
    with pytest.raises(InputError) as caught:
        Suspension.from_dict(data)
    return list(caught.value.problems)


# -- which suspension a file describes ------------------------------------------------------------


def test_the_file_says_what_it_describes():
    assert type(CAR) is DoubleWishbone
    assert type(CAR_OF_THE_PAPER) is MacPherson
    assert CAR.to_dict()["suspension"] == "double_wishbone"
    data = CAR_OF_THE_PAPER.to_dict()
    del data["suspension"]  # as in files from before there were two
    assert Suspension.from_dict(data) == CAR_OF_THE_PAPER


def test_without_the_key_the_hardpoints_show_what_was_forgotten(as_stored):
    data = CAR.to_dict()
    del data["suspension"]
    (problem,) = problems_of(data)
    assert "lower_arm_front" in problem
    as_stored(problem)


@pytest.mark.parametrize("kind", ["double_wishbon", "multilink", 3, None, ["macpherson"]])
def test_unknown_kinds_are_refused_with_the_known_ones(kind):
    (problem,) = problems_of(CAR.to_dict() | {"suspension": kind})
    assert problem.startswith(f"suspension = {kind!r} is not a known kind of suspension.")
    assert problem.endswith((*(f"{known}?" for known in KINDS), f"{', '.join(KINDS)}."))


def test_a_kind_loads_only_its_own_files(refused):
    assert DoubleWishbone.load("double_wishbone_car") == CAR
    refused(
        InputError,
        lambda: DoubleWishbone.load("reference_car"),
        lambda: MacPherson.from_dict(CAR.to_dict()),
    )


# -- what it says ---------------------------------------------------------------------------------


def test_parameters_are_those_of_the_equations():
    parameters = CAR.parameters()
    assert set(parameters) == set(double_wishbone.PARAMETERS)
    assert {type(value) for value in parameters.values()} == {float}
    assert parameters["upper_arm_rear_z"] == 0.474
    assert parameters["spring_rate"] == 60000.0
    assert parameters["damper_rate"] == 4000.0
    assert parameters["rack_axis_y"] == parameters["spin_axis_y"] == 1.0
    assert Model(CAR).equations is double_wishbone


def test_centres_of_mass_follow_their_rules():
    p = CAR.with_changes({"bodies.knuckle.com_mm": None}).parameters()
    assert p["lower_arm_com_y"] == pytest.approx((-0.36 - 0.36 - 0.72) / 3.0, rel=1e-15)
    assert p["upper_arm_com_z"] == pytest.approx((0.5 + 0.474 + 0.505) / 3.0, rel=1e-15)
    assert p["knuckle_com_x"] == pytest.approx(-0.01, rel=1e-15)
    assert p["tie_rod_com_y"] == pytest.approx(-0.557, rel=1e-15)
    assert p["rack_com_z"] == 0.258


def test_spring_can_be_given_in_two_ways():
    by_length = CAR.with_changes({"spring.force_at_design_N": None, "spring.free_length_mm": 530.0})
    assert by_length.parameters()["spring_free_length"] == 0.53
    # at design it is sqrt(20^2 + 100^2 + 420^2) mm long
    length = (0.02**2 + 0.1**2 + 0.42**2) ** 0.5
    expected = length + 5360.268 / 60000.0
    assert CAR.parameters()["spring_free_length"] == pytest.approx(expected, rel=1e-15)
    model = Model(CAR)
    assert float(model.signal("spring_force", model.design_state)) == pytest.approx(5360.268)


def test_round_trips():
    assert Suspension.from_dict(CAR.to_dict()) == CAR
    assert CAR.with_changes({}) == CAR
    assert pickle.loads(pickle.dumps(CAR)) == CAR
    assert pickle.loads(pickle.dumps(Model(CAR))).suspension == CAR
    assert CAR.mirrored().mirrored() == CAR


# -- errors ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {"spring.rate_N_per_m": -1.0},
        {"damper.rate_N_s_per_m": -1.0},
        {"damper.velocity_m_per_s": [0.0]},
        {"damper.rate_N_s_per_m": None, "damper.velocity_m_per_s": [-1.0, 1.0]},
        {"damper.rate_N_s_per_m": None},
        {
            "damper.rate_N_s_per_m": None,
            "damper.velocity_m_per_s": [1.0, 0.0],
            "damper.force_N": [9.0, 0.0],
        },
        {"damper.friction_velocity_m_per_s": 0.0},
        {"spring.free_length_mm": 530.0},
        {"spring.force_at_design_N": None},
        {"spring.rate_N_per_m": 0.0},
        {"tyre.lifts_off": 1},
        {"bodies.tie_rod.mass_kg": 1.0},
        {"bodies.rack.mass_kg": 2.0},
        {"vehicle.side": "left"},
        {"hardpoints.unit": "m"},
        {"hardpoints.upper_ball_joint.z": 180.0},
        {"hardpoints.lower_ball_joint.y": -360.5, "hardpoints.lower_ball_joint.z": 195.0},
        {"hardpoints.upper_arm_front.x": -150.0},
        {"hardpoints.spring_top": [-10.0, -600.0, 200.0]},
        {"hardpoints.tie_rod_outer": [5.0, -720.0, 185.5]},
        {"hardpoints.tie_rod_outer": [-10.0, -695.0, 345.0]},
        {"hardpoints.tie_rod_inner": [-130.0, -700.0, 100.0]},
        {"hardpoints.tie_rod_inner": [-257.97, -691.72, 260.0]},
    ],
)
def test_refused(changes, as_stored):
    as_stored(*problems(changes))


def test_upper_arm_at_its_dead_centre(as_stored):
    # arms about x, the lower ball joint in the plane of the upper arm
    points = {
        "upper_arm_front": [120.0, -600.0, 600.0],
        "upper_arm_rear": [-140.0, -600.0, 600.0],
        "upper_ball_joint": [0.0, -660.0, 400.0],
        "lower_ball_joint": [0.0, -720.0, 200.0],
    }
    (problem,) = problems({f"hardpoints.{name}": point for name, point in points.items()})
    as_stored(problem)


def test_there_are_no_equations_with_a_free_rack(refused):
    refused(InputError, lambda: Model(CAR, free_rack=True))


@pytest.mark.parametrize(
    ("key", "instead_of"), [("free_length_mm", "force_at_design_N"), ("radius_mm", "")]
)
def test_commented_keys_of_the_starter_file_are_valid(key, instead_of, tmp_path):
    text = (resources.files("kintrafo.vehicle.data") / "double_wishbone_car.toml").read_text(
        "utf-8"
    )
    assert f"# {key} = " in text
    text = text.replace(f"# {key} = ", f"{key} = ")
    if instead_of:
        text = text.replace(f"{instead_of} = ", f"# {instead_of} = ")
    (tmp_path / "car.toml").write_text(text, encoding="utf-8")
    rest = equilibrium(Model(tmp_path / "car.toml"))
    # the length in the comment is rounded to 0.1 mm
    height = float(Model(CAR).signal("wheel_center_z", rest))
    assert height == pytest.approx(0.3, abs=1e-4)
