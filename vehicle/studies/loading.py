"""The axis of the part of a load case that acts, with loads of joints, springs and rods as curves.

The axis has the whole case in its name, so that a changed file of load cases is another axis.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ...core.named_types import Array
from ...core.quantities import Display
from ...core.validator import Validator, shown
from ..analysis.loads.cases import read, standard_cases
from ..analysis.loads.columns import LOADS, columns
from ..analysis.loads.static import static
from ..assembly.assembly import Assembly
from ..assembly.quantity import Quantity
from ..models.reach import PositionError
from .axis import SweepAxis, number_of

LOADING = "load"
"""Load cases of an assembly on a held body, as those of `kintrafo loads`."""
CASES = "cases"
OPTIONS = ("case", "static_load_N", CASES)
"""The name of the load case, the unit of its keys in ``_g``, and load cases or their file."""

_ALONG = Quantity("load_part", "1", "part of the load case",
    "factor of the forces and moments of the load case",
    "", Display("%", 100.0))  # fmt: skip
_USUAL = "static"


def plain(given: Validator, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options with the load case itself in place of its file, as a text."""
    found = {"case": _USUAL} | dict(options)
    cases = found.get(CASES)
    if cases is None:
        return found
    try:
        if isinstance(cases, str) and cases.startswith("{"):
            cases = json.loads(cases)
        elif isinstance(cases, str | Path):
            of_file = read(cases)
            cases = of_file.get(CASES, {})
            if "static_load_N" in of_file:
                found = {"static_load_N": of_file["static_load_N"]} | found
        given.mapping(CASES, cases, "names and load cases")
        if not given.failed and given.among("case", found["case"], cases) == found["case"]:
            own = {found["case"]: cases[found["case"]]}
            text = json.dumps(own, default=lambda array: np.asarray(array).tolist())
            # options of a name are separated by commas before a key with an equals sign
            found[CASES] = text.replace("=", r"\u003d")
    except (TypeError, ValueError):
        given.fail(f"cases = {shown(cases)}: load cases or the name of their file are needed.")
    return found


def axis(given: Validator, options: Mapping[str, Any]) -> SweepAxis:
    """Return the axis of a load case, by default the standard case ``static``."""
    case, load = options.get("case", _USUAL), number_of(options.get("static_load_N"))
    given.text("case", case)
    if load is not None:
        load = given.number("static_load_N", load, "N", above=0.0)
    described = json.loads(options[CASES]) if CASES in options else None

    def curves(assembly: Assembly, parts: Array) -> xr.Dataset:
        return _curves(assembly, parts, str(case), described, load)

    return SweepAxis(_ALONG, LOADS, f"the load case {case}", curves, (1.0,), 1.0)


def _curves(
    assembly: Assembly,
    parts: Array,
    case: str,
    described: Mapping[str, Any] | None,
    static_load: float | None,
) -> xr.Dataset:
    """Return the loads under some parts of a load case."""
    with Validator("load") as given:
        known = standard_cases(assembly) if described is None else described
        given.among("case", case, known)
    several, rows = np.unique(parts, return_inverse=True)
    # names of cases are those in messages
    names = [case if part == 1.0 else f"{case}.part_{i}" for i, part in enumerate(several, 1)]
    cases = {n: _scaled(known[case], float(p)) for n, p in zip(names, several, strict=True)}
    found = static(assembly, cases, static_load=static_load)
    for part, reason in zip(several, found["reason"].values, strict=True):
        if reason:
            raise PositionError(f"{100.0 * part:g} % of the load case {case}: {reason}")
    loads = {
        name: xr.Variable(_ALONG.name, values[rows], LOADS[name].attributes())
        for name, values in columns(found).items()
    }
    along = xr.Variable(_ALONG.name, parts, _ALONG.attributes())
    return xr.Dataset(loads, {_ALONG.name: along})


def _scaled(case: Any, part: float) -> Any:
    """Return a load case with a part of its forces and moments."""
    if part == 1.0 or not isinstance(case, Mapping):
        return case
    return {
        key: [part * number for number in value]
        if key.startswith(("contact", "center")) and _are_numbers(value)
        else _scaled(value, part)
        for key, value in case.items()
    }


def _are_numbers(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, int | float) for each in value)
