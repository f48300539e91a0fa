"""Suspensions behind a Pitman arm: positions, characteristics and loads, from an input file.

The oracle is a relay rod by Newton's method on its pose (`oracle.relay_rod`), with the wheel
carrier on five rods behind it. The equations of motion are compared with maximal coordinates in
`test_mechanisms`.
"""

import json
import re

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import FILE
from kintrafo import Axle, InputError, Model, characteristics, compliance, loads
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import model_named
from kintrafo.vehicle.assembly.axle import AxleAssembly
from kintrafo.vehicle.models.axle.equations import declared
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.equations import declared as of_a_car
from kintrafo.vehicle.models.model_batch import ModelBatch
from kintrafo.vehicle.models.plausibility import plausibility
from kintrafo.vehicle.models.points import hardpoints
from kintrafo.vehicle.models.reach import at_rest
from kintrafo.vehicle.report.page import render
from kintrafo.vehicle.studies.sensitivity import sensitivity
from oracle.corners import Wishbones, difference
from support.models import needs_gcc, own

# A linkage in which nothing is parallel, upright or equal.
ARM = {
    "pivot_mm": [-385.0, 300.0, 268.0],
    "axis": [0.05, 0.1, 1.0],
    "ball_mm": [-140.0, 310.0, 270.0],
    "idler_pivot_mm": [-375.0, -280.0, 250.0],
    "idler_axis": [-0.1, 0.05, 1.0],
    "idler_ball_mm": [-145.0, -310.0, 262.0],
    "gear_ratio": 18.0,
}
STOP = {"clearance_mm": 40.0, "rate_N_per_m": 1e5}
RIGHT = kintrafo.load("double_wishbone_car").with_changes(
    {"bump_stop": STOP, "vehicle.end": "front", "rack": None, "pitman_arm": ARM}
)
AXLE = Axle.from_dict({"axle": "front", "side": RIGHT})
PLACES = [(-0.06, 0.0), (0.0, 0.06), (0.03, -0.07), (0.05, 0.03)]  # wheel travel, rack [m]

# Rounding of the poses; of differences of them by the oracle.
POSE, SLOPE = 1e-13, 1e-9


@pytest.fixture(scope="module", params=("left", "right"))
def bench(request):
    return Wishbones(AXLE.sides[request.param])


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_both_sides_are_where_their_rods_put_them(bench, place):
    model, (travel, rack) = AXLE.models[bench.suspension.vehicle.side], place
    height = bench.points["wheel_center"][2] + travel
    state = kintrafo.state_at_height(model, height, rack_position=rack)
    at = hardpoints(model, state, model.inputs({"rack_position": rack}))
    for name in ("lower_ball_joint", "upper_ball_joint", "tie_rod_outer", "wheel_center"):
        assert at[name] == pytest.approx(bench.joint(name, place), rel=0.0, abs=POSE), name
    linkage = bench.carrier.linkage
    inner = bench.carrier.inner(rack)
    assert at["tie_rod_inner"] == pytest.approx(inner, rel=0.0, abs=POSE)
    idler = linkage.carried(rack, linkage.points["idler_ball"])
    assert at["idler_ball"] == pytest.approx(idler, rel=0.0, abs=POSE)
    assert at["pitman_ball"] == pytest.approx(linkage.at(rack).center, rel=0.0, abs=POSE)
    assert np.array_equal(at["idler_pivot"], linkage.points["idler_pivot"])


def test_characteristics_over_the_arm_are_those_of_the_rods(bench):
    place = (0.02, -0.04)
    model = AXLE.models[bench.suspension.vehicle.side]
    at = characteristics.over(model, "rack", [place[1]], travel=place[0])
    assert float(at["toe"][0]) == pytest.approx(bench.toe(place), abs=POSE)
    # positive to the left: toe of the left wheel is positive to the right
    gradient = -bench.side * bench.by_rack(bench.toe, place)
    assert float(at["steer_gradient"][0]) == pytest.approx(gradient, rel=SLOPE)
    per_turn = 2.0 * np.pi * bench.carrier.linkage.length / ARM["gear_ratio"]
    assert model.suspension.steering_gear.travel_per_turn() == pytest.approx(per_turn, rel=1e-14)


