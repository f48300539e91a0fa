"""Targets and limits beside the curves of commands: which are met, and where they are drawn."""

import json
from base64 import b64decode

import numpy as np
import pytest
from kintrafo import (
    Axle,
    InputError,
    Model,
    RigidAxle,
    Suspension,
    characteristics,
    report,
    variation,
)
from kintrafo.vehicle.assembly.motions import MOTIONS
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.plots import curves
from kintrafo.vehicle.report import axle_chapter, goals_chapter
from kintrafo.vehicle.studies.goals import Limit
from typer.testing import CliRunner

pytestmark = pytest.mark.usefixtures("rough_drawings")
GOALS = """
[free]
"hardpoints.tie_rod_inner" = 1.0

[targets.toe]
at_mm = [-40, 0, 40]
value = 0.0
within = 0.2

[[limits.scrub_radius]]
at_mm = [0, 40]
over = "rack"
most = 25.0
"""


def called(*words):
    return CliRunner().invoke(app, [*words])


@pytest.fixture
def goals(tmp_path):
    path = tmp_path / "goals.toml"
    path.write_text(GOALS, encoding="utf-8")
    return path


def test_verdicts_are_those_of_the_curves(goals):
    car = Suspension.load("reference_car")
    target, limit = variation.judge(car, variation.goals(variation.read(goals)))
    toe = np.rad2deg(characteristics.over(Model(car), "travel", [-0.04, 0.0, 0.04])["toe"].values)
    worst = np.abs(toe).argmax()
    assert target.met == (np.abs(toe).max() <= 0.2)
    assert np.rad2deg(target.beyond) == pytest.approx(np.abs(toe)[worst] - 0.2)
    assert target.at == pytest.approx([-0.04, 0.0, 0.04][worst])
    scrub = characteristics.over(Model(car), "rack", [0.0, 0.04])["scrub_radius"].values
    assert limit.met == bool((scrub <= 0.025).all())
    assert limit.beyond == pytest.approx(scrub.max() - 0.025)


def test_characteristics_and_compare_report_and_draw(goals, tmp_path):
    page = tmp_path / "page.png"
    asked = ["characteristics", "reference_car", "--goals", str(goals), "--step", "20"]
    shown = called(*asked, "--of", "toe", "--plot", str(page))
    assert shown.exit_code == 0, shown.output
    assert "target: toe angle" in shown.output
    assert "missed by" in shown.output
    told = json.loads(called(*asked, "--json").output)
    assert [(goal["name"], goal["met"]) for goal in told["goals"]] == [
        ("toe", False),
        ("scrub_radius", False),
    ]
    both = called("compare", "reference_car", "offset_strut_car", "--goals", str(goals), "--json")
    assert [goal["file"] for goal in json.loads(both.stdout)["goals"]] == [
        "reference_car",
        "offset_strut_car",
    ]


def test_a_chapter_of_the_report_has_them(goals, refused):
    wanted = variation.goals(variation.read(goals))
    chapter = goals_chapter(Model("reference_car"), wanted)
    assert [row[:2] for row in chapter.tables[0].rows] == [
        ("target: toe angle [deg]", "missed"),
        ("limit: scrub radius [mm] over the rack", "missed"),
    ]
    assert [picture.words for picture in chapter.pictures] == [
        "Curves over wheel travel with targets and limits",
        "Curves over the rack with targets and limits",
    ]
    assert chapter.words[0] == "0 of 2 are met, 2 missed."
    refused(
        InputError,
        lambda: goals_chapter(Model("reference_car"), []),
        lambda: goals_chapter("reference_car", wanted),
    )


