"""Targets and limits of compliance: what studies make of them, where they are printed and drawn."""

import json

import numpy as np
import pytest
from cars.rigid_axles import FIVE
from kintrafo import Axle, InputError, Model, RigidAxle, Suspension, compliance, report, variation
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.input.toml_writer import write_toml
from kintrafo.vehicle.plots import curves
from kintrafo.vehicle.report import compliance_chapter, goals_chapter
from kintrafo.vehicle.studies.goals import Limit
from scipy.optimize import brentq
from typer.testing import CliRunner

pytestmark = pytest.mark.usefixtures("rough_drawings")
REAR = "bushings.arm_rear.radial_N_per_mm"
BUSHES = {
    "arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 900.0, "axis": [0.2, 0.1, 1.0]},
    "strut_top": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": 700.0},
}
CAR = Suspension.load("reference_car").with_changes({"bushings": BUSHES})
RODS = {"panhard_rod_chassis": {"axial_N_per_mm": 5000.0}}
GOALS = """
[limits.toe_by_lateral]
at_mm = [-20, 20]
most = 0.1

[[targets.camber_by_braking]]
held = "spring"
value = 0.0
within = 0.01
"""


def called(*words):
    return CliRunner().invoke(app, [*words])


def under(car, name, at, held="height"):
    """Return a compliance in the unit for people, deg/kN."""
    return np.rad2deg(compliance.linear(Model(car), None, at, held=held)[name].values) * 1e3


@pytest.fixture
def goals(tmp_path):
    path = tmp_path / "goals.toml"
    path.write_text(GOALS, encoding="utf-8")
    return path


@pytest.fixture
def soft_car(tmp_path):
    write_toml(CAR, tmp_path / "soft_car.toml")
    return str(tmp_path / "soft_car.toml")


def test_verdicts_are_those_of_the_compliance(goals):
    target, limit = variation.judge(CAR, variation.goals(variation.read(goals)))
    toe = under(CAR, "toe_by_lateral", [-0.02, 0.02])
    camber = under(CAR, "camber_by_braking", [0.0], "spring")
    assert (limit.over, limit.met) == ("height", bool((toe <= 0.1).all()))
    assert np.rad2deg(limit.beyond) * 1e3 == pytest.approx(toe.max() - 0.1)
    assert target.over == "spring"
    assert np.rad2deg(target.beyond) * 1e3 == pytest.approx(abs(camber[0]) - 0.01)


def test_a_stiffness_is_found_for_a_compliance():
    wanted = 0.11
    target = {"toe_by_lateral": {"value": wanted, "within": 1e-3}}
    found = variation.optimise(CAR, {REAR: 500.0}, target)

    def missed(rate):
        toe = under(CAR.with_changes({REAR: rate}), "toe_by_lateral", [0.0])[0]
        return toe - wanted

    assert found.success
    # what moving costs shifts it by 1e-8 of the rate, and the solver stops where 1e-8 is to gain
    assert 900.0 + found.moved[REAR] == pytest.approx(brentq(missed, 400.0, 1400.0), rel=1e-5)


def test_cars_of_a_tolerance_are_within_limits_of_compliance():
    place, most = "hardpoints.tie_rod_outer.x", float(under(CAR, "toe_by_lateral", [0.0])[0])
    found = variation.tolerance(
        CAR, {place: 5.0}, limits={"toe_by_lateral": {"most": most}}, count=6, names=["toe"],
        positions=[0.0],
    )  # fmt: skip
    there = found["value_of"].values[:, 0] * 1e3
    cars = [CAR.with_changes({place: float(x)}) for x in there]
    expected = [under(car, "toe_by_lateral", [0.0])[0] <= most for car in cars]
    assert found["within_limits"].values.tolist() == expected
    assert 0 < sum(expected) < len(expected)


