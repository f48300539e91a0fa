"""Compliance of the wheel by the unit-load theorem: what bushes do under loads, to first order."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.quantities import Display, display_of, variable
from ...suspension.corner import Corner, Motion
from ...suspension.model import Model
from ...suspension.positions import arm_angles, design_height
from ...suspension.reach import at_rest
from ..characteristics import wheel
from ..characteristics.catalogue import Quantity
from ..characteristics.datasets import TRAVEL
from ..characteristics.from_model import corner
from ..sweep import usual_travel
from .bushes import Bush, bushes_of, world_compliance
from .poses import CENTER, CONTACT, Poses, rotated
from .reactions import Equations, Load

Array = NDArray[np.float64]
Vector = tuple[float, float, float]
Held = Literal["height", "spring", "locked"]

HELD = {
    "height": "the contact stays at its height",
    "spring": "spring and stops carry the wheel",
    "locked": "the spring is locked",
}
"""What holds the wheel under the loads."""


@dataclass(frozen=True)
class _Test:
    """A load on the wheel, as a rig applies it.

    Attributes
    ----------
    name, words : str
    at : str
        Where it acts, and where displacements are told.
    force, moment : tuple of float
        On a left wheel, tyre axes; the mirror image on a right one.
    unit : str
        SI unit of the load.
    shown : Display
        Unit for people, and how many of the SI unit it has.
    sense : tuple of float
        Direction in which a displacement is told, on a left wheel.
    where : str
        That direction in words; empty where no displacement is told.
    """

    name: str
    words: str
    at: str
    force: Vector
    moment: Vector
    unit: str
    shown: Display
    sense: Vector
    where: str


_KILONEWTON = Display("kN", 1e3)
_INWARD, _REARWARD, _NOTHING = (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)
_TESTS = (
    _Test("lateral", "a lateral force inward at the contact", CONTACT, _INWARD, _NOTHING, "N",
          _KILONEWTON, _INWARD, "inward"),
    _Test("braking", "a braking force at the contact", CONTACT, _REARWARD, _NOTHING, "N",
          _KILONEWTON, _REARWARD, "rearward"),
    _Test("recession", "a rearward force at the wheel centre", CENTER, _REARWARD, _NOTHING, "N",
          _KILONEWTON, _REARWARD, "rearward"),
    _Test("aligning", "a torque about the vertical towards toe-out", CONTACT, _NOTHING,
          (0.0, 0.0, 1.0), "N m", Display("100 N m", 1e2), _NOTHING, ""),
)  # fmt: skip


def compliance(
    model: Model,
    bushings: Mapping[str, Any],
    travel: ArrayLike | None = None,
    *,
    rack_position: float = 0.0,
    held: Held = "height",
) -> xr.Dataset:
    """Return how the wheel gives way under loads, over wheel travel, to first order.

    Parameters
    ----------
    model : Model
    bushings : mapping
        By hardpoint: ``axial_N_per_mm`` along its axis and ``radial_N_per_mm`` across it, one
        number or two; what is left out is rigid. ``axis``, by default that of the arm's bearings,
        of the strut, the tie rod or the wheel; at other ball joints it must be given.
        ``radial_axis``, the direction of the first of two radial numbers. Both in chassis axes at
        design; they turn with the part that is nearer to the chassis. At ``wheel_center``, the
        bearing, ``tilt_Nm_per_deg`` about all axes across the spin axis.
    travel : array_like, shape (n,), optional
        Heights of the wheel centre above its design height [m]; by default the usual range.
    rack_position : float, optional
        Displacement of the rack [m].
    held : {'height', 'spring', 'locked'}, optional
        What holds the wheel: the contact stays at its height, as on a rig whose pads do not move
        vertically; spring and stops, as on one that keeps the vertical force; or a locked spring.

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel``: toe, camber and displacement by a lateral force inward, a braking
        force, a rearward force at the wheel centre and an aligning torque; and ``flexibility``,
        displacement and rotation of the contact by force and moment on the wheel there, tyre axes,
        of shape (n, 6, 6) [m/N], [rad/N], [m/(N m)], [rad/(N m)].

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a travel is out of reach.

    Notes
    -----
    By the unit-load theorem: each bush gives way to what it carries of a unit load, and moves the
    wheel by that times what it carries of another one. What statics does not decide, such as the
    force along the axis of an arm, is shared as the least energy asks. Linear about bushes that
    are at their hardpoints; their torsion about an arm's axis, and what the static load does in
    turned bushes, are left out. The force at the contact stays where the wheel's lowest point was.

    Examples
    --------
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> found = compliance(Model("reference_car"), bushes, [0.0])
    >>> round(float(np.rad2deg(found["toe_by_lateral"][0])) * 1e3, 3)  # deg/kN
    0.065
    """
    with Arguments("compliance") as given:
        given.kind("model", model, Model, Model.NEEDED)
        rack_position = given.number("rack_position", rack_position, "m")
        given.among("held", held, HELD)
        if travel is not None:
            travel = given.array("travel", travel, "m", dimensions=[1])
        described = given.mapping("bushings", bushings, "hardpoints and stiffnesses")
        if not given.refused:
            bushes = bushes_of(given, model, described)
            if not bushes and not given.refused:
                given.refuse("bushings: one or more are needed.")
            if model.suspension.tyre_radius() is None:
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
    travels = usual_travel(model, rack=rack_position) if travel is None else travel
    angles = arm_angles(model, design_height(model) + travels, rack_position)
    poses = Poses.of(model, *at_rest(model, angles, rack_position))
    there = corner(model, angles, rack_position)
    flexibility = _flexibility(poses, there, bushes, held)
    return _dataset(poses, there, flexibility, np.asarray(travels), held)


def _flexibility(poses: Poses, there: Corner, bushes: list[Bush], held: Held) -> Array:
    """Return displacement and rotation of the contact by loads on it, chassis axes, (n, 6, 6)."""
    forces = _Forces(poses, stopped=bool(there.stops) and held != "locked")
    structure = poses.model.suspension.structure()
    by_point = {bush.point: bush for bush in bushes}
    energy = np.zeros((len(poses.states), *2 * forces.spring.shape[-1:]))
    if held != "locked":
        spring, stops = _compliance_of_lines(there)
        energy += _energy(forces.spring, spring[:, None, None])
    for joint, carried in zip(structure.joints, forces.carried, strict=True):
        for i, point in enumerate(joint.at):
            if point in by_point:
                soft = world_compliance(by_point[point], joint, poses.turned)
                energy += _energy(carried[:, i], soft)
    if forces.stopped:
        acting = np.isfinite(stops)
        energy[acting, -1, -1] += stops[acting]
        energy[~acting, -1, :] = energy[~acting, :, -1] = 0.0
    total = _released(energy, slice(6, None))
    return _released(total, slice(2, 3)) if held == "height" else total


class _Forces:
    """What everything carries of unit loads at the contact, and of what is tense by itself.

    Parameters
    ----------
    poses : Poses
    stopped : bool
        Whether stops carry besides the spring.

    Attributes
    ----------
    carried : list of ndarray, each of shape (n, touching points, 6, 6 + tensions)
        Of each joint: under unit forces and moments in chassis axes, the suspension held by its
        spring; then in each state of tension, that between spring and stops the last.
    spring : ndarray, shape (n, 1, 6 + tensions)
        The force of the spring.
    """

    def __init__(self, poses: Poses, *, stopped: bool) -> None:
        self.stopped = stopped
        equations = Equations(poses, "spring")
        equations.check()
        still, at = np.zeros(3), poses.points[CONTACT]
        loads = [Load("wheel", CONTACT, "road", axis, still, at) for axis in np.eye(3)]
        loads += [Load("wheel", CONTACT, "road", still, axis, at) for axis in np.eye(3)]
        applied = [equations.applied([load]) for load in loads]
        if stopped:
            applied.append(equations.applied(equations.pushed("damper")))
        unknowns = equations.solve(np.stack(applied, axis=-1))
        tensions = [joint.tensions(poses.points) for joint in equations.joints]
        count, size = sum(t.shape[-1] for t in tensions), unknowns.shape[-1]
        self.spring = np.insert(unknowns[:, -1:], 6, np.zeros((count, 1, 1)), axis=-1)
        self.carried, begin = [], 6
        for at_joint, own in zip(equations.at_joints(unknowns), tensions, strict=True):
            every = np.zeros((*at_joint.shape[:-1], size + count))
            every[..., :6], every[..., 6 + count :] = at_joint[..., :6], at_joint[..., 6:]
            every[..., begin : begin + own.shape[-1]] = own
            begin += own.shape[-1]
            self.carried.append(every)


def _energy(forces: Array, soft: Array) -> Array:
    """Return what forces do on the displacements by other ones, (n, forces, forces)."""
    result: Array = forces.mT @ soft @ forces
    return result


def _released(flexibility: Array, held: slice) -> Array:
    """Return a flexibility where some displacements are zero, by the forces that this takes."""
    inner = flexibility[:, held, held]
    # what is rigid on all sides carries nothing by itself
    forces = np.linalg.pinv(inner, hermitian=True) @ flexibility[:, held]
    result = flexibility - flexibility[:, :, held] @ forces
    return result[:, :6, :6]


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


# -- results --------------------------------------------------------------------------------------


def _dataset(
    poses: Poses, there: Corner, flexibility: Array, travels: Array, held: Held
) -> xr.Dataset:
    axes = poses.wheel_axes()
    found: dict[Any, Any] = {}
    for test in _TESTS:
        for quantity, values in _told(test, poses, there, flexibility):
            found[quantity.name] = xr.Variable(TRAVEL.name, values, quantity.attributes())
    words = "displacement and rotation of the contact by force and moment there, tyre axes"
    found["flexibility"] = variable(
        (TRAVEL.name, "moved", "by"), rotated(flexibility, axes), words, "SI"
    )
    coordinates = {
        TRAVEL.name: xr.Variable(TRAVEL.name, travels, TRAVEL.attributes()),
        "moved": ["x", "y", "z", "rx", "ry", "rz"],
        "by": ["fx", "fy", "fz", "mx", "my", "mz"],
    }
    return xr.Dataset(found, coordinates, {"title": "compliance", "held": HELD[held]})


def _told(
    test: _Test, poses: Poses, there: Corner, flexibility: Array
) -> Iterator[tuple[Quantity, Array]]:
    """Yield what the wheel does under a load, by the formulas of the characteristics."""
    axes, side = poses.wheel_axes(), there.vehicle.side
    mirror = np.array([1.0, side, 1.0])
    force, moment = (
        np.einsum("nij,i->nj", axes, vector)
        for vector in (mirror * test.force, side * mirror * test.moment)
    )
    arm = poses.points[test.at] - poses.points[CONTACT]
    load = np.concatenate([force, moment + np.cross(arm, force)], axis=-1)
    moved = np.einsum("nab,nb->na", flexibility, load)
    turn = moved[:, 3:]
    shift = moved[:, :3] + np.cross(turn, arm)
    as_motion = replace(there, travel=Motion(shift, turn))
    told = [
        ("toe", "rad", "toe angle", "positive toe-in", wheel.bump_steer(as_motion)),
        ("camber", "rad", "camber", "positive with the top outboard",
         wheel.camber_gradient(as_motion)),
    ]  # fmt: skip
    if test.where:
        along = np.einsum("nij,i->nj", axes, mirror * test.sense)
        words = f"displacement {test.where}"
        told.append(("displacement", "m", words, "", (along * shift).sum(axis=-1)))
    for name, unit, words, sign, values in told:
        shown = display_of({"units": unit})
        display = Display(f"{shown.units}/{test.shown.units}", shown.factor * test.shown.factor)
        where = f"of the {test.at.replace('_', ' ').replace('center', 'centre')}"
        quantity = Quantity(
            f"{name}_by_{test.name}",
            f"{unit}/({test.unit})" if " " in test.unit else f"{unit}/{test.unit}",
            f"{words} by {test.words}",
            f"{words} {where}" if name == "displacement" else f"change of {words}",
            sign or f"positive {test.where}",
            display=display,
        )
        yield quantity, values