@pytest.mark.parametrize("file", ["reference_axle", "rigid_axle"])
def test_a_chapter_of_an_axle_has_the_curves_of_each_motion(file):
    axle = (Axle if file == "reference_axle" else RigidAxle).load(file)
    over_roll = characteristics.over(axle, "roll", np.deg2rad([-2.0, 2.0]))
    height = over_roll["roll_center_height"].values * 1e3
    described = {
        "targets": {
            "camber_left": {"over": "left", "value": 0.0, "within": 0.5},
            "camber_right": {"over": "left", "value": 3.0, "within": 0.5},
        },
        # a millimetre less than the greatest
        "limits": {"roll_center_height": {
            "over": "roll", "at_deg": [-2.0, 2.0], "most": height.max() - 1.0}},
    }  # fmt: skip
    wanted = variation.goals(described, ["bump", "roll", "left", "right"])
    chapter = goals_chapter(axle, wanted)
    assert chapter.words[0] == "1 of 3 are met, 2 missed."
    assert [row[:3] for row in chapter.tables[0].rows] == [
        ("target: camber, left [deg] over travel of the left wheel", "met", ""),
        ("target: camber, right [deg] over travel of the left wheel", "missed", "2.5"),
        ("limit: roll-centre height [mm] over roll", "missed", "1"),
    ]
    assert [picture.words for picture in chapter.pictures] == [
        "Curves over travel of the left wheel with targets and limits",
        "Curves over roll with targets and limits",
    ]
    drawing = b64decode(chapter.pictures[0].source.partition("base64,")[2]).decode()
    for words in ("target, left", "target, right", "camber [deg]"):
        assert f">{words}<" in drawing


@pytest.mark.usefixtures("one_picture")
@pytest.mark.parametrize("file", ["reference_axle", "rigid_axle"])
def test_reports_of_axles_show_how_many_goals_are_missed(monkeypatch, tmp_path, file):
    (tmp_path / "goals.toml").write_text(
        "[limits.camber_left]\nat_mm = [0, 40]\nmost = 9\n"
        "[limits.camber_right]\nat_mm = [0, 40]\nleast = 9\n"
        "[targets.toe_left]\nvalue = 0.0\nwithin = 1.0\n"
        '[limits.spring_force_left]\nover = "load"\ncase = "brake"\nmost = 1e5\n',
        encoding="utf-8",
    )

    def titles(*_, chapters, goals=None, **__):
        (chapter,) = (one for one in chapters if one.title == "Targets and limits")
        assert chapter.words[0] == "3 of 4 are met, 1 missed."
        # the page of the axle shows its right side, of whose toe nothing else is wanted
        names = ["toe_right", "camber_left", "camber_right", "spring_force_left"]
        assert [goal.name for goal in goals or ()] == (names if file == "reference_axle" else [])
        return tmp_path / "report.html"

    for name in ("write", "write_chapters"):
        monkeypatch.setattr(report, name, titles)
    asked = [str(tmp_path / "report.html"), "--goals", str(tmp_path / "goals.toml")]
    shown = called("report", file, *asked)
    assert shown.exit_code == 0, shown.exception


def test_marks_are_at_their_values(goals):
    car = Model("reference_car")
    dataset = characteristics.over(car, "travel", np.linspace(-0.05, 0.05, 11))
    wanted = variation.goals(variation.read(goals))
    (axes,) = curves.figure(dataset, ["toe"], goals=wanted).get_axes()
    (target,) = (one for one in axes.containers if one.get_label() == "target")
    points = target.lines[0].get_xydata()
    np.testing.assert_allclose(points, [[0.0, -40.0], [0.0, 0.0], [0.0, 40.0]], atol=1e-12)
    low, high = axes.get_xlim()
    assert low <= -0.2 <= 0.2 <= high
    (without,) = curves.figure(dataset, ["camber"], goals=wanted).get_axes()
    assert not without.containers


def test_what_is_marked_is_in_sight_however_far_from_the_curve(goals):
    dataset = characteristics.over(Model("reference_car"), "travel", np.linspace(-0.05, 0.05, 201))
    flat = dataset["toe"].copy(data=np.deg2rad(5.0) + 0.01 * dataset["toe"].values)
    wanted = variation.goals(variation.read(goals))
    (axes,) = curves.figure(dataset.assign(toe=flat), ["toe"], goals=wanted).get_axes()
    low, high = axes.get_xlim()
    # the targets are 0 deg with 0.2 deg to either side
    assert low < -0.2 < 5.0 < high


