"""Targets and limits in the interactive charts of a report: data and words of the page."""

import json
import re

import kintrafo
import numpy as np
import pytest
from kintrafo import Axle, InputError, Model, PositionError, System, characteristics, variation
from kintrafo.generated import four_bar
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.report.grid import Grid, GridAxis
from kintrafo.vehicle.report.marks import of_shown_side
from kintrafo.vehicle.report.page import render

CAR = Model("reference_car")
OF_AXLES = ("bump", "roll", "left", "right")
BESIDE = {"at_mm": [-40, 40], "value": [0.8, -0.6], "within": 0.3}
DESCRIBED = {
    "targets": {"toe": {"at_mm": [-40, 0, 40], "value": [0.1, 0.0, -0.3], "within": 0.2}},
    "limits": {
        "camber": {"at_mm": [-20, 120], "least": -1.5, "most": 1.5},
        "scrub_radius": [
            {"over": "rack", "at_mm": [0, 40], "most": 25.0},
            {"over": "rack", "at_mm": 95, "least": 5.0},
        ],
        "turning_circle": {"over": "rack", "at_mm": 20, "most": 900.0},
        "caster": {"at_mm": -130, "least": 1.0},
        "toe_by_lateral": {"at_mm": 0, "most": 0.1, "held": "spring"},
    },
}


@pytest.fixture
def coarse(monkeypatch):
    """Sample at few positions, to either side 100 mm of travel and 60 mm of rack."""
    grid = Grid(GridAxis(-0.1, 0.05, 5), GridAxis(-0.06, 0.03, 5))
    monkeypatch.setattr("kintrafo.vehicle.report.page.reachable_grid", lambda _: grid)


def handed(page):
    """Return the curves that the page's script reads, by their keys."""
    found = re.search(r'id="payload">(.*?)</script>', page, re.DOTALL)
    return {curve["key"]: curve for curve in json.loads(found[1])["curves"]}


def figure_of(page, key):
    found = re.search(rf'<figure data-curve="{key}">.*?</figure>', page, re.DOTALL)
    return found[0]


@pytest.mark.usefixtures("coarse")
def test_the_page_is_handed_the_numbers_of_the_file():
    goals = variation.goals(DESCRIBED)
    page = render(CAR, goals=goals)
    assert page == render(CAR, goals=goals)
    curves = handed(page)
    # to and from SI units nothing is lost but rounding, which is not written
    assert curves["toe"]["goals"] == [
        {"kind": "target", "at": [-40, 0, 40], "value": [0.1, 0.0, -0.3], "within": 0.2}
    ]
    assert curves["camber"]["goals"] == [
        {"kind": "least", "at": [-20], "value": [-1.5], "within": 0.0},
        {"kind": "most", "at": [-20], "value": [1.5], "within": 0.0},
    ]
    assert curves["scrub_radius_over_rack"]["goals"] == [
        {"kind": "most", "at": [0, 40], "value": [25.0, 25.0], "within": 0.0}
    ]
    assert not curves["scrub_radius"]["goals"]
    # as far as a limit goes, a curve with a pole is drawn
    low, high = curves["turning_circle_over_rack"]["range"]
    assert low < 900.0 <= high
    marked = {key for key, curve in curves.items() if curve["goals"]}
    assert marked == {"toe", "camber", "scrub_radius_over_rack", "turning_circle_over_rack"}
    assert not any(curve["goals"] for curve in handed(render(CAR)).values())


@pytest.mark.usefixtures("coarse")
def test_nothing_is_left_out_in_silence():
    page = render(CAR, goals=variation.goals(DESCRIBED))
    assert "Beyond this chart: limit at 120 mm." in figure_of(page, "camber")
    assert "Beyond this chart: limit at 95 mm." in figure_of(page, "scrub_radius_over_rack")
    assert "Beyond this chart: limit at \u2212130 mm." in figure_of(page, "caster")
    (words,) = re.findall(r"Not in the interactive charts: (.*?)</p>", page)
    # "[deg/kN]" has no letter that HTML writes otherwise
    assert words.startswith("limit: toe angle by a lateral force")
    assert words.endswith("[deg/kN] (held: spring).")
    # where a chart has some it is in sight, with a legend of what it has
    (folded,) = re.findall(r'<details class="more">.*', page, re.DOTALL)
    assert 'data-curve="scrub_radius_over_rack"' not in folded
    for key, legend in (("toe", ["target"]), ("camber", ["limit"]), ("caster", [])):
        names = re.findall(r"</svg> (\w+)</span>", figure_of(page, key))
        assert names == legend
    assert "toe angle in deg over wheel travel, with targets" in page


