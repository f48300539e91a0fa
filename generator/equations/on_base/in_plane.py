"""Bodies that move in a plane with their base: one moment of inertia each enters the equations."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...program.vectors import SymmetricTensor, Vector
from .flow import HALF, NONE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ...kinematics.carried import Carried
    from ..inertia import SpatialInertia


def in_plane(carried: Carried, inertia: SpatialInertia) -> SpatialInertia:
    """Return the inertia of a body, or of a lamina with the same equations in a plane.

    If base and body turn about one direction only, the second moments along the plane enter the
    equations only by their sum, which is the moment of inertia about the normal of the plane. Each
    of the two is replaced by half of that moment, and products of inertia by zero.
    """
    normal = _normal(twist.angular for twist in carried.base.twists.values())
    along = None if normal is None else _along(carried.axes, normal)
    if along is None:
        return inertia
    moment = tuple(inertia.tensor)[along]
    xx, yy, zz = (moment if i == along else HALF * moment for i in range(3))
    return replace(inertia, tensor=SymmetricTensor(xx, yy, zz, NONE, NONE, NONE))


def _normal(turning: Iterable[Vector]) -> int | None:
    """Return the one axis of a base about which its motions turn, or None."""
    turned = {i for omega in turning for i, part in enumerate(omega) if part != 0}
    return turned.pop() if len(turned) == 1 else None


def _along(axes: Iterable[Vector], normal: int) -> int | None:
    """Return the axis of a body that is always along an axis of the base; None without one."""
    found = [i for i, axis in enumerate(axes) if tuple(axis)[normal] != 0]
    return found[0] if len(found) == 1 else None
