"""The commands of ``kintrafo``: results, files, exit codes, and what a script reads."""

import json
import re
import sys

import numpy as np
import pytest
import xarray as xr
from cars.driving_cars import car_on_arms
from kintrafo import Model, Suspension, characteristics
from kintrafo.core.quantities import variable
from kintrafo.core.tabulated import number, significant
from kintrafo.terminal import console
from kintrafo.vehicle import cli
from kintrafo.vehicle.cli.compare import _differing
from kintrafo.vehicle.data.starter import not_of_a_suspension
from matplotlib.image import imread
from rich.console import Console
from support.folders import ROOT

CAR = "reference_car"
POSITIONS = ("characteristics", CAR, "--positions")
CAR_FILE = ROOT / "vehicle/data/reference_car.toml"


@pytest.mark.parametrize("command", sorted(cli.COMMANDS))
def test_every_command_has_help_with_examples(kintrafo, command):
    code, out, _ = kintrafo(*command.split(), "--help")
    assert code == 0
    assert f"kintrafo {command}" in out.partition("Examples:")[2]


# -- the page of the documentation --------------------------------------------------------------

PAGE = (ROOT / "docs/reference/command-line.md").read_text(encoding="utf-8")


def test_the_change_of_the_tutorial_turns_bump_steer_round():
    car = Suspension.load("reference_car")
    lower = car.with_changes({"hardpoints.tie_rod_inner.z": 272.0})
    before, after = (
        float(characteristics.over(Model(c), "travel", np.zeros(1))["bump_steer"][0])
        for c in (car, lower)
    )
    assert after < 0.0 < before


def test_some_characteristics_are_compared(kintrafo, tmp_path, ends):
    kintrafo("new", "my_car.toml")
    code, out, _ = kintrafo(
        "compare",
        CAR,
        "my_car.toml",
        "--of",
        "toe",
        "--of",
        "camber",
        "--plot",
        "a.png",
        "-o",
        "a.csv",
    )
    assert code == 0
    assert "toe angle" in out
    assert "caster" not in out
    assert "caster" in (tmp_path / "a.csv").read_text(encoding="utf-8")
    height, width, _ = imread(tmp_path / "a.png").shape
    assert width > height  # two curves beside each other
    ends(2, "compare", CAR, "my_car.toml", "--of", "too")


@pytest.mark.parametrize(
    "line",
    [
        "characteristics reference_axle --over bump,roll --bump 20 --rebound 20",
        "characteristics reference_car --bump 20 --rebound 20 --of toe,camber",
        "loads reference_car --case static,brake --part knuckle,chassis",
        "sensitivity reference_car --of toe --place hardpoints.ball_joint.z,wheel.toe_deg",
    ],
)
def test_a_list_with_commas_is_a_repeated_option(kintrafo, line):
    repeated = re.sub(r"(--[a-z]+) ([\w.]+),([\w.]+)", r"\1 \2 \1 \3", line)
    assert repeated != line
    code, out, err = kintrafo(*line.split())
    assert (code, kintrafo(*repeated.split())[:2]) == (0, (0, out)), err
    assert kintrafo(*line.replace(",", ",,").split())[0] == 2


def test_the_documentation_names_every_command():
    (table,) = re.findall(r"\| command \|.*?\n\n", PAGE, flags=re.DOTALL)
    named = re.findall(r"^\| `(mechanism \w+|\w+)", table, flags=re.MULTILINE)
    assert sorted(named) == sorted(cli.COMMANDS)


def test_the_first_screen_has_no_command_of_few(kintrafo):
    _, out, _ = kintrafo("--help")
    listed = set(re.findall(r"^│ (\w+)", out, flags=re.MULTILINE))
    assert {"schema", "paper"} == {name for name in cli.COMMANDS if " " not in name} - listed
    assert "mechanism" in listed


def test_what_does_not_take_a_rigid_axle_says_so(kintrafo, ends):
    """Its page and the refusal name the same command."""
    page = (ROOT / "docs/suspension/types.md").read_text(encoding="utf-8")
    (listed,) = re.findall(r"`([^`]*)` needs the file of a suspension", page)
    assert listed in not_of_a_suspension("rigid_axle")
    kintrafo("new", "rear.toml", "--rigid-axle")
    ends(2, "export", "rear.toml", "--to", "points")


