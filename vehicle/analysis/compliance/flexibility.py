"""Flexibility of the wheels by the unit-load theorem, from the energy of compliant parts.

All forces are linear in unit loads: forces and moments at the contact of each wheel, the torque of
an anti-roll bar, and statically indeterminate tensions. The energy is a quadratic form of these;
the indeterminate tensions have the values of least energy.

Source: S. P. Timoshenko and D. H. Young, Theory of Structures, second edition, McGraw-Hill, 1965
(unit loads, least work).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from scipy.optimize import root

from ....core.named_types import Array
from ....core.validator import Validator
from ...assembly.load import Load
from ...assembly.part_poses import CONTACT, PartPoses, rotated, touching
from ...assembly.soft_lines import SoftLines
from ...corner.bushes import Bush
from ...corner.corner import RoadWheel
from ...corner.structure import GROUND, PartJoint
from ...input.vehicle import TyreSection
from ..loads.reactions import BalanceEquations

WheelSupport = Literal["height", "tyre", "spring", "locked"]

HELD = {
    "height": "the contact stays at its height",
    "tyre": "the tyre rests on a road that stays at its height",
    "spring": "spring and stops carry the wheel",
    "locked": "the spring is locked",
}
"""Supports of a wheel under loads."""

_VERTICAL, _COMPONENTS = 2, 6
# A flexibility below this part of the rest is rounding: the part is rigid.
_RIGID = 1e-12


@dataclass(frozen=True)
class Side:
    """A suspension or a rigid axle with its compliant parts; arrays over n positions.

    Attributes
    ----------
    poses : PartPoses
    bushes : sequence of Bush
    lines : SoftLines or None
        None with locked springs.
    bar : sequence of Load
        Loads of an anti-roll bar on it for a unit torque; empty without one.
    """

    poses: PartPoses
    bushes: Sequence[Bush]
    lines: SoftLines | None
    bar: Sequence[Load] = ()


def flexibility(
    sides: Sequence[Side], held: WheelSupport, *, rack: float = 0.0, bar: float = 0.0
) -> Array:
    """Return displacement and rotation of the contacts by loads on them.

    Parameters
    ----------
    sides : sequence of Side
        A suspension, both sides of an axle, or a rigid axle.
    held : {'height', 'tyre', 'spring', 'locked'}
        Support of the wheels.
    rack : float, optional
        Compliance of the rack along its axis [m/N].
    bar : float, optional
        Twist of the anti-roll bar for a unit torque [rad/(N m)].

    Returns
    -------
    ndarray, shape (n, 6 wheels, 6 wheels)
        Chassis axes; force and moment on each wheel in turn.
    """
    energies = [_Energy(side) for side in sides]
    wheels = [wheel for side in sides for wheel in side.poses.wheels.values()]
    applied = _COMPONENTS * len(wheels)
    has_bar = any(side.bar for side in sides)
    size = applied + has_bar + sum(each.tensions for each in energies)
    energy = np.zeros((len(sides[0].poses.states), size, size))
    on_rack, first, begin = np.zeros((*energy.shape[:1], 1, size)), 0, applied + has_bar
    for side, each in zip(sides, energies, strict=True):
        # indices of the unknowns of this side
        count = _COMPONENTS * len(side.poses.wheels)
        own = [*range(first, first + count), *[applied][: int(has_bar)]]
        own += range(begin, begin + each.tensions)
        first, begin = first + count, begin + each.tensions
        energy[:, np.array(own)[:, None], own] += each.energy
        on_rack[..., own] += each.on_rack
    energy += _energy(on_rack, rack)
    if has_bar:
        energy[:, applied, applied] += bar
    total = _released(energy, list(range(applied, size)))
    if held not in ("height", "tyre"):
        return total
    upward = [_COMPONENTS * i + _VERTICAL for i in range(len(wheels))]
    tyres = np.diag(1.0 / rates_of_tyres(wheels)) if held == "tyre" else 0.0
    return _released(total, upward, soft=tyres, keep=True)


def rates_of_tyres(wheels: Sequence[RoadWheel]) -> Array:
    """Return the vertical rates of the tyres, zero if there is none, (wheels,) [N/m]."""
    return np.array([wheel.vehicle.tyre_rate or 0.0 for wheel in wheels])


def refuse_without_rate(given: Validator, held: WheelSupport, *tyres: TyreSection) -> None:
    """Add an error if tyres support the wheels and one of them has no vertical rate."""
    if held == "tyre" and not all(tyre.rate_N_per_m > 0.0 for tyre in tyres):
        given.fail(
            "held: the tyre supports the wheel, but [tyre] rate_N_per_m = 0 N/m. Enter its rate, "
            "or select another support of the wheel: height, spring, locked."
        )


class _Energy:
    """The energy of the compliant parts of a suspension or a rigid axle under unit loads.

    The unknowns are forces and moments at the contacts, the torque of the bar if there is one, and
    ``tensions`` indeterminate states, those of stops the last. ``energy`` has the shape (n,
    unknowns, unknowns); ``on_rack`` is the force on the rack along its axis, (n, 1, unknowns).
    """

    def __init__(self, side: Side) -> None:
        poses, lines = side.poses, side.lines
        stops = np.zeros((len(poses.states), 0)) if lines is None else lines.stops
        forces = _Forces(side, poses.structure.dampers[: stops.shape[-1]])
        self.tensions = forces.tensions
        self.energy = np.zeros((len(poses.states), *2 * forces.spring.shape[-1:]))
        self.on_rack = np.zeros_like(forces.spring[:, :1])
        if lines is not None:
            self.energy += _energy(forces.spring, lines.springs)
        by_point = {bush.point: bush for bush in side.bushes}
        for joint, carried in zip(poses.structure.joints, forces.carried, strict=True):
            if joint.first == "rack":
                assert poses.rack_axis is not None  # there is a rack
                self.on_rack -= np.einsum("c,nkcu->nku", poses.rack_axis, carried[:, :, :3])
            self.energy += _of_joint(joint, carried, by_point, poses)
        for which in range(-stops.shape[-1], 0):
            acting = np.isfinite(stops[:, which])
            self.energy[acting, which, which] += stops[acting, which]
            self.energy[~acting, which, :] = self.energy[~acting, :, which] = 0.0
            self.on_rack[~acting, :, which] = 0.0


def shared(equations: BalanceEquations, unknowns: Array, bushes: Sequence[Bush]) -> list[Array]:
    """Return the loads on the joints in the first position, with parts at design.

    Statically indeterminate loads have the least energy of the bushes, also of curved ones; loads
    between rigid joints alone are unchanged.

    Parameters
    ----------
    equations : BalanceEquations
    unknowns : ndarray, shape (n, unknowns)
        From `BalanceEquations.solve`.
    bushes : sequence of Bush

    Returns
    -------
    list of ndarray, each of shape (touching points, 6)
        Of each joint.
    """
    states = np.concatenate([unknowns[..., None], equations.indeterminate], axis=-1)
    tensions = [joint.tensions(equations.poses.points)[0] for joint in equations.joints]
    place, count = states.shape[-1], sum(own.shape[-1] for own in tensions)
    every = []
    for at_points, own in zip(equations.at_joints(states), tensions, strict=True):
        carried = np.concatenate([at_points[0], np.zeros((*own.shape[:-1], count))], axis=-1)
        carried[..., place : place + own.shape[-1]] = own
        place += own.shape[-1]
        every.append(carried)
    by_point = {bush.point: bush for bush in bushes}
    on_bushes = [
        (by_point[point], carried[i])
        for joint, carried in zip(equations.joints, every, strict=True)
        for i, point in enumerate(joint.at)
        if point in by_point
    ]
    parts = _of_least_energy(on_bushes, every[0].shape[-1] - 1)
    return [carried[..., 0] + carried[..., 1:] @ parts for carried in every]


def _of_least_energy(on_bushes: Sequence[tuple[Bush, Array]], count: int) -> Array:
    """Return the amounts of the indeterminate tensions with the least energy of the bushes.

    Each bush comes with its forces and moments, (6, 1 + count), by the loads and by each tension.
    """

    def slopes(parts: Array) -> tuple[Array, Array]:
        first, second = np.zeros(count), np.zeros((count, count))
        for bush, carried in on_bushes:
            own = carried[:, 1:]
            moved, by = bush.give(carried[:, 0] + own @ parts)
            first, second = first + own.T @ moved, second + own.T @ by @ own
        return first, second

    sizes, ways = np.linalg.eigh(slopes(np.zeros(count))[1])
    free = ways[:, sizes > _RIGID * sizes.max(initial=0.0)]

    def reduced(along: Array) -> tuple[Array, Array]:
        first, second = slopes(free @ along)
        return free.T @ first, free.T @ second @ free

    if not free.shape[1]:
        return np.zeros(count)
    search: Any = root  # its stubs do not allow a function that also returns its derivative
    found: Array = search(reduced, np.zeros(free.shape[1]), jac=True, options={"xtol": 1e-14}).x
    first, second = reduced(found)
    return free @ (found - np.linalg.solve(second, first))


def _of_joint(
    joint: PartJoint, carried: Array, bushes: Mapping[str, Bush], poses: PartPoses
) -> Array:
    """Return the energy of the bushes of a joint."""
    total = np.zeros((*carried.shape[:1], *2 * carried.shape[-1:]))
    for i, point in enumerate(joint.at):
        if point in bushes:
            soft = bushes[point].compliance
            if joint.first not in GROUND:  # bushes turn with the first part
                soft = rotated(soft, poses.turned[joint.first])
            total += _energy(carried[:, i], soft)
    return total


class _Forces:
    """Loads of joints and springs under unit loads, and in each indeterminate tension.

    ``carried`` has the loads on each joint, (n, touching points, 6, loads + tensions): under unit
    forces and moments in chassis axes and a unit torque of the bar, with springs as supports; then
    in tensions of one joint, of several, and of stops. ``spring`` has the force of each spring.
    """

    def __init__(self, side: Side, stopped: Sequence[str]) -> None:
        poses, springs = side.poses, side.poses.structure.springs
        equations, still = BalanceEquations(poses, springs), np.zeros(3)
        loads = []
        for part, on_road in poses.wheels.items():
            at = touching(on_road)
            loads += [Load(part, CONTACT, "road", axis, still, at) for axis in np.eye(3)]
            loads += [Load(part, CONTACT, "road", still, axis, at) for axis in np.eye(3)]
        groups = [*([load] for load in loads), *([[*side.bar]] if side.bar else [])]
        applied = [equations.applied(group) for group in groups]
        applied += [equations.applied(equations.pushed(line)) for line in stopped]
        unknowns = equations.solve(np.stack(applied, axis=-1))
        tensions = [joint.tensions(poses.points) for joint in equations.joints]
        count, begin = sum(t.shape[-1] for t in tensions), len(groups)
        # tensions of several joints follow those of single joints
        by_loads, by_stops = np.split(unknowns, [begin], axis=-1)
        further = np.concatenate([equations.indeterminate, by_stops], axis=-1)
        self.tensions = count + further.shape[-1]
        nothing = np.zeros((len(poses.states), len(springs), count))
        of_springs = (each[:, -len(springs) :] for each in (by_loads, further))
        of_loads, of_further = of_springs
        self.spring = np.concatenate([of_loads, nothing, of_further], axis=-1)
        self.carried = []
        after = len(groups) + count
        both = zip(equations.at_joints(by_loads), equations.at_joints(further), strict=True)
        for (at_joint, at_further), own in zip(both, tensions, strict=True):
            every = np.zeros((*at_joint.shape[:-1], len(groups) + self.tensions))
            every[..., : len(groups)] = at_joint
            every[..., after:] = at_further
            every[..., begin : begin + own.shape[-1]] = own
            begin += own.shape[-1]
            self.carried.append(every)


def _energy(forces: Array, soft: Array | float) -> Array:
    """Return the work of forces on the displacements by each other, (n, forces, forces)."""
    scaled = forces * soft if np.ndim(soft) == 0 else soft @ forces
    return forces.mT @ scaled


def _released(
    flexibility: Array, held: list[int], *, soft: Array | float = 0.0, keep: bool = False
) -> Array:
    """Return a flexibility with supports of flexibility `soft` in the directions `held`.

    Rows and columns of these directions are left out, or kept with the deflections of the supports.
    """
    rows = np.array(held, dtype=int)
    inner = flexibility[:, rows[:, None], rows] + soft
    # tensions between rigid joints alone are zero
    forces = np.linalg.pinv(inner, hermitian=True) @ flexibility[:, rows]
    result: Array = flexibility - flexibility[:, :, rows] @ forces
    others = slice(None) if keep else np.delete(np.arange(result.shape[-1]), rows)
    return result[:, others][:, :, others]
