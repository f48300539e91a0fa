"""Positions of free bodies, and distances and angles between them with their derivatives.

A body moves by a displacement of its centre and a rotation about it, six coordinates. Measures
between two bodies have first and second derivatives in the twelve of both: displacement and
rotation of the first body, then of the second one; second derivatives are those along screw
motions, ``exp(rotation)``. Body 0 is the ground, which is fixed. Arrays have a leading dimension
for the positions of a suspension.

Source: R. M. Murray, Z. Li and S. S. Sastry, A Mathematical Introduction to Robotic Manipulation,
CRC Press, 1994, chapter 2.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array

Indices = NDArray[np.intp]

_TIP = 1e-9
"""Least radius [m]."""

_DISPLACED, _ROTATED = (slice(0, 3), slice(6, 9)), (slice(3, 6), slice(9, 12))


@dataclass(frozen=True)
class RigidDisplacements:
    """Positions of bodies."""

    centers: Array  # (n, bodies, 3) [m]
    # rotations from the positions in which vectors of the bodies are given, (n, bodies, 3, 3)
    turned: Array

    @classmethod
    def at(cls, centers: Array) -> "RigidDisplacements":
        """Return bodies without rotation, with their centres at some places."""
        return cls(centers, np.broadcast_to(np.eye(3), (*centers.shape, 3)))

    def moved(self, by: Array) -> "RigidDisplacements":
        """Return the positions after displacements and rotations, (n, bodies, 6)."""
        from scipy.spatial.transform import Rotation  # noqa: PLC0415 (slow to import)

        turns: Array = Rotation.from_rotvec(by[..., 3:].reshape(-1, 3)).as_matrix()
        return RigidDisplacements(
            self.centers + by[..., :3], turns.reshape(self.turned.shape) @ self.turned
        )

    def of(self, bodies: Indices, vectors: Array) -> Array:
        """Return body-fixed vectors after the rotations, (n, measures, 3)."""
        return np.einsum("nfij,nfj->nfi", self.turned[:, bodies], vectors)


@dataclass(frozen=True)
class BodyMeasures:
    """Functions of the positions of two bodies each, with derivatives."""

    bodies: Indices  # (measures, 2)
    value: Array  # (n, measures)
    slope: Array  # (n, measures, 12)
    bend: Array  # (n, measures, 12, 12)

    @classmethod
    def together(cls, parts: Sequence["BodyMeasures"]) -> "BodyMeasures":
        """Return several groups of measures as one."""
        return cls(
            np.concatenate([part.bodies for part in parts]),
            *(
                np.concatenate([getattr(part, name) for part in parts], axis=1)
                for name in ("value", "slope", "bend")
            ),
        )

    def slopes(self, count: int) -> Array:
        """Return the first derivatives in all bodies, (n, measures, bodies, 6)."""
        found = np.zeros((*self.value.shape, count, 6))
        each = np.arange(len(self.bodies))
        for end, part in enumerate((slice(0, 6), slice(6, 12))):
            found[:, each, self.bodies[:, end]] += self.slope[..., part]
        return found

    def bent(self, weights: Array, count: int) -> Array:
        """Return the sum of the second derivatives times weights, (n, bodies, 6, bodies, 6)."""
        found = np.zeros((len(weights), count, 6, count, 6))
        weighted = weights[..., None, None] * self.bend
        halves = slice(0, 6), slice(6, 12)
        for which, pair in enumerate(self.bodies):
            for row, i in zip(halves, pair, strict=True):
                for column, j in zip(halves, pair, strict=True):
                    found[:, i, :, j, :] += weighted[:, which, row, column]
        return found


@dataclass(frozen=True)
class Distances:
    """Distance from a point of one body to a point of another, along a direction of the first."""

    bodies: Indices  # (measures, 2)
    # the direction, and the points from the centres of their bodies, (n, measures, 3) [m]
    along: Array
    start: Array
    end: Array

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the distances at some places [m]."""
        first, second = self.bodies.T
        along, start = places.of(first, self.along), places.of(first, self.start)
        end = places.of(second, self.end)
        apart = places.centers[:, second] + end - places.centers[:, first] - start
        turning, parting = _turning(along, 0), _parting(start, end)
        bend = turning.mT @ parting
        bend += bend.mT
        bend[..., _ROTATED[0], _ROTATED[0]] += second_by_rotation(apart - start, along)
        bend[..., _ROTATED[1], _ROTATED[1]] += second_by_rotation(end, along)
        slope = _times(turning, apart) + _times(parting, along)
        return BodyMeasures(self.bodies, np.einsum("nfi,nfi->nf", along, apart), slope, bend)


