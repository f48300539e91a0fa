"""How the wheels give way to forces: the energy of what is soft, by the unit-load theorem.

Everything is linear in unit loads: forces and moments at the contact of each wheel, the torque of
an anti-roll bar, and what is tense by itself. What each soft thing does under one of them while it
carries another is an energy; what statics does not decide gives the least of it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.vectors import unit_vector
from ...suspension.bushes import Bush
from ...suspension.corner import Corner
from ...suspension.structure import GROUND, Joint
from ..characteristics import wheel
from .poses import CONTACT, Poses, rotated
from .reactions import Equations, Load

Array = NDArray[np.float64]
Held = Literal["height", "spring", "locked"]

HELD = {
    "height": "the contact stays at its height",
    "spring": "spring and stops carry the wheel",
    "locked": "the spring is locked",
}
"""What holds a wheel under the loads."""

_VERTICAL, _COMPONENTS = 2, 6


@dataclass(frozen=True)
class Wheel:
    """A wheel and what is soft about its suspension; arrays over n positions.

    Attributes
    ----------
    poses : Poses
    there : Corner
    bushes : sequence of Bush
    bar : Load or None
        What an anti-roll bar does on the suspension for a unit torque of it.
    """

    poses: Poses
    there: Corner
    bushes: Sequence[Bush]
    bar: Load | None = field(default=None)


def flexibility(
    wheels: Sequence[Wheel], held: Held, *, rack: float = 0.0, bar: float = 0.0
) -> Array:
    """Return displacement and rotation of the contacts by loads on them.

    Parameters
    ----------
    wheels : sequence of Wheel
        One, or both of an axle.
    held : {'height', 'spring', 'locked'}
        What holds each wheel.
    rack : float, optional
        How far the rack gives way along its axis for a unit force [m/N].
    bar : float, optional
        Twist of the anti-roll bar by its torque, where there is one [rad/(N m)].

    Returns
    -------
    ndarray, shape (n, 6 wheels, 6 wheels)
        Chassis axes; force and moment on each wheel in turn.
    """
    sides = [_Side(w, held) for w in wheels]
    applied = _COMPONENTS * len(wheels)
    has_bar = any(w.bar for w in wheels)
    size = applied + has_bar + sum(side.tensions for side in sides)
    energy = np.zeros((len(wheels[0].poses.states), size, size))
    on_rack, begin = np.zeros((*energy.shape[:1], 1, size)), applied + has_bar
    for i, side in enumerate(sides):
        # which of all unknowns those of this side are
        own = [*range(_COMPONENTS * i, _COMPONENTS * (i + 1)), *[applied][: int(has_bar)]]
        own += range(begin, begin + side.tensions)
        begin += side.tensions
        energy[:, np.array(own)[:, None], own] += side.energy
        on_rack[..., own] += side.on_rack
    energy += _energy(on_rack, rack)
    if has_bar:
        energy[:, applied, applied] += bar
    total = _released(energy, list(range(applied, size)))
    if held != "height":
        return total
    return _released(total, [_COMPONENTS * i + _VERTICAL for i in range(len(wheels))], keep=True)


class _Side:
    """The energy of one wheel's suspension under unit loads.

    Attributes
    ----------
    tensions : int
        How many states of tension there are by themselves, that between spring and stops the last.
    energy : ndarray, shape (n, unknowns, unknowns)
        By unit forces and moments at the contact, a unit torque of the bar where there is one, and
        the tensions.
    on_rack : ndarray, shape (n, 1, unknowns)
        The force on the rack along its axis.
    """

    def __init__(self, wheel: Wheel, held: Held) -> None:
        poses, there = wheel.poses, wheel.there
        forces = _Forces(wheel, stopped=bool(there.stops) and held != "locked")
        self.tensions = forces.tensions
        self.energy = np.zeros((len(poses.states), *2 * forces.spring.shape[-1:]))
        self.on_rack = np.zeros_like(forces.spring)
        if held != "locked":
            spring, stops = _compliance_of_lines(there)
            self.energy += _energy(forces.spring, spring[:, None, None])
        by_point = {bush.point: bush for bush in wheel.bushes}
        structure = poses.model.suspension.structure()
        for joint, carried in zip(structure.joints, forces.carried, strict=True):
            if joint.first == "rack":
                axis = unit_vector(poses.model.suspension.rack.axis)
                self.on_rack -= np.einsum("c,nkcu->nku", axis, carried[:, :, :3])
            self.energy += _of_joint(joint, carried, by_point, poses)
        if forces.stopped:
            acting = np.isfinite(stops)
            self.energy[acting, -1, -1] += stops[acting]
            self.energy[~acting, -1, :] = self.energy[~acting, :, -1] = 0.0
            self.on_rack[~acting, :, -1] = 0.0


def _of_joint(joint: Joint, carried: Array, bushes: Mapping[str, Bush], poses: Poses) -> Array:
    """Return the energy of the bushes of a joint."""
    total = np.zeros((*carried.shape[:1], *2 * carried.shape[-1:]))
    for i, point in enumerate(joint.at):
        if point in bushes:
            soft = _world_compliance(bushes[point], joint, poses.turned)
            total += _energy(carried[:, i], soft)
    return total


def _world_compliance(bush: Bush, joint: Joint, turned: Mapping[str, Array]) -> Array:
    """Return a compliance in chassis axes, the joint's first part having turned, (..., 6, 6)."""
    if joint.first in GROUND:
        return bush.compliance
    return rotated(bush.compliance, turned[joint.first])