def test_arrows_at_the_end_of_an_axis_are_in_sight():
    """The axis of a constant curve ends a tenth of a unit beside it, at these limits."""
    dataset = characteristics.over(Model("reference_car"), "travel", np.linspace(-0.05, 0.05, 11))
    flat = dataset.assign(toe=dataset["toe"].copy(data=np.zeros(11)))
    wanted = variation.goals({"limits": {"toe": {"least": -0.1, "most": 0.1}}})
    (axes,) = curves.figure(flat, ["toe"], goals=wanted).get_axes()
    low, high = axes.get_xlim()
    # an arrow is 6 points wide, of some 150 that the axis has
    assert low < -0.1 - 0.04 * (high - low)
    assert high > 0.1 + 0.04 * (high - low)


def test_what_does_not_vary_has_its_place_where_there_are_goals(goals):
    dataset = characteristics.over(Model("reference_car"), "travel", np.linspace(-0.05, 0.05, 11))
    dataset = dataset.assign(toe=dataset["toe"].copy(data=np.full(11, 0.01)))
    wanted = variation.goals(variation.read(goals))
    without = [name for names in curves.grouped(dataset).values() for name in names]
    pages = [name for names in curves.grouped(dataset, wanted).values() for name in names]
    assert {*pages} - {*without} == {"toe"}


def drawn(axes, label, *, level=False):
    """Return position and value of all marks that are called so."""
    bars = [one.lines[0] for one in axes.containers if one.get_label() == label]
    lines = [one for one in axes.get_lines() if one.get_label() == label]
    order = 1 if level else -1  # wheel travel is on the vertical axis
    return [one.get_xydata()[:, ::order].tolist() for one in (*bars, *lines)]


def test_goals_of_an_axle_are_those_of_its_sides():
    at = [-40.0, 40.0]
    same = {"at_mm": at, "value": [0.5, -0.5], "within": 0.1}
    described = {
        "targets": {"camber_left": same, "camber_right": same},
        "limits": {
            "toe_left": {"at_mm": at, "least": -0.2, "most": 0.1},
            "toe_right": {"at_mm": at, "most": 0.3},
            "roll_center_height": {"at_mm": at, "least": 20.0},
        },
    }
    wanted = variation.goals(described, ["bump"])
    dataset = characteristics.over(
        Axle.load("reference_axle"), "bump", np.linspace(-0.05, 0.05, 11)
    )
    names = ["camber", "toe", "roll_center_height"]
    panels = curves.figure(dataset, names, goals=wanted, columns=2)
    camber, toe, height = panels.get_axes()
    beside = {round(axes.get_position().x0, 2) for axes in panels.get_axes()}
    assert len(beside) == 2
    # what is the same for both is one mark, and of one side it has the colour of its curve
    assert drawn(camber, "target") == [pytest.approx(np.array([[-40.0, 0.5], [40.0, -0.5]]))]
    assert not drawn(camber, "target, left")
    left, right = (line.get_color() for line in toe.get_lines()[:2])
    for side, colour, bounds in (("left", left, [-0.2, 0.1]), ("right", right, [0.3])):
        marks = [line for line in toe.get_lines() if line.get_label() == f"limit, {side}"]
        assert [line.get_color() for line in marks] == [colour] * len(bounds)
        expected = [[[x, bound] for x in at] for bound in bounds]
        np.testing.assert_allclose(drawn(toe, f"limit, {side}"), expected, atol=1e-12)
    assert not drawn(toe, "limit")
    # marks are named once below the panels, curves in each panel
    (legend,) = panels.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert sorted(words) == ["limit", "limit, left", "limit, right", "target"]
    for axes in (camber, toe):
        assert [text.get_text() for text in axes.get_legend().get_texts()] == ["left", "right"]
    assert height.get_legend() is None
    np.testing.assert_allclose(drawn(height, "limit"), [[[x, 20.0] for x in at]])


@pytest.fixture
def figures(monkeypatch):
    """Return the panels that chapters draw, by what is above each picture and the curve's name."""
    found = {}
    draw = curves.figure

    def noted(dataset, names, *, title, **words):
        made = draw(dataset, names, title=title, **words)
        found.update(
            {(title, name): axes for name, axes in zip(names, made.get_axes(), strict=True)}
        )
        return made

    monkeypatch.setattr("kintrafo.vehicle.report.chapters.curves.figure", noted)
    return found


OF_AXLES = ("bump", "roll", "left", "right")


