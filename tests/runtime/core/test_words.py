"""Words of the command line and of pages: units and names that users know."""

import json
import re
from typing import get_type_hints

import kintrafo
import numpy as np
import pytest
import typer.main
from kintrafo import InputError, Model, Suspension, export, variation
from kintrafo.core.quantities import unit_or_stroke
from kintrafo.equations.errors import located
from kintrafo.generated import four_bar
from kintrafo.pages.embedded import embedded
from kintrafo.vehicle import cli
from kintrafo.vehicle.analysis.sheet import sheet
from kintrafo.vehicle.cli.option_groups import with_groups

# -- pages -----------------------------------------------------------------------------------------

TEXTS = ["<!-- <script>", "</script>", "<!--", "]]>", "a < b & c", "\u2028"]


@pytest.mark.parametrize("text", TEXTS)
def test_data_in_a_page_end_nothing(text):
    data = {text: [text, {"meaning": text}]}
    page = embedded(data)
    assert "<" not in page
    assert json.loads(page) == data


def test_every_page_has_its_data_without_marks(tmp_path):
    """Of all pages that hold data: that of a mechanism, of a motion and of a suspension."""
    title = "<!-- <script>"
    system = kintrafo.System(four_bar)
    result = kintrafo.simulate(
        system, (0.0, 0.1), system.design_state, t_eval=np.linspace(0.0, 0.1, 4)
    )
    pages = [
        kintrafo.report.write(system, tmp_path / "mechanism.html", title=title),
        kintrafo.animate(result, tmp_path / "motion.html", title=title),
    ]
    for page in pages:
        text = page.read_text(encoding="utf-8")
        (data,) = re.findall(r'<script[^>]*id="payload"[^>]*>(.*?)</script>', text, re.DOTALL)
        assert "<" not in data
        assert "&lt;!-- &lt;script&gt;" in text
        assert "<!-- <script>" not in text


# -- numbers at the command line -------------------------------------------------------------------


def number_options():
    """Return command, option, unit and whether it is whole, of every option that is a number."""
    found = []
    root = typer.main.get_command(cli.app)
    for name, module in cli.COMMANDS.items():
        hints = get_type_hints(with_groups(module.command), include_extras=True)
        command = root
        for word in name.split():
            command = command.commands[word]
        for parameter in command.params:
            hint = str(hints.get(parameter.name, ""))
            kinds = re.findall(r"\b(float|int)\b", hint.partition("typer")[0])
            if kinds and parameter.opts[0].startswith("--"):
                found.append((name, parameter.opts[0], parameter.metavar, kinds[0] == "int"))
    return found


@pytest.mark.parametrize(("command", "option", "unit", "whole"), number_options())
def test_every_number_is_refused_with_its_unit(kintrafo, command, option, unit, whole):
    known = {"MM": "mm", "M": "m", "DEG": "deg", "S": "s", "MS": "ms", "HZ": "Hz", "KM/H": "km/h"}
    known |= {"REV/S": "rev/s", "1/S": "1/s", "N": "N", "%": "%"}
    assert whole or unit in (*known, "NUMBER", "TIMES"), "a unit that no message names"
    for value in ("80mm", "1_0"):
        code, _, err = kintrafo(*command.split(), "a", "b", "c", option, value)
        message = " ".join(re.sub(r"[│╭╰─╮╯]", " ", err).split())
        assert code == 2
        assert "valid" not in message.replace("Invalid value for", ""), message
        in_unit = f" in {known[unit]}, without the unit," if unit in known else ""
        wanted = "a whole number" if whole else f"a finite number{in_unit}"
        assert f"{value!r}: {wanted}" in message


def test_there_are_such_options():
    assert len(number_options()) > 40


@pytest.mark.parametrize("line", ["compare a b --over x", "new a.toml --suspension x"])
def test_a_choice_is_refused_in_our_words(kintrafo, line):
    code, _, err = kintrafo(*line.split())
    assert code == 2
    assert "Value error" not in err


# -- units and names -------------------------------------------------------------------------------


