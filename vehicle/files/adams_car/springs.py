"""The spring of a subsystem of Adams/Car: its rate or curve, and its force at the design position.

It is read from a property file beside the subsystem, in which deflection and force are positive in
compression. A straight curve is a rate.
"""

import math
import os
import re
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import tomlkit

from ....core.errors import InputError
from ...input.curve import SEGMENTS
from ...input.teim_orbit import FileBlock, read_blocks
from ...input.teim_values import MILLIMETRES, NEWTONS, Values, number, shown, unit_of
from ..fitting import Side, fewer
from .subsystem import Subsystem

_STRAIGHT = 1e-3  # greatest distance of a straight curve from a line, over the greatest force
_FOLDER = "springs.tbl"
_NAME = "usage"  # key of the name in the template
_FORCE = ("value_type", "user_value")


class AdamsSpring(NamedTuple):
    """A spring."""

    rate: float | None  # [N/m]; None for a curve
    force: float | None  # at the design position [N]; None if not known
    file: str  # name of the property file
    curve: tuple[tuple[float, float], ...] = ()  # compressions [mm], rising, and forces [N]
    lost: tuple[tuple[float, float], ...] = ()  # surplus points of the curve, which are left out

    def words(self) -> str:
        """Return a description."""
        force = "" if self.force is None else f", {self.force:g} N at design"
        law = f"by {len(self.curve)} points" if self.rate is None else f"{self.rate / 1e3:g} N/mm"
        return f"spring {law}{force} ({self.file})"

    def reaches(self, force: float) -> bool:
        """Return whether a compression has a force [N]."""
        return not self.curve or self.curve[0][1] < force < self.curve[-1][1]


def spring_of(subsystem: Subsystem, side: Side) -> tuple[AdamsSpring | None, list[str]]:
    """Return the spring of a side, and descriptions of springs and keys that are not read."""
    of_side, unread = [], []
    for values in subsystem.springs:
        if values.get("symmetry", "left/right").lower() in ("left/right", "single", side):
            of_side.append(values)
        else:
            unread.append(f"{_named(values)} is not of the {side} side: {_words(values)}")
    if len(of_side) != 1:
        several = [f"{_named(v)} is not the only one: {_words(v)}" for v in of_side]
        return None, [*unread, *several]
    (values,) = of_side
    try:
        found = _spring(values, subsystem)
    except InputError as error:
        return None, [*unread, f"{_named(values)}: {error.problems[0]} {_words(values)}"]
    read = ["symmetry", "property_file", *(_FORCE if found.force is not None else ())]
    rest = {key: value for key, value in values.items() if key not in read}
    if found.lost:
        points = ", ".join(f"{x:g} mm: {force:g} N" for x, force in found.lost)
        unread.append(f"{_named(values)}: points of the greatest extension ({points})")
    return found, [*unread, *([f"{_named(values)}: {_words(rest)}"] if _words(rest) else [])]


def _named(values: Mapping[str, str]) -> str:
    return f"spring {shown(values.get(_NAME, ''))}"


def _words(values: Mapping[str, str]) -> str:
    """Return keys and values in printable form."""
    return ", ".join(f"{shown(k.upper())} = {shown(v)}" for k, v in values.items() if k != _NAME)


def _spring(values: Mapping[str, str], subsystem: Subsystem) -> AdamsSpring:
    """Return the spring of a block, or raise an `InputError` with the reason why not."""
    name = re.split(r"[\\/:>]", values.get("property_file", ""))[-1]
    file = _beside(Path(subsystem.source).parent, name)
    if file is None:
        raise InputError([f"its file {shown(name)!r} is not beside the subsystem."])
    scaled = [key for key, text in values.items() if "scal" in key and number(text) != 1.0]
    if scaled:
        raise InputError([f"{shown(scaled[0].upper())} is not 1."])
    kind, given = values.get("value_type", "").lower(), number(values.get("user_value", ""))
    law = _law(file, subsystem.length_unit * given if kind == "installed_length" else math.nan)
    if kind == "preload":
        law = law._replace(force=NEWTONS.get(subsystem.force_unit.lower(), math.nan) * given)
    known = law.force is not None and 0.0 < law.force < math.inf
    return law._replace(force=law.force if known else None, file=shown(name))