@pytest.mark.usefixtures("one_picture")
@pytest.mark.parametrize("file", ["reference_axle", "rigid_axle"])
def test_chapters_of_axles_have_what_is_wanted(file, figures, refused):
    """Curves that they have not else are added, and positions beyond the usual ones."""
    at = {"at_mm": [-85.0, 40.0]}
    described = {
        "targets": {
            "roll_moment": {"over": "roll", "at_deg": 1.5, "value": 900.0, "within": 50.0},
            "camber_right": {"over": "right", **at, "value": [2.0, -1.0], "within": 0.5},
        },
        "limits": {
            "roll_center_height": {**at, "least": 20.0},
            "camber_left": {"at_mm": 0.0, "most": 3.0},
        },
    }
    wanted = variation.goals(described, OF_AXLES)
    axle = (Axle if file == "reference_axle" else RigidAxle).load(file)
    axle_chapter(axle, wanted)
    expected = {
        ("roll", "roll_moment", "target"): [[1.5, 900.0]],
        ("right", "camber", "target, right"): [[-85.0, 2.0], [40.0, -1.0]],
        ("bump", "roll_center_height", "limit"): [[-85.0, 20.0], [40.0, 20.0]],
        ("bump", "camber", "limit, left"): [[0.0, 3.0]],
    }
    for (motion, name, label), points in expected.items():
        words = MOTIONS[motion]
        title = words[:1].upper() + words[1:]
        (axes,) = (a for (t, n), a in figures.items() if t.startswith(title) and n == name)
        level = motion == "roll"
        np.testing.assert_allclose(drawn(axes, label, level=level), [points], atol=1e-9)
        # the curve goes as far as what is marked on it
        along = np.array(axes.get_lines()[0].get_xydata()[:, 0 if level else 1])
        assert along.min() <= points[0][0]
        assert points[-1][0] <= along.max()
        # and has as many points there as elsewhere
        assert np.diff(along).max() == pytest.approx(np.median(np.diff(along)), rel=1e-6)
    marked = [key for key, axes in figures.items() if axes.get_legend_handles_labels()[1]]
    assert len(marked) == len(expected)
    refused(
        InputError,
        lambda: axle_chapter(axle, [Limit("ackermann_left", "bump", np.zeros(1), 0.0, 1.0)]),
    )
    figures.clear()
    axle_chapter(axle)
    assert not any(axes.get_legend_handles_labels()[1] for axes in figures.values())
    assert not any(title.startswith("The right wheel moves") for title, _ in figures)


def test_goals_over_one_axis_are_not_mixed_up(refused):
    limit = {"camber_left": [{"most": 1.0}, {"most": 2.0, "over": "left"}]}
    wanted = variation.goals({"limits": limit}, ["bump", "left"])
    dataset = characteristics.over(Axle.load("reference_axle"), "bump", [-0.01, 0.01])
    refused(InputError, lambda: curves.figure(dataset, ["camber"], goals=wanted))
    assert curves.figure(dataset, ["camber"], goals=wanted[:1])


@pytest.mark.parametrize(
    ("file", "goal", "words"),
    [
        ("reference_axle", "[limits.camber_left]\nat_mm = 40\nmost = 0.5", "limit: camber, left"),
        (
            "rigid_axle",
            '[targets.axle_steer]\nover = "roll"\nat_deg = 2\nvalue = 1\nwithin = 0.1',
            "target: steer angle of the axle",
        ),
    ],
)
def test_goals_of_axles_are_drawn_over_their_motion_alone(tmp_path, monkeypatch, file, goal, words):
    (tmp_path / "goals.toml").write_text(goal, encoding="utf-8")
    given = {}

    def note(_, path, *__, goals, **___):
        given[path.name] = len(goals)
        return path

    monkeypatch.setattr(curves, "write_overview", note)
    asked = ["--goals", str(tmp_path / "goals.toml"), "--over", "bump,roll"]
    shown = called("characteristics", file, *asked, "--plot", str(tmp_path / "a.png"))
    assert shown.exit_code == 0, shown.output
    assert words in shown.output
    over_roll = "at_deg" in goal
    assert given == {"a_bump.png": not over_roll, "a_roll.png": over_roll}


