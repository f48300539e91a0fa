"""Ranges of a mechanism's parameters, and inertia tensors that a body can have.

The defaults of a declaration are checked with these functions, and every parameter set of a
compiled model. This file depends on nothing else of the project.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ELEMENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
"""Ends of the names of parameters for the elements of an inertia tensor."""

# Rounding error of a principal moment of inertia, relative to the largest.
_ROUNDING = 1e-9


def out_of_range(
    values: Mapping[str, float], described: Mapping[str, Mapping[str, Any]]
) -> list[str]:
    """Return a text for each parameter out of its range, with name, value, unit and range.

    `values` are finite numbers by name, in SI units. By name `described` has the unit, and those of
    the bounds ``least``, ``above`` and ``most`` that exist.

    Examples
    --------
    >>> out_of_range({"mass": -1.0}, {"mass": {"unit": "kg", "least": 0.0}})
    ["parameter 'mass' = -1 kg is out of its range; give 0 kg or more"]
    """
    problems = []
    for name, entry in described.items():
        value, wanted = values[name], []
        unit = "" if entry["unit"] == "1" else f" {entry['unit']}"
        least, above, most = (entry.get(bound) for bound in ("least", "above", "most"))
        if least is not None and not value >= least:
            wanted.append(f"{least:g}{unit} or more")
        if above is not None and not value > above:
            wanted.append(f"more than {above:g}{unit}")
        if most is not None and not value <= most:
            wanted.append(f"{most:g}{unit} or less")
        if wanted:
            problems.append(
                f"parameter {name!r} = {value:g}{unit} is out of its range; give "
                f"{' and '.join(wanted)}"
            )
    return problems


def inertia_of_no_body(values: Mapping[str, float]) -> list[str]:
    """Return a text for each inertia tensor that no body can have, from parameters by name (SI).

    No principal moment of a body exceeds the sum of the other two. A tensor with missing elements
    is not checked: in a plane only one moment counts. The moment of a rotor about its axis has no
    bound, since that of a shaft that turns with it may be included.
    """
    return list(_impossible_tensors(values))


def rotors_of_no_body(values: Mapping[str, float]) -> list[str]:
    """Return a text for each body of revolution that is flatter than a disc.

    Parameters, by name in SI units, that end in ``_inertia_spin`` and ``_inertia_diametral`` are
    moments of the bodies alone, without shafts.
    """
    return [
        f"parameter '{body}_inertia_spin' = {spin:g} kg m^2 is more than twice "
        f"'{body}_inertia_diametral' = {across:g} kg m^2, the most that a body of revolution can "
        "have (a flat disc)"
        for body, spin, across in _rotors(values)
        if spin > 2.0 * across * (1.0 + _ROUNDING)
    ]


def impossible(
    values: Mapping[str, Any], described: Mapping[str, Mapping[str, Any]], count: int
) -> NDArray[np.bool_]:
    """Return which of many parameter sets `out_of_range` or `inertia_of_no_body` refuses, (count,).

    By name `values` has a finite number, or an array of shape (count,), in SI units.
    """
    found = np.zeros(count, dtype=bool)
    for name, entry in described.items():
        value = np.asarray(values[name])
        found |= ~(value >= entry.get("least", -np.inf)) | ~(value > entry.get("above", -np.inf))
        found |= ~(value <= entry.get("most", np.inf))
    for _, elements in tensors(values):
        found |= _of_no_body(np.linalg.eigvalsh(inertia_tensor(elements)))
    return found


def tensors(values: Mapping[str, Any]) -> Iterator[tuple[str, list[Any]]]:
    """Yield name and elements of each inertia tensor of which all elements are given."""
    for name in values:
        body = name.removesuffix("_inertia_xx")
        elements = [values.get(f"{body}_inertia_{e}") for e in ELEMENTS]
        if body != name and not any(element is None for element in elements):
            yield body, elements


def inertia_tensor(elements: Sequence[Any]) -> Array:
    """Return inertia tensors, (..., 3, 3), from their elements in the order of `ELEMENTS`."""
    xx, yy, zz, xy, xz, yz = np.broadcast_arrays(*elements)
    tensors: Array = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return np.moveaxis(tensors, (0, 1), (-2, -1))


def _of_no_body(moments: NDArray[np.floating[Any]]) -> NDArray[np.bool_]:
    small, middle, large = np.moveaxis(moments, -1, 0)
    return np.minimum(small, small + middle - large) < -_ROUNDING * large


def _rotors(values: Mapping[str, float]) -> Iterator[tuple[str, float, float]]:
    """Yield the name of each body of revolution, with its moments about the axis and across it."""
    for name, spin in values.items():
        body = name.removesuffix("_inertia_spin")
        across = values.get(f"{body}_inertia_diametral")
        if body != name and across is not None:
            yield body, spin, across


def _impossible_tensors(values: Mapping[str, float]) -> Iterator[str]:
    for body, elements in tensors(values):
        moments = np.linalg.eigvalsh(inertia_tensor(elements))
        if _of_no_body(moments):
            small, middle, large = moments.tolist()
            yield (
                f"inertia of {body!r}: the principal moments {small:.4g}, {middle:.4g} and "
                f"{large:.4g} kg m^2 are impossible: none may be negative, nor greater than the "
                "sum of the other two. Check the diagonal and the signs of xy, xz and "
                "yz (elements of the tensor: minus the products of inertia). In a plane, where "
                "only the moment about the normal counts, give each of the others half of it"
            )