def test_its_position_is_called_the_displacement_of_its_ball():
    over = characteristics.over(AXLE, "rack", [0.0])
    held = characteristics.over(RIGHT, "travel", [0.0])
    for found in (over, held):
        assert found["rack_position"].attrs["long_name"] == "displacement of the Pitman arm's ball"
    assert over.attrs["title"] == "characteristics over the Pitman arm"


def test_a_parallelogram_moves_its_rod_along_a_circle():
    """Omitted values of the idler arm are mirrored ones: both tie rods move alike."""
    alike = {"pivot_mm": [-390.0, 300.0, 265.0], "axis": [0.0, 0.0, 2.0]}
    car = RIGHT.with_changes({"pitman_arm": alike | {"ball_mm": [-140.0, 300.0, 265.0]}})
    racks = np.array([-0.08, 0.05])
    turn = racks / 0.25
    for side in (car, car.mirrored()):
        model = Model(side)
        at = hardpoints(model, *at_rest(model, model.design_state[0], racks))
        x, y, z = side.hardpoints.metres("tie_rod_inner")
        circle = [x + 0.25 * (np.cos(turn) - 1.0), y + 0.25 * np.sin(turn), z + 0.0 * turn]
        assert pytest.approx(np.array(circle), rel=0.0, abs=POSE) == at["tie_rod_inner"].T


# -- loads ----------------------------------------------------------------------------------------


def test_the_moment_of_the_arm_does_the_work_of_both_tie_rods():
    """With directions of the tie rods' ends by differences of the oracle."""
    push = {"contact_N": [-800.0, 3000.0, 6000.0]}
    cases = {"turn": {"left": push, "right": {"contact_N": [0.0, 2500.0, 3000.0]}, "rack_mm": 50.0}}
    found = loads.static(AXLE, cases).sel(case="turn")
    work = 0.0
    for side, suspension in AXLE.sides.items():
        row = (found["part"] == "relay_rod") & (found["by"] == f"tie_rod_{side}")
        force = found["force"].values[row.values][0]
        carrier = Wishbones(suspension).carrier
        work += force @ difference(lambda h, carrier=carrier: carrier.inner(0.05 + h))
    assert abs(work) > 100.0
    # the differences' 1e-9 of forces of some kN
    assert float(found["rack_force"]) == pytest.approx(-work, abs=1e-5)
    length = AXLE.right.steering_gear.length()
    assert float(found["pitman_moment"]) == pytest.approx(-work * length, abs=1e-5)
    # a ball joint in the middle of nothing: the idler arm has no moment about its axis
    about = (found["part"] == "idler_arm") & (found["point"] == "idler_pivot")
    axis = np.array(ARM["idler_axis"]) / np.linalg.norm(ARM["idler_axis"])
    assert abs(found["moment"].values[about.values] @ axis).max() < 1e-9


@pytest.mark.parametrize("whole", [False, True], ids=["corner", "axle"])
def test_in_the_middle_it_holds_tie_rods_on_bushes_as_a_rack_does(whole):
    """The ends of the tie rods are the same, and rest: so are all deflections."""
    soft = {
        "lower_arm_front": {"radial_N_per_mm": 5000.0, "axial_N_per_mm": 2000.0},
        "tie_rod_inner": {"axial_N_per_mm": 8000.0},
    }
    on_arm = RIGHT.with_changes({"bushings": soft})
    on_rack = on_arm.with_changes({"pitman_arm": None, "rack": {"axis": [0.0, 1.0, 0.0]}})
    subjects = [
        Axle.from_dict({"axle": "front", "side": o}) if whole else o for o in (on_arm, on_rack)
    ]
    for found, expected in (
        [compliance.linear(each) for each in subjects],
        [compliance.nonlinear(each, None, "lateral", [0.0, 2000.0]) for each in subjects],
    ):
        numbers = [name for name in expected if expected[name].dtype.kind == "f"]
        assert numbers
        for name in numbers:
            # the equilibrium is found to 1e-12 m and rad
            np.testing.assert_allclose(found[name], expected[name], rtol=1e-9, atol=1e-11)


