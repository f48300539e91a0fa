"""Planar loops: hinges along each other, guides across them.

A declaration may state it, by one direction that all hinges have. Otherwise (each hinge a line
through two points, or along a direction of its own), the default parameters decide; that other ones
fulfil it too is one of the `assumptions`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..declare.evaluation import AtDefaults
from ..declare.geometry import Direction
from ..declare.joints import Prismatic, Revolute
from ..program.floors import ROUNDING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..declare.geometry import Line
    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism
    from ..program.vectors import Vector

    Array = NDArray[Any]


class Planes:
    """Finds the plane of a loop of a mechanism."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.at_defaults = AtDefaults(mechanism)
        self._units: dict[Vector, Array] = {}

    def normal(self, joints: Sequence[Joint]) -> Direction | None:
        """Return the direction of the hinges of a planar loop; None for others.

        With hinges along one declared direction the loop is planar even where a guide leaves the
        plane: a contradiction in the declaration, which is one of the `assumptions`.
        """
        hinges = [j for j in joints if isinstance(j, Revolute)]
        guides = [j for j in joints if isinstance(j, Prismatic)]
        if not hinges or len(hinges) + len(guides) < len(joints):
            return None
        first = hinges[0].axis
        if isinstance(first.towards, Direction) and len({j.axis.towards for j in hinges}) == 1:
            return first.towards
        return self._by_numbers(hinges, guides)

    def _by_numbers(
        self, hinges: Sequence[Revolute], guides: Sequence[Prismatic]
    ) -> Direction | None:
        n = self._unit(hinges[0].axis.vector)
        off = [np.linalg.norm(np.cross(n, self._unit(j.axis.vector))) for j in hinges[1:]]
        off += [np.abs(n @ self._unit(j.direction.components)) for j in guides]
        in_plane = all(amount <= float(ROUNDING) for amount in off)  # not so if one is NaN
        return _direction(hinges[0].name, hinges[0].axis) if in_plane else None

    def _unit(self, vector: Vector) -> Array:
        if vector not in self._units:
            v = np.array([self.at_defaults(component) for component in vector])
            size = np.linalg.norm(v)
            self._units[vector] = v / size if size > 0.0 else np.full(3, np.nan)
        return self._units[vector]


def _direction(name: str, line: Line) -> Direction:
    """Return the direction of a line."""
    if isinstance(line.towards, Direction):
        return line.towards
    return Direction(f"{name}_line", between=(line.through, line.towards))
