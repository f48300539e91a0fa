"""The input file's JSON Schema, for editors, and its reference page.

``python -m kintrafo.input.schema SCHEMA PAGE`` writes both.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .macpherson import MacPherson as Suspension
from .section import Section
from .units import unit_of

_LIMITS = {
    "ge": "minimum",
    "gt": "exclusiveMinimum",
    "le": "maximum",
    "lt": "exclusiveMaximum",
}

_HEAD = """\
# The input file

A suspension is a TOML file. The name of a key ends in its unit; `[hardpoints]` has one `unit` for
all of its points. Points are `[x, y, z]` in chassis axes of ISO 8855 (x forward, y left, z up), at
the design position. What a file says is checked as a whole: every problem is reported at once, with
the value, the unit, what is allowed and what to do.

`kintrafo new FILE` writes an annotated file to begin with. Editors that know JSON Schema complete
keys and show their meaning with [the schema](../runtime/data/suspension.schema.json). Both it and
this page are written by `make format-page`.

Where the spring is free of force is said in one of four ways: by the slide of the strut
(`spring_free_slide_mm`), by the distance of its seats (`spring_free_length_mm`), by its force with
the strut extended (`spring_preload_N`), or by its force at the design position
(`spring_force_at_design_N`). The damper has a rate in `[strut]`, or a curve in `[damper]`.
"""

_TABLE_HEAD = "| key | unit | allowed | left out | meaning |\n|---|---|---|---|---|"


def schema() -> dict[str, Any]:
    """Return the JSON Schema of the input file.

    Returns
    -------
    dict
        Every key with its description, its unit as ``x-unit`` and its range.
    """
    data: dict[str, Any] = _in_json_schema(Suspension.model_json_schema())
    data["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    data["title"] = "MacPherson suspension"
    for section in data["$defs"].values():
        for key, entry in section.get("properties", {}).items():
            entry.pop("title", None)
            unit = unit_of(key)
            if unit:
                entry["x-unit"] = unit
    for entry in data["properties"].values():
        entry.pop("title", None)
    return data


def _in_json_schema(part: Any) -> Any:
    """Return a schema with pydantic's names of limits in those of JSON Schema."""
    if isinstance(part, dict):
        return {_LIMITS.get(key, key): _in_json_schema(value) for key, value in part.items()}
    return [_in_json_schema(item) for item in part] if isinstance(part, list) else part


def schema_text() -> str:
    """Return the schema as it is published."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


def page_text() -> str:
    """Return the reference page, a table for each section."""
    data = schema()
    parts = [_HEAD, _TABLE_HEAD, *_rows(data, data), "", *_sections(data, data, "", Suspension)]
    return "\n".join(parts).rstrip() + "\n"


def _sections(
    data: dict[str, Any], owner: dict[str, Any], prefix: str, model: type[Section]
) -> Iterator[str]:
    required = owner.get("required", [])
    for name, entry in owner["properties"].items():
        section = _section(data, entry)
        if section is None:
            continue
        title = f"{prefix}{name}"
        optional = "" if name in required else " (optional)"
        yield f"## [{title}]{optional}\n\n{_capital(model.model_fields[name].description)}.\n"
        rows = list(_rows(data, section))
        if rows:
            yield _TABLE_HEAD
            yield "\n".join(rows) + "\n"
        inner = _model_of(model, name)
        yield from _sections(data, section, f"{title}.", inner)


def _model_of(model: type[Section], name: str) -> type[Section]:
    annotation = model.model_fields[name].annotation
    kinds = (annotation, *getattr(annotation, "__args__", ()))
    return next(k for k in kinds if isinstance(k, type) and issubclass(k, Section))


def _section(data: dict[str, Any], entry: dict[str, Any]) -> dict[str, Any] | None:
    """Return the section that an entry refers to; None if it is a value."""
    for option in (entry, *entry.get("anyOf", ()), *entry.get("allOf", ())):
        if "$ref" in option:
            found: dict[str, Any] = data["$defs"][option["$ref"].rpartition("/")[2]]
            return found
    return None


def _rows(data: dict[str, Any], section: dict[str, Any]) -> Iterator[str]:
    required = section.get("required", [])
    for key, entry in section["properties"].items():
        if _section(data, entry) is not None:
            continue
        unit = entry.get("x-unit", "")
        left_out = "refused" if key in required else _default(entry)
        yield f"| `{key}` | {unit} | {_allowed(entry)} | {left_out} | {entry['description']} |"


def _default(entry: dict[str, Any]) -> str:
    value = entry.get("default")
    return "-" if value is None else json.dumps(value)


def _allowed(entry: dict[str, Any]) -> str:
    """Return the range of a value in words."""
    options = [entry, *entry.get("anyOf", ())]
    for option in options:
        choices = [option["const"]] if "const" in option else option.get("enum", ())
        if choices:
            return " or ".join(f'`"{value}"`' for value in choices)
        if option.get("type") == "boolean":
            return "true or false"
        if option.get("type") == "array":
            return "three numbers" if option.get("maxItems") else "numbers"
        if "exclusiveMinimum" in option:
            return f"more than {option['exclusiveMinimum']:g}" + _at_most(option)
        if "minimum" in option:
            low = f"{option['minimum']:g}"
            return f"{low} to {option['maximum']:g}" if "maximum" in option else f"{low} or more"
    return "a number"


def _at_most(option: dict[str, Any]) -> str:
    return f", at most {option['maximum']:g}" if "maximum" in option else ""


def _capital(text: str | None) -> str:
    return (text or "")[:1].upper() + (text or "")[1:]


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(schema_text(), encoding="utf-8", newline="\n")
    Path(sys.argv[2]).write_text(page_text(), encoding="utf-8", newline="\n")
