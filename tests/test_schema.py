"""The JSON Schema of the input file and its page: up to date, and of one mind with the checks."""

import json
from importlib import resources
from pathlib import Path

import pytest
from kintrafo import Suspension, data
from kintrafo.input import schema
from kintrafo.input.section import Section

ROOT = Path(__file__).parents[1]
PUBLISHED = resources.files(data).joinpath("suspension.schema.json").read_text(encoding="utf-8")


def test_what_is_published_is_what_the_models_say():
    assert schema.schema_text() == PUBLISHED, "make format-page writes it anew"
    page = (ROOT / "docs/file-format.md").read_text(encoding="utf-8")
    assert page == schema.page_text(), "make format-page writes it anew"


def test_every_key_is_described_and_every_number_has_a_unit_or_none():
    sections = json.loads(PUBLISHED)["$defs"]
    for name, section in sections.items():
        for key, entry in section["properties"].items():
            assert entry.get("description") or "$ref" in str(entry), f"{name}.{key}"
            assert ("x-unit" in entry) == bool(schema.unit_of(key)), f"{name}.{key}"


@pytest.mark.parametrize(
    ("section", "key", "limits"),
    [
        ("Strut", "spring_rate_N_per_m", {"minimum": 0.0}),
        ("Wheel", "camber_deg", {"minimum": -45.0, "maximum": 45.0}),
        ("WheelBody", "mass_kg", {"exclusiveMinimum": 0.0}),
    ],
)
def test_ranges_are_in_the_words_of_json_schema(section, key, limits):
    entry = json.loads(PUBLISHED)["$defs"][section]["properties"][key]
    assert limits.items() <= entry.items()


def test_page_has_a_row_for_every_key_of_the_reference_car():
    page = schema.page_text()

    def keys(section):
        for key, value in section.items():
            if isinstance(value, dict):
                yield from keys(value)
            else:
                yield key

    for key in keys(Suspension.load("reference_car").to_dict()):
        assert f"| `{key}` |" in page
    assert "## [bodies.wheel]" in page
    assert issubclass(schema.Suspension, Section)
