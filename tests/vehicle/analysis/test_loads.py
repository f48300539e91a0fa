"""Loads on parts: against multipliers, the compiled equations of motion, and statics by hand."""

import csv
import math
import re
from contextlib import suppress

import numpy as np
import pytest
from cars.axles import AXLE, BENT
from cars.instants import Instant
from cars.rigid_axles import AXLES as RIGID
from kintrafo import (
    Axle,
    InputError,
    Model,
    PositionError,
    Suspension,
    arm_angles,
    equilibrium,
    load,
    loads,
    model_of,
    roads,
    simulate,
)
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.analysis.loads.along import in_motion
from kintrafo.vehicle.assembly.corner import CornerAssembly
from kintrafo.vehicle.models.positions import design_height
from kintrafo.vehicle.models.reach import at_rest
from oracle.constraints import ARM, BODIES, KNUCKLE, RACK, TIE_ROD, UPPER_STRUT, WHEEL
from oracle.newton import Mechanism

CAR = Suspension.load("reference_car")
WISHBONES = Suspension.load("double_wishbone_car")
OFFSET = Suspension.load("offset_strut_car")
PUSHED = Suspension.load("push_rod_car")
LINKED = Suspension.load("multi_link_car")
TRAILING = Suspension.load("trailing_arm_car")
PULLED = Suspension.load("pull_rod_car")
STOPPED = CAR.with_changes(
    {
        "bump_stop": {"clearance_mm": 40.0, "rate_N_per_m": 2e5},
        "rebound_stop": {"clearance_mm": 60.0, "rate_N_per_m": 2e5},
    }
)
STILL = {"static": {"contact_g": [0.0, 0.0, 1.0]}}


def heavy(suspension):
    """Return a suspension all of whose parts have mass, beside every axis."""
    changes = {}
    for i, body in enumerate(("tie_rod", "upper_strut", "rack")):
        center = {"tie_rod": [-120.0, -510.0, 255.0], "upper_strut": [-15.0, -600.0, 770.0]}
        changes[f"bodies.{body}.mass_kg"] = 1.0 + i
        changes[f"bodies.{body}.com_mm"] = center.get(body, [-140.0, -300.0, 280.0])
        for element, value in {"xx": 0.02, "yy": 0.015, "zz": 0.012, "xy": 0.002}.items():
            changes[f"bodies.{body}.inertia_{element}_kg_m2"] = value
    return suspension.with_changes(changes)


def total(found, part, by, about):
    """Return force and moment about a point that one part exerts on another."""
    chosen = found.isel(load=((found["part"] == part) & (found["by"] == by)).values)
    force, moment = chosen["force"].values[0], chosen["moment"].values[0]
    arms = chosen["at"].values[0] - about
    return np.concatenate([force.sum(0), (moment + np.cross(arms, force)).sum(0)])


# -- what moves ---------------------------------------------------------------------------------


