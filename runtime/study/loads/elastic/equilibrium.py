"""The equilibrium of a suspension whose joints give way, however far: Newton's method.

Unknown are displacements and rotations of all parts, what holds them together, and what holds the
wheel. The matrix is exact; steps are those of all positions at once.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ....core.vectors import cross
from ....suspension.corner import UP
from ...characteristics.wheel import lowest_point
from ..flexibility import Held
from ..poses import CENTER, Poses
from .connections import Connections, Soft
from .places import Measured, Places, cross_matrix

Array = NDArray[np.float64]

_MOST_STEPS = 40
# A step this small is the last one: the next would be as small as its square, in m and rad.
_LAST_STEP = 1e-9
# No step goes farther: beyond it, first derivatives say little.
_LONGEST = 0.02
# Conditions that follow from others, to rounding.
_REPEATED = 1e-9
# Unknown forces are counted in this many newtons, so that they are of the size of displacements.
_FORCE = 1e5
LOADS = 9
"""Numbers of a load, see `Equilibrium.under`."""

# A unit of what the road does to hold a wheel up, as a load.
_UPWARD = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class State:
    """Where the parts of a suspension are, and what holds them there; n positions.

    Attributes
    ----------
    places : Places
    forces : ndarray, shape (n, conditions)
        Of the conditions [N], [N m].
    road : ndarray, shape (n,)
        Vertical force of the road at the contact [N].
    lock : ndarray, shape (n,)
        What locks the spring [N].
    found : ndarray of bool, shape (n,)
        Whether this is an equilibrium that lasts.
    """

    places: Places
    forces: Array
    road: Array
    lock: Array
    found: NDArray[np.bool_]


class Equilibrium:
    """A suspension on bushes in many positions, under loads at the contact of its wheel.

    Parameters
    ----------
    poses : Poses
        With rigid joints.
    soft : Soft
        What gives way.

    Attributes
    ----------
    poses : Poses
    start : State
        With rigid joints: no equilibrium.
    """

    def __init__(self, poses: Poses, soft: Soft) -> None:
        self.poses, self._connections = poses, Connections(poses, soft)
        connections = self._connections
        self._count, self._wheel = len(connections.bodies), connections.index("wheel")
        measured = connections.at(connections.start)
        self._rigid = _independent(
            measured.slopes(self._count)[0, :, 1:].reshape(len(connections.laws), -1),
            [which for which, law in enumerate(connections.laws) if law is None],
        )
        self._soft = [which for which, law in enumerate(connections.laws) if law is not None]
        n = len(poses.axis)
        nothing = np.zeros(n)
        forces = np.zeros((n, len(self._rigid)))
        never = np.zeros(n, dtype=bool)
        self.start = State(connections.start, forces, nothing, nothing, never)
        self._weights = poses.weights()
        self._spoke = poses.points[CENTER] - connections.start.centers[:, self._wheel]
        self._height = self.contact(connections.start)[:, 2]

    # -- where the wheel is -----------------------------------------------------------------------

    def axis(self, places: Places) -> Array:
        """Return the spin axis of the wheel, pointing outboard, (n, 3)."""
        return places.of(np.array([self._wheel]), self.poses.axis[:, None])[:, 0]

    def center(self, places: Places) -> Array:
        """Return the wheel centre, (n, 3) [m]."""
        spoke = places.of(np.array([self._wheel]), self._spoke[:, None])[:, 0]
        center: Array = places.centers[:, self._wheel] + spoke
        return center

    def contact(self, places: Places) -> Array:
        """Return the lowest point of the wheel, (n, 3) [m]."""
        return lowest_point(self.center(places), self.axis(places), self._radius)

    def moved(self, point: Array, since: Places, places: Places) -> Array:
        """Return how far the wheel took a point with it, (n, 3) [m].

        Parameters
        ----------
        point : ndarray, shape (n, 3)
            Where it was [m].
        since, places : Places
            Before and after.
        """
        wheel = self._wheel
        turned = places.turned[:, wheel] @ since.turned[:, wheel].mT
        arm = np.einsum("nij,nj->ni", turned, point - since.centers[:, wheel])
        shift: Array = places.centers[:, wheel] + arm - point
        return shift

    def beyond(self, state: State) -> list[str]:
        """Return which lengths are beyond what the file allows."""
        suspension = self.poses.model.suspension
        length = {f"{suspension.STOPPED}_length": self._connections.stroke(state.places)}
        allowed = suspension.allowed_lengths()
        return [one.beyond for one in allowed if (one.left(length) < 0.0).any()]

    @property
    def _radius(self) -> float:
        radius = self.poses.model.suspension.tyre_radius()
        assert radius is not None  # callers have seen to it
        return radius

    # -- equilibrium ------------------------------------------------------------------------------

    def under(self, load: Array, held: Held, near: State) -> State:
        """Return the equilibrium under a load.

        Parameters
        ----------
        load : ndarray, shape (n, 9)
            Force and moment on the wheel at its lowest point, and force at its centre, chassis
            axes [N], [N m].
        held : {'height', 'spring', 'locked'}
            What holds the wheel: the road at the height where the contact was with rigid joints, or
            a force of the road as in `near`, the spring as it is or as long as it is there.
        near : State
            Where to begin; it need not be an equilibrium.
        """
        state = near
        length = self._connections.at(near.places).value[:, self._connections.spring]
        found = np.zeros(len(load), dtype=bool)
        for _ in range(_MOST_STEPS):
            matrix, left = self._linear(state, load, held, length)
            step = _solution(matrix, left)
            step[found] = 0.0
            state, far = self._moved(state, step, held)
            found |= far < _LAST_STEP
            if found.all() or not np.isfinite(far).any():
                break
        matrix, _ = self._linear(state, load, held, length)
        return replace(state, found=found & self._lasts(matrix))

    def rate(self, state: State, load: Array) -> Array:
        """Return how the force of the road rises with its height, (n,) [N/m].

        Parameters
        ----------
        state : State
            An equilibrium under a load, the wheel held by the road.
        load : ndarray, shape (n, 9)
        """
        matrix, left = self._linear(state, load, "height", np.zeros(len(load)))
        higher = np.zeros_like(left)
        higher[:, -1] = -1.0
        return _solution(matrix, higher)[:, -1] * _FORCE

    def _moved(self, state: State, step: Array, held: Held) -> tuple[State, Array]:
        """Return the state after a step, and how far that went."""
        size = 6 * (self._count - 1)
        far = np.abs(step[:, :size]).max(axis=1)
        with np.errstate(invalid="ignore"):
            part = np.minimum(1.0, _LONGEST / np.maximum(far, _LONGEST))
        by = np.zeros((len(step), self._count, 6))
        by[:, 1:] = (part[:, None] * step[:, :size]).reshape(len(step), -1, 6)
        forces = state.forces + part[:, None] * step[:, size : size + len(self._rigid)] * _FORCE
        state = replace(state, places=state.places.moved(np.nan_to_num(by)), forces=forces)
        if held != "spring":
            name = "road" if held == "height" else "lock"
            more = getattr(state, name) + part * step[:, -1] * _FORCE
            state = replace(state, **{name: more})
        return state, far

    def _linear(self, state: State, load: Array, held: Held, length: Array) -> tuple[Array, Array]:
        """Return the derivative of what is left of all equations, and what is left."""
        measured = self._connections.at(state.places)
        n, size = len(load), 6 * (self._count - 1)
        slopes = measured.slopes(self._count)[:, :, 1:].reshape(n, len(self._connections.laws), -1)
        inner, stiffness = self._inner(state, measured, slopes)
        outer, outer_by = self._outer(state.places, load + state.road[:, None] * _UPWARD)
        conditions, values = slopes[:, self._rigid], measured.value[:, self._rigid]
        direction = -conditions.mT
        if held != "spring":
            row = slopes[:, self._connections.spring, None]
            off = measured.value[:, self._connections.spring] - length
            column = -row.mT
            if held == "height":
                upward, _ = self._outer(state.places, np.broadcast_to(_UPWARD, load.shape))
                upward -= self._gravity(n)
                row, column = upward[:, None], upward[..., None]
                off = self.contact(state.places)[:, 2] - self._height
            conditions = np.concatenate([conditions, row], axis=1)
            direction = np.concatenate([direction, column], axis=2)
            values = np.concatenate([values, off[:, None]], axis=1)
        matrix = np.zeros((n, size + values.shape[1], size + values.shape[1]))
        matrix[:, :size, :size] = (outer_by - stiffness) / _FORCE
        matrix[:, :size, size:] = direction
        matrix[:, size:, :size] = conditions
        return matrix, np.concatenate([(outer - inner) / _FORCE, values], axis=1)

    def _inner(self, state: State, measured: Measured, slopes: Array) -> tuple[Array, Array]:
        """Return what resists displacements and rotations of the parts, and its derivative."""
        laws = self._connections.laws
        forces, rates = np.zeros_like(measured.value), np.zeros_like(measured.value)
        for which in self._soft:
            law = laws[which]
            assert law is not None
            forces[:, which], rates[:, which] = law(measured.value[:, which])
        forces[:, self._rigid] = state.forces
        forces[:, self._connections.spring] += state.lock
        n, size = slopes.shape[0], slopes.shape[-1]
        bent = measured.bent(forces, self._count)[:, 1:, :, 1:].reshape(n, size, size)
        stiffness = bent + slopes.mT @ (rates[..., None] * slopes)
        total = np.einsum("nf,nfx->nx", forces, slopes)
        # a moment is told in axes that stay, in which a rotation after another is no sum
        for begin in range(3, size, 6):
            rows = slice(begin, begin + 3)
            stiffness[:, rows, rows] -= 0.5 * cross_matrix(total[:, rows])
        return total, stiffness

    def _outer(self, places: Places, load: Array) -> tuple[Array, Array]:
        """Return what pushes and turns the parts from outside, and its derivative."""
        n, wheel = len(load), 6 * (self._wheel - 1)
        total, by = self._gravity(n), np.zeros((n, *2 * (6 * (self._count - 1),)))
        force, moment, pushed = load[:, :3], load[:, 3:6], load[:, 6:]
        rows = slice(wheel + 3, wheel + 6)
        axis, center = self.axis(places), places.centers[:, self._wheel]
        arm, spoke = self.contact(places) - center, self.center(places) - center
        total[:, wheel : wheel + 3] += force + pushed
        total[:, rows] += moment + cross(arm, force) + cross(spoke, pushed)
        # how the lowest point moves as the wheel turns
        turning = -cross_matrix(axis)
        rise = axis[:, 2, None]
        across = np.sqrt(1.0 - rise**2)
        upward = UP - rise * axis
        by_rise = -(axis[..., None] * turning[:, None, 2] + rise[..., None] * turning)
        shrink = (upward * rise / across**3)[..., None] * turning[:, None, 2]
        moved = -cross_matrix(spoke) - self._radius * (by_rise / across[..., None] + shrink)
        by[:, rows, rows] += cross_matrix(pushed) @ cross_matrix(spoke)
        by[:, rows, rows] -= cross_matrix(force) @ moved
        return total, by

    def _gravity(self, n: int) -> Array:
        total = np.zeros((n, self._count - 1, 6))
        for body, weight in self._weights.items():
            which = self._connections.index(body)
            if which:
                total[:, which - 1, :3] = weight
        return total.reshape(n, -1)

    def _lasts(self, matrix: Array) -> NDArray[np.bool_]:
        """Tell where all that the conditions leave free is resisted."""
        size = 6 * (self._count - 1)
        stiffness, conditions = -matrix[:, :size, :size], matrix[:, size:, :size]
        fine = np.isfinite(matrix.reshape(len(matrix), -1).sum(axis=1))
        _, _, right = np.linalg.svd(np.where(fine[:, None, None], conditions, 0.0))
        free = right[:, conditions.shape[1] :]
        reduced = free @ np.where(fine[:, None, None], stiffness, 0.0) @ free.mT
        least = np.linalg.eigvalsh(0.5 * (reduced + reduced.mT))
        lasts: NDArray[np.bool_] = fine & (least > 0.0).all(axis=1)
        return lasts


def _independent(slopes: Array, wanted: Sequence[int]) -> list[int]:
    """Return those of some conditions that do not follow from those before them.

    Which these are is the same in every position, as their order is.

    Parameters
    ----------
    slopes : ndarray, shape (measures, unknowns)
    wanted : sequence of int
        Which measures are conditions.
    """
    kept: list[int] = []
    basis = np.zeros((0, slopes.shape[1]))
    for which in wanted:
        row = slopes[which]
        for _ in range(2):  # once more takes the rounding errors of the first time away
            row = row - (basis @ row) @ basis
        size = np.linalg.norm(row)
        if size > _REPEATED * np.linalg.norm(slopes[which]):
            kept.append(which)
            basis = np.vstack([basis, row / size])
    return kept


def _solution(matrix: Array, left: Array) -> Array:
    """Return the steps after which nothing is left, to first order; no numbers where none is."""
    try:
        return -np.linalg.solve(matrix, left[..., None])[..., 0].astype(float)
    except np.linalg.LinAlgError:  # one spoils all
        found: Array = np.full(left.shape, np.nan)
        for i, (each, rest) in enumerate(zip(matrix, left, strict=True)):
            if np.isfinite(each).all() and np.linalg.cond(each) < 1e15:
                found[i] = -np.linalg.solve(each, rest)
    return found
