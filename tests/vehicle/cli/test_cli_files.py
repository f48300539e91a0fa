"""The command line and the disk: no file is lost, and errors of printing have a message."""

import json
import os
import sys
from pathlib import Path

import pytest
from kintrafo.terminal.exits import standing_streams
from kintrafo.vehicle import cli
from support.folders import ROOT

CAR = "reference_car"
TEXT = (ROOT / "vehicle/data/reference_car.toml").read_text(encoding="utf-8")
CHRONO = ROOT / "tests/data/chrono/MacPhersonStrut.json"
ADAMS = ROOT / "tests/data/adams/front_suspension.sub"
STUDIES = ROOT / "tests/data/studies"
SOFT = ("--bushes", str(STUDIES / "bushes.toml"))
FULL = Path("/dev/full")


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path_factory.mktemp("cache")))


# one for each command that writes; the file in the way and the arguments that name it
WRITING = {
    "new": (["new", "a.toml"], "a.toml"),
    "import of Project Chrono": (["import", str(CHRONO), "a.toml"], "a.toml"),
    "import of Adams/Car": (["import", str(ADAMS), "a.toml"], "a.toml"),
    "import of a table": (
        ["import", str(STUDIES / "points.csv"), "a.toml", "--from", CAR],
        "a.toml",
    ),
    "export --to points": (["export", CAR, "--to", "points"], f"{CAR}_points.csv"),
    "schema": (["schema", "a.json"], "a.json"),
    "--positions": (["characteristics", CAR, "--positions", "--plot", "a.svg"], "a_travel.svg"),
    "--figures": (["characteristics", CAR, "--step", 40, "--figures", "."], "camber_travel.png"),
    "characteristics": (["characteristics", CAR, "-o", "a.nc"], "a_rack.nc"),
    "characteristics of an axle": (
        ["characteristics", "reference_axle", "--over", "roll", "--plot", "a.svg"],
        "a_roll.svg",
    ),
    "simulate": (["simulate", CAR, "-o", "a.parquet"], "a.parquet"),
    "simulate --loads": (["simulate", CAR, "--loads", "a.csv"], "a.csv"),
    "loads": (["loads", CAR, "-o", "a.nc"], "a.nc"),
    "loads of an axle": (["loads", "reference_axle", "-o", "a.csv"], "a.csv"),
    "loads of a rigid axle": (["loads", "rigid_axle", "-o", "a.nc"], "a.nc"),
    "loads --plot of a rigid axle": (
        ["loads", "rigid_axle", "--case", "brake", "--plot", "a.svg"],
        "a_brake.svg",
    ),
    "simulate --loads of a rigid axle": (["simulate", "rigid_axle", "--loads", "a.csv"], "a.csv"),
    "loads --plot": (["loads", CAR, "--case", "brake", "--plot", "a.png"], "a_brake.png"),
    "drive --loads": (["drive", "driving_car", "--loads", "a.csv"], "a.csv"),
    "mechanism animate": (["mechanism", "animate", CAR, "a.gif"], "a.gif"),
    "sheet": (["sheet", CAR, "-o", "a.csv"], "a.csv"),
    "compliance": (["compliance", CAR, *SOFT, "--plot", "a.svg"], "a.svg"),
    "compliance --nonlinear": (
        ["compliance", CAR, *SOFT, "--nonlinear", "--plot", "a.svg"],
        "a.svg",
    ),
    "compliance --nonlinear of an axle": (
        ["compliance", "--nonlinear", "reference_axle", *SOFT, "--over", "roll", "--plot", "a.svg"],
        "a.svg",
    ),
    "compare": (["compare", CAR, CAR, "--plot", "a.pdf"], "a.pdf"),
    "sensitivity": (
        ["sensitivity", CAR, "--place", "hardpoints.ball_joint.z", "-o", "a.nc"],
        "a.nc",
    ),
    "tolerance": (
        ["tolerance", CAR, str(STUDIES / "tolerances.toml"), "--cars", 2, "--plot", "a.svg"],
        "a.svg",
    ),
    "optimise": (["optimise", CAR, str(STUDIES / "goals.toml"), "-o", "a.toml"], "a.toml"),
    "pareto": (["pareto", CAR, str(STUDIES / "front.toml"), "--member-file", "a.toml"], "a.toml"),
    "pareto --out": (["pareto", CAR, str(STUDIES / "front.toml"), "-o", "a.csv"], "a.csv"),
    "fit": (
        ["fit", CAR, str(STUDIES / "rig.csv"), str(STUDIES / "tolerances.toml"), "-o", "a.toml"],
        "a.toml",
    ),
    "sweep": (["sweep", CAR, "wheel.toe_deg=0,1", "--duration", 0.01, "--plot", "a.png"], "a.png"),
    "report": (["report", CAR], f"{CAR}.html"),
    "report of an axle": (["report", "reference_axle"], "reference_axle.html"),
    "report of a rigid axle": (["report", "rigid_axle", "--standard-cases"], "rigid_axle.html"),
    "mechanism derivation": (["mechanism", "derivation", "slider_crank", "-o", "a.tex"], "a.tex"),
    "mechanism derivation with figures": (
        ["mechanism", "derivation", "slider_crank", "-o", "a.tex"],
        "a_bodies.pdf",
    ),
    "export": (["export", "four_bar", "--to", "c", "-o", "."], "four_bar.h"),
    "export --to fmu": (["export", "four_bar", "--to", "fmu"], "four_bar.fmu"),
    "paper": (["paper", "."], "figure_6_wheel_motion.svg"),
    "tyre": (["tyre", "passenger_205_55", "-o", "a.csv"], "a.csv"),
    "drive": (["drive", "driving_car", "-o", "a.csv"], "a.csv"),
    "ride": (["ride", "quarter_car", "--duration", "2", "-o", "a.nc"], "a.nc"),
}