@pytest.mark.parametrize("file", ["twist_beam", "quarter_car"])
def test_every_assembly_has_a_topology_a_derivation_and_a_motion_to_look_at(
    kintrafo, tmp_path, file
):
    code, out, _ = kintrafo("mechanism", "topology", file, "--json")
    assert code == 0
    assert "wheel" in out
    for line in ("derivation {0} -o d.md", "animate {0} m.gif --duration 0.02"):
        assert kintrafo("mechanism", *line.format(file).split())[0] == 0
    assert "$" in (tmp_path / "d.md").read_text(encoding="utf-8")
    assert (tmp_path / "m.gif").stat().st_size > 1000


# -- check and new ------------------------------------------------------------------------------


def test_new_refuses_to_overwrite(kintrafo, tmp_path, ends):
    assert kintrafo("new", "my_car.toml")[0] == 0
    (tmp_path / "my_car.toml").write_text("# mine", encoding="utf-8")
    ends(2, "new", "my_car.toml")
    assert (tmp_path / "my_car.toml").read_text(encoding="utf-8") == "# mine"
    assert kintrafo("new", "my_car.toml", "--force")[0] == 0
    assert kintrafo("check", "my_car.toml")[0] == 0
    assert kintrafo("new", "my_car.yaml")[0] == 2
    assert kintrafo("new", "x.toml", "--template", "reference_cat")[0] == 2


def test_check_sums_up(kintrafo):
    code, out, _ = kintrafo("check", CAR, "--json")
    found = json.loads(out)
    assert code == 0
    # the file places the equilibrium at 300 mm; the tyre is compressed by 19 mm there
    assert found["equilibrium"]["height"] == pytest.approx(0.3, abs=1e-9)
    assert found["equilibrium"]["signals"]["tyre_force"] == pytest.approx(0.019 * 200e3, rel=1e-9)
    points = Model(CAR).suspension.hardpoints
    rod = np.subtract(points.tie_rod_outer, points.tie_rod_inner) / 1e3
    assert found["geometry"]["tie_rod_length"] == pytest.approx(np.linalg.norm(rod), rel=1e-14)
    assert "12.35 Hz" in kintrafo("check", CAR)[1]


def test_check_lists_problems(kintrafo, tmp_path):
    text = (ROOT / "vehicle/data/reference_car.toml").read_text(encoding="utf-8")
    bad = text.replace("spring_rate_N_per_m", "sprng_rate_N_per_m").replace("= 22.0", "= -22.0")
    (tmp_path / "bad.toml").write_text(bad, encoding="utf-8")
    code, out, _ = kintrafo("check", "bad.toml")
    assert code == 1
    assert "[strut] sprng_rate_N_per_m is not a known key" in out
    code, out, _ = kintrafo("check", "bad.toml", "--json")
    assert code == 1
    assert len(json.loads(out)["problems"]) == 2
    # a file that is not there is a mistake in the arguments
    assert kintrafo("check", "no_such.toml")[0] == 2


def test_check_finds_the_body_of_a_car_below_the_ground(kintrafo, tmp_path):
    car_on_arms().with_changes({"body.com_mm": [-1200.0, 0.0, -90.0]}).save(tmp_path / "low.toml")
    code, out, _ = kintrafo("check", "low.toml")
    assert code == 1
    assert "problem: [body] com_mm" in out
    code, out, _ = kintrafo("check", "low.toml", "--json")
    assert code == 1
    assert len(json.loads(out)["problems"]) == 1


def test_check_finds_no_equilibrium(kintrafo, tmp_path):
    text = (ROOT / "vehicle/data/reference_car.toml").read_text(encoding="utf-8")
    # a spring that pushes the wheel down wherever it is, and a tyre that does not hold against it
    pushed = re.sub(r"(spring_free_slide_mm) = \S+", r"\1 = -5000.0", text)
    pushed = re.sub(r"^(rate_N_per_m) = \S+", r"\1 = 0.0", pushed, flags=re.MULTILINE)
    (tmp_path / "pushed.toml").write_text(pushed, encoding="utf-8")
    code, out, _ = kintrafo("check", "pushed.toml")
    assert code == 1
    assert "no stable equilibrium" in out


# -- results ------------------------------------------------------------------------------------


def test_positions_are_printed_as_a_table_and_written(kintrafo, tmp_path):
    code, out, _ = kintrafo(
        "characteristics", CAR, "--positions", "--bump", 20, "--rebound", 10, "-o", "path.csv"
    )
    assert code == 0
    names, *rows = (tmp_path / "path_travel.csv").read_text(encoding="utf-8").splitlines()
    assert names.startswith("wheel_travel [mm],rack_position [mm],strut_length [mm]")
    heights = [float(row.split(",")[names.split(",").index("wheel_center_z [mm]")]) for row in rows]
    assert heights == pytest.approx(np.arange(290.0, 321.0, 2.0), abs=1e-6)
    assert "320.000" in out


