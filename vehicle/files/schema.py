"""The input file's JSON Schema, for editors, and its reference page."""

import json
from collections.abc import Container, Iterable, Iterator, Mapping
from typing import Any

from pydantic.json_schema import models_json_schema

from ...core.validator import Validator
from ..corner.base import KIND
from ..corner.bushes import BUSH_SCHEMA
from ..data.starter import CAR, DEFAULT, whole_axles, words_of
from ..input.bodies import RigidBody
from ..input.messages import is_named, subsection
from ..input.section import Section
from ..input.units import unit_of
from ..kinds import KINDS
from ..models.axle.file import AxleFile
from ..models.car.driving import LinearTyreSection
from ..models.car.file import CarFile
from ..models.whole_axle import WholeAxle, whole_axle_class

Manoeuvres = Mapping[str, type[Section]]

MANOEUVRE = "manoeuvre"
"""The key of a file of a manoeuvre, and of no other."""

_LIMITS = {
    "ge": "minimum",
    "gt": "exclusiveMinimum",
    "le": "maximum",
    "lt": "exclusiveMaximum",
}

_HEAD = """\
# Input file

A suspension, an axle, a car or a manoeuvre is a TOML file. `kintrafo new FILE` writes an annotated
starter file. The name of a key ends in its unit; `[hardpoints]` has one `unit` for all of its
points. Points are `[x, y, z]` in chassis axes of ISO 8855 (x forward, y left, z up), at the design
position. The line `suspension = "..."` above the first section names the type of the suspension;
keys that only one type has are in the part of that type below. A key without a default (`-`) may be
left out; its meaning names the value or the key that then applies, if there is one.

The file is checked as a whole. Every problem is reported at once, with the value, the unit, the
allowed range and what to do:

```text
my_car.toml: 1 problem
  - line 43: [strut] sprng_rate_N_per_m is not a known key. Did you mean spring_rate_N_per_m?
```

Editors that know JSON Schema complete keys, show their meaning and underline errors.
`kintrafo schema kintrafo.schema.json` writes
[the schema](../../vehicle/data/suspension.schema.json) of suspensions, axles, cars and manoeuvres
beside your files; the first line

```toml
#:schema ./kintrafo.schema.json
```

names it for editors with a TOML language server, such as Even Better TOML for Visual Studio Code.
The schema cannot express whether the points make a mechanism that can be assembled; `kintrafo
check FILE` tests that. The schema and this page are written by `make format-page`.
"""

_BUSHINGS = """\
### [bushings.POINT] (optional)

The compliance of the joint at a hardpoint, for [compliance](../suspension/compliance.md). A
direction without an entry is rigid. One stiffness or curve is needed. `[bushings.rack]` has
`axial_N_per_mm` alone, the stiffness of the steering at the rack. All other analyses have
rigid joints.
"""

_CURVES = """\
### Curves

Springs, dampers and bushes have a rate, or a curve by its points. Between its points a curve is a
monotone cubic (Fritsch and Carlson): smooth, and within the forces of both neighbours. With
`interpolation = "linear"` it consists of straight lines, as in some other programs. Both pass
through the points and differ between them: the damper curve in the comments of the starter file
has -2177 N at -0.7 m/s, straight lines have -1986 N there.

Beyond its points a curve is extrapolated linearly: that of a damper with its slope at the end,
those of springs and bushes with the slope between their last two points, so that they carry any
force. A simulation reports when it goes beyond the points, and `kintrafo check` when the spring is
beyond them at design. At a corner between two straight lines the rate is that of the less
compressed side; a motion over such a corner is as accurate as its tolerances, with more steps.

The force of a spring must not fall as it is compressed. A curve over `length_mm` gives the
force at every distance of the seats, and needs neither `free_length_mm` nor `force_at_design_N`.
A curve over `compression_mm` needs one of them: `free_length_mm` is the distance of the seats
at which the compression is 0; `force_at_design_N` is the force at the design position, from which
the compression there follows.

```toml
[spring]
compression_mm = [0.0, 40.0, 80.0, 120.0, 160.0]
force_N = [0.0, 2000.0, 4400.0, 7600.0, 12000.0]
force_at_design_N = 5360.268
```

Analyses that need a rate take the slope of the curve at the length that the spring has: wheel
rate, ride frequency, compliance, linearised motion. Where a curve is flat, this rate is zero.
"""

_EVERY_BODY = """\
### Every body

All bodies except the wheel have these keys; the wheel is a body of revolution with its own keys.
The inertia is the tensor about the centre of mass, in chassis axes; `xy` is the element of the
matrix, minus the product of inertia.
"""

_AN_AXLE = """\
## An axle

A file of its own, which names the hardpoint files of its sides; `kintrafo new FILE --axle` writes
one. See [Axles](../suspension/axles.md).
"""

_AXLE = "axle"  # the key of a file of an axle, and of no other

_A_CAR = """\
## A car

A file of its own, which names the files of its axles, or of the corner of a quarter car;
`kintrafo new FILE --car` writes one. See [A car](../suspension/car.md).
"""

