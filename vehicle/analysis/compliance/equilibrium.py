"""Equilibrium of a suspension or an axle on bushes with large deflections: Newton's method.

The unknowns are displacements and rotations of all parts, the forces of rigid joints, and the
forces that support the wheels. The Jacobian is exact; all positions are solved together.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ....core.threads import in_one_thread
from ....core.vectors import cross
from ...assembly.anti_roll_bar import AnyBar
from ...assembly.part_poses import PartPoses
from ...assembly.wheel import lowest_point
from ...corner.corner import UP
from .connections import CompliantJoints, Connections
from .flexibility import WheelSupport, rates_of_tyres
from .rigid_displacements import BodyMeasures, RigidDisplacements, cross_matrix

_MOST_STEPS = 40
# The largest deflection of a bush: real ones reach some tens of millimetres [m].
_FARTHEST = 0.1
# A step this small is the last one: the next would be of the size of its square, in m and rad.
_LAST_STEP = 1e-9
# Longer steps are shortened to this one: first derivatives hold only nearby.
_LONGEST = 0.02
# Conditions with a smaller independent part follow from others, to rounding.
_REPEATED = 1e-9
# Unit of the unknown forces [N], with which they are of the size of displacements.
_FORCE = 1e5
LOADS = 9
"""Components of a load, see `ElasticEquilibrium.under`."""

# A unit of vertical force of the road on a wheel, as a load.
_UPWARD = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class ElasticState:
    """Displacements of the parts of a suspension or an axle, and forces on them; n positions."""

    places: RigidDisplacements
    forces: Array  # forces and moments of the conditions, (n, conditions) [N], [N m]
    road: Array  # vertical force of the road at each contact, (n, wheels) [N]
    lock: Array  # force that locks each spring, (n, wheels) [N]
    found: NDArray[np.bool_]  # whether this is a stable equilibrium, (n,)


class _Rest(NamedTuple):
    """Lengths of the springs [m] and forces of the road [N] in a state of reference."""

    length: Array
    road: Array


class ElasticEquilibrium:
    """Equilibrium of a suspension or an axle on bushes, in many positions, under loads on wheels.

    The sides are a suspension, both sides of an axle, or a rigid axle: their poses with rigid
    joints, and their compliant joints. A bar is between the sides, or on a rigid axle. ``start`` is
    the state with rigid joints, which is not an equilibrium; ``wheels`` are those of this state.
    """

    def __init__(
        self, sides: Sequence[tuple[PartPoses, CompliantJoints]], bar: AnyBar | None = None
    ) -> None:
        self.poses, self._connections = [poses for poses, _ in sides], Connections(sides, bar)
        self.wheels = [wheel for poses in self.poses for wheel in poses.wheels.values()]
        connections = self._connections
        self._count = connections.start.centers.shape[1]
        measured = connections.at(connections.start)
        self._rigid = _independent(
            measured.slopes(self._count)[0, :, 1:].reshape(len(connections.laws), -1),
            [which for which, law in enumerate(connections.laws) if law is None],
        )
        self._soft = [which for which, law in enumerate(connections.laws) if law is not None]
        n = len(self.poses[0].states)
        nothing = np.zeros((n, len(self.wheels)))
        forces = np.zeros((n, len(self._rigid)))
        never = np.zeros(n, dtype=bool)
        self.start = ElasticState(connections.start, forces, nothing, nothing, never)
        self._weights = {
            connections.index(side, body): weight
            for side, poses in enumerate(self.poses)
            for body, weight in poses.weights().items()
        }
        self._spokes = [
            wheel.center - connections.start.centers[:, body]
            for wheel, body in zip(self.wheels, connections.wheels, strict=True)
        ]
        self._heights = self._contact_heights(connections.start)
        self._rates = rates_of_tyres(self.wheels)

    # -- pose of a wheel --------------------------------------------------------------------------

    def axis(self, places: RigidDisplacements, side: int = 0) -> Array:
        """Return the spin axis of a wheel, pointing outboard, (n, 3)."""
        wheel = np.array([self._connections.wheels[side]])
        return places.of(wheel, self.wheels[side].axis[:, None])[:, 0]

    def center(self, places: RigidDisplacements, side: int = 0) -> Array:
        """Return the centre of a wheel, (n, 3) [m]."""
        wheel = self._connections.wheels[side]
        spoke = places.of(np.array([wheel]), self._spokes[side][:, None])[:, 0]
        return places.centers[:, wheel] + spoke

    def contact(self, places: RigidDisplacements, side: int = 0) -> Array:
        """Return the lowest point of a wheel, (n, 3) [m]."""
        return lowest_point(self.center(places, side), self.axis(places, side), self._radius(side))

    def moved(
        self, point: Array, since: RigidDisplacements, places: RigidDisplacements, side: int = 0
    ) -> Array:
        """Return the displacement of a point of a wheel from `since` to `places`, (n, 3) [m]."""
        wheel = self._connections.wheels[side]
        turned = places.turned[:, wheel] @ since.turned[:, wheel].mT
        arm = np.einsum("nij,nj->ni", turned, point - since.centers[:, wheel])
        return places.centers[:, wheel] + arm - point

    def beyond(self, state: ElasticState) -> list[str]:
        """Return messages for lengths beyond the limits of the files."""
        return [
            allowed.beyond
            for poses, own in zip(self.poses, self._connections.strokes(state.places), strict=True)
            for allowed in poses.allowed_lengths()
            if (allowed.left(own) < 0.0).any()
        ]

    def overstretched(self, state: ElasticState) -> str:
        """Return a message for a bush with an impossible deflection; empty if there is none."""
        far = self._connections.deflected(state.places)
        for bush, amount in sorted(far.items(), key=lambda item: -float(np.nanmax(item[1]))):
            most = 1e3 * float(np.nanmax(amount))
            if most > 1e3 * _FARTHEST:
                return (
                    f"the bush at {bush} deflects by {most:.4g} mm, more than any bush can: "
                    f"{1e3 * _FARTHEST:g} mm"
                )
        return ""

    def _radius(self, side: int) -> float:
        radius = self.wheels[side].vehicle.tyre_radius
        assert radius is not None  # checked by callers
        return radius

    def _contact_heights(self, places: RigidDisplacements) -> Array:
        heights = [self.contact(places, side)[:, 2] for side in range(len(self.wheels))]
        return np.stack(heights, axis=1)

    # -- equilibrium ------------------------------------------------------------------------------

    def under(
        self, load: Array, held: WheelSupport, near: ElasticState, since: ElasticState | None = None
    ) -> ElasticState:
        """Return the equilibrium under a load, by iteration from a state that need not be one.

        The load, (n, wheels, 9), is force and moment on each wheel at its lowest point, and force
        at its centre, chassis axes [N], [N m]. Wheels are held by 'height', a road at the height of
        the contact with rigid joints; 'tyre', a tyre on the road of `since`; 'spring', the force of
        the road in `near`; 'locked', a spring with its length in `since`: the state without the
        load, by default `near`.
        """
        state = near
        rest = self._rest(since or near)
        found = np.zeros(len(load), dtype=bool)
        for _ in range(_MOST_STEPS):
            matrix, left = self._linear(state, load, held, rest)
            step = _solution(matrix, left)
            step[found] = 0.0
            state, far = self._moved(state, step, held)
            found |= far < _LAST_STEP
            if found.all() or not np.isfinite(far).any():
                break
        matrix, _ = self._linear(state, load, held, rest)
        return replace(state, found=found & self._lasts(matrix, held))

    def rate(self, state: ElasticState, load: Array) -> Array:
        """Return the derivatives of road forces in contact heights, (n, wheels, wheels) [N/m].

        The state is an equilibrium under a load, with the road as support of the wheels.
        """
        wheels = state.road.shape[1]
        matrix, left = self._linear(state, load, "height", self._rest(state))
        columns = []
        for wheel in range(wheels):
            higher = np.zeros_like(left)
            higher[:, wheel - wheels] = -1.0
            columns.append(_solution(matrix, higher)[:, -wheels:] * _FORCE)
        return np.stack(columns, axis=-1)

    def torque_of_bar(self, state: ElasticState) -> Array:
        """Return the torque of the bar, positive if the first half is turned farther [N m]."""
        which = self._connections.bar
        if which is None:
            return np.zeros(len(state.road))
        law = self._connections.laws[which]
        assert law is not None
        return law(self._connections.at(state.places).value[:, which])[0]

    def _moved(
        self, state: ElasticState, step: Array, held: WheelSupport
    ) -> tuple[ElasticState, Array]:
        """Return the state after a step, and the length of the step."""
        size = 6 * (self._count - 1)
        far = np.abs(step[:, :size]).max(axis=1)
        with np.errstate(invalid="ignore"):
            part = np.minimum(1.0, _LONGEST / np.maximum(far, _LONGEST))
        by = np.zeros((len(step), self._count, 6))
        by[:, 1:] = (part[:, None] * step[:, :size]).reshape(len(step), -1, 6)
        forces = state.forces + part[:, None] * step[:, size : size + len(self._rigid)] * _FORCE
        state = replace(state, places=state.places.moved(np.nan_to_num(by)), forces=forces)
        if held != "spring":
            name = "lock" if held == "locked" else "road"
            more = getattr(state, name) + part[:, None] * step[:, -state.road.shape[1] :] * _FORCE
            state = replace(state, **{name: more})
        return state, far

    def _rest(self, since: ElasticState) -> _Rest:
        measured = self._connections.at(since.places).value
        return _Rest(measured[:, self._connections.springs], since.road)

    def _linear(
        self, state: ElasticState, load: Array, held: WheelSupport, rest: _Rest
    ) -> tuple[Array, Array]:
        """Return the Jacobian and the residual of all equations."""
        measured = self._connections.at(state.places)
        n, size = len(load), 6 * (self._count - 1)
        slopes = measured.slopes(self._count)[:, :, 1:].reshape(n, len(self._connections.laws), -1)
        inner, stiffness = self._inner(state, measured, slopes)
        outer, outer_by = self._outer(state.places, load + state.road[..., None] * _UPWARD)
        conditions, values = slopes[:, self._rigid], measured.value[:, self._rigid]
        direction = -conditions.mT
        if held != "spring":
            rows = slopes[:, self._connections.springs]
            off = measured.value[:, self._connections.springs] - rest.length
            columns = -rows.mT
            if held != "locked":
                rows = self._upward(state.places, load)
                columns = rows.mT
                off = self._contact_heights(state.places) - self._heights
            if held == "tyre":
                off = off + (state.road - rest.road) / self._rates
            conditions = np.concatenate([conditions, rows], axis=1)
            direction = np.concatenate([direction, columns], axis=2)
            values = np.concatenate([values, off], axis=1)
        matrix = np.zeros((n, size + values.shape[1], size + values.shape[1]))
        matrix[:, :size, :size] = (outer_by - stiffness) / _FORCE
        matrix[:, :size, size:] = direction
        matrix[:, size:, :size] = conditions
        if held == "tyre":
            own = slice(-len(self.wheels), None)
            matrix[:, own, own] = np.diag(_FORCE / self._rates)
        return matrix, np.concatenate([(outer - inner) / _FORCE, values], axis=1)

    def _inner(
        self, state: ElasticState, measured: BodyMeasures, slopes: Array
    ) -> tuple[Array, Array]:
        """Return the forces of joints, bushes and springs on the parts, and their derivative."""
        laws = self._connections.laws
        forces, rates = np.zeros_like(measured.value), np.zeros_like(measured.value)
        for which in self._soft:
            law = laws[which]
            assert law is not None
            forces[:, which], rates[:, which] = law(measured.value[:, which])
        forces[:, self._rigid] = state.forces
        forces[:, self._connections.springs] += state.lock
        n, size = slopes.shape[0], slopes.shape[-1]
        bent = measured.bent(forces, self._count)[:, 1:, :, 1:].reshape(n, size, size)
        stiffness = bent + slopes.mT @ (rates[..., None] * slopes)
        total = np.einsum("nf,nfx->nx", forces, slopes)
        # moments are in fixed axes, in which successive rotations do not add up
        for begin in range(3, size, 6):
            rows = slice(begin, begin + 3)
            stiffness[:, rows, rows] -= 0.5 * cross_matrix(total[:, rows])
        return total, stiffness

    def _upward(self, places: RigidDisplacements, load: Array) -> Array:
        """Return the loads on the parts by a unit road force at a wheel, (n, wheels, unknowns)."""
        found = []
        for side in range(load.shape[1]):
            one = np.zeros_like(load)
            one[:, side] = _UPWARD
            found.append(self._outer(places, one)[0] - self._gravity(len(load)))
        return np.stack(found, axis=1)

    def _outer(self, places: RigidDisplacements, load: Array) -> tuple[Array, Array]:
        """Return the weights and the loads of the wheels on the parts, and their derivative."""
        n = len(load)
        total, by = self._gravity(n), np.zeros((n, *2 * (6 * (self._count - 1),)))
        for side, wheel in enumerate(self._connections.wheels):
            begin = 6 * (wheel - 1)
            rows = slice(begin + 3, begin + 6)
            force, moment, pushed = np.split(load[:, side], 3, axis=1)
            center = places.centers[:, wheel]
            arm = self.contact(places, side) - center
            spoke = self.center(places, side) - center
            total[:, begin : begin + 3] += force + pushed
            total[:, rows] += moment + cross(arm, force) + cross(spoke, pushed)
            by[:, rows, rows] += cross_matrix(pushed) @ cross_matrix(spoke)
            by[:, rows, rows] -= cross_matrix(force) @ self._contact_by_turn(places, side, spoke)
        return total, by

    def _contact_by_turn(self, places: RigidDisplacements, side: int, spoke: Array) -> Array:
        """Return the derivative of the lowest point in the rotation of the wheel, (n, 3, 3)."""
        axis = self.axis(places, side)
        turning = -cross_matrix(axis)
        rise = axis[:, 2, None]
        across = np.sqrt(1.0 - rise**2)
        upward = UP - rise * axis
        by_rise = -(axis[..., None] * turning[:, None, 2] + rise[..., None] * turning)
        shrink = (upward * rise / across**3)[..., None] * turning[:, None, 2]
        moved: Array = -cross_matrix(spoke)
        moved -= self._radius(side) * (by_rise / across[..., None] + shrink)
        return moved

    def _gravity(self, n: int) -> Array:
        total = np.zeros((n, self._count, 6))
        for which, weight in self._weights.items():
            total[:, which, :3] = weight
        return total[:, 1:].reshape(n, -1)

    @in_one_thread
    def _lasts(self, matrix: Array, held: WheelSupport) -> NDArray[np.bool_]:
        """Return where the stiffness in all free directions is positive: a stable equilibrium."""
        size = 6 * (self._count - 1)
        stiffness, conditions = -matrix[:, :size, :size], matrix[:, size:, :size]
        if held == "tyre":  # its rate is a stiffness rather than a condition
            rows = conditions[:, -len(self.wheels) :]
            stiffness = stiffness + rows.mT @ (self._rates[:, None] / _FORCE * rows)
            conditions = conditions[:, : -len(self.wheels)]
        fine = np.isfinite(matrix.reshape(len(matrix), -1).sum(axis=1))
        _, _, right = np.linalg.svd(np.where(fine[:, None, None], conditions, 0.0))
        free = right[:, conditions.shape[1] :]
        reduced = free @ np.where(fine[:, None, None], stiffness, 0.0) @ free.mT
        least = np.linalg.eigvalsh(0.5 * (reduced + reduced.mT))
        return fine & (least > 0.0).all(axis=1)


def _independent(slopes: Array, wanted: Sequence[int]) -> list[int]:
    """Return the indices of conditions that do not follow from those before them.

    Dependence is that of the slopes in the first position, (measures, unknowns).
    """
    kept: list[int] = []
    basis = np.zeros((0, slopes.shape[1]))
    for which in wanted:
        row = slopes[which]
        for _ in range(2):  # the second time removes the rounding errors of the first one
            row = row - (basis @ row) @ basis
        size = np.linalg.norm(row)
        if size > _REPEATED * np.linalg.norm(slopes[which]):
            kept.append(which)
            basis = np.vstack([basis, row / size])
    return kept


@in_one_thread
def _solution(matrix: Array, left: Array) -> Array:
    """Return the Newton steps; NaN where the matrix is singular."""
    try:
        return -np.linalg.solve(matrix, left[..., None])[..., 0].astype(float)
    except np.linalg.LinAlgError:  # raised for all positions because of one
        found: Array = np.full(left.shape, np.nan)
        for i, (each, rest) in enumerate(zip(matrix, left, strict=True)):
            if np.isfinite(each).all() and np.linalg.cond(each) < 1e15:
                found[i] = -np.linalg.solve(each, rest)
    return found