def test_every_command_that_writes_is_here():
    shown = {name for name in cli.COMMANDS if not any(w.startswith(name) for w in WRITING)}
    assert shown == {"check", "mechanism topology", "mechanism generate"}


@pytest.mark.parametrize("command", WRITING)
def test_no_command_writes_over_what_it_did_not_write(kintrafo, tmp_path, command):
    arguments, name = WRITING[command]
    (tmp_path / name).write_text("a year of work")
    code, out, err = kintrafo(*arguments)
    assert (code, out) == (2, "")
    assert "--force" in err
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "a year of work"


@pytest.mark.parametrize("name", ["reference_axle", "twist_beam", "driving_car"])
def test_points_are_those_of_a_suspension(tmp_path, name, ends):
    ends(2, "export", name, "--to", "points")
    assert not list(tmp_path.iterdir())


def test_no_file_is_written_twice(tmp_path, ends):
    ends(2, "simulate", CAR, "-o", "a.csv", "--loads", "a.csv", "--duration", 0.01)
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    "command", ["new", "schema", "--positions", "import of Project Chrono", "import of Adams/Car"]
)
def test_force_and_again(kintrafo, tmp_path, command):
    arguments, name = WRITING[command]
    (tmp_path / name).write_text("a year of work")
    assert kintrafo(*arguments, "--force")[0] == 0
    written = (tmp_path / name).read_bytes()
    assert kintrafo(*arguments)[0] == 0
    assert (tmp_path / name).read_bytes() == written