def test_its_points_vary_in_studies():
    """Against differences of characteristics over cars whose file has other values."""
    place, step = "pitman_arm.idler_pivot_mm.y", 0.01

    def steer(change):
        moved = RIGHT.with_changes({place: ARM["idler_pivot_mm"][1] + change})
        return float(characteristics.over(Model(moved), "rack", [0.04])["steer"][0])

    found = sensitivity(RIGHT, [place], over="rack", positions=[0.04], names=["steer"])
    difference = (steer(step) - steer(-step)) / (2e-3 * step)
    # of second order in 10 micrometres, and rounding over that
    assert float(found["steer"].squeeze()) == pytest.approx(difference, rel=1e-6)


@pytest.mark.parametrize(
    ("place", "values"),
    [
        ("pitman_arm.gear_ratio", [18.0, -1.0, 20.0]),
        ("vehicle.wheelbase_mm", [2600.0, 0.0, 2700.0]),
        ("pitman_arm.idler_pivot_mm.x", [-375.0, -143.5, -380.0]),
    ],
)
def test_what_a_file_may_not_have_is_taken_out_of_a_batch(place, values):
    """As one by one: optional keys have ranges, and both arms need a lever."""
    batch = ModelBatch(RIGHT, {place: np.array(values)}, free_rack=False)
    assert batch.valid.tolist() == [True, False, True]
    with pytest.raises(InputError):
        RIGHT.with_changes({place: values[1]})


# -- equations of an axle -------------------------------------------------------------------------


@needs_gcc
def test_the_sides_of_an_axle_share_the_linkage():
    """Without a bar and with a prescribed arm, each side moves as it does by itself."""
    equations = own(declared(AXLE), derivatives=False)
    assert [name for name in equations.BODIES if "relay" in name] == ["relay_rod"]
    parameters = {
        name: value
        for side, own_values in AXLE.parameters_by_side().items()
        for known, value in own_values.items()
        for name in (known if side == "right" else f"left_{known}",)
        if name in equations.PARAMETERS
    }
    system = kintrafo.System(equations, parameters)
    rng = np.random.default_rng(5)
    state = system.design_state + np.concatenate([0.05 * rng.normal(size=4), rng.normal(size=4)])
    inputs = system.inputs({"rack_position": 0.03, "rack_velocity": -0.4, "rack_acceleration": 6.0})
    found = dict(zip(system.state_names, system.evaluate("rhs", state, inputs), strict=True))
    for side, model in AXLE.models.items():
        names = [f"{side}_{name}" for name in model.state_names]
        own_state = [state[system.state_names.index(name)] for name in names]
        own_inputs = [
            inputs[system.input_names.index(n if n in system.input_names else f"{side}_{n}")]
            for n in model.input_names
        ]
        expected = model.evaluate("rhs", np.array(own_state), np.array(own_inputs))
        # sums of some hundred terms in another order
        assert [found[name] for name in names] == pytest.approx(expected, rel=1e-11)


def test_margins_of_a_strut_behind_it_are_those_at_its_state():
    """The residuals close the linkage again, at given coordinates; nothing else has these."""
    functions = generate(model_named("macpherson_pitman_arm")).functions
    margins = functions["margins"]
    by_name = dict(zip(margins.labels, margins.results, strict=True))
    copies = [name for name in by_name if name.endswith("__given")]
    assert "idler_arm_closure__given" in copies
    assert all(by_name[name] == by_name[name.removesuffix("__given")] for name in copies)
    reading = [n for n, f in functions.items() if any("given" in s.name for s in f.free_symbols)]
    assert reading == ["residuals"]


