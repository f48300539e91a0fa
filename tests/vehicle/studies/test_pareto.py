"""Fronts of several objectives: against grids, optima, and everything that can go wrong."""

import importlib
import itertools
import json
import signal
import sys

import numpy as np
import pytest
from kintrafo import InputError, Model, Suspension, characteristics, variation
from kintrafo.vehicle.plots.pareto import write_front
from kintrafo.vehicle.studies.candidates import Candidates
from kintrafo.vehicle.studies.front import compromise, spread, unbeaten
from matplotlib.image import imread

CAR = Suspension.load("reference_car")
ROD, JOINT = "hardpoints.tie_rod_inner.z", "hardpoints.ball_joint.z"
FREE = {ROD: 15.0, JOINT: 10.0}
TOE = {"toe": {"at_mm": [-50.0, 50.0], "value": 0.0, "within": 0.02}}
HEIGHT = {"roll_center_height_kinematic": {"at_mm": 0.0}}
# The ball joint may come down by some seven of its ten millimetres.
MOST_SCRUB = 21.0
SCRUB = {"scrub_radius": {"at_mm": 0.0, "most": MOST_SCRUB}}
SHORT = {"population": 4, "generations": 2}
STUDY = f"""
[free]
"{ROD}" = 15.0
"{JOINT}" = 10.0
[targets.toe]
at_mm = [-50, 50]
value = 0.0
within = 0.02
[maximise.roll_center_height_kinematic]
[limits.scrub_radius]
most = {MOST_SCRUB}
"""
QUICK = ("--population", 4, "--generations", 2)


def numbers_of(suspension):
    """Return deviation of toe [rad], roll-centre height [m] and scrub radius [m], by the curves."""
    found = characteristics.over(Model(suspension), "travel", [-0.05, 0.0, 0.05])
    toe = np.hypot(*found["toe"].values[[0, 2]]) / np.sqrt(2.0)
    return float(toe), *(float(found[n][1]) for n in (*HEIGHT, "scrub_radius"))


@pytest.fixture(scope="module")
def front():
    return variation.pareto(
        CAR, FREE, TOE, maximise=HEIGHT, limits=SCRUB, population=20, generations=16
    )


@pytest.fixture(scope="module")
def costs(front):
    """Return what is to be small of each member, in parts of its range over the front."""
    toe, height = (front.dataset[o.name].values for o in front.objectives)
    return in_parts(front, toe, height)


def in_parts(front, toe, height):
    """Return what is to be small, from 0 to 1 over the front."""
    found = []
    for sign, values, objective in zip((1, -1), (toe, height), front.objectives, strict=True):
        own = sign * front.dataset[objective.name].values
        found.append((sign * np.asarray(values) - own.min()) / np.ptp(own))
    return np.stack(found, axis=-1)


def beats(one, other, by=0.0):
    return bool((one <= other - by).all() and (one < other - by).any())


# -- what is on a front ---------------------------------------------------------------------------


def test_members_are_what_the_curves_say_and_keep_the_limits(front):
    toe, height = (front.dataset[o.name].values for o in front.objectives)
    for member in range(1, len(front.moved) + 1):
        car = front.suspension(member)
        found = numbers_of(car)
        # the same equations at other positions beside: rounding only
        np.testing.assert_allclose(found[:2], [toe[member - 1], height[member - 1]], rtol=1e-9)
        assert found[2] <= 1e-3 * MOST_SCRUB * (1.0 + 1e-12)
        for place, by in front.moved[member - 1].items():
            assert abs(by) <= FREE[place]
            expected = float(front.dataset[place][member - 1]) * 1e3
            axis = "xyz".index(place[-1])
            point = car.to_dict()["hardpoints"][place.split(".")[1]]
            assert point[axis] == pytest.approx(expected, abs=1e-9)
    assert front.success
    assert front.keeps_limits
    assert front.before == pytest.approx(
        dict(zip((o.name for o in front.objectives), numbers_of(CAR), strict=False)), rel=1e-9
    )


def test_no_member_beats_another(costs):
    assert len(costs) == 20
    assert not any(beats(a, b) for a, b in itertools.permutations(costs, 2))
    assert (np.diff(costs[:, 0]) > 0.0).all()


