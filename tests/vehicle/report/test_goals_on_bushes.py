"""Targets and limits in the curves of a chapter on bushes: those about them, and no others."""

import re
from base64 import b64decode
from pathlib import Path

import pytest
import xarray as xr
from kintrafo import Axle, InputError, Model, RigidAxle, characteristics, compliance, variation
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.report import elastokinematics_chapter
from kintrafo.vehicle.studies.sweep_axes import SWEEP_AXES

pytestmark = pytest.mark.usefixtures("rough_drawings")
CAR, AXLE, RIGID = Model("reference_car"), Axle.load("reference_axle"), RigidAxle.load("rigid_axle")
SOFT = {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}
BUSHES = {"arm_rear": SOFT}
OF_RODS = {f"{side}_link_chassis": SOFT for side in ("left", "right")}
AT = [-0.02, 0.0, 0.02]
OF_AXLES = ("bump", "roll", "left", "right")
TOE = {"value": 0.0, "within": 0.05}


def wanted(ways, **targets):
    return variation.goals({"targets": targets}, ways)


def marks(chapter):
    """Return how many targets each picture names in its legend."""
    svgs = [b64decode(p.source.partition("base64,")[2]).decode() for p in chapter.pictures]
    return [len(re.findall(r">target<", svg)) for svg in svgs]


FOUND = {
    "a corner": (lambda: compliance.elastokinematics(CAR, BUSHES, along=AT), "travel", CAR),
    "an axle in bump": (
        lambda: compliance.elastokinematics(AXLE, BUSHES, "bump", AT),
        "bump",
        AXLE,
    ),
    "one wheel": (lambda: compliance.elastokinematics(AXLE, BUSHES, "left", AT), "left", AXLE),
    "a rigid axle in roll": (
        lambda: compliance.elastokinematics(RIGID, OF_RODS, "roll", AT),
        "roll",
        RIGID,
    ),
}


@pytest.mark.parametrize("name", [name for name in FOUND if name != "an axle in bump"])
def test_goals_are_drawn_where_the_curves_go(name):
    """Those over something else that has the same axis are not."""
    make, over, _ = FOUND[name]
    dataset = make()
    assert dataset.attrs["over"] == over
    ways = ("travel",) if over == "travel" else OF_AXLES
    toe = "toe" if over == "travel" else "toe_left"
    key = "at_deg" if over == "roll" else "at_mm"
    own = wanted(ways, **{toe: TOE | {key: 0.0, "over": over}})
    drawn = elastokinematics_chapter(dataset, goals=own)
    assert marks(drawn)[0] == 1
    assert "with rigid joints" in drawn.words[-1]
    others = [way for way in OF_AXLES if way != over] if over != "travel" else []
    foreign = [goal for way in others for goal in wanted(ways, **{toe: TOE | {"over": way}})]
    assert elastokinematics_chapter(dataset, goals=foreign) == elastokinematics_chapter(dataset)


@pytest.mark.parametrize("name", ["a corner", "an axle in bump"])
def test_what_can_be_wanted_of_curves_is_what_they_are(name):
    """The curves with rigid joints are those that goals are judged by, where words are the same."""
    make, over, subject = FOUND[name]
    found = flat(make()).sel(data_set="kinematic")
    of_model = flat(characteristics.over(subject, over, AT))
    known = SWEEP_AXES[over].known
    same = [n for n in map(str, found) if n in known and words(found[n]) == known[n].long_name]
    assert len(same) >= 4
    for curve in same:
        # of an angle or a length, to rounding of another order of operations
        xr.testing.assert_allclose(
            found[curve].drop_vars("data_set"), of_model[curve], rtol=1e-9, atol=1e-12
        )


def words(data):
    return str(data.attrs["long_name"])


def test_a_wheel_rate_at_the_contact_is_another():
    dataset = FOUND["a corner"][0]()
    rate = variation.goals({"limits": {"wheel_rate": {"at_mm": 0.0, "least": 20.0}}})
    assert elastokinematics_chapter(dataset, goals=rate) == elastokinematics_chapter(dataset)


def test_goals_about_a_turned_rack_are_refused(refused):
    turned = compliance.elastokinematics(CAR, BUSHES, along=AT, rack_position=0.01)
    toe = wanted(("travel",), toe=TOE)
    refused(InputError, lambda: elastokinematics_chapter(turned, goals=toe))
    assert elastokinematics_chapter(turned).tables
    both = compliance.elastokinematics(AXLE, BUSHES, "bump", AT, rack_position=-0.01)
    refused(
        InputError, lambda: elastokinematics_chapter(both, goals=wanted(OF_AXLES, toe_left=TOE))
    )
    del turned.attrs["over"]
    refused(
        InputError,
        lambda: elastokinematics_chapter(turned, goals=toe),
        lambda: elastokinematics_chapter(turned, goals=["toe"]),
    )


@pytest.mark.usefixtures("coarse_report", "one_picture")
def test_a_report_has_them(kintrafo, monkeypatch):
    seen = []
    whole = elastokinematics_chapter

    def watched(*found, goals):
        seen.append((found, goals))
        return whole(*found, goals=goals)

    monkeypatch.setattr("kintrafo.report.elastokinematics_chapter", watched)
    toe = "[targets.toe]\nat_mm = [0, 100]\nvalue = 0.0\nwithin = 0.05\n"
    soft = "[bushings.arm_rear]\naxial_N_per_mm = 500.0\nradial_N_per_mm = 2000.0\n"
    Path("g.toml").write_text(toe, encoding="utf-8")
    Path("b.toml").write_text(soft, encoding="utf-8")
    report = ["report", "reference_car", "--bushes", "b.toml", "--goals", "g.toml"]
    code, _, err = kintrafo(*report)
    assert code == 0, err
    (((found,), goals),) = seen
    assert [goal.name for goal in goals] == ["toe"]
    # as far as they are about
    assert float(found["wheel_travel"].max()) == pytest.approx(0.1, rel=1e-12)
