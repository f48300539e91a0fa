"""Instantaneous mobility at the design position, from closure equations in numbers.

The count of degrees of freedom assumes general dimensions. Bricard's chain has six hinges, so six
equations for six angles, and moves all the same, because its axes are in a special position. At the
design position, with the default parameters, the rates of all relative coordinates fulfil ``L rates
= 0``, where each column of L is the screw of a coordinate, in each loop that the coordinate is part
of (Davies, 1981).

It is evaluated only before an iteration; a closed form needs no numbers.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import networkx as nx
import numpy as np

from ..declare.evaluation import AtDefaults
from ..declare.joints import Cylindrical, Free, Prismatic, Revolute, Spherical, Universal

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from numpy.typing import NDArray

    from ..declare.joints import Joint
    from ..declare.mechanism import Mechanism
    from ..program.vectors import Vector
    from .graph import JointGraph
    from .known import Coordinate

    Array = NDArray[np.float64]

# Fraction of the largest singular value below which a direction of motion counts as exact.
# Dimensions are declared with six digits and more where a special geometry is intended.
_TOLERANCE = 1e-7


class Mobility:
    """The instantaneous mobility of a mechanism at its design position, with default parameters.

    `driven` are the names of the joints whose coordinates are independent or prescribed.
    """

    def __init__(self, topology: JointGraph, driven: Collection[str]) -> None:
        self._topology = topology
        joints = topology.mechanism.joints
        self._coordinates = [(j.name, c) for j in joints for c in j.coordinates]
        self._driven = np.array([name in driven for name, _ in self._coordinates])

    @property
    def is_known(self) -> bool:
        """Whether all parameters of the joints are declared, so that there are numbers."""
        value = AtDefaults(self._topology.mechanism)
        vectors = (v for joint in self._topology.mechanism.joints for v in _vectors(joint))
        return all(math.isfinite(value(component)) for v in vectors for component in v)

    @property
    def freedoms(self) -> int:
        """Number of independent motions; a joint that follows another one has none of its own."""
        columns = len(self._coordinates) - len(self._topology.mechanism.geared)
        return columns - _rank(self._closure)

    def driven_move(self) -> bool:
        """Return whether every driven coordinate can move, for any motion of the others."""
        return _rank(self._closure) == _rank(self._closure[:, ~self._driven])

    def determines(self, coordinates: Iterable[Coordinate]) -> bool:
        """Return whether given coordinates are at rest when all driven ones are."""
        closure = self._closure[:, ~self._driven]
        _, _, right = np.linalg.svd(closure, full_matrices=True)
        free = right[_rank(closure) :].T  # a basis of its null space
        names = [
            c for c, is_driven in zip(self._coordinates, self._driven, strict=True) if not is_driven
        ]
        rows = [names.index(c) for c in coordinates]
        return bool(np.abs(free[rows]).max(initial=0.0) < _TOLERANCE)

    @cached_property
    def _closure(self) -> Array:
        """L: six rows for each independent loop, a column for each relative coordinate."""
        mechanism, graph = self._topology.mechanism, self._topology.graph
        screws = _Screws(mechanism)
        rows = []
        for bodies in nx.cycle_basis(graph):
            block = {j.name: np.zeros((6, j.freedoms)) for j in mechanism.joints}
            for here, there in pairwise([*bodies, bodies[0]]):
                joint = self._topology.joint_between(here, there)
                sense = 1.0 if here == joint.first.name else -1.0
                block[joint.name] = sense * screws.of(joint)
            for joint in mechanism.geared:  # a follower moves with the joint that it follows
                block[joint.first_followed.name] += screws.ratio(joint) * block[joint.name]
                block[joint.name] = np.zeros((6, 1))
            rows.append(np.hstack(list(block.values())))
        return np.vstack([np.zeros((0, len(self._coordinates))), *rows])


class _Screws:
    """Angular velocity and velocity at the origin for unit rates of relative coordinates.

    Lengths are in units of the size of the mechanism, so that both parts have equal weight.
    """

    def __init__(self, mechanism: Mechanism) -> None:
        self._value = AtDefaults(mechanism)
        points = [_reference(joint) for joint in mechanism.joints]
        places = np.array([self._number(p) for p in points if p is not None])
        self._middle = places.mean(axis=0) if len(places) else np.zeros(3)
        spread = (
            np.sqrt(np.mean(np.sum((places - self._middle) ** 2, axis=1))) if len(places) else 1
        )
        self._size = spread or 1.0

    def of(self, joint: Joint) -> Array:
        """Return a column for each coordinate of a joint."""
        return np.transpose(
            [
                np.concatenate((np.zeros(3), axis)) if slides else self._turn(axis, joint)
                for slides, axis in self._axes(joint)
            ]
        )

    def ratio(self, joint: Joint) -> float:
        """Return the displacement of a joint per unit of the one it follows, through all gears."""
        if joint.gear is None:
            return 1.0
        sizes = [self._size if isinstance(j, Prismatic) else 1.0 for j in (joint, joint.gear.joint)]
        own = float(self._value(joint.gear.ratio.symbol)) * sizes[1] / sizes[0]
        return own * self.ratio(joint.gear.joint)

    def _axes(self, joint: Joint) -> list[tuple[bool, Array]]:
        """Return the axis of each coordinate of a joint, with whether it slides."""
        if isinstance(joint, Revolute):
            return [(False, self._unit(joint.axis.vector))]
        if isinstance(joint, Prismatic):
            return [(True, self._unit(joint.direction.components))]
        if isinstance(joint, Cylindrical):
            axis = self._unit(joint.axis.vector)
            return [(True, axis), (False, axis)]
        if isinstance(joint, Universal):
            first = self._unit(joint.first_axis.components)
            second = np.cross(first, self._unit(joint.shaft.vector))
            return [(False, first), (False, second / np.linalg.norm(second))]
        turns = [(False, axis) for axis in np.eye(3)]
        if isinstance(joint, Free):
            return [(True, axis) for axis in np.eye(3)] + turns
        assert isinstance(joint, Spherical)
        return turns

    def _turn(self, axis: Array, joint: Joint) -> Array:
        point = _reference(joint)
        origin = self._middle if point is None else self._number(point)
        place = (origin - self._middle) / self._size
        return np.concatenate((axis, np.cross(place, axis)))

    def _unit(self, vector: Vector) -> Array:
        number = self._number(vector)
        return number / np.linalg.norm(number)

    def _number(self, vector: Vector) -> Array:
        return np.array([self._value(component) for component in vector])


def _reference(joint: Joint) -> Vector | None:
    """Return the position of a point of a joint's axes at design."""
    if isinstance(joint, Revolute | Cylindrical):
        return joint.axis.through.position
    return None if joint.center is None else joint.center.position


def _vectors(joint: Joint) -> list[Vector]:
    """Return all vectors of a joint."""
    if isinstance(joint, Prismatic):
        return [joint.direction.components]
    if isinstance(joint, Revolute | Cylindrical):
        return [joint.axis.through.position, joint.axis.vector]
    if isinstance(joint, Universal):
        return [joint.at.position, joint.shaft.vector, joint.first_axis.components]
    return [] if joint.center is None else [joint.center.position]


def _rank(matrix: Array) -> int:
    sizes = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(sizes > _TOLERANCE * sizes.max(initial=0.0)))
