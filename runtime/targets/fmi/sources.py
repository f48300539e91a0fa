"""The C that a unit is compiled from."""

import math
from collections.abc import Iterable, Mapping
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from ...core.physical import tensors
from ...simulation import native
from ...simulation.dead_points import meanings
from ..emitted import Emitted
from ..text import environment, number, quoted
from .description import Crossing, ModelDescription

MARK = "kintrafo: numbers of a model"
EQUATIONS = "equations"
"""Folder of the emitted files."""

_CORE = ("dead_points.c", "derivatives.c", "model.h", "steps.c", "unit.c", "unit.h")
# What integrates, without what needs SUNDIALS.
_NATIVE = (
    "dormand_prince.c", "dormand_prince.h", "eigenvalues.c", "eigenvalues.h", "fixed_step.c",
    "fixed_step.h", "integrate.c", "integrate.h", "margins.c", "margins.h", "number.h", "pieces.h",
    "polynomial.h", "powers.h", "rk4.c", "rodasp.c", "rodasp.h", "roots.c", "roots.h", "trust.h",
    "worker.h",
)  # fmt: skip


HEADERS = {
    "fmi2.c": ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"),
    "fmi3.c": ("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h"),
}
"""The C file of each version of FMI, and the headers of the standard that it needs."""


def source_files(
    known: ModelDescription, fronts: Iterable[str], token: str, values: list[float]
) -> dict[str, str]:
    """Return all files, by path below ``sources``.

    Parameters
    ----------
    known : ModelDescription
    fronts : iterable of str
        Those of `HEADERS` that there are to be.
    token : str
        As in the description.
    values : list of float
        Parameters, start and inputs.
    """
    here = files(__package__)
    chosen = list(fronts)
    headers = [header for front in chosen for header in HEADERS[front]]
    emitted = known.emitted
    return {
        **{name: _text(here / "core" / name) for name in (*_CORE, *chosen)},
        **{name: _text(here / "headers" / name) for name in headers},
        **{name: _text(files(native) / name) for name in _NATIVE},
        **{f"{EQUATIONS}/{name}": text for name, text in emitted.sources.items()},
        "model.c": _model(known),
        "numbers.c": _numbers(known, token, values),
    }


def _text(file: Any) -> str:
    text: str = file.read_text(encoding="utf-8")
    return text


def _numbers(known: ModelDescription, token: str, values: list[float]) -> str:
    """Return the file of the numbers."""
    entries = {
        "title": known.emitted.title,
        "version": version("kintrafo"),
        "name": known.identifier,
    }
    template = environment("fmi").get_template("numbers.c.jinja")
    return template.render(entries, mark=MARK, token=token, values=values)


def _model(known: ModelDescription) -> str:
    """Return the tables of the model."""
    emitted, manifest = known.emitted, known.manifest
    equations = emitted.system.equations
    uses = [int(use) for use in meanings(equations)]
    places = {name: k for k, name in enumerate(manifest["parameters"])}
    rows = {
        "parameters": [_parameter(*item) for item in manifest["parameters"].items()],
        "inputs": _inputs(manifest["inputs"]),
        "events": [_event(crossing) for crossing in known.crossings],
        "guards": [
            _row(quoted(g["name"]), quoted(g["unit"]), quoted(g["meaning"]), use)
            for g, use in zip(manifest["guards"], uses, strict=True)
        ],
        "assumptions": [
            _row(quoted(a["meaning"]), quoted(a["remedy"])) for a in manifest["assumptions"]
        ],
        "zeros": sum("least" not in a for a in manifest["assumptions"]),
        "tensors": [_row(quoted(body), _row(*places)) for body, places in tensors(places)],
        "guard_use": uses,
        "constants": list(map(quoted, equations.CONSTANTS)),
        "states": list(map(quoted, manifest["state"])),
        "signals": list(map(quoted, manifest["signals"])),
        "positions": manifest["layout"]["positions"],
        "speeds": manifest["layout"]["speeds"],
    }
    template = environment("fmi").get_template("model.c.jinja")
    return template.render(
        rows | _functions(emitted),
        title=emitted.title,
        version=version("kintrafo"),
        name=emitted.name,
    )


def _functions(emitted: Emitted) -> dict[str, Any]:
    """Return the C functions by what they are for, and where derivatives are."""
    derivatives = ("rhs_input_jacobian", "signals_jacobian", "signals_input_jacobian")
    found = {name: emitted.result(name) for name in derivatives}
    there = [result for result in found.values() if result is not None and result.length]
    named = {
        name: "NULL" if result is None or not result.length else result.function
        for name in (
            "rhs", "rhs_jacobian", "signals", "margins", "rhs_tangent", "signals_tangent",
        )
        for result in (emitted.result(name),)
    }  # fmt: skip
    tangents = {named["rhs_tangent"], named["signals_tangent"]} != {"NULL"}
    named["prepare_tangent"] = f"{emitted.name}_prepare_tangent" if tangents else "NULL"
    return {
        "functions": named | {"linearisation": there[0].function if there else "NULL"},
        "linearised": there[0].size if there else 0,
        "places": [-1 if r is None or not r.length else r.start for r in found.values()],
    }


def _row(*parts: object) -> str:
    return f"{{{', '.join(map(str, parts))}}}"


def _bound(value: float) -> str:
    return number(value) if math.isfinite(value) else f"{'-' * (value < 0.0)}INFINITY"


def _parameter(name: str, entry: Mapping[str, Any]) -> str:
    least, above = (_bound(entry.get(key, -math.inf)) for key in ("least", "above"))
    return _row(
        quoted(name), quoted(entry["unit"]), least, above, _bound(entry.get("most", math.inf))
    )


def _inputs(inputs: Mapping[str, Mapping[str, Any]]) -> list[str]:
    names = list(inputs)
    sources: Iterable[str | None] = (entry["derivative_of"] for entry in inputs.values())
    places = (-1 if source is None else names.index(source) for source in sources)
    return [_row(quoted(name), place) for name, place in zip(names, places, strict=True)]


def _event(c: Crossing) -> str:
    words = quoted(c.name), quoted(c.meaning)
    return _row(*words, c.signal, c.guard, number(c.level), c.parameter, number(c.sign), c.needs)
