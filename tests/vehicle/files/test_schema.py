"""The JSON Schema of the input file and its page: up to date, and of one mind with the checks."""

import json
import tomllib
from importlib import resources

import jsonschema
import pytest
from kintrafo import Axle, Suspension, handling
from kintrafo.core.errors import InputError
from kintrafo.vehicle import data
from kintrafo.vehicle.analysis.handling import MANOEUVRES
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.cli.published import published
from kintrafo.vehicle.data import axles as axle_data
from kintrafo.vehicle.data.starter import manoeuvres
from kintrafo.vehicle.files import schema
from support.folders import ROOT
from typer.testing import CliRunner

PUBLISHED = resources.files(data).joinpath("suspension.schema.json").read_text(encoding="utf-8")


def test_what_is_published_is_what_the_models_say():
    page = (ROOT / "docs/reference/file-format.md").read_text(encoding="utf-8")
    assert published() == (PUBLISHED, page), "make format-page writes it anew"


def test_every_key_is_described_and_every_number_has_a_unit_or_none():
    sections = json.loads(PUBLISHED)["$defs"]
    for name, section in sections.items():
        for key, entry in section["properties"].items():
            assert entry.get("description") or "$ref" in str(entry), f"{name}.{key}"
            assert ("x-unit" in entry) == bool(schema.unit_of(key)), f"{name}.{key}"


@pytest.mark.parametrize(
    ("section", "key", "limits"),
    [
        ("StrutSection", "spring_rate_N_per_m", {"minimum": 0.0}),
        ("WheelSection", "camber_deg", {"minimum": -45.0, "maximum": 45.0}),
        ("WheelBody", "mass_kg", {"exclusiveMinimum": 0.0}),
    ],
)
def test_ranges_are_in_the_words_of_json_schema(section, key, limits):
    entry = json.loads(PUBLISHED)["$defs"][section]["properties"][key]
    assert limits.items() <= entry.items()


CARS = ("reference_car", "offset_strut_car", "chrono_generic", "double_wishbone_car")


def read(name):
    text = resources.files(data).joinpath(f"{name}.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@pytest.mark.parametrize("name", CARS)
def test_page_has_a_row_for_every_key_of_a_car(name):
    page = schema.page_text(MANOEUVRES)

    def keys(section):
        for key, value in section.items():
            if isinstance(value, dict):
                yield from keys(value)
            else:
                yield key

    for key in keys({k: v for k, v in read(name).items() if k != "suspension"}):
        assert f"| `{key}` |" in page
    assert "## [bodies.wheel]" in page


def test_what_every_kind_has_is_on_the_page_once():
    page, _, of_rigid_axles = schema.page_text(MANOEUVRES).partition("## A rigid axle")
    assert "### [rods.NAME]" in of_rigid_axles
    for section in ("vehicle", "wheel", "rack", "gravity"):
        assert page.count(f"### [{section}]") == 1
    assert page.count("| `inertia_xy_kg_m2` |") == 1


# -- with a validator of its own ----------------------------------------------------------------


@pytest.fixture(scope="module")
def validator():
    published = json.loads(PUBLISHED)
    jsonschema.Draft202012Validator.check_schema(published)
    return jsonschema.Draft202012Validator(published)


@pytest.mark.parametrize("name", CARS)
def test_packaged_cars_are_valid(validator, name):
    car = read(name)
    validator.validate(car)
    if name != "double_wishbone_car":  # the kind may be left out
        validator.validate({k: v for k, v in car.items() if k != "suspension"})


@pytest.mark.parametrize(
    ("name", "section", "key", "value", "complaint"),
    [
        ("reference_car", "wheel", "camber_deg", 46.0, "greater than the maximum of 45"),
        ("reference_car", "wheel", "camber_degree", 1.0, "'camber_degree' was unexpected"),
        ("reference_car", "hardpoints", "ball_joint", [1.0, 2.0], "too short"),
        ("reference_car", "hardpoints", "upper_ball_joint", [0.0] * 3, "was unexpected"),
        ("double_wishbone_car", "strut", "length_max_mm", 1.0, "'strut' was unexpected"),
        ("double_wishbone_car", "spring", "rate_N_per_m", -1.0, "less than the minimum of 0"),
    ],
)
def test_what_the_program_refuses_the_schema_refuses_too(
    validator, name, section, key, value, complaint
):
    car = read(name)
    car.setdefault(section, {})[key] = value
    (error,) = validator.iter_errors(car)
    assert complaint in error.message
    with pytest.raises(InputError):
        Suspension.from_dict(car)


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({}, ""),
        ({"sides": "reference_car"}, "'sides' was unexpected"),
        ({"axle": "middle"}, "'middle' is not one of"),
        ({"side": 3}, "3 is not of type 'string'"),
        ({"drive": {"share": 2.0}}, "2.0 is greater than the maximum of 1"),
        ({"suspension": "macpherson"}, "'suspension' was unexpected"),
    ],
)
def test_files_of_axles_are_in_it(validator, changes, complaint):
    folder = resources.files(axle_data)
    text = folder.joinpath("reference_axle.toml").read_text(encoding="utf-8")
    axle = tomllib.loads(text)
    found = [error.message for error in validator.iter_errors(axle | changes)]
    assert [complaint in message for message in found] == [True] * bool(changes)
    if changes:
        with pytest.raises(InputError):
            Axle.from_dict(axle | changes)


@pytest.mark.parametrize("name", manoeuvres())
def test_packaged_manoeuvres_are_valid(validator, name):
    found = tomllib.loads(manoeuvres()[name].read_text(encoding="utf-8"))
    validator.validate(found)
    first = next(key for key, value in found.items() if isinstance(value, float))
    for changes, complaint in (
        ({"sped": 3.0}, "'sped' was unexpected"),
        ({"manoeuvre": "step_ster"}, "is not one of"),
        ({first: -1.0}, "less than"),
    ):
        assert any(complaint in error.message for error in validator.iter_errors(found | changes))


@pytest.mark.parametrize("name", manoeuvres())
def test_numbers_beyond_the_published_ranges_of_manoeuvres_are_errors(name):
    found = tomllib.loads(manoeuvres()[name].read_text(encoding="utf-8"))
    model = MANOEUVRES[found["manoeuvre"]]
    for key, entry in json.loads(PUBLISHED)["$defs"][model.__name__]["properties"].items():
        if key not in found:  # it may be one of several, of which one is allowed
            continue
        for end, factor in (("minimum", 0.999), ("maximum", 1.001)):
            if entry.get(end):
                with pytest.raises(InputError, match=f"{key} = "):
                    handling.load_manoeuvre(name, {key: factor * entry[end]})


def test_a_kind_that_there_is_not(validator):
    errors = list(validator.iter_errors(read("reference_car") | {"suspension": "leaf_spring"}))
    assert [error.validator for error in errors] == ["enum"]


# -- the command ----------------------------------------------------------------------------------


def test_the_command_prints_or_writes_it(tmp_path):
    run = CliRunner().invoke
    assert run(app, ["schema"]).output == PUBLISHED
    path = tmp_path / "folder" / "kintrafo.schema.json"
    assert run(app, ["schema", str(path)]).exit_code == 0
    assert path.read_text(encoding="utf-8") == PUBLISHED
    assert [file.name for file in path.parent.iterdir()] == [path.name]