def test_stiffnesses_have_tolerances():
    """Beside a limit of compliance, or where compliance is what is looked at."""
    bounds = {"toe_by_lateral": {"at_mm": [0.0], "most": 0.13}}
    found = variation.tolerance(
        CAR, {REAR: "20 %"}, limits=bounds, count=8, names=["toe"], positions=[0.0, 0.01]
    )
    rates = found["value_of"].values[:, 0] * 1e-3
    cars = [CAR.with_changes({REAR: float(rate)}) for rate in rates]
    softness = np.array([float(under(car, "toe_by_lateral", [0.0])[0]) for car in cars])
    assert found["within_limits"].values.tolist() == (softness <= 0.13).tolist()
    assert 0 < int(found["within_limits"].sum()) < 8
    # with rigid joints they do nothing
    assert float(abs(found["toe"] - found["toe_nominal"]).max()) == 0.0
    held = variation.tolerance(
        CAR, {REAR: "20 %"}, count=8, held="spring", names=["toe_by_lateral"], positions=[0.0]
    )
    softness = [float(under(car, "toe_by_lateral", [0.0], "spring")[0]) for car in cars]
    band = np.rad2deg(held["toe_by_lateral"].sel(quantile=[0.0, 1.0]).values[:, 0]) * 1e3
    np.testing.assert_allclose(band, [min(softness), max(softness)], rtol=1e-12)
    assert float(held["toe_by_lateral_share"][0, 0]) == pytest.approx(1.0)


def test_sensitivities_by_stiffnesses_are_slopes_of_the_compliance():
    found = variation.sensitivity(
        CAR, ["bushings"], held="tyre", names=["toe_by_lateral", "camber_by_braking"],
        positions=[0.0, 0.01],
    )  # fmt: skip
    assert found.sizes["place"] == 4
    for name in ("toe_by_lateral", "camber_by_braking"):
        low, high = (
            under(CAR.with_changes({REAR: 900.0 + by}), name, [0.0, 0.01], "tyre")
            for by in (-0.5, 0.5)
        )
        slope = np.rad2deg(found[name].sel(place=REAR).values) * 1e6  # deg/kN per N/mm
        np.testing.assert_allclose(slope, high - low, rtol=1e-5)
    effect = next(iter(variation.effects(found, "toe_by_lateral")))
    assert (effect.place, effect.unit) == (REAR, "deg/kN per N/mm")


@pytest.mark.parametrize("subject", ["car", "rigid axle"])
def test_many_cars_have_curves_of_compliance(subject):
    if subject == "car":
        of, place, name = CAR, REAR, "toe_by_lateral"
    else:
        of = RigidAxle.load("rigid_axle").with_changes({"bushings": RODS})
        place = "bushings.panhard_rod_chassis.axial_N_per_mm"
        name = "axle_lateral_by_lateral_parallel"
    rates = [800.0, 900.0, 1200.0]
    found = variation.cars(of, {place: rates}, names=[name], held="height", positions=[0.0, 0.02])
    for i, rate in enumerate(rates):
        changed = of.with_changes({place: rate})
        expected = compliance.linear(changed, None, [0.0, 0.02])[name]
        np.testing.assert_allclose(found[name][i], expected, rtol=1e-12)


@pytest.mark.parametrize(
    "call",
    [
        lambda: variation.tolerance(CAR, {REAR: "20 %"}, count=4),
        lambda: variation.sensitivity(CAR, [REAR]),
        lambda: variation.cars(CAR, {REAR: [1.0, 2.0]}, over="rack"),
        lambda: variation.sensitivity(CAR, [REAR], held="road"),
        lambda: variation.sensitivity(CAR, [REAR], held="tyre", over="rack"),
        lambda: variation.sensitivity(Suspension.load("reference_car"), held="tyre"),
    ],
)
def test_stiffnesses_of_what_is_rigid_are_refused(call, refused):
    refused(InputError, call)


def test_commands_vary_stiffnesses(soft_car, tmp_path, as_stored):
    values = tmp_path / "t.toml"
    values.write_text('[tolerances]\n"bushings" = "30 %"\n[limits.toe_by_lateral]\nmost = 0.13\n')
    done = called("tolerance", soft_car, str(values), "--cars", "6", "--of", "toe")
    assert "within all limits" in done.output, done.output
    done = called("tolerance", soft_car, str(values), "--cars", "4", "--held", "spring")
    assert "deg/kN" in done.output, done.output
    done = called("sensitivity", soft_car, "--held", "height", "--place", "bushings")
    assert "arm_rear" in done.output, done.output
    done = called("sensitivity", soft_car, "--held", "height", "--over", "rack")
    assert done.exit_code != 0
    as_stored(str(done.exception))


def test_a_front_of_stiffnesses(refused):
    pytest.importorskip("pymoo")
    asked = {"population": 4, "generations": 2}
    softest = {"toe_by_recession": {"at_mm": 0.0}}
    stiffest = {"toe_by_lateral": {"value": 0.1, "within": 0.01}}
    found = variation.pareto(CAR, {REAR: 300.0}, stiffest, maximise=softest, **asked)
    member = found.suspension(1)
    toe = under(member, "toe_by_recession", [0.0])[0]
    column = next(name for name in found.dataset if "toe_by_recession" in str(name))
    assert np.rad2deg(found.dataset[column].values[0]) * 1e3 == pytest.approx(toe)
    refused(
        InputError,
        lambda: variation.pareto(
            CAR, {REAR: 300.0}, {"toe": {"value": 0.1, "within": 0.01}}, **asked
        ),
    )