_A_LINEAR_TYRE = """\
### A linear tyre

`[tyres.front]` and `[tyres.rear]`, instead of the file of a tyre. The forces are linear at small
slip and approach the limit of friction.
"""

_A_MANOEUVRE = """\
## A manoeuvre

A file of its own for `kintrafo drive`; `kintrafo new FILE --template NAME` writes one. Its line
`manoeuvre = "..."` names it. See [Handling](../suspension/handling.md).
"""

_TABLE_HEAD = "| key | unit | allowed | default | meaning |\n|---|---|---|---|---|"


def schema(manoeuvres: Manoeuvres) -> dict[str, Any]:
    """Return the JSON Schema of input files: suspensions, axles, cars and manoeuvres.

    Parameters
    ----------
    manoeuvres : mapping of str to type
        The sections of manoeuvres, by their names in files.

    Returns
    -------
    dict
        Every key with its description, its unit as ``x-unit`` and its range. The keys ``axle``,
        ``rigid_axle`` and so on, ``car`` and ``manoeuvre`` distinguish files; other files are
        suspensions, whose kind defines their sections.
    """
    with Validator("schema") as given:
        given.mapping("manoeuvres", manoeuvres, "sections by the words for them")
    whole = _whole_axles()
    models: list[type[Section]] = [
        *KINDS.values(),
        AxleFile,
        *whole.values(),
        CarFile,
        LinearTyreSection,
        *manoeuvres.values(),
    ]
    _, made = models_json_schema([(model, "validation") for model in models])
    sections = {name: _with_units(section) for name, section in made["$defs"].items()}
    kinds = {"description": "the kind of suspension", "enum": list(KINDS), "default": DEFAULT}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "suspension, axle, car or manoeuvre",
        "type": "object",
        "if": {"required": [_AXLE]},
        "then": _reference(AxleFile),
        "else": {
            "if": {"required": [MANOEUVRE]},
            "then": _named_manoeuvre(manoeuvres),
            "else": _chosen(whole | {CAR: CarFile}, kinds),
        },
        "$defs": sections | {"Bushing": BUSH_SCHEMA},
    }


def _whole_axles() -> dict[str, type[WholeAxle]]:
    """Return the axles without sides by the keys in their files."""
    return {key: whole_axle_class(key) for key in whole_axles()}


def _chosen(by_key: Mapping[str, type[Section]], kinds: dict[str, Any]) -> dict[str, Any]:
    """Return the schema of files of other assemblies, distinguished by their keys."""
    found: dict[str, Any] = {
        "properties": {KIND: kinds},
        "allOf": [{"if": _names(name), "then": _reference(KINDS[name])} for name in KINDS],
    }
    for key, model in reversed([*by_key.items()]):
        found = {"if": {"required": [key]}, "then": _reference(model), "else": found}
    return found


def _named_manoeuvre(manoeuvres: Manoeuvres) -> dict[str, Any]:
    """Return the schema of files of manoeuvres, each of which names its manoeuvre."""
    words = {"description": "name of the manoeuvre", "enum": list(manoeuvres)}
    chosen = [
        {"if": {"properties": {MANOEUVRE: {"const": name}}}, "then": _reference(model)}
        for name, model in manoeuvres.items()
    ]
    return {"properties": {MANOEUVRE: words}, "allOf": chosen}


def _names(kind: str) -> dict[str, Any]:
    """Return the schema of a file that names a kind; the default may be left out."""
    required = [] if kind == DEFAULT else [KIND]
    return {"properties": {KIND: {"const": kind}}, "required": required}


def _reference(model: type[Section]) -> dict[str, str]:
    return {"$ref": f"#/$defs/{model.__name__}"}


def _with_units(made: dict[str, Any]) -> dict[str, Any]:
    """Return the published schema of a section from that of pydantic."""
    section: dict[str, Any] = _in_json_schema(made)
    for key, entry in section["properties"].items():
        entry.pop("title", None)
        unit = unit_of(key)
        if unit:
            entry["x-unit"] = unit
    return section


def _in_json_schema(part: Any) -> Any:
    """Return a schema with pydantic's names of limits replaced by those of JSON Schema.

    Optional values may be None in pydantic's schema, but not in a file.
    """
    if isinstance(part, dict):
        options = part.get("anyOf", ())
        if len(options) == 2 and {"type": "null"} in options:
            (option,) = (one for one in options if one != {"type": "null"})
            part = option | {key: value for key, value in part.items() if key != "anyOf"}
        return {_LIMITS.get(key, key): _in_json_schema(value) for key, value in part.items()}
    return [_in_json_schema(item) for item in part] if isinstance(part, list) else part


def schema_text(manoeuvres: Manoeuvres) -> str:
    """Return the text of the published schema."""
    return json.dumps(schema(manoeuvres), indent=2, ensure_ascii=False) + "\n"