def test_positions_on_a_grid(kintrafo, tmp_path):
    line = ["--positions", "--over", "both", "--step", "20", "-o", "map.nc"]
    assert kintrafo("characteristics", CAR, *line)[0] == 0
    grid = xr.load_dataset(tmp_path / "map_both.nc", engine="scipy")
    assert dict(grid.sizes) == {"wheel_travel": 9, "rack_position": 7}
    assert grid["rack_position"].values == pytest.approx(np.arange(-0.06, 0.061, 0.02))


def test_characteristics_at_design(kintrafo):
    code, out, _ = kintrafo("characteristics", CAR, "--step", 20)
    assert code == 0
    assert re.search(r"caster angle\s+│\s+2\.9517 │ deg", out)
    code, out, _ = kintrafo("characteristics", CAR, "--step", 20, "--json")
    found = json.loads(out)
    assert found["over_travel"]["variables"]["camber"]["units"] == "rad"
    assert len(found["over_travel"]["coordinates"]["wheel_travel"]["values"]) == 9


def test_a_picture_compares_the_curves_whose_differences_can_be_seen():
    """Neither curves that cover each other, nor one curve twice, as toe and steer."""
    cars = (Suspension.load("reference_car"),) * 2
    cars = (cars[0], cars[1].with_changes({"strut.spring_rate_N_per_m": 30e3}))
    table = xr.concat([characteristics.over(car) for car in cars], "data_set")
    assert _differing(table) == ["wheel_rate", "ride_rate"]


def test_compare_with_itself_differs_by_nothing(kintrafo, ends):
    code, out, _ = kintrafo("compare", CAR, CAR, "--json")
    assert code == 0
    found = json.loads(out)
    assert {entry["data_set"] for entry in found} == {f"{CAR} (2)"}
    assert {entry["largest"] for entry in found} == {0.0}
    ends(2, "compare", CAR)


@pytest.mark.parametrize("car", [CAR, "double_wishbone_car"])
def test_simulation_settles_where_statics_says(kintrafo, tmp_path, car):
    arguments = ("simulate", car, "--road-step", 20, "--duration", 2, "--json", "-o", "step.nc")
    code, out, _ = kintrafo(*arguments, "--plot", "step.png")
    assert code == 0
    last = {name: entry["last"] for name, entry in json.loads(out)["statistics"].items()}
    from kintrafo import equilibrium

    model = Model(car)
    rest = model.signals(equilibrium(model, road_height=0.02))
    # 2 s are 30 time constants of the wheel-hop mode; the integration is good to 1e-6
    assert last["wheel_center_z"] == pytest.approx(float(rest["wheel_center_z"]), abs=1e-6)
    assert xr.load_dataset(tmp_path / "step.nc", engine="scipy").sizes["time"] == 2001
    assert imread(tmp_path / "step.png").std() > 0.01


def test_steering_with_mass_leaves_the_rack_free(kintrafo, tmp_path, as_stored, ends):
    text = (ROOT / "vehicle/data/reference_car.toml").read_text(encoding="utf-8")
    heavy = re.sub(r"(\[bodies.tie_rod\][^=]*=) 0.0", r"\1 1.0", text)
    assert heavy != text
    (tmp_path / "heavy.toml").write_text(heavy, encoding="utf-8")
    code, out, err = kintrafo("simulate", "heavy.toml", "--json")
    assert code == 0
    as_stored(" ".join(err.split()))
    assert "beta9" in json.loads(out)["statistics"]
    ends(2, "simulate", "heavy.toml", "--rack", 3)
    assert kintrafo("check", "heavy.toml")[0] == 0
    assert kintrafo("characteristics", "heavy.toml", "--positions", "--over", "rack")[0] == 0


def test_wheel_that_leaves_the_ground_is_reported(kintrafo, as_stored):
    code, out, err = kintrafo("simulate", CAR, "--road-step", -60)
    assert code == 1  # its tyre holds on to the road
    assert "The wheel leaves the ground" in out
    as_stored(" ".join(err.split()))


def test_unfinished_simulation_keeps_what_it_has(kintrafo, tmp_path):
    # the rack moves away until the tie rod cannot reach the knuckle
    code, _, err = kintrafo("simulate", CAR, "--rack-sine", 200, "-o", "part.csv")
    assert (code, "tie_rod" in err) == (1, True)
    rows = (tmp_path / "part.csv").read_text(encoding="utf-8").splitlines()
    assert 80 < len(rows) < 1001


