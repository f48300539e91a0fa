"""``kintrafo paper`` and ``python -m kintrafo.generator``: what they write and say."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from kintrafo import Model, cli, paper
from kintrafo.generator.__main__ import app as generator_app
from matplotlib.image import imread
from typer.testing import CliRunner

MODEL = Model("reference_car")


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


def test_users_mistake_has_no_traceback(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr("sys.argv", ["kintrafo", "paper", str(tmp_path), "--data", "no_such_car"])
    with pytest.raises(SystemExit) as caught:
        cli.run()
    assert caught.value.code == 2
    error = capsys.readouterr().err
    assert "no_such_car" in error
    assert "Traceback" not in error


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