def test_a_stroke_is_no_formula(tmp_path):
    written = export.write(sheet(Model("reference_car")), tmp_path / "sheet.csv")
    rows = written.read_text(encoding="utf-8").splitlines()
    assert any(",-," in row for row in rows)
    assert "'-" not in written.read_text(encoding="utf-8")


def test_units_with_a_one_in_them():
    units = ["1", "", "1/s", "deg/(100 N m)", "10 N"]
    shown = [unit_or_stroke({"units": unit}) for unit in units]
    assert shown == ["-", "-", "1/s", "deg/(100 N m)", "10 N"]


def test_states_are_called_by_what_they_are():
    """Of a suspension whose equations have the symbols of the paper."""
    model = Model("reference_car")
    with pytest.raises(kintrafo.SimulationError, match=r"beta1 = \S+ rad \(arm angle\), beta5"):
        kintrafo.simulate(model, (0.0, 1.0), model.state(beta1_rate=1e6))
    assert located({"crank": 1.0, "ratio": 2.0}, {"crank": {"unit": "rad", "meaning": "x"}}) == (
        "crank = 1 rad, ratio = 2"
    )


def test_what_is_not_at_rest_has_its_own_unit():
    system = kintrafo.System(four_bar)
    with pytest.raises(InputError, match=r" rad/s\^2"):
        kintrafo.rest(system, inputs={"crank_torque": 1e9})


def test_rest_of_a_mechanism_is_named(refused):
    refused(InputError, lambda: kintrafo.equilibrium(kintrafo.System(four_bar)))


TINY = (5e-324, 1e-320, 1e-200, 1e-13, 1e12, 1e200, 1e308)


@pytest.mark.parametrize("value", TINY)
def test_amounts_beyond_all_measure(value, refused):
    """Their squares would be zero or infinite: no raw error in any study."""
    car = Suspension.load("reference_car")
    measured = kintrafo.characteristics.over(Model(car), "travel", [-0.02, 0.0, 0.02])[["toe"]]
    place = "hardpoints.tie_rod_inner.z"
    goal = {"toe": {"value": 0.1, "within": 1.0}}
    for study in (
        lambda: variation.fit(car, measured, {place: 1.0}, accuracy={"toe": value}),
        lambda: variation.fit(car, measured, {place: value}),
        lambda: variation.optimise(car, {place: value}, targets=goal),
        lambda: variation.tolerance(car, {place: value}, count=2),
    ):
        with refused(InputError):
            study()


# -- tables with --of ------------------------------------------------------------------------------

BUSHES = {
    "reference_car": "[bushings.arm_rear]\nradial_N_per_mm = 1000.0\n",
    "rigid_axle": "[bushings.panhard_rod_axle]\naxial_N_per_mm = 5000.0\n",
}
GRID = "--bump 20 --rebound 20 --step 10"


@pytest.mark.parametrize(
    ("line", "there", "elsewhere"),
    [
        (f"characteristics reference_car {GRID} --of bump_steer", "bump steer", "camber"),
        (f"characteristics reference_axle {GRID} --over bump --of toe", "toe angle", "camber"),
        (f"characteristics reference_axle {GRID} --over roll --of toe", "toe left", "camber"),
        (f"characteristics rigid_axle {GRID} --over roll --of roll_steer", "roll steer", "toe"),
        ("compliance reference_car --bushes b.toml --of toe_by_lateral", "lateral force", "camber"),
        (
            "compliance rigid_axle --bushes b.toml --of axle_steer_by_lateral_parallel",
            "steer",
            "toe",
        ),
        ("compare reference_car reference_car --of toe", "toe", "camber"),
        ("sensitivity reference_car --of toe", "toe", "camber"),
    ],
)
def test_tables_have_what_was_asked_for(kintrafo, tmp_path, line, there, elsewhere):
    subject = line.split()[1]
    (tmp_path / "b.toml").write_text(BUSHES.get(subject, ""), encoding="utf-8")
    code, out, err = kintrafo(*line.split())
    assert code == 0, err
    assert there in " ".join(out.split())
    assert elsewhere not in out
