"""The C files of one model: its tables and its numbers."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from ...core.physical import tensors
from ...simulation.dead_points import meanings_of
from ..emitted import result_of
from ..text import environment, number, quoted
from .crossings import Crossing, crossings
from .files import MARK


def tables(manifest: Mapping[str, Any], token: str, values: Sequence[float]) -> dict[str, str]:
    """Return the files of a model by name.

    `token` is that of the description of the FMU; `values` are parameters, initial state and
    initial inputs.
    """
    return {"model.c": _model(manifest), "numbers.c": _numbers(manifest, token, values)}


def any_tables(manifest: Mapping[str, Any]) -> dict[str, str]:
    """Return the files of a model without a token, with zero for all numbers."""
    count = sum(len(manifest[group]) for group in ("parameters", "state", "inputs"))
    return tables(manifest, "", [0.0] * count)


def _numbers(manifest: Mapping[str, Any], token: str, values: Sequence[float]) -> str:
    entries = {"title": manifest["title"], "name": manifest["name"]}
    template = environment("fmi").get_template("numbers.c.jinja")
    return template.render(entries, mark=MARK, token=token, values=values)


def _model(manifest: Mapping[str, Any]) -> str:
    uses = [int(use) for use in meanings_of(manifest)]
    places = {name: k for k, name in enumerate(manifest["parameters"])}
    rows = {
        "parameters": [_parameter(*item) for item in manifest["parameters"].items()],
        "inputs": _inputs(manifest["inputs"]),
        "events": [_event(crossing) for crossing in crossings(manifest)],
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
        "constants": list(map(quoted, manifest["constants"])),
        "states": list(map(quoted, manifest["state"])),
        "signals": list(map(quoted, manifest["signals"])),
        "positions": manifest["layout"]["positions"],
        "speeds": manifest["layout"]["speeds"],
    }
    template = environment("fmi").get_template("model.c.jinja")
    named = {"title": manifest["title"], "name": manifest["name"]}
    return template.render(rows | _functions(manifest) | named)


def _functions(manifest: Mapping[str, Any]) -> dict[str, Any]:
    """Return the C functions by purpose, and the places of derivatives."""
    derivatives = ("rhs_input_jacobian", "signals_jacobian", "signals_input_jacobian")
    found = {name: result_of(manifest, name) for name in derivatives}
    there = [result for result in found.values() if result is not None and result.length]
    named = {
        name: "NULL" if result is None else result.function
        for name in (
            "rhs", "rhs_jacobian", "signals", "margins", "rhs_tangent", "signals_tangent",
        )
        for result in (result_of(manifest, name),)
    }  # fmt: skip
    tangents = {named["rhs_tangent"], named["signals_tangent"]} != {"NULL"}
    named["prepare_tangent"] = f"{manifest['name']}_prepare_tangent" if tangents else "NULL"
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