WRONG = [
    {"toe_by_lateral": {"held": "air", "most": 1.0}},
    {"toe": {"held": "height", "most": 1.0}},
    {"toe_by_lateral": {"over": "rack", "most": 1.0}},
]


@pytest.mark.parametrize("limits", WRONG)
def test_what_has_no_meaning_is_refused(limits, refused):
    refused(InputError, lambda: variation.goals({"limits": limits}))


def test_without_bushes_nothing_is_judged(goals, refused):
    wanted = variation.goals(variation.read(goals))
    refused(InputError, lambda: variation.judge(Suspension.load("reference_car"), wanted))


@pytest.mark.parametrize(
    ("axle", "bushes"),
    [
        (Axle.load("reference_axle"), BUSHES),
        (RigidAxle.load("rigid_axle"), RODS),
        (FIVE, dict(FIVE.bushings or {})),  # without rigid rods they have no curves
    ],
    ids=["independent", "rigid", "five rods"],
)
def test_goals_of_both_wheels(axle, bushes):
    name = "toe_by_lateral_opposed_left"
    found = compliance.linear(axle, bushes, [0.0, 0.02])
    toe = np.rad2deg(flat(found)[name].values) * 1e3
    limits = {name: {"at_mm": [0.0, 20.0], "most": 0.01}}
    wanted = variation.goals({"limits": limits}, ["bump", "roll"])
    # the bushes that are given, and their images on the other side
    soft = assembly_of(axle).with_bushings(bushes)
    (verdict,) = variation.judge(soft, wanted)
    assert np.rad2deg(verdict.beyond) * 1e3 == pytest.approx(toe.max() - 0.01, rel=1e-9)
    (axes,) = curves.figure(
        found.drop_dims(["moved", "by"]), [name.removesuffix("_left")], goals=wanted
    ).get_axes()
    (line,) = (line for line in axes.get_lines() if line.get_label() == "limit, left")
    np.testing.assert_allclose(line.get_xydata(), [[0.01, 0.0], [0.01, 20.0]], rtol=1e-12)
    (row,) = goals_chapter(soft, wanted).tables[0].rows
    assert row[0].endswith("[deg/kN] (held: height)")
    if isinstance(axle, Axle):
        assert row[2] == f"{toe.max() - 0.01:.5g}"


@pytest.mark.parametrize(
    ("of", "name", "label"),
    [
        (Model(CAR), "toe_by_lateral", "limit"),
        (assembly_of(Axle.load("reference_axle")).with_bushings(BUSHES),
         "toe_by_lateral_opposed_left", "limit, left"),
        (assembly_of(RigidAxle.load("rigid_axle")).with_bushings(RODS),
         "toe_by_lateral_parallel_right", "limit, right"),
    ],
    ids=["suspension", "axle", "rigid axle"],
)  # fmt: skip
def test_the_chapter_of_compliance_draws_those_of_its_wheels(of, name, label, monkeypatch, refused):
    """Those with wheels that are held otherwise are in the chapter of goals alone."""
    panels = {}
    draw = curves.figure

    def noted(dataset, names, **words):
        made = draw(dataset, names, **words)
        panels.update(zip(names, made.get_axes(), strict=True))
        return made

    monkeypatch.setattr("kintrafo.vehicle.report.chapters.curves.figure", noted)
    described = [{"at_mm": [-20, 20], "most": 0.3}, {"held": "locked", "most": 0.4}]
    axes = ["travel", "rack"] if isinstance(of, Model) else ["bump", "roll"]
    wanted = variation.goals({"limits": {name: described}}, axes)
    compliance_chapter(compliance.linear(of, None, [-0.02, 0.0, 0.02]), wanted)
    marked = {
        curve: {line.get_label(): line.get_xydata().tolist() for line in axes.get_lines()
                if line.get_label().startswith("limit")}
        for curve, axes in panels.items()
    }  # fmt: skip
    curve = name.removesuffix("_left").removesuffix("_right")
    assert {key: marks for key, marks in marked.items() if marks} == {
        curve: {label: [[pytest.approx(0.3), -20.0], [pytest.approx(0.3), 20.0]]}
    }
    refused(
        InputError,
        lambda: compliance_chapter(
            compliance.linear(of, None, [0.0]),
            [Limit("camber_by_wind", "height", np.zeros(1), 0.0, 1.0)],
        ),
    )


