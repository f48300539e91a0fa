"""Targets and limits beside the curves of commands: which are met, and where they are drawn."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kintrafo import InputError, Model, Suspension, characteristics, variation
from kintrafo.cli import app
from kintrafo.plots import curves
from kintrafo.report import goals_chapter
from typer.testing import CliRunner

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


def called(*words: str) -> Any:
    return CliRunner().invoke(app, [*words])


@pytest.fixture
def goals(tmp_path: Path) -> Path:
    path = tmp_path / "goals.toml"
    path.write_text(GOALS, encoding="utf-8")
    return path


def test_verdicts_are_those_of_the_curves(goals: Path) -> None:
    car = Suspension.load("reference_car")
    target, limit = variation.judge(car, variation.goals(variation.read(goals)))
    toe = np.rad2deg(characteristics.travel(Model(car), [-0.04, 0.0, 0.04])["toe"].values)
    worst = np.abs(toe).argmax()
    assert target.met == (np.abs(toe).max() <= 0.2)
    assert np.rad2deg(target.beyond) == pytest.approx(np.abs(toe)[worst] - 0.2)
    assert target.at == pytest.approx([-0.04, 0.0, 0.04][worst])
    scrub = characteristics.steering(Model(car), [0.0, 0.04])["scrub_radius"].values
    assert limit.met == bool((scrub <= 0.025).all())
    assert limit.beyond == pytest.approx(scrub.max() - 0.025)


def test_characteristics_and_compare_tell_and_draw(goals: Path, tmp_path: Path) -> None:
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
    assert [goal["file"] for goal in json.loads(both.output)["goals"]] == [
        "reference_car",
        "offset_strut_car",
    ]


def test_a_chapter_of_the_report_has_them(goals: Path) -> None:
    wanted = variation.goals(variation.read(goals))
    chapter = goals_chapter(Model("reference_car"), wanted)
    assert [row[3] for row in chapter.tables[0].rows] == ["missed", "missed"]
    assert [picture.words for picture in chapter.pictures] == [
        "Curves over wheel travel with targets and limits",
        "Curves over the rack with targets and limits",
    ]
    with pytest.raises(InputError, match="goals is empty"):
        goals_chapter(Model("reference_car"), [])


def test_marks_are_at_their_values(goals: Path) -> None:
    car = Model("reference_car")
    dataset = characteristics.travel(car, np.linspace(-0.05, 0.05, 11))
    wanted = variation.goals(variation.read(goals))
    (axes,) = curves.figure(dataset, ["toe"], goals=wanted).get_axes()
    (target,) = (one for one in axes.containers if one.get_label() == "target")
    points = target.lines[0].get_xydata()
    np.testing.assert_allclose(points, [[-40.0, 0.0], [0.0, 0.0], [40.0, 0.0]], atol=1e-12)
    low, high = axes.get_ylim()
    assert low <= -0.2 <= 0.2 <= high
    (without,) = curves.figure(dataset, ["camber"], goals=wanted).get_axes()
    assert not without.containers


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["reference_axle"], "over 'rack' is not known. Known are: bump, roll"),
        (["reference_car", "--rack", "10"], "in its middle"),
        (["trailing_arm_car"], "over travel"),
    ],
)
def test_where_goals_mean_nothing_they_are_refused(
    goals: Path, words: list[str], text: str
) -> None:
    # what has no rack has no goal over it
    goals.write_text("[[limits" + GOALS.partition("[[limits")[2], encoding="utf-8")
    shown = called("characteristics", *words, "--goals", str(goals))
    assert shown.exit_code != 0
    told = f"{shown.output} {shown.exception}"
    assert text in " ".join(told.replace("│", " ").split())


def test_goals_have_a_door() -> None:
    car = Suspension.load("reference_car")
    for wrong in (3, [3], None):
        with pytest.raises(InputError):
            variation.judge(car, wrong)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="no_such"):
        variation.goals({"targets": {"no_such": {"value": 0.0, "within": 1.0}}})
    with pytest.raises(InputError):
        variation.goals(3)  # type: ignore[arg-type]
