"""Pictures of any mechanism: its points, pages to move and play, GIFs, and what is refused."""

import json
import re
from importlib import import_module
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from kintrafo.generated import excavator, four_bar, slider_crank
from kintrafo.systems.skeleton import Skeleton
from kintrafo.vehicle.cli import app
from PIL import Image
from support.browser import Watched, needs_chromium
from support.folders import ROOT
from typer.testing import CliRunner

_FOLDER = Path(str(kintrafo.generated.__file__)).parent
GENERATED = sorted(path.stem for path in _FOLDER.glob("*.json"))
EXAMPLE = ROOT / "examples" / "pushrod_suspension.py"


@pytest.mark.parametrize("name", GENERATED)
def test_bodies_carry_the_points_of_their_joints_together(name):
    """Both bodies of a joint have its points in the same place in every motion."""
    module = import_module(f"kintrafo.generated.{name}")
    skeleton = Skeleton(kintrafo.System(module))
    start = skeleton.system.design_state
    size = start.size // 2
    moved = np.tile(start, (5, 1))
    moved[:, :size] += np.random.default_rng(1).uniform(-0.03, 0.03, (5, size))
    places = skeleton.places(moved)
    joints = {j["name"]: j["bodies"] for j in module.equations.manifest["joints"]}
    assert skeleton.joints
    for joint, points in skeleton.joints.items():
        for point in points:
            one, other = (
                places[body][:, skeleton.bodies[body].index(point)] for body in joints[joint]
            )
            np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-12)


def test_points_of_a_four_bar_are_where_circles_meet():
    """By hand: the crank's pin on its circle, the other pin at two lengths from two points."""
    skeleton = Skeleton(kintrafo.System(four_bar))
    design = skeleton.places(skeleton.system.design_state)
    turned = skeleton.places(skeleton.system.state(crank_angle=0.4))
    o, a = design["crank"][:2, :2]
    c, s = np.cos(0.4), np.sin(0.4)
    pin = o + np.array([[c, -s], [s, c]]) @ (a - o)
    np.testing.assert_allclose(turned["crank"][1, :2], pin, atol=1e-15)
    names = skeleton.bodies["rocker"]
    at = {n: (design["rocker"][i], turned["rocker"][i]) for i, n in enumerate(names)}
    for point, beside in (("rocker_bearing", at["rocker_bearing"]), ("pin", (a, pin))):
        before, after = (
            np.hypot(*(at["rocker_pin"][when][:2] - beside[when][:2])) for when in (0, 1)
        )
        assert after == pytest.approx(before, abs=1e-14), point


def _payload(path):
    text = path.read_text(encoding="utf-8")
    found = re.search(r'id="payload">(.*?)</script>', text, re.DOTALL)
    return json.loads(found[1])


def test_report_of_a_mechanism_has_the_positions_of_the_equations(tmp_path):
    """A slider for each coordinate, from the design position to where a loop opens."""
    system = kintrafo.System(excavator)
    data = _payload(kintrafo.report.write(system, tmp_path / "excavator.html"))
    assert [s["name"] for s in data["scenes"]] == [
        "boom_stroke",
        "arm_stroke",
        "bucket_stroke",
        "time",
    ]
    scene = data["scenes"][1]
    for index in (1, 30, 60, 119):
        state = system.state(arm_stroke=scene["values"][index])
        shown = np.reshape(scene["places"]["arm"][index], (-1, 3))
        np.testing.assert_allclose(Skeleton(system).places(state)["arm"], shown, atol=1e-4)
    assert scene["values"][60] == 0.0
    end = np.array(system.state(arm_stroke=scene["values"][-1] * 1.001))
    with pytest.raises(kintrafo.ClosureError):
        system.evaluate("positions", end)