def test_compliance_prints_and_draws_them(goals, tmp_path, monkeypatch, as_stored):
    """Bushes of a file of their own count, as they do in its curves."""
    text = "\n".join(
        f"[bushings.{point}]\n" + "\n".join(f"{key} = {value}" for key, value in table.items())
        for point, table in BUSHES.items()
    )
    (tmp_path / "bushes.toml").write_text(text, encoding="utf-8")
    given = []

    def note(_, path, *__, goals, **___):
        given.extend(goal.name for goal in goals)
        return path

    monkeypatch.setattr(curves, "write_overview", note)
    asked = ["compliance", "reference_car", "--bushes", str(tmp_path / "bushes.toml")]
    asked += ["--goals", str(goals)]
    shown = called(*asked, "--plot", str(tmp_path / "a.png"), "--json")
    assert shown.exit_code == 0, shown.output
    assert given == ["toe_by_lateral"]
    as_stored(" ".join(shown.stderr.split()))
    (judged,) = json.loads(shown.stdout)["goals"]
    toe = under(CAR, "toe_by_lateral", [-0.02, 0.02])
    assert np.rad2deg(judged["beyond"]) * 1e3 == pytest.approx(toe.max() - 0.1)
    assert "limit: toe angle by a lateral force" in called(*asked).stdout
    shown = called(*asked, "--rack", "10")
    assert shown.exit_code == 2
    as_stored(" ".join(shown.output.replace("│", " ").split()))


@pytest.mark.parametrize(
    ("file", "asked", "found"),
    [
        ("reference_car", ["toe_by_lateral", "camber_by_braking"], None),
        # both wheels of a curve are drawn together
        (
            "reference_axle",
            ["toe_by_lateral_opposed_right", "toe_by_braking_parallel"],
            ["toe_by_lateral_opposed", "toe_by_braking_parallel"],
        ),
    ],
)
def test_compliance_draws_what_is_named(tmp_path, monkeypatch, file, asked, found, as_stored):
    bushes = tmp_path / "bushes.toml"
    bushes.write_text("[bushings.arm_rear]\nradial_N_per_mm = 900\n", encoding="utf-8")
    given = []

    def note(_, path, names, *__, **___):
        given.extend(names)
        return path

    monkeypatch.setattr(curves, "write_overview", note)
    words = ["compliance", file, "--bushes", str(bushes), "--plot", str(tmp_path / "a.png")]
    shown = called(*words, *(word for name in asked for word in ("--of", name)))
    assert shown.exit_code == 0, shown.exception
    assert given == (found or asked)
    shown = called(*words, "--of", "toe_by_laterl")
    as_stored(str(shown.exception))
    assert not list(tmp_path.glob("*.png"))


def test_comparisons_and_reports_have_them(goals, soft_car, tmp_path, monkeypatch, as_stored):
    asked = ["--held", "spring", "--goals", str(goals), "--json"]
    shown = called("compare", soft_car, soft_car, *asked)
    assert shown.exit_code == 0, shown.exception
    assert [goal["name"] for goal in json.loads(shown.stdout)["goals"]] == ["camber_by_braking"] * 2
    shown = called("characteristics", soft_car, "--goals", str(goals))
    as_stored(str(shown.exception))

    def written(*_, chapters, **__):
        (chapter,) = (one for one in chapters if one.title == "Targets and limits")
        met = (under(CAR, "toe_by_lateral", [-0.02, 0.02]) <= 0.1).all()
        assert chapter.words[0] == f"{int(met)} of 2 are met, {2 - int(met)} missed."
        words = "Compliance over wheel travel with targets and limits"
        assert [picture.words for picture in chapter.pictures] == [words, words]
        return tmp_path / "report.html"

    monkeypatch.setattr(report, "write", written)
    shown = called("report", soft_car, str(tmp_path / "report.html"), "--goals", str(goals))
    assert shown.exit_code == 0, shown.exception


@pytest.mark.parametrize("kind", [Suspension, RigidAxle])
def test_bushes_of_a_file_without_any_are_asked_for(kind, refused):
    of = kind.load("reference_car" if kind is Suspension else "rigid_axle")
    for name in ("bushings", "bushings.arm_rear.axial_N_per_mm"):
        with refused(InputError):
            variation.tolerance(of, {name: "20 %"}, count=4)