def test_a_grid_of_all_values_has_nothing_better(front, costs):
    """Nor is a part of the front missing: each car of the grid has a member that is as good."""
    steps = np.linspace(-1.0, 1.0, 13)
    cars = [
        CAR.with_changes({ROD: 280.0 + 15.0 * a, JOINT: 180.0 + 10.0 * b})
        for a, b in itertools.product(steps, steps)
    ]
    toe, height, scrub = np.transpose([numbers_of(car) for car in cars])
    allowed = scrub <= 1e-3 * MOST_SCRUB
    assert 20 < allowed.sum() < len(cars) - 20  # the limit is in the way
    grid = in_parts(front, toe, height)[allowed]
    # 20 members are a twentieth of the ranges apart; of five seeds the worst is behind by 0.02
    assert not any(beats(a, b, 0.05) for a in grid for b in costs)
    assert all((costs <= car + 0.08).all(axis=1).any() for car in grid)


@pytest.mark.parametrize("within", [0.3, 5.0])
def test_what_weights_find_lies_at_the_front(front, costs, within):
    """The optimum of a sum is of the true front: near to a member, and hardly better than any."""
    height = {"roll_center_height_kinematic": {"at_mm": 0.0, "value": 130.0, "within": within}}
    aims = {"toe": TOE["toe"] | {"within": 0.1}} | height
    found = variation.optimise(CAR, FREE, aims, SCRUB)
    assert found.success, found.message
    toe, high, _ = numbers_of(found.suspension)
    best = in_parts(front, toe, high)
    assert not any(beats(best, member, 0.05) for member in costs)
    assert np.abs(costs - best).max(axis=1).min() < 0.1


def test_what_matters_may_be_left_out_and_plays_no_part(refused):
    found = [
        variation.pareto(
            CAR,
            {ROD: 10.0},
            {"toe": {"at_mm": [-50.0, 50.0], "value": 0.0, **within}},
            maximise={"toe": {"at_mm": 0.0}},
            population=4,
            generations=2,
        ).dataset
        for within in ({}, {"within": 0.02}, {"within": 500.0})
    ]
    assert all(other.identical(found[0]) for other in found)
    refused(InputError, lambda: variation.goals({"targets": {"toe": {"value": 0.0}}}))


def test_the_compromise_is_nearest_to_the_best_of_both(front, costs):
    distances = [float(np.hypot(*member)) for member in costs]
    assert front.compromise == 1 + distances.index(min(distances))


def test_fronts_of_random_numbers():
    random = np.random.default_rng(7)
    for size, objectives in ((1, 2), (60, 2), (80, 3)):
        rows = random.integers(0, 9, (size, objectives)).astype(float)
        found = unbeaten(rows)
        expected = {tuple(a) for a in rows if not any(beats(b, a) for b in rows)}
        assert len(found) == len(expected)
        assert {tuple(row) for row in rows[found]} == expected
    line = np.stack([np.arange(101.0), -np.arange(101.0)], axis=1)
    assert spread(line, 5).tolist() == [0, 25, 50, 75, 100]
    assert spread(line, 200).tolist() == list(range(101))
    assert compromise(line) == 50
    assert compromise(np.ones((1, 2))) == 0


# -- searches --------------------------------------------------------------------------------------


def test_the_seed_decides(kintrafo, tmp_path):
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    before = np.random.get_state()[1].tolist()  # noqa: NPY002 (the state of everybody)
    for name, seed in (("a.csv", 5), ("b.csv", 5), ("c.csv", 6)):
        options = (*QUICK, "--seed", seed, "-o", name)
        assert kintrafo("pareto", "reference_car", "s.toml", *options)[0] == 0
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002 (the same)
    texts = [(tmp_path / f"{name}.csv").read_bytes() for name in "abc"]
    assert texts[0] == texts[1] != texts[2]
    heading = b"member,toe_deviation [deg],roll_center_height_kinematic_least [mm],"
    assert texts[0].startswith(heading)


