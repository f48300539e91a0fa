"""Declarations of planar mechanisms: flat points, hinges across the plane."""

from __future__ import annotations

from typing import Literal

from ..program.vectors import UNIT_Y
from .bodies import Body
from .declared import DeclarationError, checked
from .geometry import UP, Direction, Line, Point
from .joints import Revolute

_ACROSS = Direction("across", fixed=UNIT_Y)

# Axis that the plane is perpendicular to, and its direction.
_NORMALS = {"z": UP, "y": _ACROSS}


def flat(
    name: str, place: tuple[float, float], meaning: str = "", normal: Literal["y", "z"] = "z"
) -> Point:
    """Return a point of a planar mechanism: two of its coordinates are parameters.

    Parameters
    ----------
    name
        Prefix of the names of its parameters.
    place
        Default coordinates in the plane [m]: x and y, or x and z.
    meaning
        Description in the documentation of the generated code; by default the name.
    normal
        Axis perpendicular to the plane, which contains the origin.

    Returns
    -------
    Point
        With two parameters, such as ``<name>_x`` and ``<name>_y`` [m].

    Raises
    ------
    DeclarationError
        If `normal` is neither 'y' nor 'z'.

    Examples
    --------
    >>> from kintrafo.generator import flat
    >>> [p.name for p in flat("crank_pin", (0.0, 0.1)).numbers]
    ['crank_pin_x', 'crank_pin_y']
    """
    if normal not in _NORMALS:
        problem = f"normal = {normal!r}: 'y' or 'z' is needed"
        raise DeclarationError(f"Point {name!r}", [problem])
    return Point(name, place, meaning, flat=normal)


@checked
def hinge(name: str, first: Body, second: Body, at: Point) -> Revolute:
    """Return a hinge of a planar mechanism; its angle is zero at the design position.

    Parameters
    ----------
    name
        Name of the joint.
    first, second
        The two bodies; the angle is that of the second one relative to the first, right-handed
        about the normal of the plane [rad].
    at
        The centre of the hinge, a point from `flat`.

    Returns
    -------
    Revolute

    Raises
    ------
    DeclarationError
        If the point is not one of a plane.

    Examples
    --------
    >>> from kintrafo.generator import Body, Ground, flat, hinge
    >>> pin = flat("pin", (0.0, 0.0))
    >>> bar = Body("bar", 1.0, flat("bar_com", (0.1, 0.0)), 1e-3)
    >>> hinge("A", Ground("ground"), bar, pin).freedoms
    1
    """
    normal = _NORMALS.get(at.flat)
    if normal is None:
        problem = f"point {at.name!r} is of no plane across y or z: make it by flat(...)"
        raise DeclarationError(f"Revolute {name!r}", [problem])
    return Revolute(name, first, second, axis=Line(at, normal))
