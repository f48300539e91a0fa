"""Bodies, poses and joints as constraint equations in redundant maximal coordinates.

Three kinds of scalar equation suffice for every joint. Bodies i and j, points P and vectors a, b
fixed in the body named by the index:

- ``point``: P_i - P_j = 0, three equations;
- ``angle``: a_i . b_j = 0;
- ``plane``: a_i . (P_j - P_i) = offset.

Units are SI; world axes are the chassis axes.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Index = npt.NDArray[np.intp]

CHASSIS = 0
BODIES = ("control_arm", "knuckle", "tie_rod", "rack", "upper_strut", "wheel")
"""The moving bodies, in the order of every array with a leading dimension of six."""
ARM, KNUCKLE, TIE_ROD, RACK, UPPER_STRUT, WHEEL = range(1, 7)
"""Indices of the bodies where the chassis counts as 0; subtract one for the arrays of six."""


@dataclass(frozen=True)
class Pose:
    """Positions of the moving bodies.

    Attributes
    ----------
    position : ndarray, shape (6, 3)
        Centres of mass, m, in the order of `BODIES`.
    rotation : ndarray, shape (6, 3, 3)
        Rotation from the design orientation: a vector v drawn on the body at design is now R v.
    """

    position: Array
    rotation: Array


@dataclass(frozen=True)
class Equations:
    """Scalar constraint equations of the three kinds, ready to be evaluated all at once.

    Body indices count the chassis as 0. Vectors and arms (from the centre of mass) are those of
    the design position. Rows are ordered: points (three rows each), angles, planes.

    Attributes
    ----------
    point_bodies : ndarray of int, shape (p, 2)
        Bodies i, j.
    point_arms : ndarray, shape (p, 2, 3)
        Arms of the common point, m.
    angle_bodies : ndarray of int, shape (a, 2)
        Bodies i, j.
    angle_vectors : ndarray, shape (a, 2, 3)
        Unit vectors.
    plane_bodies : ndarray of int, shape (f, 2)
        Bodies i, j.
    plane_arms : ndarray, shape (f, 2, 3)
        Arms of the two points, m.
    plane_normals : ndarray, shape (f, 3)
        Unit vector fixed in body i.
    plane_offsets : ndarray, shape (f,)
        Distance of point j from the plane through point i, m.
    """

    point_bodies: Index
    point_arms: Array
    angle_bodies: Index
    angle_vectors: Array
    plane_bodies: Index
    plane_arms: Array
    plane_normals: Array
    plane_offsets: Array

    def evaluate(self, pose):
        """Return residual and Jacobian.

        Parameters
        ----------
        pose : Pose
            Need not satisfy the equations.

        Returns
        -------
        residual : ndarray, shape (n,)
            In m for points and planes, dimensionless for angles.
        jacobian : ndarray, shape (n, 6 bodies)
            With respect to the world components of (displacement of the centre of mass,
            infinitesimal rotation) of each body in turn; times the twists it gives the rates of
            the residual.
        """
        position, rotation = with_chassis(pose)
        jacobian = np.zeros((self.size, len(position), 6))
        p, a = 3 * len(self.point_bodies), len(self.angle_bodies)

        arms = _turn(rotation[self.point_bodies], self.point_arms)
        places = position[self.point_bodies] + arms
        block_rows = np.arange(p).reshape(-1, 3)
        for side, sign in ((0, 1.0), (1, -1.0)):
            block = np.concatenate(
                (
                    np.broadcast_to(sign * np.eye(3), (len(block_rows), 3, 3)),
                    -sign * skew(arms[:, side]),
                ),
                axis=2,
            )
            jacobian[block_rows, self.point_bodies[:, side, None]] += block

        vectors = _turn(rotation[self.angle_bodies], self.angle_vectors)
        normal = np.cross(vectors[:, 0], vectors[:, 1])
        angle_rows = np.arange(p, p + a)
        jacobian[angle_rows, self.angle_bodies[:, 0], 3:] += normal
        jacobian[angle_rows, self.angle_bodies[:, 1], 3:] -= normal

        arms = _turn(rotation[self.plane_bodies], self.plane_arms)
        ends = position[self.plane_bodies] + arms
        span = ends[:, 1] - ends[:, 0]
        normals = _turn(rotation[self.plane_bodies[:, 0]], self.plane_normals)
        plane_rows = np.arange(p + a, self.size)
        jacobian[plane_rows, self.plane_bodies[:, 0], :3] -= normals
        jacobian[plane_rows, self.plane_bodies[:, 0], 3:] += np.cross(normals, span + arms[:, 0])
        jacobian[plane_rows, self.plane_bodies[:, 1], :3] += normals
        jacobian[plane_rows, self.plane_bodies[:, 1], 3:] += np.cross(arms[:, 1], normals)

        residual = np.concatenate(
            (
                (places[:, 0] - places[:, 1]).ravel(),
                np.einsum("ij,ij->i", vectors[:, 0], vectors[:, 1]),
                np.einsum("ij,ij->i", normals, span) - self.plane_offsets,
            )
        )
        return residual, jacobian[:, 1:].reshape(self.size, -1)

    def convective(self, pose, twist):
        """Return the second time derivative of the residual at zero accelerations.

        Parameters
        ----------
        pose : Pose
            Current pose.
        twist : ndarray, shape (6, 6)
            Velocity of the centre of mass (m/s) and angular velocity (rad/s) of each body.

        Returns
        -------
        ndarray, shape (n,)
            The rate of the Jacobian times the twists, m/s² or 1/s².
        """
        _, rotation = with_chassis(pose)
        position = np.vstack((np.zeros((1, 3)), pose.position))
        speed = np.vstack((np.zeros((1, 3)), twist[:, :3]))
        omega = np.vstack((np.zeros((1, 3)), twist[:, 3:]))

        arms = _turn(rotation[self.point_bodies], self.point_arms)
        spins = omega[self.point_bodies]
        pulls = np.cross(spins, np.cross(spins, arms))
        points = (pulls[:, 0] - pulls[:, 1]).ravel()

        vectors = _turn(rotation[self.angle_bodies], self.angle_vectors)
        spins = omega[self.angle_bodies]
        rates = np.cross(spins, vectors)
        pulls = np.cross(spins, rates)
        angles = np.sum(
            pulls[:, 0] * vectors[:, 1]
            + 2.0 * rates[:, 0] * rates[:, 1]
            + vectors[:, 0] * pulls[:, 1],
            axis=1,
        )

        arms = _turn(rotation[self.plane_bodies], self.plane_arms)
        spins = omega[self.plane_bodies]
        ends = position[self.plane_bodies] + arms
        end_rates = speed[self.plane_bodies] + np.cross(spins, arms)
        end_pulls = np.cross(spins, np.cross(spins, arms))
        normals = _turn(rotation[self.plane_bodies[:, 0]], self.plane_normals)
        normal_rates = np.cross(spins[:, 0], normals)
        normal_pulls = np.cross(spins[:, 0], normal_rates)
        planes = np.sum(
            normal_pulls * (ends[:, 1] - ends[:, 0])
            + 2.0 * normal_rates * (end_rates[:, 1] - end_rates[:, 0])
            + normals * (end_pulls[:, 1] - end_pulls[:, 0]),
            axis=1,
        )
        return np.concatenate((points, angles, planes))

    @cached_property
    def size(self):
        """Number of scalar equations n."""
        return 3 * len(self.point_bodies) + len(self.angle_bodies) + len(self.plane_bodies)


class Assembler:
    """Collects joints as constraint equations.

    Every joint lies between bodies `i` and `j` (the chassis is 0); its points (m) and axes (any
    length) are those of the design position in chassis axes, shape (3,).

    Parameters
    ----------
    centres : ndarray, shape (1 + bodies, 3)
        Centres of mass at design, the chassis's origin first, m.
    """

    def __init__(self, centres):
        self._centres = centres  # (1 + bodies, 3), the chassis's is the origin
        self._points = []
        self._angles = []
        self._planes = []

    def _arm(self, body, point):
        return point - self._centres[body]

    def spherical(self, i, j, point):
        """Hold a point of both bodies together: three equations."""
        self._points.append(((i, j), (self._arm(i, point), self._arm(j, point))))

    def perpendicular(self, i, j, a, b):
        """Keep vector a of body i perpendicular to vector b of body j: one equation."""
        self._angles.append(((i, j), (unit(a), unit(b))))

    def in_plane(self, i, j, normal, points, offset=0.0):
        """Keep a point of j at an offset (m) from a plane of i through a point: one equation."""
        arms = (self._arm(i, points[0]), self._arm(j, points[1]))
        self._planes.append(((i, j), arms, unit(normal), offset))

    def parallel(self, i, j, axis):
        """Keep a common axis parallel: two equations."""
        for across in perpendiculars(axis):
            self.perpendicular(i, j, axis, across)

    def revolute(self, i, j, point, axis):
        """Let the bodies turn about an axis through a point: five equations."""
        self.spherical(i, j, point)
        self.parallel(i, j, axis)

    def universal(self, i, j, point, axis_i, axis_j):
        """Hold a point together and an axis of each body perpendicular: four equations."""
        self.spherical(i, j, point)
        self.perpendicular(i, j, axis_i, axis_j)

    def cylindrical(self, i, j, axis, points):
        """Let the bodies turn about and slide along an axis: four equations."""
        self.parallel(i, j, axis)
        for across in perpendiculars(axis):
            self.in_plane(i, j, across, points)

    def prismatic(self, i, j, axis, point):
        """Let the bodies slide along an axis: five equations."""
        first, second = perpendiculars(axis)
        self.cylindrical(i, j, axis, (point, point))
        self.perpendicular(i, j, first, second)

    def equations(self):
        """Return the equations collected so far."""
        return Equations(
            np.array([bodies for bodies, _ in self._points], dtype=np.intp).reshape(-1, 2),
            np.array([arms for _, arms in self._points]).reshape(-1, 2, 3),
            np.array([bodies for bodies, _ in self._angles], dtype=np.intp).reshape(-1, 2),
            np.array([vectors for _, vectors in self._angles]).reshape(-1, 2, 3),
            np.array([plane[0] for plane in self._planes], dtype=np.intp).reshape(-1, 2),
            np.array([plane[1] for plane in self._planes]).reshape(-1, 2, 3),
            np.array([plane[2] for plane in self._planes]).reshape(-1, 3),
            np.array([plane[3] for plane in self._planes], dtype=float),
        )


def with_chassis(pose):
    """Return positions (1 + bodies, 3) and rotations with the chassis's first."""
    return (
        np.concatenate((np.zeros((1, 3)), pose.position)),
        np.concatenate((np.eye(3)[None], pose.rotation)),
    )


def _turn(rotation, vectors):
    """Multiply matrices (..., 3, 3) and vectors (..., 3)."""
    return (rotation @ vectors[..., None])[..., 0]


def skew(vectors):
    """Return the matrices S with S u = v x u for vectors v, shape (..., 3)."""
    matrix = np.zeros((*vectors.shape[:-1], 3, 3))
    matrix[..., 0, 1], matrix[..., 1, 0] = -vectors[..., 2], vectors[..., 2]
    matrix[..., 2, 0], matrix[..., 0, 2] = -vectors[..., 1], vectors[..., 1]
    matrix[..., 1, 2], matrix[..., 2, 1] = -vectors[..., 0], vectors[..., 0]
    return matrix


def unit(v):
    """Return v / |v|."""
    return v / np.linalg.norm(v)


def perpendiculars(axis):
    """Return two unit vectors that complete unit(axis) to a right-handed triad axis, u, v."""
    along = unit(axis)
    first = unit(np.cross(along, np.eye(3)[np.argmin(np.abs(along))]))
    return first, np.cross(along, first)