def test_what_cannot_be_built_is_beyond_all_limits():
    """With half a metre to either side no arm reaches most bearings."""
    parts = []
    found = variation.pareto(
        CAR, {"hardpoints.tie_rod_outer.y": 500.0}, TOE, maximise=HEIGHT,
        population=12, generations=2, progress=parts.append,
    )  # fmt: skip
    assert found.success
    assert "could not be built, or did not reach a position" in found.message
    for member in range(1, len(found.moved) + 1):
        toe, *_ = numbers_of(found.suspension(member))  # it can be built
        assert float(found.dataset["toe_deviation"][member - 1]) == pytest.approx(toe, rel=1e-9)
    assert parts == sorted(parts)
    assert parts[-1] == pytest.approx(1.0)


def test_limits_that_cannot_be_kept(refused):
    far = SCRUB | {"bump_steer": {"most": -1.0}}
    found = variation.pareto(CAR, FREE, TOE, maximise=HEIGHT, limits=far, **SHORT)
    assert not found.success
    assert "the nearest one not those of: bump_steer" in found.message
    assert not found.keeps_limits
    assert (found.moved, found.compromise, found.dataset.sizes["member"]) == ((), 0, 0)
    refused(InputError, lambda: found.suspension(1))


def test_values_that_move_nothing_are_named(refused):
    idle = "bodies.wheel.mass_kg"
    found = variation.pareto(CAR, {ROD: 5.0, idle: 1.0}, TOE, maximise=HEIGHT, **SHORT)
    assert f"without effect on an objective: {idle}" in found.message
    refused(InputError, lambda: variation.pareto(CAR, {idle: 1.0}, TOE, maximise=HEIGHT, **SHORT))


def test_objectives_that_agree_have_one_best_car(refused):
    """Both want the camber of the file at the end of its range."""
    camber = {"camber": [{"at_mm": [-30.0, 30.0]}, {"over": "rack", "at_mm": 20.0}]}
    found = variation.pareto(CAR, {"wheel.camber_deg": 1.0}, minimise=camber, **SHORT)
    names = [objective.name for objective in found.objectives]
    assert names == ["camber_greatest", "camber_over_rack_greatest"]
    assert len(found.moved) == found.compromise == 1
    assert found.message.startswith("one suspension is the best in every objective")
    assert found.dataset[names[1]].attrs["long_name"] == "camber over the rack"
    refused(InputError, lambda: found.suspension(2))


def test_several_objectives_of_one_kind_are_distinguished_and_drawn(tmp_path):
    aims = {"toe": [TOE["toe"], TOE["toe"] | {"at_mm": 20.0}]}
    found = variation.pareto(CAR, FREE, aims, maximise=HEIGHT, limits=SCRUB, **SHORT)
    assert [o.name for o in found.objectives][:2] == ["toe_deviation", "toe_deviation (2)"]
    path = write_front(found, tmp_path / "front.png", chosen=1, title="three objectives")
    picture = imread(path)
    assert picture.shape[0] > 700  # two rows of panels
    assert picture.std() > 0.01


# -- commands -------------------------------------------------------------------------------------


def test_the_chosen_member_is_written(kintrafo, tmp_path):
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    code, out, err = kintrafo(
        "pareto", "reference_car", "s.toml", *QUICK, "--member", 2, "--member-file", "car.toml"
    )
    assert code == 0, err
    for words in ("file", "compromise", "chosen", "values of member 2", "on the front"):
        assert words in " ".join(out.split()), out
    written = Suspension.load(tmp_path / "car.toml")
    code, out, _ = kintrafo("pareto", "reference_car", "s.toml", *QUICK, "--json", "--member", 2)
    told = json.loads(out)
    values = {name: data["values"][1] for name, data in told["variables"].items()}
    assert numbers_of(written)[:2] == pytest.approx([*values.values()][:2], rel=1e-9)
    assert (told["chosen"], told["success"], set(told["before"])) == (2, True, {*values} - {*FREE})


@pytest.mark.parametrize("member", [0, 5, 4])
def test_a_member_that_is_not_there(kintrafo, tmp_path, member, as_stored):
    """Four cars of a generation have no fifth member, and need not have a fourth."""
    study = STUDY.replace("[limits.scrub_radius]\nmost = 21.0", "[limits.toe]\nmost = 0.001")
    (tmp_path / "s.toml").write_text(study, encoding="utf-8")
    code, out, err = kintrafo(
        "pareto", "reference_car", "s.toml", *QUICK, "--member", member,
        "-o", "a.csv", "--plot", "a.svg", "--member-file", "a.toml",
    )  # fmt: skip
    assert (code, out) == (2, "")
    as_stored(" ".join(err.split()))
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


