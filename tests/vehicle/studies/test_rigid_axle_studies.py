"""Studies of values of a rigid axle: against where a root finder puts the beam of other values.

The root finder of `test_rigid_axle` shares nothing with the equations.
"""

import numpy as np
import pytest
from cars.rigid_axles import AXLE, Found
from kintrafo import (
    Axle,
    InputError,
    Model,
    RigidAxle,
    characteristics,
    load,
    rig,
    roads,
    variation,
)
from kintrafo.core.validator import Validator
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.models.rigid_axle.model import RigidAxleModel
from kintrafo.vehicle.studies.design_variables import linkage_of, matching

ROLLS = np.deg2rad([-3.0, 2.0])
GOALS = {
    "targets": {"axle_steer": {"over": "roll", "at_deg": [-3.0, 2.0], "value": 0.0, "within": 0.1}},
    "limits": {"roll_center_height": {"at_mm": [0.0, 20.0], "least": 390.0, "most": 420.0}},
}


def steer(axle):
    """Return the steer angle of an axle in some rolls of the body, by the root finder."""
    found = Found(axle)
    turns = [found.pose(0.0, -roll)[1] for roll in ROLLS]
    return np.array([turn.as_euler("ZXY")[0] for turn in turns])


def test_sensitivities_are_differences_of_what_the_root_finder_finds():
    """Of ends of rods, and of a damper's place that does not count."""
    places = ["rods.panhard_rod.axle.z", "rods.left_link.chassis.z", "hardpoints.damper_top.z"]
    ours = variation.sensitivity(AXLE, places, over="roll", positions=ROLLS, names=["axle_steer"])
    assert ours["axle_steer"].dims == ("place", "roll_angle")
    for place in places[:2]:
        at = {"rods.panhard_rod.axle.z": 400.0, "rods.left_link.chassis.z": 305.0}[place]
        beside = [steer(AXLE.with_changes({place: at + by})) for by in (-1.0, 1.0)]
        # (1 mm / 300 mm)^2 of them
        slope = (beside[1] - beside[0]) / 2e-3
        np.testing.assert_allclose(ours["axle_steer"].sel(place=place), slope, rtol=2e-4)
    assert (ours["axle_steer"].sel(place=places[2]) == 0.0).all()


def test_all_points_of_a_linkage_vary_by_default():
    """Those of rods and of the steering, too, which are no hardpoints of their file."""
    steered = load("steered_rigid_axle").to_dict()
    points = {f"hardpoints.{name}" for name in steered["hardpoints"] if name != "unit"}
    points |= {f"rods.{name}.{end}" for name in steered["rods"] for end in ("chassis", "axle")}
    points |= {"drag_link.knuckle", "pitman_arm.pivot_mm", "pitman_arm.ball_mm"}
    for axle, wanted in (
        (load("steered_rigid_axle"), points),
        (AXLE, {f"hardpoints.{name}" for name in AXLE.hardpoints.given()}
         | {f"rods.{name}.{end}" for name in AXLE.rods for end in ("chassis", "axle")}),
    ):  # fmt: skip
        with Validator("test") as given:
            found = matching(given, axle, linkage_of(axle))
        assert {name.rpartition(".")[0] for name in found} == wanted


def test_what_a_rig_measured_is_explained(kintrafo, tmp_path, refused, as_stored):
    """Curves over roll in deg, of the root finder."""
    meant = AXLE.with_changes({"rods.left_link.chassis.z": 298.0})
    rolls = np.linspace(-3.0, 3.0, 5)
    steered = np.rad2deg(
        [Found(meant).pose(0.0, -r)[1].as_euler("ZXY")[0] for r in np.deg2rad(rolls)]
    )
    rows = [f"{roll},{angle}" for roll, angle in zip(rolls, steered, strict=True)]
    text = "\n".join(["roll_angle [deg],axle_steer [deg]", *rows])
    (tmp_path / "rig.csv").write_text(text, encoding="utf-8")
    errors = '[tolerances]\n"rods.left_link.chassis.z" = 20.0\n'
    (tmp_path / "errors.toml").write_text(errors, encoding="utf-8")
    given = ["rig.csv", "errors.toml", "-o", "built.toml", "--plot", "fit.svg"]
    code, _, err = kintrafo("fit", "rigid_axle", *given)
    assert code == 0, err
    built = RigidAxle.load("built.toml").rods["left_link"].chassis[2]
    # of a curve that is known to 2 %, and an error that is more likely small
    assert built == pytest.approx(298.0, abs=0.5)
    code, _, err = kintrafo("fit", "reference_car", "rig.csv", "errors.toml")
    assert code != 0
    as_stored(" ".join(err.split()))
    refused(
        InputError,
        lambda: rig.beside(rig.measured_curves("rig.csv"), {"car": Model("reference_car")}),
    )


