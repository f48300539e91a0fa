"""Tables of the page: characteristics at design, and the input data."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..corner.bushes import BUSH_SCHEMA
from ..input.section import Section
from ..kinds import Suspension
from ..models.plausibility import typical_ranges
from .curves import CharacteristicCurve
from .payload import ReportSamples


@dataclass(frozen=True)
class Row:
    """One characteristic at design."""

    curve: CharacteristicCurve
    value: float  # value at design, in the display unit of the curve
    decimals: int  # number of decimals of the written value
    typical: str = ""  # typical range; empty if unknown
    source: str = ""  # source of this range
    verdict: str = ""  # comparison of the value with the range


@dataclass(frozen=True)
class InputTable:
    """One section of the input file."""

    name: str  # as in the file; empty for keys before the first section
    meaning: str
    rows: list[tuple[str, str, str]]  # key, value as text, and meaning


def summary(samples: ReportSamples, suspension: Suspension) -> list[Row]:
    """Return the characteristics over travel at the design position.

    Typical ranges exist for front wheels, which are steered.
    """
    usual = typical_ranges(suspension.suspension) if suspension.steered() else {}
    design = samples.grid.travel.zero, samples.grid.rack.zero
    return [
        _row(curve, curve.values[design], samples.looks[curve.key].decimals, usual.get(curve.name))
        for curve in samples.curves
        if curve.over == "travel"
    ]


def _row(
    curve: CharacteristicCurve, value: float, decimals: int, usual: dict[str, Any] | None
) -> Row:
    shown = value * curve.factor
    plain = Row(curve, shown, decimals)
    # a range in another unit cannot be compared
    if usual is None or usual["unit"] != curve.unit:
        return plain
    within = usual["low"] <= round(shown, decimals) <= usual["high"]
    return replace(
        plain,
        typical=f"{usual['low']:g} to {usual['high']:g}".replace("-", "\u2212"),
        source=usual["source"],
        verdict="within" if within else "outside",
    )


def input_tables(described: Section) -> list[InputTable]:
    """Return the input data of a suspension or a rigid axle, a table for each section."""
    return list(_tables(described, "", "above the first section"))


def _tables(section: Section, name: str, meaning: str) -> Iterator[InputTable]:
    """Yield the table of a section's values, then those of the sections in it."""
    fields = type(section).model_fields
    values = {key: getattr(section, key) for key in fields}
    rows = [
        (key, _text(value), fields[key].description or "")
        for key, value in values.items()
        if value is not None and not _has_tables(value)
    ]
    if rows:
        yield InputTable(name, meaning, rows)
    for key, value in values.items():
        if isinstance(value, Section):
            yield from _tables(value, f"{name}.{key}".lstrip("."), fields[key].description or "")
        elif isinstance(value, Mapping) and all(isinstance(v, Section) for v in value.values()):
            for inner, named in value.items():
                yield from _tables(named, f"{key}.{inner}", fields[key].description or "")
        elif _has_tables(value):  # of bushes, by point
            known = BUSH_SCHEMA["properties"]
            for point, table in value.items():
                rows = [(k, _text(own), known[k]["description"]) for k, own in table.items()]
                yield InputTable(f"{key}.{point}", fields[key].description or "", rows)


def _has_tables(value: Any) -> bool:
    """Return whether a value is a section, or a table of sections or tables."""
    if isinstance(value, Mapping):
        return all(isinstance(inner, Section | Mapping) for inner in value.values())
    return isinstance(value, Section)


def _text(value: Any) -> str:
    """Return a value as text; numbers in full, points with commas, truth as in TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple | list):
        return ", ".join(_text(item) for item in value)
    if isinstance(value, Mapping):
        return "; ".join(f"{key}: {_text(inner)}" for key, inner in value.items())
    if isinstance(value, float):
        return f"{value:.12g}".replace("-", "\u2212")
    return str(value)