def test_nothing_is_written_where_no_car_keeps_the_limits(kintrafo, tmp_path):
    (tmp_path / "s.toml").write_text(STUDY.replace("21.0", "-90.0"), encoding="utf-8")
    code, out, _ = kintrafo("pareto", "reference_car", "s.toml", *QUICK, "-o", "a.csv")
    assert code == 1
    assert "not those of: scrub_radius" in " ".join(out.split())
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


@pytest.mark.usefixtures("interruptible")
def test_an_interruption_ends_it_at_once(kintrafo, tmp_path, monkeypatch):
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    looked_at = []
    values = Candidates.values

    def interrupted(self, x):
        looked_at.append(x)
        if len(looked_at) == 30:
            signal.raise_signal(signal.SIGINT)
        return values(self, x)

    monkeypatch.setattr(Candidates, "values", interrupted)
    code, out, _ = kintrafo(
        "pareto",
        "reference_car",
        "s.toml",
        "--population",
        12,
        "-o",
        "a.csv",
        "--member-file",
        "a.toml",
    )
    assert (code != 0, out, len(looked_at)) == (True, "", 30)
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


def test_without_pymoo_it_is_said_how_to_install_it(tmp_path, monkeypatch, ends):
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    monkeypatch.setitem(sys.modules, "pymoo.algorithms.moo.nsga2", None)
    monkeypatch.setattr(Candidates, "values", None)  # before anything is computed
    ends(3, "pareto", "reference_car", "s.toml", "-o", "a.csv")
    assert [path.name for path in tmp_path.iterdir()] == ["s.toml"]


# -- mistakes -------------------------------------------------------------------------------------


def call(**given):
    right = {"suspension": CAR, "free": FREE, "targets": TOE, "maximise": HEIGHT}
    variation.pareto(**(right | given))


WRONG = [
    {"suspension": "reference_car"},
    {"progress": 1},
    {"population": 3},
    {"population": 7.5},
    {"generations": 0},
    {"population": 10_000, "generations": 11},
    {"seed": -1},
    {"seed": "one"},
    {"free": {}},
    {"free": {ROD: 0.0}},
    {"free": {"hardpoint": 1.0}},
    {"free": [ROD]},
    {"free": {"bushings.arm_rear.axial_N_per_mm": 1.0}},
    {"targets": {}},
    {"maximise": {"toe": [{"at_mm": at} for at in range(6)]}},
    {"targets": [1.0]},
    {"targets": {"toe": {"within": 0.1}}},
    {"targets": {"toe": {"value": 0.0, "within": 0.0}}},
    {"minimise": {"camberr": {}}},
    {"minimise": {"camber": 1.0}},
    {"minimise": {"camber": {"value": 1.0}}},
    {"minimise": {"camber": {"over": "roll"}}},
    {"maximise": {"camber": {"at_mm": [np.nan]}}},
    {"minimise": {"turning_circle": {"over": "rack", "at_mm": 0.0}}},
    {"limits": {"toe": {}}},
]


@pytest.mark.parametrize("given", WRONG)
def test_what_cannot_be_used(given, refused):
    if "bushings" in str(given):
        bushes = {"bushings": {"arm_rear": {"axial_N_per_mm": 400.0}}}
        given = given | {"suspension": CAR.with_changes(bushes)}
    refused(InputError, lambda: call(**given))


def test_a_position_out_of_reach_is_no_study():
    module = importlib.import_module("kintrafo.vehicle.models.positions")
    with pytest.raises(module.PositionError):
        call(targets={"toe": TOE["toe"] | {"at_mm": [900.0]}})


def test_a_file_with_something_else(tmp_path, ends):
    (tmp_path / "s.toml").write_text(STUDY.replace("maximise", "maximize"), encoding="utf-8")
    ends(2, "pareto", "reference_car", "s.toml")
