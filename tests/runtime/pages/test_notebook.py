"""Displays of a notebook: HTML with pictures, as IPython requests them."""

import re
import subprocess
import sys
from base64 import b64decode
from html.parser import HTMLParser
from types import SimpleNamespace
from xml.etree import ElementTree as ET

import kintrafo
import pytest
from IPython.core.formatters import HTMLFormatter
from kintrafo import Axle, Model, RigidAxle, SimulationError, Suspension, System
from kintrafo.generated import four_bar
from kintrafo.notebook import register

CAR = Model("reference_car")
CRANK = System(four_bar)


@pytest.fixture(scope="module")
def formatter():
    made = HTMLFormatter()
    register(made)
    return made


class Checked(HTMLParser):
    """Sees that every tag is closed, and collects texts and images."""

    def __init__(self, page):
        super().__init__()
        self.open, self.texts, self.images = [], [], []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, _):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_startendtag(self, _, attrs):
        kind, data = dict(attrs)["src"].split(",")
        assert kind == "data:image/svg+xml;base64"
        self.images.append(ET.fromstring(b64decode(data)))

    def handle_data(self, data):
        self.texts.append(data)


@pytest.mark.parametrize("name", ["reference_car", "multi_link_car", "trailing_arm_car"])
def test_suspensions_of_any_kind(formatter, name):
    car = Suspension.load(name)
    page = Checked(formatter(car))
    assert len(page.images) == 1
    assert page.texts[0] == f"{car.heading()}, right side"
    x, y, z = car.hardpoints.wheel_center
    row = page.texts.index("wheel_center")
    assert [float(text) for text in page.texts[row + 1 : row + 4]] == [x, y, z]
    assert {*car.hardpoints.given()} <= {*page.texts}


def test_a_model_names_its_states(formatter):
    texts = Checked(formatter(CAR)).texts
    assert ", ".join(CAR.state_names) in texts
    assert ", ".join(CAR.input_names) in texts


def test_any_mechanism_is_drawn_beside_its_names(formatter):
    page = Checked(formatter(CRANK))
    assert (page.texts[0], len(page.images)) == (CRANK.equations.NAME.replace("_", " "), 1)
    for names in (CRANK.state_names, CRANK.input_names, CRANK.signal_names):
        assert ", ".join(names) in page.texts


def test_linear_equations_name_their_modes(formatter):
    linear = kintrafo.linearise(CAR, CAR.design_state)
    texts = Checked(formatter(linear)).texts
    assert linear.modes[0].text in texts
    assert ", ".join(linear.output_names) in texts


@pytest.mark.parametrize(
    ("shown", "title"),
    [
        (Axle.load("reference_axle"), "Front axle, MacPherson suspension"),
        (RigidAxle.load("rigid_axle"), "Rigid axle"),
    ],
    ids=["axle", "rigid axle"],
)
def test_axles(formatter, shown, title):
    page = Checked(formatter(shown))
    assert (page.texts[0], len(page.images)) == (title, 1)


def test_a_motion_with_its_first_curves(formatter):
    start = kintrafo.state_at_height(CAR, 0.325)
    page = Checked(formatter(kintrafo.simulate(CAR, (0.0, 0.1), start)))
    assert len(page.images) == 2
    assert "The end of the time was reached." in page.texts
    assert any("the tyre pulls at the road" in text for text in page.texts)


def test_motions_of_other_mechanisms_and_those_that_failed(formatter):
    long_crank = {"crank_pin_x": 0.2, "crank_pin_y": 0.1, "spring_rate": 5000.0}
    crank = System(four_bar, long_crank)
    with pytest.raises(SimulationError) as caught:
        kintrafo.simulate(crank, (0.0, 0.5), crank.state(crank_angle_rate=-20.0))
    texts = Checked(formatter(caught.value.partial)).texts
    assert "failed" in texts
    assert any("dead point" in text for text in texts)


def test_what_runs_in_a_notebook_is_reported(monkeypatch):
    made = HTMLFormatter()
    shell = SimpleNamespace(display_formatter=SimpleNamespace(formatters={"text/html": made}))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    register()
    assert "<table>" in made(CAR)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: None))
    register()  # IPython is there, but no notebook runs


def test_importing_kintrafo_loads_none_of_it():
    listing = "import sys, kintrafo; print([n for n in sys.modules if re.search(PATTERN, n)])"
    pattern = r"matplotlib|IPython|notebook\.p"
    program = f"import re; PATTERN = {pattern!r}; {listing}"
    found = subprocess.run([sys.executable, "-c", program], capture_output=True, check=True)
    assert re.fullmatch(rb"\[\]\s*", found.stdout)


@pytest.mark.parametrize(
    "shown",
    [CAR.suspension, CAR.suspension.hardpoints, RigidAxle.load("rigid_axle")],
    ids=["suspension", "hardpoints", "rigid axle"],
)
def test_completion_proposes_what_is_ours(shown):
    proposed = {name for name in dir(shown) if not name.startswith("_")}
    assert not {name for name in proposed if name.startswith("model_")} | (
        proposed & {"copy", "dict", "json", "parse_obj", "validate", "construct"}
    )
    assert {*type(shown).model_fields} <= proposed
    assert "wheel_center" in dir(CAR.suspension.hardpoints)
    assert {"with_changes", "save", "to_dict"} <= {*dir(CAR.suspension)}


def test_completion_proposes_signals():
    motion = kintrafo.simulate(CRANK, (0.0, 0.01), CRANK.design_state)
    assert motion.signals._ipython_key_completions_() == list(CRANK.signal_names)