def test_topology_needs_no_sympy(kintrafo, monkeypatch):
    monkeypatch.setitem(sys.modules, "sympy", None)
    code, out, _ = kintrafo("mechanism", "topology", "--json")
    assert code == 0
    found = json.loads(out)
    assert found["mobility"] == 3
    assert [joint["type"] for joint in found["joints"]].count("spherical") == 2
    assert "universal joint" not in kintrafo("mechanism", "topology")[2]


# -- mistakes -----------------------------------------------------------------------------------


def test_mistakes_end_with_a_message(ends, tmp_path):
    # one style: the command or the file, and nothing before it
    style = r"error: (kintrafo( [a-z]+)+|no_such_car|\S+\.\w+): 1 problem "
    for arguments, code in (
        ([*POSITIONS, "--bump", "400"], 1),
        (["characteristics", CAR, "--bump", "-4"], 2),
        (["characteristics", CAR, "--step", "0"], 2),
        (["characteristics", CAR, "--step", "1e-9"], 2),
        (["characteristics", CAR, "-o", "curves.ods"], 2),
        (["characteristics", CAR, "--plot", "curves.bmp"], 2),
        (["characteristics", CAR, "--rack", "900"], 1),
        (["characteristics", CAR, "--travel", "x"], 2),
        (["characteristics", CAR, "--figures", "f", "--format", "gif"], 2),
        (["simulate", CAR, "--height", "9999"], 1),
        (["simulate", CAR, "--duration", "-1"], 2),
        (["simulate", CAR, "--duration", "0", "--road-sine", "3"], 2),
        (["simulate", CAR, "--speed", "50"], 2),
        ([*POSITIONS, "--travel", "20"], 2),
        ([*POSITIONS, "--of", "toe"], 2),
        ([*POSITIONS, "--over", "roll"], 2),
        ([*POSITIONS, "--over", "both", "--rack", "20"], 2),
        (["simulate", CAR, "--output-step", "0"], 2),
        (["simulate", CAR, "--output-step", "1e-9"], 2),
        (["simulate", CAR, "--method", "Euler"], 2),
        (["simulate", CAR, "--rtol", "2"], 2),
        (["simulate", CAR, "--road-step", "9", "--road-sine", "9"], 2),
        (["simulate", CAR, "--road-step", "9", "--road-step-at", "7"], 2),
        (["simulate", CAR, "--road-sine", "9", "--road-frequency", "0"], 2),
        (["simulate", CAR, "--road-step-at", "0.2"], 2),
        (["simulate", CAR, "--rack-frequency", "2"], 2),
        (["simulate", CAR, "--measured", "none.csv"], 2),
        (["simulate", CAR, "--road-step", "nan"], 2),
        (["characteristics", CAR, "--bump", "1e400"], 2),
        (["mechanism", "topology", "no_such_car"], 2),
        (["compare", CAR, "no_such_car"], 2),
        (["mechanism", "animate", CAR, "x.gif", "--start", "beta1=1", "--start", "beta1=2"], 2),
        (["mechanism", "generate", CAR_FILE], 2),
    ):
        message = ends(code, *arguments)
        assert code != 2 or re.match(style, message)
    assert not list(tmp_path.iterdir())


def test_missing_packages_are_named_with_the_remedy(monkeypatch, ends):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    ends(3, "characteristics", CAR, "-o", "path.parquet")
    monkeypatch.setitem(sys.modules, "sympy", None)
    ends(3, "mechanism", "generate", __file__)


def test_a_folder_in_the_way_is_refused(tmp_path, ends):
    (tmp_path / "path_rack.csv").mkdir()
    ends(2, "characteristics", CAR, "-o", "path.csv")


def test_numbers_in_tables():
    assert [number(v) for v in (-1e-9, 1.23456, np.nan)] == ["0.000", "1.235", "-"]
    assert [significant(v) for v in (-1e-12, 0.0045141, np.inf)] == ["0", "0.0045141", "infinite"]


def test_columns_that_do_not_fit_are_in_further_tables(monkeypatch, capsys):
    """No number is cut: a table is as wide as the terminal at most and begins with the position."""
    monkeypatch.setattr(console, "console", Console(width=80))
    over = {"wheel_travel": variable("wheel_travel", np.linspace(-0.08, 0.08, 5), "", "m")}
    forces = {
        f"force_{n}": variable("wheel_travel", np.full(5, 24554.1), "", "N") for n in "abcdefgh"
    }
    console.print_curves(xr.Dataset(forces, over), list(forces), "forces")
    shown = capsys.readouterr().out
    assert "…" not in shown
    assert shown.count("24554.1") == 5 * len(forces)
    assert shown.count("-80.000") == 2
    assert max(map(len, shown.splitlines())) <= 80
