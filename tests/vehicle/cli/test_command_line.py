"""``kintrafo paper`` and ``python -m kintrafo.generator``: what they write and say."""

import os
import re
import subprocess
import sys
import tomllib
import typing
import xml.etree.ElementTree as ET
from collections import defaultdict

import numpy as np
import pytest
import typer
from kintrafo import Model
from kintrafo.__main__ import run
from kintrafo.generator.__main__ import app as generator_app
from kintrafo.vehicle import cli
from kintrafo.vehicle.analysis import paper
from matplotlib.image import imread
from support.folders import ROOT
from typer.testing import CliRunner

MODEL = Model("reference_car")
REFERENCE = ROOT / "vehicle/data/reference_car.toml"


def test_paper_writes_figures_and_a_summary(tmp_path):
    result = CliRunner().invoke(cli.app, ["paper", str(tmp_path)])
    assert result.exit_code == 0, result.output
    for word in ("mobility", "300.000 mm", "-18.0825", "75.4816", "13 s", "6 min", "no hardpoints"):
        assert word in " ".join(result.output.split()), word
    names = [f"figure_{n}" for n in ("4_wheel_path", "5_wheel_angles", "6_wheel_motion")]
    for name in names:
        assert imread(tmp_path / f"{name}.png").std() > 0.01  # not a blank page
        assert ET.parse(tmp_path / f"{name}.svg").getroot().tag.endswith("svg")
    assert imread(tmp_path / "overview.png").std() > 0.01


@pytest.mark.usefixtures("rough_drawings")
def test_paper_of_a_car_that_nothing_steers(tmp_path):
    """It has no rack that is held."""
    command = ["paper", str(tmp_path / "out"), "--data", "trailing_arm_car"]
    result = CliRunner().invoke(cli.app, command)
    assert result.exit_code == 0, result.output
    assert "rack" not in result.output


def test_users_mistake_has_no_traceback(kintrafo):
    code, _, error = kintrafo("paper", "out", "--data", "no_such_car")
    assert code == 2
    assert "no_such_car" in error
    assert "Traceback" not in error