def test_motions_over_a_road_are_those_of_one_after_the_other():
    bump = Scenario(inputs={"road_height": roads.step(0.02, at=0.1, end=0.4)}, duration=0.4)
    place, signal, rates = "damper.rate_N_s_per_m", "left_axle_wheel_acceleration", [2e3, 4e3]
    found = variation.sweep(AXLE, {place: rates}, bump, reductions={signal: "max"})
    assert found["success"].all()
    for rate in rates:
        model = RigidAxleModel(AXLE.with_changes({place: rate}))
        _, alone = run(model, bump, rtol=1e-6, atol=1e-9)
        ours = float(found[f"{signal}_max"].sel({place: rate}))
        # the tolerances of both, of stiff tyres
        assert ours == pytest.approx(float(alone[signal].max()), rel=1e-4)


def test_goals_are_judged_of_axles_too():
    wanted = variation.goals(GOALS, ["bump", "roll"])
    of_steer, of_height = variation.judge(AXLE, wanted)
    steered = np.rad2deg(steer(AXLE))
    worst = int(np.abs(steered).argmax())
    assert (of_steer.met, of_height.met) == (np.abs(steered).max() <= 0.1, True)
    assert of_steer.beyond == pytest.approx(np.deg2rad(np.abs(steered).max() - 0.1), abs=1e-12)
    assert of_steer.at == pytest.approx(ROLLS[worst])
    axle = Axle.load("reference_axle")
    limits = {"limits": {"camber_left": {"over": "left", "at_mm": 50.0, "most": 0.0},
                         "roll_stiffness": {"over": "roll", "least": 1e5}}}  # fmt: skip
    camber, stiffness = variation.judge(axle, variation.goals(limits, ["bump", "roll", "left"]))
    assert (camber.met, camber.at, stiffness.met) == (True, 0.05, False)


WRONG = [
    lambda: variation.sensitivity(AXLE, over="travel"),
    lambda: variation.sensitivity(AXLE, ["rods.panhard"]),
    lambda: variation.sensitivity(AXLE, names=["scrub_radius"]),
    lambda: variation.sweep(AXLE, {"wheel.toe_deg": 0.0}, Scenario(height={"middle": 0.3})),
    lambda: variation.judge(AXLE, variation.goals({"limits": {"toe": {"most": 0.0}}})),
    lambda: variation.goals({"limits": {"axle_steer": {"at_mm": 2.0, "most": 1.0}}}, ["roll"]),
    lambda: variation.optimise(AXLE, {"rods": 1.0}, {"bar_twist": {"value": 0.0, "within": 1.0}}),
]  # fmt: skip


@pytest.mark.parametrize("study", WRONG)
def test_what_cannot_be_studied_is_refused_by_name(study, refused):
    refused(InputError, study)


def test_what_no_rods_allow_has_no_neighbour(refused):
    refused(InputError, lambda: variation.sensitivity(AXLE, over="roll", positions=[0.9]))
    found = variation.cars(AXLE, {"rods.panhard_rod.axle.y": [-459.9999, 460.0]}, positions=[0.0])
    assert "[rods.panhard_rod] is upright" in str(found["reason"].values[0])
    assert str(found["reason"].values[1]) == ""


def test_the_commands_take_it(kintrafo, tmp_path):
    goals = """
[free]
"rods.panhard_rod.axle.z" = 20.0
[tolerances]
"rods.panhard_rod" = 2.0
[targets.roll_center_height]
value = 420.0
within = 1.0
[limits.axle_steer]
over = "roll"
at_deg = 2.0
most = 0.1
"""
    (tmp_path / "goals.toml").write_text(goals, encoding="utf-8")
    lines = [
        ["sensitivity", "--place", "rods", "--of", "roll_steer", "--over", "roll", "--at", "2"],
        ["tolerance", "goals.toml", "--cars", "5", "--of", "axle_lateral", "--plot", "bands.svg"],
        ["optimise", "goals.toml", "-o", "better.toml", "--plot", "goals.svg"],
        ["characteristics", "--goals", "goals.toml", "--over", "bump,roll"],
    ]
    words = ["at 2 deg of roll", "5 of 5 cars", "found", "limit: steer angle of the axle"]
    for (command, *rest), told in zip(lines, words, strict=True):
        code, out, err = kintrafo(command, "rigid_axle", *rest)
        assert code == 0, err
        assert told in " ".join(out.split())
    better = characteristics.over(RigidAxle.load("better.toml"), "bump", [0.0])
    assert float(better["roll_center_height"][0]) == pytest.approx(0.42, abs=1e-5)
