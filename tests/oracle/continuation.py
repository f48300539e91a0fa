"""Bodies on rods, many at a time, followed from design by small steps in maximal coordinates.

A body has six coordinates and six equations: rods keep their lengths, and heights of points of it
are given. Inner ends of rods, and heights, move with a parameter along a way. Nothing is
eliminated, and nothing is shared with the generator.

A step is taken where Newton's method converges to what the tangent predicts, the body turns little,
and the Jacobian keeps nine tenths of what it was; otherwise it is tried shorter, down to nothing.
SI units, chassis axes (z up).
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

# Rotations count by this length [m].
SIZE = 0.3
# Most that the Jacobian may change, and the body turn [rad], in a step.
CHANGE, TURN = 0.1, 0.1
# Steps of the parameter, of the whole way: the longest, and one that is nothing.
LONGEST, NOTHING = 0.01, 1e-9
# Newton's method: iterations, and the correction that is its rounding [m].
ITERATIONS, ROUNDED = 6, 1e-12


@dataclass
class Poses:
    """Poses of bodies: their reference points [m], and rotations from design."""

    center: np.ndarray
    rotation: np.ndarray

    def of(self, some):
        """Return those of some bodies."""
        return Poses(self.center[some], self.rotation[some])

    def put(self, some, others):
        """Replace those of some bodies."""
        self.center[some], self.rotation[some] = others.center, others.rotation

    def moved(self, twist):
        """Return the poses after small motions: translations, and turns times `SIZE`."""
        turn = Rotation.from_rotvec(twist[:, 3:] / SIZE).as_matrix()
        return Poses(self.center + twist[:, :3], turn @ self.rotation)


@dataclass(frozen=True)
class Rods:
    """The constraints of many bodies.

    Attributes
    ----------
    outer : ndarray, shape (bodies, rods, 3)
        Ends on the body, from its reference at design [m].
    length : ndarray, shape (bodies, rods)
        [m]
    inner : callable
        Given indices of bodies and their parameters, returns where the other ends are, shape
        (some, rods, 3) [m].
    points : ndarray, shape (bodies, points, 3)
        Those whose heights are given, from the reference at design [m].
    heights : callable
        Given indices and parameters, returns their heights, shape (some, points) [m].
    """

    outer: np.ndarray
    length: np.ndarray
    inner: Callable[[np.ndarray, np.ndarray], np.ndarray]
    points: np.ndarray
    heights: Callable[[np.ndarray, np.ndarray], np.ndarray]

    def equations(self, some, at, poses):
        """Return what is left of the equations [m], and their derivatives by `Poses.moved`."""
        turned = np.swapaxes(poses.rotation, -1, -2)
        arms = self.outer[some] @ turned
        rods = poses.center[:, None] + arms - self.inner(some, at)
        lengths = np.linalg.norm(rods, axis=-1)
        along = rods / lengths[..., None]
        offsets = self.points[some] @ turned
        up = np.broadcast_to([0.0, 0.0, 1.0], offsets.shape)
        left = np.concatenate(
            [
                lengths - self.length[some],
                poses.center[:, None, 2] + offsets[..., 2] - self.heights(some, at),
            ],
            axis=1,
        )
        ways = np.concatenate([along, up], axis=1)
        arms = np.concatenate([arms, offsets], axis=1)
        return left, np.concatenate([ways, _cross(arms, ways) / SIZE], axis=-1)

    def solved(self, some, at, poses):
        """Return poses near given ones, their Jacobians, and which of them are found."""
        before = np.full(some.size, TURN * SIZE)
        fine = np.ones(some.size, dtype=bool)
        for _ in range(ITERATIONS):
            left, rows = self.equations(some, at, poses)
            with np.errstate(all="ignore"):
                correction = _solve(rows, -left)
            size = np.abs(correction).max(axis=-1)
            fine &= size <= np.maximum(0.3 * before, ROUNDED)
            before = size
            poses = poses.moved(np.where(fine[:, None], correction, 0.0))
        _, rows = self.equations(some, at, poses)
        return poses, rows, fine & (before <= 10.0 * ROUNDED)

    def tangent(self, some, at, poses, rows):
        """Return how poses move with the parameter."""
        small = 1e-6
        ahead, _ = self.equations(some, at + small, poses)
        behind, _ = self.equations(some, at - small, poses)
        return _solve(rows, (behind - ahead) / (2.0 * small))


def _cross(one, two):
    """Return vector products; NumPy's takes five times as long."""
    (a, b, c), (x, y, z) = (np.moveaxis(v, -1, 0) for v in (one, two))
    return np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=-1)