def entry_points():
    """Return the ways into the command line: the script that is installed, and ``-m``."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    module, function = project["scripts"]["kintrafo"].split(":")
    return ["-c", f"from {module} import {function}; {function}()"], ["-m", "kintrafo"]


@pytest.mark.parametrize("way", entry_points())
def test_an_interrupt_while_python_imports_ends_quietly(tmp_path, way):
    """As if Ctrl-C came while the first package that is not Python's own was imported."""
    (tmp_path / "typer.py").write_text("raise KeyboardInterrupt", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, *way, "--help"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_of_a_command_ends_quietly(monkeypatch, capfd):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("kintrafo.vehicle.analysis.checkup.checkup", interrupted)
    monkeypatch.setattr("sys.argv", ["kintrafo", "check", "reference_car"])
    with pytest.raises(SystemExit) as end:
        run()
    assert end.value.code == 130
    assert tuple(capfd.readouterr()) == ("", "")


def test_error_keeps_the_brackets_of_section_names(kintrafo, tmp_path):
    text = REFERENCE.read_text(encoding="utf-8").replace("spring_rate_N", "sprng_rate_N")
    (tmp_path / "my_car.toml").write_text(text, encoding="utf-8")
    _, _, error = kintrafo("paper", "out", "--data", "my_car.toml")
    assert "[strut] sprng_rate_N_per_m is not a known key" in error


def test_file_in_the_way_of_the_folder(kintrafo, tmp_path):
    (tmp_path / "out").write_text("in the way", encoding="utf-8")
    code, _, error = kintrafo("paper", "out")
    assert code != 0
    assert "File exists" in error


def test_version_names_the_solver():
    result = CliRunner().invoke(cli.app, ["--version"])
    assert result.exit_code == 0
    assert "kintrafo" in result.output
    assert "SUNDIALS" in result.output


def test_overdamped_wheel_hop_is_said_to_be_so():
    stiff = Model(MODEL.suspension.with_changes({"strut.damper_rate_N_s_per_m": 60000.0}))
    rest = paper.rest(stiff).hop
    assert not rest.oscillates
    assert "overdamped" in rest.text
    # two real roots of s^2 + 2 zeta w s + w^2
    first, second = (value.real for value in rest.eigenvalues)
    frequency = 2 * np.pi * rest.natural_frequency
    assert first * second == pytest.approx(frequency**2)
    assert -(first + second) == pytest.approx(2 * rest.damping_ratio * frequency)


def test_design_position_is_that_of_the_car():
    higher = Model(MODEL.suspension.with_changes({"hardpoints.wheel_center.z": 310.0}))
    curves = paper.kinematics(higher, points=7)
    assert curves.z[curves.design] == pytest.approx(0.31, abs=1e-12)
    assert curves.camber[curves.design] == pytest.approx(0.0, abs=1e-12)


def test_figures_show_what_the_paper_describes():
    curves = paper.kinematics(MODEL, points=61)
    assert curves.z == pytest.approx(np.linspace(0.15, 0.45, 61), abs=1e-14)
    # Figure 5: the camber changes its sign, the toe turns in as the wheel rises (oversteering)
    assert curves.camber[0] > 0.0 > curves.camber[-1]
    assert curves.steer[-1] > 0.0 > curves.steer[0]


def test_figure_six_starts_and_settles():
    motion = paper.dynamics(MODEL)
    height = motion.result.signals["wheel_center_z"]
    assert height[0] == pytest.approx(0.325, abs=1e-12)
    assert height[-1] == pytest.approx(0.3, abs=1e-6)
    assert motion.result.t.size == 10_001
    assert motion.seconds > 0.0


def test_topology_command_prints_tables_and_draws_the_graph(tmp_path):
    picture = tmp_path / "new" / "graph.png"
    result = CliRunner().invoke(generator_app, ["topology", "--picture", str(picture)])
    assert result.exit_code == 0, result.output
    words = " ".join(result.output.split())
    for word in (
        "= 3; independent loops: 2",
        "transformer 1",
        "transformer 2",
        "2154",
        "C.azimuth",
    ):
        assert word in words, word
    assert imread(picture).std() > 0.01


@pytest.mark.parametrize("name", cli.COMMANDS)
def test_help_says_all_that_the_function_does(name, monkeypatch):
    """Text in brackets is not markup, and lines break at the width of the terminal."""
    monkeypatch.setenv("COLUMNS", "600")
    words = [*name.split(), "--help"]
    shown = CliRunner().invoke(cli.app, words, env={"COLUMNS": "600"}).output
    command = cli.COMMANDS[name].command
    for paragraph in command.__doc__.split("\n\n"):
        assert " ".join(paragraph.split()) in " ".join(shown.split())
    for hint in typing.get_type_hints(command, include_extras=True).values():
        for info in getattr(hint, "__metadata__", ()):
            assert " ".join((info.help or "").split()) in " ".join(shown.split())


# Options with different lists of names: motions, wheels on a road or under a load.
_OF_SEVERAL_LISTS = {"--over", "--wheels"}


def test_options_of_one_name_have_values_of_one_kind():
    """No option is a length in one command and a time in another one."""
    kinds = defaultdict(set)
    groups = [typer.main.get_command(cli.app)]
    for group in groups:
        for command in group.commands.values():
            groups += [command] if hasattr(command, "commands") else []
            for option in command.params:
                if option.param_type_name == "option":
                    assert sum(name.startswith("--") for name in option.opts) == 1, option.opts
                    kinds[max(option.opts, key=len)].add(option.metavar)
    assert len(kinds) > 80
    assert {name for name, found in kinds.items() if len(found) > 1} == _OF_SEVERAL_LISTS


def test_what_documents_name_is_there_after_one_import():
    documents = [*(ROOT / "docs").rglob("*.md"), ROOT / "README.md"]
    named = {
        n for d in documents for n in re.findall(r"`(kintrafo(?:\.\w+)+)", d.read_text("utf-8"))
    }
    assert "kintrafo.report.write" in named
    named -= {"kintrafo.generator"}  # of an extra, imported by its own name
    script = "import sys, kintrafo\nfor name in sys.argv[1:]: eval(name)"
    subprocess.run([sys.executable, "-c", script, *sorted(named)], check=True)


@pytest.mark.parametrize(
    ("line", "unused"),
    [
        (["--help"], {"xarray", "scipy", "pandas", "pydantic", "numpy"}),
        (
            ["check", "reference_car"],
            {"xarray", "pandas", "scipy.interpolate", "kintrafo.simulation", "rich.markdown"},
        ),
        (["check", "reference_axle"], {"xarray", "pandas", "scipy.interpolate"}),
        (["check", "rigid_axle"], {"kintrafo.vehicle.plots", "kintrafo.simulation"}),
        (
            ["characteristics", "reference_car"],
            {"scipy.interpolate", "scipy.io", "kintrafo.simulation", "kintrafo.vehicle.studies"},
        ),
    ],
)
def test_a_command_imports_only_what_it_uses(line, unused):
    program = "import sys; from kintrafo.__main__ import run\n"
    program += "try: run()\nexcept SystemExit as end: assert not end.code, end.code\n"
    program += "print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program, *line], capture_output=True, check=True, text=True
    )
    assert not (unused | {"matplotlib", "sympy", "dask"}) & set(done.stdout.split())
