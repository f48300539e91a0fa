"""What the parameters of a mechanism can be: ranges, and the inertia that some body has.

A declaration is held against it with its defaults, and a compiled model with every set of
parameters. Depends on nothing else of this project.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ELEMENTS = ("xx", "yy", "zz", "xy", "xz", "yz")
"""Elements of an inertia tensor, by the ends of their parameters' names."""

# What rounding may do to a principal moment of inertia, relative to the largest.
_ROUNDING = 1e-9


def out_of_range(
    values: Mapping[str, float], described: Mapping[str, Mapping[str, Any]]
) -> list[str]:
    """Find values that are outside of the ranges of their parameters.

    Parameters
    ----------
    values : mapping
        Finite numbers by name, SI units.
    described : mapping
        By name: the unit, and ``least``, ``above`` and ``most`` as far as there are such bounds.

    Returns
    -------
    list of str
        One text for each, with name, value, unit and range.

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
    """Find inertia tensors that no body can have.

    The principal moments of a body are none above the sum of the others. What is not given as a
    whole is not looked at: in a plane only one moment counts. The moment of a rotor about its axis
    has no bound: a shaft that turns with it adds to this one alone.

    Parameters
    ----------
    values : mapping
        Parameters by name: those that end in ``_inertia_xx`` and so on, SI units.

    Returns
    -------
    list of str
        One text for each body.
    """
    return list(_impossible_tensors(values))


def rotors_of_no_body(values: Mapping[str, float]) -> list[str]:
    """Find bodies of revolution that are flatter than a disc.

    Parameters
    ----------
    values : mapping
        Parameters by name: those that end in ``_inertia_spin`` and ``_inertia_diametral``, SI
        units, of the bodies alone, without shafts.

    Returns
    -------
    list of str
        One text for each body.
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
    """Return which of many parameter sets `out_of_range` or `inertia_of_no_body` has a word about.

    Parameters
    ----------
    values : mapping
        By name: a number, or an array of shape (count,); SI units, finite.
    described : mapping
        As of `out_of_range`.
    count : int
        Of the sets.

    Returns
    -------
    ndarray of bool, shape (count,)
    """
    found = np.zeros(count, dtype=bool)
    for name, entry in described.items():
        value = np.asarray(values[name])
        found |= ~(value >= entry.get("least", -np.inf)) | ~(value > entry.get("above", -np.inf))
        found |= ~(value <= entry.get("most", np.inf))
    for _, elements in tensors(values):
        found |= _of_no_body(_moments(elements))
    return found


def tensors(values: Mapping[str, Any]) -> Iterator[tuple[str, list[Any]]]:
    """Yield the bodies whose inertia is given as a whole, with the elements."""
    for name in values:
        body = name.removesuffix("_inertia_xx")
        elements = [values.get(f"{body}_inertia_{e}") for e in ELEMENTS]
        if body != name and not any(element is None for element in elements):
            yield body, elements


def _moments(elements: list[Any]) -> Array:
    """Return the principal moments, in order, in the last dimension."""
    xx, yy, zz, xy, xz, yz = np.broadcast_arrays(*elements)
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    moments: Array = np.linalg.eigvalsh(np.moveaxis(tensors, (0, 1), (-2, -1)))
    return moments


def _of_no_body(moments: Array) -> NDArray[np.bool_]:
    small, middle, large = np.moveaxis(moments, -1, 0)
    found: NDArray[np.bool_] = np.minimum(small, small + middle - large) < -_ROUNDING * large
    return found


def _rotors(values: Mapping[str, float]) -> Iterator[tuple[str, float, float]]:
    """Yield the bodies of revolution, with their moments about the axis and across."""
    for name, spin in values.items():
        body = name.removesuffix("_inertia_spin")
        across = values.get(f"{body}_inertia_diametral")
        if body != name and across is not None:
            yield body, spin, across


def _impossible_tensors(values: Mapping[str, float]) -> Iterator[str]:
    for body, elements in tensors(values):
        moments = _moments(elements)
        if _of_no_body(moments):
            small, middle, large = moments.tolist()
            yield (
                f"inertia of {body!r}: the principal moments {small:.4g}, {middle:.4g} and "
                f"{large:.4g} kg m^2 are impossible: none may be negative, nor greater than the "
                "sum of the other two. Check the diagonal and the signs of xy, xz and "
                "yz (elements of the tensor: minus the products of inertia). In a plane, where "
                "only the moment about the normal counts, give each of the others half of it"
            )