def test_at_the_rear_of_a_car_it_is_a_part_of_the_body():
    rear = Axle.from_dict({"axle": "rear", "side": RIGHT.with_changes({"vehicle.end": "rear"})})
    car = Car.from_dict({**FILE, "car": "roll", "tyres": None, "rear": rear.to_dict()})
    assert "rear axle: [pitman_arm] (a part of the body" in "; ".join(car.unused)
    names = {body.name for body in of_a_car(car).mechanism.bodies}
    assert "rear_left_tie_rod" in names
    assert not any("relay_rod" in name for name in names)


def test_its_report_has_the_linkage_in_place_of_a_rack():
    text = render(Model(RIGHT))
    found = re.search(r'id="payload">(.*?)</script>', text, re.DOTALL)
    data = json.loads(found[1])
    assert data["on_rack"] is False
    assert {"pitman_pivot", "pitman_ball", "idler_pivot", "idler_ball"} <= set(data["points"])
    assert '<label for="rack">Pitman arm</label>' in text


# -- files ----------------------------------------------------------------------------------------


def test_a_file_keeps_it_and_both_sides_have_one_linkage(tmp_path):
    again = Axle.load(AXLE.save(tmp_path / "axle.toml"))
    assert again.to_dict() == AXLE.to_dict()
    assert again.left.pitman_arm == again.right.pitman_arm
    assert "rack" not in again.to_dict()["side"]
    assert "steered by a Pitman arm" in AxleAssembly(again).words
    moved = again.with_changes({"side.pitman_arm.ball_mm.x": -150.0})
    assert moved.left.pitman_arm.ball_mm == (-150.0, 310.0, 270.0)


@pytest.mark.parametrize(
    "arm",
    [
        ARM | {"axis": [0.0, 0.0, 0.0]},
        ARM | {"ball_mm": [-385.0, 300.0, 300.0], "axis": [0.0, 0.0, 1.0]},
        ARM | {"idler_ball_mm": ARM["ball_mm"]},
        ARM | {"idler_ball_mm": [-140.0, 310.0, -200.0]},
        ARM | {"ball_mm": [-385.0, 450.0, 268.0], "idler_ball_mm": [-385.0, -300.0, 268.0]},
        ARM | {"gear_ratio": 0.0},
        ARM | {"mass_kg": 3.0},
    ],
    ids=["no axis", "no arm", "no rod", "upright", "dead centre", "no ratio", "unknown key"],
)
def test_a_linkage_that_cannot_move_is_refused(arm, refused):
    refused(InputError, lambda: RIGHT.with_changes({"pitman_arm": arm}))


def test_a_point_in_metres_is_noticed():
    assert not plausibility(RIGHT).problems
    moved = RIGHT.with_changes({"pitman_arm": ARM | {"ball_mm": [-0.14, 0.31, 0.27]}})
    (problem,) = plausibility(moved).problems
    assert problem.startswith("[pitman_arm] ball_mm is 0.434 mm from the origin. Is it in metres?")


@pytest.mark.parametrize(
    "changes",
    [
        {"rack": {"axis": [0.0, 1.0, 0.0]}},
        {"pitman_arm": None},
        {"bushings": {"rack": {"axial_N_per_mm": 1e4}}},
    ],
    ids=["both", "neither", "bush of a rack"],
)
def test_what_steers_is_one_thing(changes, refused):
    refused(InputError, lambda: RIGHT.with_changes(changes))


def test_sides_that_differ_and_a_free_arm_are_refused(refused):
    refused(InputError, lambda: AXLE.with_changes({"left.pitman_arm.ball_mm.x": -150.0}))
    refused(
        InputError,
        lambda: AXLE.with_changes(
            {"left.pitman_arm": None, "left.rack": {"axis": [0.0, 1.0, 0.0]}}
        ),
    )
    refused(InputError, lambda: Model(RIGHT, free_rack=True))
    strut = kintrafo.load("reference_car").with_changes({"rack": None, "pitman_arm": ARM})
    refused(InputError, lambda: strut.with_changes({"bodies.tie_rod.mass_kg": 1.0}))