@dataclass(frozen=True)
class Radii:
    """Distance of a point of one body from a line that is fixed to another."""

    bodies: Indices  # (measures, 2)
    # two directions of the first body across the line, (n, measures, 3)
    across: Array
    other: Array
    # a point of the line, and the other one, from the centres of their bodies, (n, measures, 3) [m]
    start: Array
    end: Array
    before: Array  # offset along both directions where these points coincide, (n, measures, 2) [m]

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the distances at some places [m]."""
        both = [
            Distances(self.bodies, along, self.start, self.end).at(places)
            for along in (self.across, self.other)
        ]
        offs = [one.value + self.before[..., i] for i, one in enumerate(both)]
        # a radius has no derivative at zero: it is rounded there
        radius = np.sqrt(offs[0] ** 2 + offs[1] ** 2 + _TIP**2)
        weights = [off / radius for off in offs]
        one, other = both
        slope = weights[0][..., None] * one.slope + weights[1][..., None] * other.slope
        bend = (
            _squared(one.slope)
            + _squared(other.slope)
            - _squared(slope)
            + offs[0][..., None, None] * one.bend
            + offs[1][..., None, None] * other.bend
        )
        return BodyMeasures(self.bodies, radius, slope, bend / radius[..., None, None])


@dataclass(frozen=True)
class Angles:
    """The cosine of the angle between directions of two bodies."""

    bodies: Indices  # (measures, 2)
    # unit vectors, (n, measures, 3)
    first: Array
    second: Array

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the cosines at some places."""
        one, other = (
            places.of(bodies, vectors)
            for bodies, vectors in zip(self.bodies.T, (self.first, self.second), strict=True)
        )
        by_first, by_second = _turning(one, 0), _turning(other, 1)
        bend = by_first.mT @ by_second
        bend += bend.mT
        for part in _ROTATED:
            bend[..., part, part] += second_by_rotation(one, other)
        slope = _times(by_first, other) + _times(by_second, one)
        return BodyMeasures(self.bodies, np.einsum("nfi,nfi->nf", one, other), slope, bend)


@dataclass(frozen=True)
class Torsions:
    """The relative rotation of two bodies about a common axis.

    If they are also tilted, it is the angle of the rotation before the shortest tilt.
    """

    bodies: Indices  # (measures, 2)
    # two unit vectors across the axis in each body, whose cross product is the axis; without a
    # twist those of both bodies are parallel, (n, measures, 3)
    first: Array
    first_other: Array
    second: Array
    second_other: Array

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the angles at some places [rad]."""

        def both(a: Array, b: Array, c: Array, d: Array, sign: float) -> BodyMeasures:
            one, other = Angles(self.bodies, a, b).at(places), Angles(self.bodies, c, d).at(places)
            sums = (
                getattr(one, name) + sign * getattr(other, name)
                for name in ("value", "slope", "bend")
            )
            return BodyMeasures(self.bodies, *sums)

        sine = both(self.first_other, self.second, self.first, self.second_other, -1.0)
        cosine = both(self.first, self.second, self.first_other, self.second_other, 1.0)
        s, c = sine.value[..., None], cosine.value[..., None]
        square = s**2 + c**2
        slope = (c * sine.slope - s * cosine.slope) / square
        # by the chain rule, with the derivatives of atan2
        outer = [
            a.slope[..., :, None] * b.slope[..., None, :]
            for a, b in ((sine, sine), (cosine, cosine), (sine, cosine))
        ]
        s, c, square = s[..., None], c[..., None], square[..., None]
        bend = (c * sine.bend - s * cosine.bend) / square
        bend += 2.0 * s * c / square**2 * (outer[1] - outer[0])
        bend += (s**2 - c**2) / square**2 * (outer[2] + outer[2].mT)
        return BodyMeasures(self.bodies, np.arctan2(sine.value, cosine.value), slope, bend)


@dataclass(frozen=True)
class Lengths:
    """Distance of two points."""

    bodies: Indices  # (measures, 2)
    # from the centres of their bodies, (n, measures, 3) [m]
    start: Array
    end: Array

    def at(self, places: RigidDisplacements) -> BodyMeasures:
        """Return the distances at some places [m]."""
        first, second = self.bodies.T
        start, end = places.of(first, self.start), places.of(second, self.end)
        apart = places.centers[:, second] + end - places.centers[:, first] - start
        length = np.linalg.norm(apart, axis=-1)
        along = apart / length[..., None]
        parting = _parting(start, end)
        slope = _times(parting, along)
        across = parting.mT @ parting - slope[..., None] * slope[..., None, :]
        bend = across / length[..., None, None]
        bend[..., _ROTATED[0], _ROTATED[0]] -= second_by_rotation(start, along)
        bend[..., _ROTATED[1], _ROTATED[1]] += second_by_rotation(end, along)
        return BodyMeasures(self.bodies, length, slope, bend)


def cross_matrix(vectors: Array) -> Array:
    """Return the skew-symmetric matrices of cross products with vectors."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    nothing = np.zeros_like(x)
    rows = [[nothing, -z, y], [z, nothing, -x], [-y, x, nothing]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def second_by_rotation(turning: Array, other: Array) -> Array:
    """Return the second derivative, in the rotation, of a rotated vector times another one."""
    outer = turning[..., :, None] * other[..., None, :]
    product = np.einsum("...i,...i->...", turning, other)[..., None, None]
    return 0.5 * (outer + outer.mT) - product * np.eye(3)


def _turning(direction: Array, end: int) -> Array:
    """Return the derivative of a direction of the first body, or the second, (..., 3, 12)."""
    found = np.zeros((*direction.shape, 12))
    found[..., _ROTATED[end]] = -cross_matrix(direction)
    return found


def _parting(start: Array, end: Array) -> Array:
    """Return the derivative of the vector from a point of the first body to one of the second."""
    found = _turning(end, 1) - _turning(start, 0)
    found[..., _DISPLACED[0]], found[..., _DISPLACED[1]] = -np.eye(3), np.eye(3)
    return found


def _squared(slope: Array) -> Array:
    return slope[..., :, None] * slope[..., None, :]


def _times(derivative: Array, vector: Array) -> Array:
    return np.einsum("...ij,...i->...j", derivative, vector)