@pytest.mark.usefixtures("coarse")
def test_one_side_of_an_axle_has_what_is_wanted_of_its_wheel():
    axle = Axle.load("reference_axle")
    described = {
        "targets": {"camber_left": BESIDE, "camber_right": {**BESIDE, "within": 0.4}},
        "limits": {
            "toe_right": {"over": "roll", "at_deg": 2, "most": 1.0},
            "roll_stiffness": {"at_mm": 0, "least": 1.0},
        },
    }
    goals = variation.goals(described, OF_AXLES)
    for side, within, other in (("left", 0.3, "right"), ("right", 0.4, "left")):
        page = render(axle.models[side], goals=goals)
        curves = handed(page)
        assert curves["camber"]["goals"] == [
            {"kind": "target", "at": [-40, 40], "value": [0.8, -0.6], "within": within}
        ]
        assert [key for key, curve in curves.items() if curve["goals"]] == ["camber"]
        for words in (
            f"target: camber, {other} [deg];",
            "limit: toe angle, right [deg] over roll",
            "limit: roll stiffness [N m/deg]",
        ):
            assert words in page


def test_what_is_not_steered_has_no_words_of_a_rack():
    wanted = variation.goals({"targets": {"camber": {"value": 0.0, "within": 1.0}}}, ("travel",))
    page = render(Model("trailing_arm_car"), goals=wanted)
    assert "</svg> target</span>" in figure_of(page, "camber")
    assert "rack in its middle" not in page.partition('id="payload"')[0]
    assert not re.search(r"<p class=\"muted\">\s*</p>", page)


WITHIN = {"value": 0.5, "within": 0.1}
OTHER = {"value": 0.5, "within": 0.2}


@pytest.mark.parametrize(
    ("left", "right", "shown"),
    [
        ({"toe": WITHIN}, {}, {"toe_right": 0.1}),
        ({"toe": WITHIN}, {"toe": WITHIN}, {"toe_right": 0.1}),
        ({"toe": WITHIN}, {"toe": OTHER}, {"toe_left": 0.1, "toe_right": 0.2}),
        # of which the wheels have the same with the other sign
        ({"steer": WITHIN}, {}, {"steer_left": 0.1}),
        ({"roll_camber": WITHIN}, {}, {"roll_camber_left": 0.1}),
    ],
)
def test_wheels_with_one_curve_have_one_page(left, right, shown):
    targets = {f"{name}_{side}": table for side, of in (("left", left), ("right", right))
               for name, table in of.items()}  # fmt: skip
    goals = variation.goals({"targets": targets}, OF_AXLES)
    axle = Axle.load("reference_axle")
    found = of_shown_side(axle, goals, "right")
    assert [goal.name for goal in found] == [*shown]
    factors = [goal.quantity.attributes()["display_factor"] for goal in found]
    assert [f * g.within for f, g in zip(factors, found, strict=True)] == pytest.approx(
        [*shown.values()]
    )
    unlike = Axle.from_dict({"axle": "front", "left": axle.left, "right": axle.right})
    assert of_shown_side(unlike, goals, "right") == goals


def test_a_wheel_of_an_axle_moves_as_by_itself():
    """Goals of a wheel in parallel travel are those of the curve on its page."""
    axle = Axle.load("reference_axle")
    travels = np.linspace(-0.06, 0.06, 5)
    together = flat(characteristics.over(axle, "bump", travels))
    for side in axle.sides:
        alone = characteristics.over(axle.models[side], "travel", travels)
        shared = [str(name) for name in alone if f"{name}_{side}" in together]
        assert len(shared) > 20
        for name in shared:
            np.testing.assert_allclose(
                alone[name], together[f"{name}_{side}"], rtol=1e-9, atol=1e-12, err_msg=name
            )


def test_goals_that_nothing_reaches_are_refused_in_words(refused):
    """And at once: curves go on as far as goals, in steps of some millimetres."""
    axle = Axle.load("reference_axle")
    far = {"camber_left": {"at_mm": [0, 1e15], "value": 0.0, "within": 0.3}}
    refused(
        PositionError,
        lambda: kintrafo.report.axle_chapter(axle, variation.goals({"targets": far}, OF_AXLES)),
    )


def test_goals_of_a_report_have_a_door(tmp_path, refused):
    path = tmp_path / "a.html"
    for wrong in (None, 3, [3], "toe", {"toe": 1}):
        with refused(InputError):
            kintrafo.report.write(CAR, path, goals=wrong)
    refused(
        InputError,
        lambda: kintrafo.report.write(System(four_bar), path, goals=variation.goals(DESCRIBED)),
    )
