"""Functions for ``casadi.external`` in a folder of C, and their derivatives."""

from collections.abc import Iterator
from typing import Any

from .emitted import Emitted

FUNCTIONS = {
    "rhs": ("rhs_jacobian", "rhs_input_jacobian"),
    "signals": ("signals_jacobian", "signals_input_jacobian"),
}
"""Functions for other libraries, each with its derivatives by state and by inputs."""


def externals(emitted: Emitted) -> list[dict[str, Any]]:
    """Return the data of the template: each function, followed by that of its derivatives.

    A mechanism without derivatives has no such function, and CasADi refuses to differentiate.
    """
    return [made for name in FUNCTIONS for made in _made(emitted, name)]


def _made(emitted: Emitted, name: str) -> Iterator[dict[str, Any]]:
    sizes = [len(emitted.system.state_names), len(emitted.system.input_names)]
    (rows,) = emitted.manifest["functions"].get(name, {}).get("shape", (0,))
    if not rows:
        return
    function = f"{emitted.name}_casadi_{name}"
    names, shapes = ["state", "inputs"], [(size, 1) for size in sizes]
    parts = [_part(emitted, name, 0, rows, 1)]
    yield _function(function, names, [name], shapes, parts)
    if any(sizes) and all(emitted.result(derivative) for derivative in FUNCTIONS[name]):
        parts = [
            _part(emitted, derivative, place, rows, sizes[place])
            for place, derivative in enumerate(FUNCTIONS[name])
        ]
        blocks = [f"jac_{name}_{by}" for by in names]
        behind = ([*names, f"out_{name}"], blocks, [*shapes, (rows, 1)], parts)
        yield _function(f"jac_{function}", *behind)


def _part(emitted: Emitted, name: str, place: int, rows: int, columns: int) -> dict[str, Any]:
    """Return the C function of a result, its place there, and its place in the output."""
    found = emitted.result(name)
    assert found is not None
    return {
        "function": found.function,
        "size": max(found.size, 1),
        "start": found.start,
        "place": place,
        "rows": rows,
        "columns": columns,
    }


def _function(
    function: str,
    names_in: list[str],
    names_out: list[str],
    shapes: list[tuple[int, int]],
    parts: list[dict[str, Any]],
) -> dict[str, Any]:
    return {
        "function": function,
        "names_in": names_in,
        "names_out": names_out,
        "sparsities_in": [_dense(*shape) for shape in shapes],
        "sparsities_out": [_dense(part["rows"], part["columns"]) for part in parts],
        "parts": [part for part in parts if part["rows"] and part["columns"]],
    }


def _dense(rows: int, columns: int) -> str:
    """Return a pattern of CasADi without zeros."""
    return f"{{{rows}, {columns}, 1}}"
