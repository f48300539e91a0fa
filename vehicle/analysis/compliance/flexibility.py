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
    """A suspension or a rigid axle with its compliant parts; arrays over n positions."""

    poses: PartPoses
    bushes: Sequence[Bush]
    lines: SoftLines | None  # None with locked springs
    bar: Sequence[Load] = ()  # loads of an anti-roll bar on it for a unit torque; empty without one


def flexibility(
    sides: Sequence[Side], held: WheelSupport, *, rack: float = 0.0, bar: float = 0.0
) -> Array:
    """Return displacement and rotation of the contacts by loads on them, chassis axes.

    The shape is (n, 6 wheels, 6 wheels): force and moment on each wheel in turn, of a suspension,
    both sides of an axle, or a rigid axle. The rack has a compliance along its axis [m/N], an
    anti-roll bar a twist for a unit torque [rad/(N m)].
    """
    energies = [_of_side(side) for side in sides]
    wheels = [wheel for side in sides for wheel in side.poses.wheels.values()]
    applied = _COMPONENTS * len(wheels)
    has_bar = any(side.bar for side in sides)
    # all sides have the torque of the bar in common
    size = sum(own.shape[-1] for own, _ in energies) - has_bar * (len(sides) - 1)
    energy = np.zeros((len(sides[0].poses.states), size, size))
    on_rack, first, begin = np.zeros((*energy.shape[:1], 1, size)), 0, applied + has_bar
    for side, (of_side, of_rack) in zip(sides, energies, strict=True):
        # indices of the unknowns of this side
        count = _COMPONENTS * len(side.poses.wheels)
        own = [*range(first, first + count), *[applied][: int(has_bar)]]
        tensions = of_side.shape[-1] - len(own)
        own += range(begin, begin + tensions)
        first, begin = first + count, begin + tensions
        energy[:, np.array(own)[:, None], own] += of_side
        on_rack[..., own] += of_rack
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


def _of_side(side: Side) -> tuple[Array, Array]:
    """Return the energy of the compliant parts of a side, and the force on its rack.

    The unknowns are forces and moments at the contacts, the torque of the bar if there is one, and
    indeterminate tensions, those of stops the last. The energy has the shape (n, unknowns,
    unknowns), the force along the axis of the rack (n, 1, unknowns).
    """
    poses, lines = side.poses, side.lines
    stops = np.zeros((len(poses.states), 0)) if lines is None else lines.stops
    springs, every = _forces(side, poses.structure.dampers[: stops.shape[-1]])
    energy = np.zeros((len(poses.states), *2 * springs.shape[-1:]))
    on_rack = np.zeros_like(springs[:, :1])
    if lines is not None:
        energy += _energy(springs, lines.springs)
    by_point = {bush.point: bush for bush in side.bushes}
    for joint, carried in zip(poses.structure.joints, every, strict=True):
        if joint.first == "rack":
            assert poses.rack_axis is not None  # there is a rack
            on_rack -= np.einsum("c,nkcu->nku", poses.rack_axis, carried[:, :, :3])
        energy += _of_joint(joint, carried, by_point, poses)
    for which in range(-stops.shape[-1], 0):
        acting = np.isfinite(stops[:, which])
        energy[acting, which, which] += stops[acting, which]
        energy[~acting, which, :] = energy[~acting, :, which] = 0.0
        on_rack[~acting, :, which] = 0.0
    return energy, on_rack


def shared(equations: BalanceEquations, unknowns: Array, bushes: Sequence[Bush]) -> list[Array]:
    """Return the loads on each joint in the first position, (touching points, 6), parts at design.

    Statically indeterminate loads have the least energy of the bushes, also of curved ones; loads
    between rigid joints alone are unchanged. The unknowns are those of `BalanceEquations.solve`.
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


def _forces(side: Side, stopped: Sequence[str]) -> tuple[Array, list[Array]]:
    """Return the forces of springs and the loads of joints under unit loads, and in tensions.

    The loads of a joint, (n, touching points, 6, loads + tensions), are those under unit forces and
    moments in chassis axes and a unit torque of the bar, with springs as supports; then those in
    indeterminate tensions of one joint, of several, and of stops.
    """
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
    after = begin + count
    # tensions of several joints follow those of single joints
    by_loads, by_stops = np.split(unknowns, [begin], axis=-1)
    further = np.concatenate([equations.indeterminate, by_stops], axis=-1)
    nothing = np.zeros((len(poses.states), len(springs), count))
    of_loads, of_further = (each[:, -len(springs) :] for each in (by_loads, further))
    every = []
    both = zip(equations.at_joints(by_loads), equations.at_joints(further), strict=True)
    for (at_joint, at_further), own in zip(both, tensions, strict=True):
        carried = np.zeros((*at_joint.shape[:-1], after + further.shape[-1]))
        carried[..., : len(groups)] = at_joint
        carried[..., after:] = at_further
        carried[..., begin : begin + own.shape[-1]] = own
        begin += own.shape[-1]
        every.append(carried)
    return np.concatenate([of_loads, nothing, of_further], axis=-1), every


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