def _solve(rows, right):
    """Return solutions of many systems, NaN of those that are singular."""
    try:
        return np.asarray(np.linalg.solve(rows, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        rows = rows.copy()
        rows[np.linalg.matrix_rank(rows) < rows.shape[-1]] = np.nan
        return np.asarray(np.linalg.solve(rows, right[..., None])[..., 0])


class Followed:
    """Bodies that are followed along their ways, from the parameter zero to `ends`.

    Attributes
    ----------
    reached : ndarray, shape (bodies,)
        How far each way is regular.
    """

    def __init__(self, rods, start, ends, *, first=None):
        count = len(ends)
        self._rods = rods
        self.reached = np.zeros(count) if first is None else first.copy()
        self._places = [np.full(count, np.nan)]
        self._poses = [start]
        self._go(start, ends)

    def _go(self, start, ends):
        now = Poses(start.center.copy(), start.rotation.copy())
        everyone = np.arange(len(ends))
        whole = ends - self.reached
        self._places[0] = self.reached.copy()
        step = LONGEST * whole
        _, rows = self._rods.equations(everyone, self.reached, now)
        going = everyone[whole != 0.0]
        while going.size:
            at, held = self.reached[going], rows[going]
            target = at + step[going]
            last = np.abs(target - ends[going]) <= 1e-12 * np.abs(whole[going])
            last |= (ends[going] - target) * np.sign(whole[going]) < 0.0
            target = np.where(last, ends[going], target)
            there = now.of(going)
            with np.errstate(all="ignore"):
                way = self._rods.tangent(going, at, there, held) * (target - at)[:, None]
            small = np.abs(way).max(axis=-1) <= TURN * SIZE
            found, after, fine = self._rods.solved(
                going, target, there.moved(np.where(small[:, None], way, 0.0))
            )
            with np.errstate(all="ignore"):
                kept = np.linalg.solve(held, after) - np.eye(6)
            fine &= small & (np.linalg.norm(kept, axis=(-2, -1)) <= CHANGE)
            done = going[fine]
            now.put(done, found.of(np.flatnonzero(fine)))
            rows[done], self.reached[done] = after[fine], target[fine]
            self._places.append(self.reached.copy())
            self._poses.append(Poses(now.center.copy(), now.rotation.copy()))
            step[done] = np.sign(whole[done]) * np.minimum(
                1.5 * np.abs(step[done]), LONGEST * np.abs(whole[done])
            )
            step[going[~fine]] *= 0.25
            nothing = np.abs(step[going]) < NOTHING * np.abs(whole[going])
            going = going[~(fine & last) & ~nothing]

    def at(self, some, places):
        """Return the poses of bodies at parameters up to which they are followed."""
        table = np.array(self._places)[:, some]
        nearest = np.abs(table - places).argmin(axis=0)
        center = np.array([self._poses[i].center[k] for i, k in zip(nearest, some, strict=True)])
        turned = np.array([self._poses[i].rotation[k] for i, k in zip(nearest, some, strict=True)])
        begin = table[nearest, np.arange(some.size)]
        for parts in (1, 8, 64):
            ways = np.linspace(begin, places, parts + 1)
            found, fine = self._along(some, ways, Poses(center, turned))
            if fine:
                return found
        message = f"bodies {some} are not found at {places}"
        raise AssertionError(message)

    def _along(self, some, ways, poses):
        """Return poses at the end of some places, and whether they are found at each."""
        fine = np.ones(some.size, dtype=bool)
        for at, to in pairwise(ways):
            _, rows = self._rods.equations(some, at, poses)
            way = self._rods.tangent(some, at, poses, rows) * (to - at)[:, None]
            poses, _, found = self._rods.solved(some, to, poses.moved(way))
            fine &= found
        return poses, bool(fine.all())

    def heights(self, some, point):
        """Return where a body has been followed to, and the heights of a point of it there [m]."""
        places = np.array([place[some] for place in self._places])
        heights = np.array(
            [poses.center[some, 2] + poses.rotation[some, 2] @ point for poses in self._poses]
        )
        return places, heights
