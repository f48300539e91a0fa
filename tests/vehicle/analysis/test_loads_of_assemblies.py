"""Loads of corners, axles and rigid axles: what holds for every assembly."""

import kintrafo
import numpy as np
import pytest
from cars.axles import AXLE, BENT
from cars.rigid_axles import AXLES as RIGID
from kintrafo import Axle, InputError, Model, PositionError, RigidAxle, Suspension, loads
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.data.starter import whole_axles
from oracle.load_cards import wrench

KINDS = ("reference_car", "offset_strut_car", "double_wishbone_car", "push_rod_car",
         "pull_rod_car", "multi_link_car", "trailing_arm_car")  # fmt: skip
CORNERS = {name: Model(name) for name in KINDS}
AXLES = {
    "without a bar": Axle.from_dict({"axle": "front", "side": Suspension.load("reference_car")}),
    "with a bar": AXLE,
    "uneven, bent": BENT,
    "multi-link": Axle.from_dict({"axle": "rear", "side": Suspension.load("multi_link_car")}),
}
WHOLE = {name: kintrafo.load(name) for name in whole_axles()}
EVERY = {**CORNERS, **AXLES, **RIGID, **WHOLE}
SHORT = {"corner": CORNERS["reference_car"], "axle": AXLE, "rigid": RIGID["lopsided"]}
each = pytest.mark.parametrize("subject", EVERY.values(), ids=EVERY)

# Forces and moments at both places of the wheels, all of them different.
LEFT = {"contact_N": [-1500.0, 700.0, 3900.0], "contact_Nm": [20.0, 5.0, -60.0]}
RIGHT = {
    "contact_N": [300.0, 1900.0, 5200.0],
    "center_N": [600.0, -50.0, 80.0],
    "center_Nm": [10.0, -90.0, 30.0],
}
HELD = {"travel_mm": 12.0, "contact_N": [800.0, -500.0, 0.0]}


def steered(subject):
    """Return whether there is a rack."""
    return assembly_of(subject).steered


def cases_of(subject):
    """Return cases with free wheels, with held ones, and with one of each."""
    rack = {"rack_mm": 8.0} if steered(subject) else {}
    if isinstance(subject, Model):
        return {"held": HELD | {"center_N": [-300.0, 20.0, 10.0]} | rack}
    return {
        "pushed": {"left": LEFT, "right": RIGHT} | rack,
        "one_held": {"left": HELD, "right": RIGHT} | rack,
        "held": {"travel_mm": -20.0, "contact_N": [0.0, 1000.0, 0.0]},
    }


@each
def test_every_part_is_in_equilibrium(subject):
    """By all loads that are listed; the chassis has what acts from outside."""
    found = loads.static(subject, cases_of(subject))
    assert not found["reason"].values.any()
    by = found["by"].str.split(dim="word", sep="_").isel(word=0)
    outside = wrench(found.isel(load=by.isin(["road", "drive", "gravity"]).values))
    for part in np.unique(found["part"].values):
        own = wrench(found.isel(load=(found["part"] == part).values))
        # sums of some tens of terms of 1e4 N and, about the origin, 1e4 N m
        expected = outside if part == "chassis" else np.zeros_like(own)
        np.testing.assert_allclose(own, expected, atol=1e-7, err_msg=str(part))
    for name in ("residual", "residual_moment", "holding_force"):
        assert float(abs(found[name]).max()) < 1e-7, name


@each
def test_a_case_alone_is_carried_as_among_others(subject):
    """Also where no wheel is free, so that no case is left for the search of an equilibrium."""
    every = cases_of(subject)
    together = loads.static(subject, every)
    for name, case in every.items():
        alone = loads.static(subject, {name: case})
        chosen = together.sel(case=[name])
        for quantity in ("force", "moment", "travel"):
            size = float(np.nanmax(np.abs(chosen[quantity])))
            np.testing.assert_allclose(
                alone[quantity].values, chosen[quantity].values, rtol=0.0, atol=1e-9 * size
            )


@each
def test_what_two_parts_exert_on_each_other_is_there_twice(subject):
    found = loads.static(subject, cases_of(subject))
    names = {str(name) for name in found["load"].values}
    parts = {str(name) for name in found["part"].values} - {"chassis"}
    for part, point, by in zip(*(found[key].values for key in ("part", "point", "by")),
                               strict=True):  # fmt: skip
        if by not in parts:
            continue
        one, back = f"{part} at {point} by {by}", f"{by} at {point} by {part}"
        assert back in names
        for name in ("force", "moment"):
            pair = (found[name].sel(load=load).values for load in (one, back))
            np.testing.assert_array_equal(next(pair), -next(pair))


@each
def test_mounts_carry_together_what_the_chassis_does(subject):
    """But for the couple of a rigid axle's bar, which has no place on the body."""
    found = loads.static(subject, cases_of(subject))
    assert "axle_middle" not in found["mount"].values
    force, moment, at = (found[f"total_{name}"].values for name in ("force", "moment", "at"))
    together = np.concatenate([force.sum(1), (moment + np.cross(at, force)).sum(1)], axis=-1)
    own = (found["part"] == "chassis") & (found["by"] != "bar")
    np.testing.assert_allclose(together, wrench(found.isel(load=own.values)), atol=1e-7)