@pytest.mark.parametrize("free", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_loads_of_the_joints_are_the_multipliers(seed, free):
    """Newton and Euler in closed form against maximal coordinates, in any motion."""
    random = np.random.default_rng(seed)
    model = Model(heavy(OFFSET) if free else OFFSET, free_rack=free)
    names = ("beta1", "spin", "rack", "beta1_rate", "spin_rate", "rack_rate", "rack_acceleration",
             "road_height", "strut_force", "rack_force")  # fmt: skip
    sizes = (0.05, 1.0, 0.02, 2.0, 60.0, 0.3, 5.0, 0.01, 300.0, 500.0)
    values = dict(zip(names, random.uniform(-1.0, 1.0, len(names)) * sizes, strict=True))
    values["beta1"] += model.design_state[0]
    if free:
        values["rack_acceleration"] = 0.0
    instant = Instant(**values)
    state, inputs = instant.arrays(model.equations)
    found = in_motion(CornerAssembly(model), state[None], inputs[None])
    oracle = Mechanism(dict(model.parameters))
    pose = instant.pose(oracle)
    solved = instant.solution(model.equations, oracle)
    _, rows = oracle.joints.evaluate(pose)
    count = rows.shape[0]
    bodies = np.concatenate(
        [np.repeat(oracle.joints.point_bodies, 3, axis=0), oracle.joints.angle_bodies,
         oracle.joints.plane_bodies]
    )  # fmt: skip
    largest = abs(found["force"].values).max()
    pairs = [(0, ARM), (ARM, KNUCKLE), (KNUCKLE, UPPER_STRUT), (0, UPPER_STRUT),
             (KNUCKLE, TIE_ROD), (RACK, TIE_ROD), (KNUCKLE, WHEEL)]  # fmt: skip

    def multipliers(first, second):
        own = (bodies == (first, second)).all(axis=1)
        wrench = -(rows[own].T @ solved.multipliers[:count][own]).reshape(6, 6)
        return wrench[second - 1]

    for first, second in pairs:
        wrench, part = multipliers(first, second), BODIES[second - 1]
        by = "chassis" if first == 0 else BODIES[first - 1]
        ours = total(found, part, by, pose.position[second - 1])
        np.testing.assert_allclose(ours, wrench, rtol=0.0, atol=1e-9 * largest)
    guide, steering = (
        total(found, "rack", by, pose.position[RACK - 1]) for by in ("chassis", "steering")
    )
    wrench = multipliers(0, RACK)
    if free:
        # there the steering pushes at the centre of mass
        axis = np.array([model.parameters[f"rack_axis_{c}"] for c in "xyz"])
        wrench[:3] += values["rack_force"] * axis
        guide += steering
    np.testing.assert_allclose(guide, wrench, rtol=0.0, atol=1e-9 * largest)


EVERY = (CAR, OFFSET, WISHBONES, PUSHED, PULLED, LINKED, TRAILING)


@pytest.mark.parametrize("car", EVERY, ids=lambda car: car.TITLE)
def test_a_mount_carries_the_total_of_what_is_bolted_there(car):
    found = loads.static(Model(car), STILL | {"held": {"travel_mm": 15.0}})
    names = [str(name) for name in found["mount"].values]
    own = found.isel(load=(found["part"] == "chassis").values)
    points = car.hardpoints.at_design()
    for name, by in zip(names, found["total_by"].values, strict=True):
        at = found["total_at"].sel(mount=name).values
        here = [n for n in own["point"].values if np.allclose(points.get(n, at[0]), at[0])]
        if name == "strut_top":
            here = ["strut_top", "spring_top"]
        chosen = own.isel(load=own["point"].isin(here).values)
        if name != "rack_guide":
            chosen = chosen.isel(load=(chosen["point"] != "rack_guide").values)
        force = chosen["force"].values
        arms = chosen["at"].values - at[:, None]
        moment = (chosen["moment"].values + np.cross(arms, force)).sum(1)
        np.testing.assert_allclose(found["total_force"].sel(mount=name), force.sum(1), atol=1e-9)
        np.testing.assert_allclose(found["total_moment"].sel(mount=name), moment, atol=1e-9)
        assert set(str(by).split(", ")) == set(chosen["by"].values)
    whole = found["total_force"].sum("mount")
    np.testing.assert_allclose(whole, own["force"].sum("load"), atol=1e-8)
    rows = loads.table(found)
    totals = rows.isel(load=(rows["part"] == "total").values)
    assert [str(point) for point in totals["point"].values] == names
    np.testing.assert_array_equal(totals["force_z"], found["total_force"].sel(axis="z"))


def test_the_top_of_a_strut_has_the_spring_in_its_total(kintrafo, tmp_path):
    """At rest the body carries the wheel less what hangs on it: nearly all at the mount."""
    out = tmp_path / "loads.csv"
    status, shown, _ = kintrafo(*f"loads reference_car --out {out}".split())
    assert status == 0
    assert "strut_top, total" in shown
    text = next(t for t in out.read_text().splitlines() if '"upper_strut, spring"' in t)
    assert text.startswith('"total at strut_top by upper_strut, spring",static')
    assert ",total," in text
    force = loads.static(Model(CAR), STILL)["total_force"].sel(mount="strut_top", axis="z")
    assert float(force[0]) == pytest.approx(3487.0, abs=1.0)


@pytest.mark.parametrize("car", EVERY, ids=lambda car: car.TITLE)
def test_joints_do_no_work(car):
    """In any motion, the forces of a joint on its two parts have no power in sum."""
    model = Model(car)
    random = np.random.default_rng(3)
    states = np.tile(model.design_state, (6, 1)) + random.uniform(-0.1, 0.1, (6, 4))
    states[:, 2:] = random.uniform(-3.0, 3.0, (6, 2))
    inputs = np.zeros((6, len(model.input_names)))
    inputs[:, :3] = random.uniform(-0.02, 0.02, (6, 3))
    found = in_motion(CornerAssembly(model), states, inputs)
    bodies = model.equations.BODIES
    twists = model.evaluate("velocities", states, inputs)
    centers = model.evaluate("positions", states, inputs)
    powers = {}
    for i, (part, by) in enumerate(zip(found["part"].values, found["by"].values, strict=True)):
        acting = ("gravity", "inertia", "spring", "damper", "road", "steering")
        if by in acting or part == "chassis":
            continue
        which = bodies.index(part)
        at = found["at"].values[:, i] - centers[:, which]
        speed = twists[:, which, 3:] + np.cross(twists[:, which, :3], at)
        power = (found["force"].values[:, i] * speed).sum(-1)
        power += (found["moment"].values[:, i] * twists[:, which, :3]).sum(-1)
        pair = frozenset((part, by))
        powers[pair] = powers.get(pair, 0.0) + power
    # and the guide of the rack
    assert len(powers) == len(car.structure().joints) + car.steered()
    for pair, power in powers.items():
        # newtons times metres a second, of some 10 kN and 1 m/s
        assert abs(power).max() < 1e-8, pair


MOVING = {
    "strut": Model(CAR), "wishbones": Model(WISHBONES), "push rod": Model(PUSHED),
    "stops": Model(STOPPED), "heavy steering": Model(heavy(CAR), free_rack=True), "axle": AXLE,
    "rigid axle": RIGID["lopsided"].with_changes({"damper.friction_N": 60.0}),
    "twist beam": load("twist_beam"), "steered rigid axle": load("steered_rigid_axle"),
}  # fmt: skip


@pytest.mark.parametrize("subject", MOVING.values(), ids=MOVING)
def test_motions_need_no_other_force(subject):
    """The compiled equations and the balance of every part agree: nothing is left to hold."""
    alone = isinstance(subject, Model)
    if not alone and find_compiler() is None:
        pytest.skip("no C compiler")
    model = subject if alone else model_of(subject)
    bump = roads.step(0.05 if alone else 0.03, at=0.02, end=0.3)
    rest = equilibrium(model, spin_rate=50.0)
    road = {"road_height" if alone else "left_road_height": bump}
    motion = simulate(model, (0.0, 0.3 if alone else 0.1), rest, inputs=road)
    found = loads.along(model, motion)
    assert found.sizes["time"] == motion.t.size
    largest = float(abs(found["force"]).max())
    assert largest > 5e3
    # rates of velocities by differences are right to some 1e-11
    for name in ("holding_force", "residual", "residual_moment"):
        assert float(abs(found[name]).max()) < 1e-9 * largest, name
    # without a brake the bearing of a wheel carries nothing about its axis
    bearing = re.compile(r"wheel\w* at wheel_center\w* by (?!road)")
    bearings = [name for name in map(str, found["load"].values) if bearing.match(name)]
    assert len(bearings) == (1 if alone else 2)
    for name in bearings:
        side = "left" if name.startswith("wheel_left") else "right"
        file = model.suspension if alone else subject
        part = file.sides[side] if isinstance(file, Axle) else file
        axis = part.wheel.spin_axis(1.0 if side == "left" else -1.0)
        moment = found["moment_in_part"].sel(load=name).values
        assert np.abs(moment @ axis).max() < 1e-9 * largest, name
    # that of a beam is about its coordinate, the turn of one half
    if "bar_spring_moment" in motion.signals:
        moment = motion.signals["bar_spring_moment"]
        np.testing.assert_allclose(found["bar_torque"], -moment, atol=1e-8)
        assert float(abs(found["bar_torque"]).max()) > 10.0


# -- load cases ---------------------------------------------------------------------------------


RESTING = {
    **{car.TITLE: (Model(car), 1e-3, 1e-3) for car in EVERY},
    "bent axle": (BENT, None, 1e-3),
    # inclined by the rounding of its file, some 2e-5
    "rigid axle": (load("rigid_axle"), 1e-5, 1e-9),
}


@pytest.mark.parametrize(("subject", "far", "apart"), RESTING.values(), ids=RESTING)
def test_at_rest_positions_and_loads_are_those_of_the_equations(subject, far, apart):
    """The tyre pushes in the plane of the wheel, which is inclined by camber and toe."""
    alone = isinstance(subject, Model)
    if not alone and find_compiler() is None:
        pytest.skip("no C compiler")
    model = subject if alone else model_of(subject)
    found, rest = loads.static(subject, STILL).sel(case="static"), equilibrium(model)
    for side in ("right",) if alone else ("left", "right"):
        here = found if alone else found.sel(wheel=side)
        name = "" if alone else f"{side}_{getattr(subject, 'end', 'axle')}_"
        name = name if f"{name}tyre_force" in model.signal_names else f"{side}_axle_"
        force = float(model.signal(f"{name}tyre_force", rest))
        assert float(here["wheel_load"]) == pytest.approx(force, rel=apart)
        if far:
            height = float(model.signal(f"{name}wheel_center_z", rest))
            design = design_height(model) if alone else subject.center[2]
            assert float(here["travel"]) == pytest.approx(height - design, abs=far)
        assert abs(float(here["holding_force"])) < 1e-8
    assert float(found["residual"].max()) < 1e-8


def state_of(model, travel, rack):
    """Return state and inputs of a position at rest."""
    return at_rest(model, arm_angles(model, design_height(model) + travel, rack), rack)


def test_a_wheel_held_at_a_travel_takes_the_load_that_presses_it_there():
    model = Model(CAR)
    pressed = loads.static(model, {"a": {"contact_N": [-500.0, 300.0, 4400.0]}})
    travel = 1e3 * float(pressed["travel"][0])
    held = loads.static(model, {"a": {"contact_N": [-500.0, 300.0, 0.0], "travel_mm": travel}})
    assert float(held["wheel_load"][0]) == pytest.approx(4400.0, rel=1e-9)
    # forces of 10 kN; the travel is passed on in millimetres
    np.testing.assert_allclose(held["force"], pressed["force"], atol=1e-6)


def test_forces_have_the_axes_of_the_tyre():
    """A steered wheel is braked along its own plane."""
    model = Model(CAR)
    found = loads.static(model, {"a": {"contact_N": [-1000.0, 0.0, 3800.0], "rack_mm": 40.0}})
    force = found["force"].sel(case="a", load="wheel at contact by road").values
    state = state_of(model, float(found["travel"][0]), 0.04)
    steer = float(model.signal("steer", *state))
    assert abs(steer) > 0.2
    assert math.atan2(-force[1], -force[0]) == pytest.approx(steer, abs=1e-12)
    bearing = found.sel(case="a", load="wheel at wheel_center by knuckle")
    axis = CAR.wheel.spin_axis(-1.0)
    # the brake holds the wheel: force times radius, but for the camber
    torque = abs(float(bearing["moment_in_part"].values @ axis))
    assert torque == pytest.approx(1000.0 * 0.3, rel=0.01)


def test_stops_carry_what_springs_do_not(refused):
    hard = {"bump_3g": {"contact_g": [0.0, 0.0, 3.0]}}
    stopped = loads.static(Model(STOPPED), hard)
    assert 0.04 < float(stopped["travel"][0]) < 0.1
    damper = stopped.sel(case="bump_3g", load="knuckle at strut_lower by damper")["force"].values
    assert np.linalg.norm(damper) > 4e3
    refused(PositionError, lambda: loads.static(Model(CAR), {"a": {"contact_N": [0.0, 0.0, 1e6]}}))
    some = loads.static(Model(CAR), STILL | {"a": {"contact_N": [0.0, 0.0, 1e6]}})
    assert some.attrs["message"] == "1 of 2 cases have an equilibrium"
    assert "Add a [bump_stop]" in str(some["reason"].values[1])
    with_stops = Model(STOPPED.with_changes({"bump_stop.rate_N_per_m": 3e4}))
    crushed = loads.static(with_stops, STILL | {"a": {"contact_N": [0.0, 0.0, 1e6]}})
    assert "Add a" not in str(crushed["reason"].values[1])
    assert np.isnan(some["force"].values[1]).all()


def test_what_is_carried_without_bound_is_not_carried(monkeypatch):
    """Cases whose equations are worse than others, as if they were at a dead point."""
    cases = {"brake": {"contact_g": [-1.0, 0.0, 1.0]}, "bump": {"contact_g": [0.0, 0.0, 3.0]}}
    model = Model(CAR)
    whole, shown = loads.static(model, cases), []
    for worst in np.geomspace(1e1, 1e6, 20):
        monkeypatch.setattr("kintrafo.vehicle.analysis.loads.balance._WORST_CONDITION", worst)
        with suppress(PositionError):  # none is carried
            found = loads.static(model, cases)
            carried = np.isfinite(found["force"]).all(dim=("load", "axis")).values
            shown.append(int(carried.sum()))
            assert ["dead point" in str(text) for text in found["reason"].values] == [*~carried]
            both = (found["force"].values[carried], whole["force"].values[carried])
            np.testing.assert_array_equal(*both)
    assert sorted(set(shown)) == [1, 2]


def test_a_spring_without_leverage_is_no_dead_point():
    """The forces in joints are finite where the leverage of the damper passes through zero."""
    odd = WISHBONES.with_changes({f"hardpoints.spring_top.{a}": v for a, v in
                                  zip("xyz", (-30.0, -500.0, 320.0), strict=True)})  # fmt: skip
    kerb = {"contact_g": [0.0, 1.5, 2.0]}
    found = loads.static(Model(odd), STILL | {"kerb": kerb}, static_load=3800.0)
    assert str(found["reason"].values[0]) == ""
    assert "there is no equilibrium" in str(found["reason"].values[1])


def test_couples_are_shown_without_a_force(kintrafo, tmp_path):
    (tmp_path / "c.toml").write_text(
        "[cases.couple]\ntravel_mm = 0\ncenter_Nm = [0, 400, 0]\n[cases.far]\n"
        "contact_N = [0, 0, 1e6]\n",
        encoding="utf-8",
    )
    code, out, _ = kintrafo("loads", "reference_car", "--cases", "c.toml", "--case", "couple",
                            "--part", "wheel", "-o", "c.csv")  # fmt: skip
    assert code == 1
    assert re.search(r"drive .* 400", out)
    # what has no number is none in the file either
    rows = [line.split(",") for line in (tmp_path / "c.csv").read_text().splitlines()]
    far = [row for row in rows if row[1] == "far"]
    assert far
    assert all(
        row[5:14] == [""] * 9 and "less than the upward load" in ",".join(row[14:]) for row in far
    )


@pytest.mark.parametrize("file", ["reference_car", "reference_axle", "rigid_axle"])
def test_totals_are_shown_alone(kintrafo, tmp_path, file, ends):
    arguments = ("loads", file, "--case", "static", "--part", "total")
    code, out, _ = kintrafo(*arguments, "-o", "a.csv", "--plot", "b.png", "--part", "wheel_left"
                            if "axle" in file else "wheel")  # fmt: skip
    assert code == 0
    lines = (tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()
    rows = [row for row in csv.reader(lines) if row[1:3] == ["static", "total"]]
    rows = [row for row in rows if any(map(float, row[5:11]))]
    assert rows
    for row in rows:
        forces = [str(round(float(value))).replace("-0", "0") for value in row[5:8]]
        assert re.search(rf"total, {re.escape(row[3])}, .*" + ".* ".join(forces), out)
    ends(2, *arguments, "--plot", "b.png")


def test_extremes_are_printed(kintrafo):
    code, out, _ = kintrafo("loads", "offset_strut_car", "--envelope", "--part", "knuckle")
    assert code == 0
    ends = loads.envelope(loads.static(Model(OFFSET)))
    end = ends.sel(load="knuckle at ball_joint by control_arm", axis="x")
    for name in ("min", "max"):
        words = rf"{end[f'force_{name}_case'].values} +{round(float(end[f'force_{name}']))}\b"
        assert re.search(words, out), words


def test_tables_need_all_of_it(refused):
    found = loads.static(Model(CAR), STILL)
    for wrong in (found[["force"]], loads.envelope(found)):
        for function in (loads.table, loads.envelope):
            with refused(InputError):
                function(wrong)


def test_envelope_names_the_cases():
    found = loads.static(Model(STOPPED))
    assert not found["reason"].values.any()
    ends = loads.envelope(found)
    values = found["force"].sel(load="control_arm at arm_front by chassis", axis="x")
    end = ends.sel(load="control_arm at arm_front by chassis", axis="x")
    assert float(end["force_max"]) == values.max()
    assert str(end["force_max_case"].values) == str(values["case"][values.values.argmax()].values)


def test_two_bearings_share_what_is_along_their_axis():
    found = loads.static(Model(CAR), {"a": {"contact_N": [-2000.0, 0.0, 3800.0]}}).sel(case="a")
    front, rear = (
        found["force"].sel(load=f"control_arm at {point} by chassis").values
        for point in ("arm_front", "arm_rear")
    )
    assert front[0] == pytest.approx(rear[0], rel=1e-12)  # the axis is that of the car
    assert "share the force along it equally" in found.attrs["rules"]


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("", 0),  # a usual case that nobody asked for is not carried: it is printed
        ("--case brake", 0),
        ("--case brake --case kerb", 1),
        ("--cases own.toml", 1),
        ("--cases own.toml --case good", 1),  # all of a file of one's own are asked for
        ("--cases bad.toml", 1),
    ],
)
def test_the_exit_code_is_about_the_cases_that_were_asked_for(kintrafo, tmp_path, words, code):
    bad = "[cases.bad]\ncontact_N = [0, 0, 1e6]\n"
    (tmp_path / "bad.toml").write_text(bad, encoding="utf-8")
    own = f"{bad}[cases.good]\ncontact_g = [0, 0, 1]\n"
    (tmp_path / "own.toml").write_text(own, encoding="utf-8")
    ended, out, err = kintrafo("loads", "reference_car", *words.split())
    assert ended == code
    assert re.search(r"\b(kerb|bad): ", out + err)


def test_files_that_are_none(tmp_path, ends):
    for text in (
        "cases = 3",
        "",
        "[cases]\n",
        "static_load_N = 1e308\n[cases.a]\ncontact_g = [0, 0, 1]",
        "[cases]\na = 3",
    ):
        (tmp_path / "c.toml").write_text(text, encoding="utf-8")
        ends(2, "loads", "reference_car", "--cases", "c.toml")


def test_options_are_named(ends):
    for option in ("--part", "--case"):
        ends(2, "loads", "reference_car", option, "nothing")


def test_a_file_of_cases(tmp_path, refused):
    path = tmp_path / "cases.toml"
    path.write_text("static_load_N = 4000.0\n[cases.a]\ncontact_g = [0, 0, 1]\n", encoding="utf-8")
    read = loads.read(path)
    found = loads.static(Model(CAR), read["cases"], static_load=read["static_load_N"])
    assert float(found["wheel_load"][0]) == pytest.approx(4000.0, rel=1e-12)
    path.write_text("[case.a]\n", encoding="utf-8")
    refused(InputError, lambda: loads.read(path))