def force_at_design(document: Any) -> float:
    """Return the force at design in an input file [N]."""
    in_strut = "strut" in document
    section = document["strut" if in_strut else "spring"]
    return float(section["spring_force_at_design_N" if in_strut else "force_at_design_N"])


def put_spring(document: Any, spring: AdamsSpring) -> None:
    """Put a spring into the text of an input file with a force at design."""
    prefix = "spring_" if "strut" in document else ""
    section = document["strut" if prefix else "spring"]
    force = force_at_design(document) if spring.force is None else spring.force
    if spring.rate is not None:
        section[f"{prefix}rate_N_per_m"] = spring.rate
    else:
        del section[f"{prefix}rate_N_per_m"]
        if prefix:
            del section[f"{prefix}force_at_design_N"]
            prefix, section = "", tomlkit.table()
            document["spring"] = section
        section["compression_mm"] = [place for place, _ in spring.curve]
        section["force_N"] = [value for _, value in spring.curve]
    section[f"{prefix}force_at_design_N"] = force


def _beside(folder: Path, name: str) -> Path | None:
    """Return the property file: beside the subsystem, or in the folder of a database."""
    places = (folder, folder / _FOLDER, folder.parent / _FOLDER)
    # unlike Path.is_file, os.path.isfile returns False for impossible names
    return next((p / name for p in places if name and os.path.isfile(p / name)), None)  # noqa: PTH113


def _law(file: Path, installed: float) -> AdamsSpring:
    """Return the rate of a spring whose curve is straight, or its curve.

    The force at design is that at a length [mm], NaN without one: its deflection is the free length
    less this one.
    """
    blocks = read_blocks(file)
    values = Values(blocks, str(file))
    length = unit_of(values, "length", "mm", MILLIMETRES)
    force = unit_of(values, "force", "newton", NEWTONS)
    points = sorted(_points(blocks))
    if len(points) < 2 or any(a[0] == b[0] for a, b in pairwise(points)):
        raise InputError(["it has no curve of deflection and force."])
    (x0, f0), (x1, f1) = points[0], points[-1]
    slope = (f1 - f0) / (x1 - x0)
    deflection = number(values.one("spring_data", "free_length")) - installed / length
    places, forces = np.array(points).T
    at = force * float(np.interp(deflection, places, forces, left=math.nan, right=math.nan))
    off = max(abs(f - f0 - slope * (x - x0)) for x, f in points)
    if not (slope > 0.0 and all(b[1] >= a[1] for a, b in pairwise(points))):
        raise InputError(["its curve falls."])
    if off <= _STRAIGHT * max(abs(f) for _, f in points):
        return AdamsSpring(_rounded(1e3 * slope * force / length), at, "")
    curve = [(_rounded(length * x), _rounded(force * f)) for x, f in points]
    kept = fewer(curve)
    if len(kept) > SEGMENTS + 1:
        raise InputError([f"its curve has {len(points)} points; {SEGMENTS + 1} are the most."])
    return AdamsSpring(None, at, "", kept, tuple(curve[: -len(kept)]))


def _rounded(value: float) -> float:
    """Return a value without digits from the rounding of its unit's conversion."""
    return float(f"{value:.12g}")


def _points(blocks: list[FileBlock]) -> list[tuple[float, float]]:
    """Return deflections and forces of the curve."""
    rows = [cells for b in blocks if b.name == "curve" for _, _, cells in b.rows()]
    points = [tuple(map(number, cells or ())) for cells in rows]
    if any(len(point) != 2 or not all(map(math.isfinite, point)) for point in points):
        raise InputError(["its curve has a row that is not two numbers."])
    return [(point[0], point[1]) for point in points]