def other(name):
    """Return a name with its sides exchanged."""
    return name.replace("left", "?").replace("right", "left").replace("?", "right")


def image_of(subject):
    """Return the mirror image of an assembly whose sides are alike but for its rods."""
    if not isinstance(subject, RigidAxle):
        return subject.mirror_image if isinstance(subject, Model) else subject
    rods = {
        other(rod): {end: [x, -y, z] for end, (x, y, z) in ends.items()}
        for rod, ends in subject.to_dict()["rods"].items()
    }
    return RigidAxle.from_dict(subject.to_dict() | {"rods": rods})


def mirrored(case):
    """Return the mirror image of what a case says of a wheel."""
    signs = {"N": [1.0, -1.0, 1.0], "Nm": [-1.0, 1.0, -1.0]}
    return {
        key: np.multiply(value, signs[key.rpartition("_")[2]]).tolist()
        for key, value in case.items()
    }


EVEN = {"corner": CORNERS["double_wishbone_car"], "axle": AXLE} | {
    name: axle for name, axle in RIGID.items() if name != "lopsided"
}


@pytest.mark.parametrize("subject", EVEN.values(), ids=EVEN)
def test_the_mirror_image_of_a_case_is_carried_alike(subject):
    case, image = LEFT, mirrored(LEFT)
    if not isinstance(subject, Model):
        case = {"left": LEFT, "right": RIGHT}
        image = {"left": mirrored(RIGHT), "right": mirrored(LEFT)}
    here, there = loads.static(subject, {"a": case}), loads.static(image_of(subject), {"a": image})
    for name in ("travel", "wheel_load"):
        np.testing.assert_allclose(here[name].values, there[name].values[::-1], rtol=1e-9)
    names = [str(name) for name in here["load"].values]
    assert {*names} == {other(str(name)) for name in there["load"].values}
    for data, signs in (("force", [1.0, -1.0, 1.0]), ("moment", [-1.0, 1.0, -1.0])):
        ours, theirs = here[data].sel(load=names), there[data].sel(load=[*map(other, names)])
        # forces of 1e4 N; what is missing in the equilibrium is some 1e-7 N
        np.testing.assert_allclose(ours, theirs * signs, atol=1e-5)


# -- errors ---------------------------------------------------------------------------------------

WRONG = [
    {},
    3,
    {"a": 3},
    {"a b": {"contact_N": [0, 0, 1]}},
    {"../a": {"contact_g": [0, 0, 1]}},
    {1: {"contact_g": [0, 0, 1]}, "1": {"contact_g": [0, 0, 1]}},
    {"a": {"contact": [0, 0, 1]}},
    {"a": {"contact_N": [0, 1]}},
    {"a": {"contact_N": [0, np.nan, 1]}},
    {"a": {"contact_N": [0, 0, -1]}},
    {"a": {"contact_N": [0, 0, 1e12]}},
    {"a": {"contact_N": [0, 0, 1], "travel_mm": 3.0}},
    {"a": {"travel_mm": "far"}},
]
WRONG_OF_SIDES = [
    {"left": 3},
    {"contact_N": [0, 0, 1], "left": {"contact_N": [0, 0, 1]}},
    {"left": {"contact_K": [0, 0, 1]}},
    {"rigth": {"contact_N": [0, 0, 1]}},
    {"travel_mm": 1.0, "left": {"contact_N": [0, 0, 1]}},
    {"left": {"rack_mm": 3.0}},
]
WRONG_OF = {
    "corner": [{"left": {"contact_N": [0, 0, 1]}}],
    "axle": WRONG_OF_SIDES,
    "rigid": [*WRONG_OF_SIDES, {"rack_mm": 3.0}],
}


@pytest.mark.parametrize("name", SHORT)
def test_cases_that_cannot_be_used(name, refused):
    for cases in [*WRONG, *({"a": case} for case in WRONG_OF[name])]:
        with refused(InputError):
            loads.static(SHORT[name], cases, static_load=6000.0)


FAR, RIGHT_UP = {"travel_mm": 900.0}, {"travel_mm": 0.0, "right": {"center_N": [0, 0, 9e3]}}
HEAVY = {"contact_N": [0.0, 0.0, 9e5]}
BEYOND = {
    "corner": [FAR, {"rack_mm": 900.0}, HEAVY, {"travel_mm": 0.0, "center_N": [0, 0, 9e3]}],
    "axle": [{"left": FAR}, {"rack_mm": 900.0}, HEAVY, RIGHT_UP],
    "rigid": [FAR, {"travel_mm": 1e8}, HEAVY, RIGHT_UP],
    "level": [{"center_N": [0.0, 0.0, -90e3]}],
}


LEVEL = {"level": next(iter(RIGID.values()))}