def test_axles_are_compared_with_goals(tmp_path):
    (tmp_path / "goals.toml").write_text(
        '[limits.roll_stiffness]\nover = "roll"\nat_deg = [-2, 2]\nmost = 600', encoding="utf-8"
    )
    asked = ["--over", "roll", "--goals", str(tmp_path / "goals.toml"), "--json"]
    for file in ("reference_axle", "rigid_axle"):
        shown = called("compare", file, file, *asked)
        assert shown.exit_code == 0, shown.output
        goals = json.loads(shown.stdout)["goals"]
        assert [goal["file"] for goal in goals] == [file, f"{file} (2)"]
        axle = (Axle if file == "reference_axle" else RigidAxle).load(file)
        over_roll = characteristics.over(axle, "roll", np.deg2rad([-2.0, 2.0]))
        stiffness = over_roll["roll_stiffness"].values
        beyond = stiffness.max() - np.rad2deg(600.0)
        for goal in goals:
            assert goal["beyond"] == pytest.approx(beyond)
            assert goal["met"] == (beyond <= 0.0)


def test_cars_beside_a_measurement_are_judged(goals, tmp_path, as_stored):
    rig = tmp_path / "rig.csv"
    rig.write_text("wheel_travel [mm],toe [deg]\n-40,-0.1\n0,0\n40,0.1\n", encoding="utf-8")
    asked = ["compare", str(rig), "reference_car", "--goals", str(goals)]
    shown = called(*asked, "--plot", str(tmp_path / "rig.png"), "--json")
    assert [goal["file"] for goal in json.loads(shown.stdout)["goals"]] == ["reference_car"]
    held = "wheel_travel [mm],toe [deg],rack_position [mm]\n-40,-0.1,12\n40,0.1,12\n"
    rig.write_text(held, encoding="utf-8")
    shown = called(*asked)
    assert shown.exit_code == 2
    as_stored(" ".join(shown.output.replace("│", " ").split()))


def test_goals_beyond_the_curves_are_refused_where_they_are_drawn(goals, tmp_path):
    asked = ["characteristics", "reference_car", "--goals", str(goals), "--bump", "30"]
    page = tmp_path / "page.png"
    shown = called(*asked, "--plot", str(page))
    assert "toe: 40 mm of wheel travel is beyond its curve, which goes from -80 to 30 mm" in str(
        shown.exception
    )
    assert not list(tmp_path.glob("*.png"))
    assert called(*asked).exit_code == 0


def test_goals_that_are_not_looked_at_are_named(goals, as_stored):
    shown = called("compare", "reference_car", "offset_strut_car", "--goals", str(goals))
    as_stored(" ".join(shown.stderr.split()))


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["rigid_axle"], "its wheels are not steered"),
        (["bmw_e90_rear_axle", "--over", "steer"], "rack or load, and these are over steer"),
        (["reference_car", "--rack", "10"], "in its middle"),
        (["reference_axle", "--rack", "10"], "in its middle"),
        (["trailing_arm_car"], "its wheels are not steered"),
    ],
)
def test_where_goals_mean_nothing_they_are_refused(goals, words, text):
    # what has no rack has no goal over it
    goals.write_text("[[limits" + GOALS.partition("[[limits")[2], encoding="utf-8")
    shown = called("characteristics", *words, "--goals", str(goals))
    assert shown.exit_code != 0
    told = f"{shown.output} {shown.exception}"
    assert text in " ".join(told.replace("│", " ").split())


def test_goals_have_a_door(refused):
    car = Suspension.load("reference_car")
    makers = [
        lambda wrong: axle_chapter(Axle.load("reference_axle"), wrong),
        lambda wrong: axle_chapter(RigidAxle.load("rigid_axle"), wrong),
        lambda wrong: goals_chapter(Model(car), wrong),
        lambda wrong: variation.judge(car, wrong),
    ]
    for wrong in (3, [3], "toe", None, {"toe": 1}):
        for make in makers:
            with refused(InputError):
                make(wrong)
    with pytest.raises(InputError, match="no_such"):
        variation.goals({"targets": {"no_such": {"value": 0.0, "within": 1.0}}})
    with pytest.raises(InputError):
        variation.goals(3)
