"""What the parameters of a mechanism can be: ranges, and the inertia that some body has.

A declaration is held against it with its defaults, and a compiled model with every set of
parameters. Depends on nothing else of this project.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

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
    """Find inertia tensors, and moments of rotors, that no body can have.

    The principal moments of a body are none above the sum of the others; those of a body of
    revolution are at most those of a flat disc. What is not given as a whole is not looked at: in a
    plane only one moment counts.

    Parameters
    ----------
    values : mapping
        Parameters by name: those that end in ``_inertia_xx`` and so on, SI units.

    Returns
    -------
    list of str
        One text for each body.
    """
    return [*_impossible_tensors(values), *_impossible_rotors(values)]


def _impossible_tensors(values: Mapping[str, float]) -> Iterator[str]:
    named = (name.removesuffix("_inertia_xx") for name in values if name.endswith("_inertia_xx"))
    bodies = [b for b in named if all(f"{b}_inertia_{e}" in values for e in ELEMENTS)]
    if not bodies:
        return
    elements = np.array([[values[f"{b}_inertia_{e}"] for e in ELEMENTS] for b in bodies])
    xx, yy, zz, xy, xz, yz = elements.T
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    for body, moments in zip(bodies, np.linalg.eigvalsh(tensors).tolist(), strict=True):
        small, middle, large = moments
        if min(small, small + middle - large) < -_ROUNDING * large:
            yield (
                f"inertia of {body!r}: the principal moments {small:.4g}, {middle:.4g} and "
                f"{large:.4g} kg m^2 are those of no body, since the largest is at most the sum of "
                "the others and none is negative. Check the diagonal and the signs of xy, xz and "
                "yz (elements of the tensor: minus the products of inertia). In a plane, where "
                "only the moment about the normal counts, give each of the others half of it"
            )


def _impossible_rotors(values: Mapping[str, float]) -> Iterator[str]:
    for name, spin in values.items():
        body = name.removesuffix("_inertia_spin")
        across = values.get(f"{body}_inertia_diametral")
        if body != name and across is not None and spin > 2.0 * across * (1.0 + _ROUNDING):
            yield (
                f"parameter {name!r} = {spin:g} kg m^2 is more than twice "
                f"'{body}_inertia_diametral' = {across:g} kg m^2, the most that a body of "
                "revolution can have (a flat disc)"
            )