class _Forces:
    """What everything carries of unit loads, and of what is tense by itself.

    Parameters
    ----------
    wheel : Wheel
    stopped : bool
        Whether stops carry besides the spring.

    Attributes
    ----------
    carried : list of ndarray, each of shape (n, touching points, 6, loads + tensions)
        Of each joint: under unit forces and moments in chassis axes and that of the bar, the
        suspension held by its spring; then in each state of tension, that between spring and stops
        the last.
    spring : ndarray, shape (n, 1, loads + tensions)
        The force of the spring.
    tensions : int
    """

    def __init__(self, wheel: Wheel, *, stopped: bool) -> None:
        poses, self.stopped = wheel.poses, stopped
        equations = Equations(poses, "spring")
        still, at = np.zeros(3), poses.points[CONTACT]
        loads = [Load("wheel", CONTACT, "road", axis, still, at) for axis in np.eye(3)]
        loads += [Load("wheel", CONTACT, "road", still, axis, at) for axis in np.eye(3)]
        loads += [wheel.bar] if wheel.bar else []
        applied = [equations.applied([load]) for load in loads]
        if stopped:
            applied.append(equations.applied(equations.pushed("damper")))
        unknowns = equations.solve(np.stack(applied, axis=-1))
        tensions = [joint.tensions(poses.points) for joint in equations.joints]
        count, begin = sum(t.shape[-1] for t in tensions), len(loads)
        self.tensions = count + stopped
        self.spring = np.insert(unknowns[:, -1:], begin, np.zeros((count, 1, 1)), axis=-1)
        self.carried = []
        after = len(loads) + count
        for at_joint, own in zip(equations.at_joints(unknowns), tensions, strict=True):
            every = np.zeros((*at_joint.shape[:-1], len(loads) + self.tensions))
            every[..., : len(loads)] = at_joint[..., : len(loads)]
            every[..., after:] = at_joint[..., len(loads) :]
            every[..., begin : begin + own.shape[-1]] = own
            begin += own.shape[-1]
            self.carried.append(every)


def _energy(forces: Array, soft: Array | float) -> Array:
    """Return what forces do on the displacements by other ones, (n, forces, forces)."""
    scaled = forces * soft if np.ndim(soft) == 0 else soft @ forces
    result: Array = forces.mT @ scaled
    return result


def _released(flexibility: Array, held: list[int], *, keep: bool = False) -> Array:
    """Return a flexibility where some displacements are zero, by the forces that this takes.

    What belongs to them is left out, unless it is to be kept as zeros.
    """
    rows = np.array(held, dtype=int)
    inner = flexibility[:, rows[:, None], rows]
    # what is rigid on all sides carries nothing by itself
    forces = np.linalg.pinv(inner, hermitian=True) @ flexibility[:, rows]
    result: Array = flexibility - flexibility[:, :, rows] @ forces
    others = slice(None) if keep else np.delete(np.arange(result.shape[-1]), rows)
    return result[:, others][:, :, others]


def _compliance_of_lines(there: Corner) -> tuple[Array, Array]:
    """Return how far spring and stops give way for a unit force along each, (n,) [m/N].

    With what their own force does as their direction changes.
    """
    rates = wheel.wheel_rate(replace(there, stops=()))
    if not (rates > 0.0).all():
        at = 1e3 * (there.center - there.design_center)[rates.argmin(), 2]
        problem = (
            f"at a wheel travel of {at:.1f} mm the spring has a rate of {rates.min():.4g} N/m at "
            "the wheel: nothing holds it. Enter a rate, or another travel."
        )
        raise InputError([problem], "compliance")
    stops = wheel.wheel_rate(there) - rates
    with np.errstate(divide="ignore"):
        return there.spring.stroke.slope**2 / rates, there.damper.slope**2 / stops