def page_text(manoeuvres: Manoeuvres) -> str:
    """Return the reference page: sections of all kinds, then those of each kind."""
    sections, shared = schema(manoeuvres)["$defs"], _shared()
    first, *_ = KINDS.values()
    parts = [_HEAD, "## Every suspension\n"]
    parts += _described(sections, first, [name for name in first.model_fields if name in shared])
    parts += [_BUSHINGS, *_table(BUSH_SCHEMA)]
    parts += [_CURVES, _EVERY_BODY]
    parts += _table(_with_units(RigidBody.model_json_schema()))
    for name, kind in KINDS.items():
        own = [section for section in kind.model_fields if section not in shared]
        parts.append(f'## {_capital(kind.TITLE)}\n\n`{KIND} = "{name}"`{kind.PAGE}\n')
        parts += _described(sections, kind, own)
    parts += [_AN_AXLE, *_table(sections[AxleFile.__name__])]
    parts += _described(sections, AxleFile, AxleFile.model_fields)
    for key, axle in _whole_axles().items():
        own = [
            name
            for name in axle.model_fields
            if name not in shared or subsection(axle, name) is not subsection(first, name)
        ]
        parts += [f"## {_capital(words_of(key))}\n", axle.PAGE, *_table(sections[axle.__name__])]
        parts += _described(sections, axle, own)
    parts += [_A_CAR, *_table(sections[CarFile.__name__])]
    parts += _described(sections, CarFile, CarFile.model_fields)
    parts += [_A_LINEAR_TYRE, *_table(sections[LinearTyreSection.__name__]), _A_MANOEUVRE]
    for name, manoeuvre in manoeuvres.items():
        parts += [f"### {name}\n", *_table(sections[manoeuvre.__name__])]
        parts += _described(sections, manoeuvre, manoeuvre.model_fields, "", "####")
    return "\n".join(parts).rstrip() + "\n"


def _shared() -> set[str]:
    """Return the names of sections that two or more kinds have and that equal in all of them."""
    first, *others = (
        {name: subsection(kind, name) for name in kind.model_fields} for kind in KINDS.values()
    )
    return {
        name
        for name, model in first.items()
        if any(name in o for o in others) and all(o.get(name, model) is model for o in others)
    }


def _described(
    sections: dict[str, Any],
    model: type[Section],
    names: Iterable[str],
    prefix: str = "",
    level: str = "###",
) -> Iterator[str]:
    """Describe sections in a section, each with a table of its keys."""
    required = sections[model.__name__].get("required", [])
    for name in names:
        inner = subsection(model, name)
        if inner is None or name not in sections[model.__name__]["properties"]:
            continue
        title = f"{prefix}{name}" + (".NAME" if is_named(model, name) else "")
        optional = "" if name in required else " (optional)"
        is_body = issubclass(inner, RigidBody)
        also = ", with the keys of every body" if is_body else ""
        meaning = _capital(model.model_fields[name].description)
        yield f"{level} [{title}]{optional}\n\n{meaning}{also}.\n"
        yield from _table(sections[inner.__name__], RigidBody.model_fields if is_body else ())
        yield from _described(sections, inner, inner.model_fields, f"{title}.", level)


def _table(section: dict[str, Any], known: Container[str] = ()) -> Iterator[str]:
    """Return the table of a section's values, without those that are described elsewhere."""
    rows = list(_rows(section, known))
    if rows:
        yield _TABLE_HEAD
        yield "\n".join(rows) + "\n"


def _rows(section: dict[str, Any], known: Container[str]) -> Iterator[str]:
    required = section.get("required", [])
    for key, entry in section["properties"].items():
        if _is_section(entry) or key in known:
            continue
        unit = entry.get("x-unit", "")
        default = "required" if key in required else _default(entry)
        yield f"| `{key}` | {unit} | {_allowed(entry)} | {default} | {entry['description']} |"


def _is_section(entry: dict[str, Any]) -> bool:
    options = (entry, *entry.get("anyOf", ()))
    named = (option.get("additionalProperties", {}) for option in options)
    return any("$ref" in option for option in (*options, *named))


def _default(entry: dict[str, Any]) -> str:
    value = entry.get("default")
    return "-" if value is None else json.dumps(value)


_SORTS = {"boolean": "true or false", "object": "a table"}


def _allowed(entry: dict[str, Any]) -> str:
    """Return the range of a value as text."""
    options = [entry, *entry.get("anyOf", ())]
    for option in options:
        choices = [option["const"]] if "const" in option else option.get("enum", ())
        if choices:
            return " or ".join(f'`"{value}"`' for value in choices)
        if option.get("type") == "array":
            return "three numbers" if option.get("maxItems") else "numbers"
        if str(option.get("type")) in _SORTS:
            return _SORTS[option["type"]]
        if "exclusiveMinimum" in option:
            most = f", at most {option['maximum']:g}" if "maximum" in option else ""
            return f"more than {option['exclusiveMinimum']:g}{most}"
        if "minimum" in option:
            low = f"{option['minimum']:g}"
            return f"{low} to {option['maximum']:g}" if "maximum" in option else f"{low} or more"
    return "a number" if any(o.get("type") in ("number", "integer") for o in options) else "text"


def _capital(text: str | None) -> str:
    return (text or "")[:1].upper() + (text or "")[1:]
