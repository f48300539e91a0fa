"""Functions for ``jax.ffi`` in a folder of C, and their derivatives."""

import math
from collections.abc import Iterator
from typing import Any

from .casadi_external import FUNCTIONS
from .emitted import Emitted


def handlers(emitted: Emitted) -> list[dict[str, Any]]:
    """Return the data of the templates: each function, followed by those of its derivatives.

    A mechanism without derivatives has no such functions, and JAX refuses to differentiate.
    """
    return [made for name in FUNCTIONS for made in _made(emitted, name)]


def _made(emitted: Emitted, name: str) -> Iterator[dict[str, Any]]:
    described = emitted.manifest["functions"].get(name)
    if described is None or not math.prod(described["shape"]):
        return
    results = {each: emitted.result(each) for each in FUNCTIONS[name]}
    there = all(found is not None and found.length for found in results.values())
    derivatives = tuple(results) if there else ()
    more = {"derivatives": derivatives, "doc": described["doc"], "wide": True}
    yield _handler(emitted, name) | more
    for each in derivatives:
        yield _handler(emitted, each)


def _handler(emitted: Emitted, name: str) -> dict[str, Any]:
    """Return the C function of a result, its place there, and its shape."""
    found = emitted.result(name)
    assert found is not None
    return {
        "name": name,
        "function": found.function,
        "size": found.size,
        "start": found.start,
        "count": found.length,
        "shape": tuple(emitted.manifest["functions"][name]["shape"]),
        "wide": False,
    }