@pytest.mark.parametrize("name", BEYOND)
def test_a_case_that_is_not_carried_ends_no_other(name, refused):
    subject = (SHORT | LEVEL)[name]
    for case in BEYOND[name]:
        with refused(PositionError) as caught:
            loads.static(subject, {"a": case})
        found = loads.static(subject, {"still": {"contact_g": [0.0, 0.0, 1.0]}, "a": case})
        assert str(found["reason"].sel(case="still").values) == ""
        assert str(found["reason"].sel(case="a").values) in str(caught.value)
        assert found.attrs["message"] == "1 of 2 cases have an equilibrium"
        lost = found.sel(case="a").drop_vars(["reason", "total_by"])
        assert not any(np.isfinite(lost[key]).any() for key in lost if "case" in found[key].dims)


# An axle whose engine is on the body, and one that carries it; the torque held elsewhere.
AT_THE_WHEEL = {"contact_g": [0.5, 0.0, 0.9]}
ON_THE_BODY = {"contact_g": [0.0, 0.0, 0.9], "center_g": [0.5, 0.0, 0.0]}


@pytest.mark.parametrize(
    ("axle", "drive", "other", "moved"),
    [
        (AXLE, ON_THE_BODY, "carrier", AT_THE_WHEEL),
        (RIGID["lopsided"], AT_THE_WHEEL, "body", ON_THE_BODY),
    ],
    ids=["axle", "rigid"],
)
def test_usual_cases_of_an_axle_act_where_its_file_holds_the_torque(axle, drive, other, moved):
    usual = loads.standard_cases(axle)
    assert usual["brake"] == {"contact_g": [-1.3, 0.0, 1.3]}
    assert usual["drive"] == drive
    inboard = loads.standard_cases(axle.with_changes({"brakes.torque_on": "body"}))
    assert inboard["brake"] == {"contact_g": [0.0, 0.0, 1.3], "center_g": [-1.3, 0.0, 0.0]}
    assert inboard["corner"] == usual["corner"]
    assert inboard["trail_brake"]["right"]["center_g"] == [-0.9, 0.0, 0.0]
    elsewhere = loads.standard_cases(axle.with_changes({"drive.torque_on": other}))
    assert elsewhere["drive"] == moved
    assert [*inboard, *elsewhere] == [*usual, *usual]
    undriven = loads.standard_cases(axle.with_changes({"drive": None}))
    assert [*undriven] == [name for name in usual if name != "drive"]


@pytest.mark.parametrize("subject", SHORT.values(), ids=SHORT)
def test_arguments_that_cannot_be_used(subject, refused):
    for load in (0.0, -3.0, np.inf, "much"):
        with refused(InputError):
            loads.static(subject, static_load=load)
    for function in (loads.static, loads.standard_cases):
        with refused(InputError):
            function("rigid_axle")
    refused(InputError, lambda: loads.along(Suspension.load("reference_car"), 3))


def test_dead_points_are_named(monkeypatch, refused):
    """As if all equations were at one."""
    monkeypatch.setattr("kintrafo.vehicle.analysis.loads.balance._WORST_CONDITION", 1.0)
    for subject in SHORT.values():
        for case in ({"contact_N": [0.0, 0.0, 6000.0]}, {"travel_mm": 0.0}):
            with refused(PositionError):
                loads.static(subject, {"a": case})


STIFFER = {"strut.spring_rate_N_per_m": 60e3}
OTHERS = {
    "stiffer corner": ("corner", Model(CORNERS["reference_car"].suspension.with_changes(STIFFER))),
    "other side": ("corner", Model(CORNERS["reference_car"].suspension.mirrored())),
    "axle": ("axle", BENT),
    "rigid": ("rigid", RIGID["triangulated"]),
}


@pytest.mark.parametrize(("name", "other"), OTHERS.values(), ids=OTHERS)
def test_a_motion_of_another_is_refused(name, other, refused):
    model, another = (
        of if isinstance(of, Model) else kintrafo.model_of(of) for of in (SHORT[name], other)
    )
    motion = kintrafo.simulate(model, (0.0, 0.01), kintrafo.equilibrium(model))
    refused(InputError, lambda: loads.along(another, motion))


@pytest.mark.parametrize(
    ("file", "part", "shown", "load"),
    [
        ("reference_axle", "rack,knuckle_left", "steering",
         "anti_roll_bar at bar_bush_left by chassis"),
        ("rigid_axle", "beam", "panhard_rod", "beam at panhard_rod_axle by panhard_rod"),
    ],
)  # fmt: skip
def test_the_command_prints_both_sides(request, tmp_path, file, part, shown, load):
    forces = {"left": "[0, 0.5, 0.7]", "right": "[0, 1, 1.3]"}
    text = "".join(f"[cases.turn.{side}]\ncontact_g = {g}\n" for side, g in forces.items())
    (tmp_path / "cases.toml").write_text(text, encoding="utf-8")
    line = f"loads {file} --cases cases.toml --case turn --part {part}"
    # a fixture has the name of the package
    command = request.getfixturevalue("kintrafo")
    code, out, err = command(*f"{line} -o loads.csv --plot bodies.png".split())
    assert code == 0, err
    assert all(word in out for word in (shown, *part.split(",")[1:]))
    assert f"{load},turn" in (tmp_path / "loads.csv").read_text(encoding="utf-8")
    assert (tmp_path / "bodies_turn.png").stat().st_size > 1000