def test_a_full_turn_is_offered_where_it_can_be_made(tmp_path):
    """The crank of a slider-crank turns round; the page mentions no limit."""
    data = _payload(kintrafo.report.write(kintrafo.System(slider_crank), tmp_path / "page.html"))
    values = data["scenes"][0]["values"]
    assert values[-1] - values[0] == pytest.approx(2 * np.pi, rel=1e-5)
    assert "cannot go further" not in (tmp_path / "page.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def spun():
    """The motion of a four-bar that turns round."""
    system = kintrafo.System(four_bar)
    times = np.linspace(0.0, 0.4, 41)
    return kintrafo.simulate(system, (0.0, 0.4), system.state(crank_angle_rate=8.0), t_eval=times)


def test_gif_lasts_as_long_as_the_motion(spun, tmp_path):
    """0.4 s at half speed are 17 frames of 50 ms."""
    path = kintrafo.animate(spun, tmp_path / "linkage.gif", fps=20, slower=2)
    with Image.open(path) as picture:
        assert picture.n_frames == 17
        assert picture.info["duration"] == 50
        first = np.array(picture.convert("RGB"))
        picture.seek(8)
        assert (first != np.array(picture.convert("RGB"))).any()


@pytest.mark.parametrize(
    "options", [{"fps": 0.0}, {"slower": -1.0}, {"slower": 1e6}, {"path": "a.mp4"}]
)
def test_what_cannot_be_shown_is_refused_by_name(spun, tmp_path, options, refused):
    """Rates, lengths and names of files."""
    path = tmp_path / options.pop("path", "a.gif")
    refused(kintrafo.InputError, lambda: kintrafo.animate(spun, path, **options))
    assert not path.exists()


def test_other_things_than_motions_and_systems_are_refused(tmp_path, refused):
    """With what is needed."""
    refused(kintrafo.InputError, lambda: kintrafo.animate("reference_car", tmp_path / "a.gif"))
    with pytest.raises(kintrafo.InputError, match=r"kintrafo\.System"):
        kintrafo.report.write("reference_car", tmp_path / "a.html")


@pytest.mark.parametrize("command", ["characteristics", "simulate", "loads"])
def test_commands_for_suspensions_say_what_a_mechanism_has(command, as_stored):
    """Not that a Python file is no valid TOML."""
    result = CliRunner().invoke(app, [command, str(EXAMPLE)])
    assert isinstance(result.exception, kintrafo.InputError)
    as_stored(str(result.exception))


def test_commands_show_a_mechanism_and_a_suspension(tmp_path):
    """Reports and motions from the command line."""
    for words in (
        ["report", str(EXAMPLE), str(tmp_path / "a.html")],
        [
            "mechanism",
            "animate",
            str(EXAMPLE),
            str(tmp_path / "b.html"),
            "--start",
            "arm_angle_rate=1",
        ],
        ["mechanism", "animate", "reference_car", str(tmp_path / "c.gif"), "--duration", "0.1"],
    ):
        result = CliRunner().invoke(app, words)
        assert result.exit_code == 0, result.output
    scene = _payload(tmp_path / "b.html")["scenes"][0]
    assert scene["states"][1][0] == 1.0
    with Image.open(tmp_path / "c.gif") as picture:
        assert picture.n_frames == 3
    refused = CliRunner().invoke(
        app, ["mechanism", "animate", str(EXAMPLE), str(tmp_path / "d.gif"), "--start", "arm_angle"]
    )
    assert "NAME=VALUE" in str(refused.exception)


class TestInABrowser:
    pytestmark = needs_chromium

    def test_a_page_moves(self, browser, tmp_path):
        """A slider moves the drawing, the table and the markers; nothing goes to the console."""
        path = kintrafo.report.write(kintrafo.System(four_bar), tmp_path / "page.html")
        watched = Watched(browser, path)
        page = watched.page
        before = page.inner_html("#view")
        page.locator("input[data-scene]").first.fill("90")
        assert page.inner_html("#view") != before
        assert page.inner_text("#now tr:first-child td") == "90 °"
        assert page.locator("#charts figure").count() == 2
        page.click("#play")
        page.wait_for_timeout(300)
        assert page.inner_text("#play") == "Pause"
        assert watched.complaints == []
        watched.context.close()


def test_where_it_does_not_stay_is_reported(tmp_path):
    """The excavator rests where modes grow; a four-bar swings about its lowest position."""
    grows = "It does not stay there"
    for module, grown in ((excavator, True), (four_bar, False)):
        page = kintrafo.report.write(kintrafo.System(module), tmp_path / f"{grown}.html")
        assert (grows in page.read_text(encoding="utf-8")) == grown


def test_a_motion_of_another_mechanism_is_refused(spun, tmp_path, refused):
    refused(
        kintrafo.InputError,
        lambda: kintrafo.report.write(kintrafo.System(excavator), tmp_path / "a.html", motion=spun),
    )
    assert not [*tmp_path.iterdir()]


def test_of_several_mechanisms_in_a_file_one_is_shown(tmp_path):
    """The option in the hint works with each command that prints the hint."""
    path = tmp_path / "two.py"
    path.write_text(
        "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n"
        "from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK\n"
    )
    commands = {
        "topology": ["mechanism", "topology", str(path)],
        "report": ["report", str(path), str(tmp_path / "one.html")],
        "animate": [
            "mechanism",
            "animate",
            str(path),
            str(tmp_path / "moving.html"),
            "--duration",
            "0.05",
        ],
        "derivation": ["mechanism", "derivation", str(path), "--out", str(tmp_path / "one.md")],
    }
    for command in commands.values():
        refused = CliRunner().invoke(app, command)
        (hint,) = re.findall(r"--model \w+", str(refused.exception))
        done = CliRunner().invoke(app, [*command, *hint.split()])
        assert done.exit_code == 0, (command, done.output)
        which = command.index(str(path))
        beside = [*command[:which], "reference_car", *command[which + 1 :], *hint.split()]
        assert "--model is for Python files" in CliRunner().invoke(app, beside).output