@pytest.mark.parametrize(
    "arguments",
    [
        ["report", "car.toml", "car.toml"],
        ["report", "car.toml", "other.toml"],
        ["schema", "other.toml"],
        ["import", "chrono.json", "chrono.json"],
        ["import", "adams.sub", "adams.sub"],
        ["import", "adams.sub", "car.toml", "--from", "car.toml"],
        ["pareto", "car.toml", "other.toml", "--member-file", "other.toml"],
        ["simulate", CAR, "--measured", "road.csv", "-o", "road.csv"],
        ["sheet", "car.csv", "-o", "car.csv"],
        ["compare", CAR, "car.csv", "-o", "./car.csv"],
    ],
)
def test_what_is_read_is_not_written_even_by_force(kintrafo, tmp_path, arguments):
    texts = {
        "car.toml": TEXT,
        "other.toml": TEXT,
        "car.csv": TEXT,
        "chrono.json": CHRONO.read_text(encoding="utf-8"),
        "adams.sub": ADAMS.read_text(encoding="utf-8"),
        "road.csv": "time_s,road_height_mm\n0,0\n1,2\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    code, out, _ = kintrafo(*arguments, "--force")
    assert (code, out) == (2, "")
    found = {path.name: path.read_text(encoding="utf-8") for path in tmp_path.iterdir()}
    assert found == texts


def test_generate_keeps_the_source(kintrafo, tmp_path):
    """The files of a mechanism are called as it is, and so is the file that declares it."""
    source = tmp_path / "four_bar.py"
    text = "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n"
    source.write_text(text)
    for options in ([], ["--force"]):
        code, out, err = kintrafo("mechanism", "generate", source, "--numpy", "-o", ".", *options)
        assert (code, out) == (2, "")
        assert source.name in err
    assert source.read_text() == text
    assert [path.name for path in tmp_path.iterdir()] == [source.name]
    assert kintrafo("mechanism", "generate", source, "--numpy", "-o", "equations")[0] == 0
    (tmp_path / "equations/four_bar.md").write_text("my notes")
    code, _, err = kintrafo("mechanism", "generate", source, "--numpy", "-o", "equations")
    assert code == 2
    assert "four_bar.md" in err


# -- standard output that leads nowhere ---------------------------------------------------------


def run_into(stream, monkeypatch, arguments):
    """Run a command whose standard output is a stream; return its exit code."""
    monkeypatch.setattr("sys.stdout", stream)
    monkeypatch.setattr("sys.argv", ["kintrafo", *map(str, arguments)])
    with pytest.raises(SystemExit) as caught:
        cli.run()
    monkeypatch.undo()
    return caught.value.code


@pytest.fixture
def full(capsys):
    """A stream onto a disk that is full, while what goes to stderr is kept."""
    del capsys
    if not FULL.exists():
        pytest.skip("no /dev/full on this system")
    # a command that fails there leads it to nothing, so that closing it raises no error
    with FULL.open("w", encoding="utf-8") as stream:
        yield stream


@pytest.mark.parametrize("arguments", [["--help"], ["schema"], ["check", CAR, "--json"]])
def test_a_full_disk_behind_standard_output(full, monkeypatch, capsys, arguments):
    assert run_into(full, monkeypatch, arguments) == 2
    assert "No space left" in capsys.readouterr().err


def test_files_are_there_though_nothing_can_be_printed(full, monkeypatch, tmp_path):
    path = tmp_path / "a.csv"
    assert run_into(full, monkeypatch, ["sheet", CAR, "-o", path]) == 2
    assert path.stat().st_size > 0


def test_a_reader_that_has_gone_ends_it_quietly(monkeypatch, capsys):
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w", encoding="utf-8") as stream:
        assert run_into(stream, monkeypatch, ["schema"]) == 1
    assert capsys.readouterr().err == ""


def test_streams_that_were_closed(monkeypatch):
    for name in ("stdout", "stderr"):
        monkeypatch.setattr(sys, name, None)
    opened = []
    monkeypatch.setattr("os.open", lambda *arguments: opened.append(arguments))
    with standing_streams():
        assert sys.stdout is not None
        assert sys.stderr is not None
    assert len(opened) == 2


# -- files that are hard to read -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a = " + "[" * 2000 + "]" * 2000, "too deeply"),
        (".".join(["a"] * 200_000) + " = 1", "too deeply"),
        ("[" + " . ".join(["'a'"] * 200_000) + "]", "too deeply"),
        ("a = " + "9" * 5000, "thousands of digits"),
        (TEXT.replace("= 25000.0", "= 1" + "0" * 4000), "spring_rate_N_per_m"),
        (TEXT.replace("[   5.0,", "[-1" + "0" * 4000 + ","), "ball_joint"),
    ],
)
def test_toml_that_no_person_writes(kintrafo, tmp_path, text, words):
    (tmp_path / "car.toml").write_text(text, encoding="utf-8")
    code, out, err = kintrafo("check", "car.toml", "--json")
    assert code == 1, err
    (problem, *_) = json.loads(out)["problems"]
    assert any(word in problem for word in words.split("|")), problem
    assert len(problem) < 1000


STRANGE = ["$^$.toml", os.fsdecode(b"caf\xe9.toml"), "two\nlines.toml", "[bold]x.toml", "=1.toml"]


@pytest.mark.parametrize("name", STRANGE)
def test_strange_names(kintrafo, tmp_path, name):
    (tmp_path / name).write_text(TEXT, encoding="utf-8")
    code, out, err = kintrafo(
        "characteristics", name, "--positions", "--step", 80, "-o", f"{name}.csv"
    )
    assert code == 0, err
    assert "positions over travel" in " ".join(out.split())
    code, out, err = kintrafo("check", f"no_such_{name}")
    assert (code, out) == (2, "")
    assert "no_such_" in err
