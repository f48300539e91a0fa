"""First-order compliance of the wheels on bushes, by the unit-load theorem."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ....core.memory import positions_given
from ....core.named_types import Array, ArrayLike
from ....core.quantities import Display, display_of, variable
from ....core.validator import Validator
from ....core.vectors import cross
from ...assembly import wheel
from ...assembly.assembly import HeldAssembly
from ...assembly.by_wheel import WHEEL, of_wheels, wheel_coordinate
from ...assembly.of import given_assembly
from ...assembly.part_poses import touching, wheel_axes
from ...assembly.quantity import TRAVEL, Quantity
from ...corner.bushes import left_out, refuse_rigid
from ...corner.corner import CarrierMotion, RoadWheel
from ...models.car.car import WHEELS
from ...models.car.file import ENDS
from ...models.sides import SIDES
from .flexibility import HELD, Side, WheelSupport, flexibility, refuse_without_rate
from .rig_loads import (
    RIG_LOADS,
    Loading,
    RigLoad,
    give_of_tyre,
    load_at_contact,
    loadings,
    sense_of,
    where_of,
)

MOVED = ("x", "y", "z", "rx", "ry", "rz")
LOADED = ("fx", "fy", "fz", "mx", "my", "mz")
"""Components of the displacement of a contact, and of the load on it."""


def linear(
    subject: Any,
    bushings: Mapping[str, Any] | None = None,
    travel: ArrayLike | None = None,
    *,
    rack_position: float = 0.0,
    held: WheelSupport = "height",
) -> xr.Dataset:
    """Return the deflections of the wheels on bushes per unit of a load, over parallel travel.

    Parameters
    ----------
    subject : Suspension, Model, Axle or RigidAxle
    bushings : mapping, optional
        Bushes instead of those of the file. By hardpoint: ``axial_N_per_mm`` along its axis and
        ``radial_N_per_mm`` across it, one number or two; directions that are left out are rigid.
        ``axis``, by default that of the arm's bearings, of the strut, the tie rod or the wheel, is
        needed at other ball joints. ``radial_axis`` is the direction of the first of two radial
        numbers. Both are in chassis axes at design and turn with the part nearer to the chassis.
        ``axial_curve`` and ``radial_curve`` replace stiffnesses by their slope at zero. At
        ``wheel_center``, the bearing, ``tilt_Nm_per_deg`` is about all axes across the spin axis.
        ``rack`` has ``axial_N_per_mm``, the stiffness of the steering at the rack. For an axle they
        are the bushes of one side, the one with the points of the anti-roll bar (``side`` of the
        file, or the right one); the other side has the mirror image. For a rigid axle the
        hardpoints are the names of rods with the ending ``_chassis`` or ``_axle``.
    travel : array_like, shape (n,), optional
        Heights of the wheel centres above design [m]; by default the usual range.
    rack_position : float, optional
        Displacement of the rack [m].
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Support of each wheel under the load, besides an anti-roll bar. 'height': the contact of a
        rigid wheel stays at its height, on the pad of a rig. 'tyre': the tyre deflects on such a
        pad. 'spring': the wheel rests on its spring and stops, and the pad has a constant vertical
        force. 'locked': the length of the spring is constant.

    Returns
    -------
    xarray.Dataset
        Over ``wheel`` and ``wheel_travel``: ``toe_by_...``, ``camber_by_...`` [rad/N], and
        ``displacement_by_...`` in the direction of the force [m/N], where ``...`` is ``lateral``, a
        force inward at the contact, ``braking``, a rearward force there, or ``recession``, a
        rearward force at the wheel centre; and toe and camber by ``aligning``, a torque about the
        vertical towards toe-out [rad/(N m)]. Of an axle by loads of the same size on both wheels,
        in the same direction, ``..._parallel``, or in opposite ones, ``..._opposed``. If the
        file has the tyre's rates along these forces, ``patch_displacement_by_...``: displacement of
        the wheel at the contact plus the deflection of the stationary tyre, which is the
        displacement of the pad of a rig. ``flexibility``, displacement and rotation of the contacts
        by force and moment on the wheels there, tyre axes of each, of shape (n, 6 wheels, 6 wheels)
        [m/N], [rad/N], [m/(N m)], [rad/(N m)]. A rigid axle also has ``axle_steer_by_...`` and
        ``axle_lateral_by_...``, positive to the left, and ``axle_longitudinal_by_...``, positive
        forward, of the line through its wheel centres.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a travel is out of reach.

    Notes
    -----
    The method is the unit-load theorem. Statically indeterminate forces, such as that along the
    axis of an arm, follow from the least energy. The result is linear about bushes that are relaxed
    at their hardpoints; their torsion and tilting, and the effect of the static load in turned
    bushes, are left out. The force at the contact acts at the lowest point of the undeflected
    wheel. Both sides of an axle load the elastic rack and the anti-roll bar; a static load of the
    bar does not change the stiffness. The force of a rod is along its line, and deflects its bushes
    in that direction. Five rods share forces by least energy, at the positions of the four that
    support the axle most stiffly.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import compliance
    >>> import kintrafo
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> found = compliance.linear(kintrafo.load("reference_car"), bushes, [0.0])
    >>> round(float(np.rad2deg(found["toe_by_lateral"][0])) * 1e3, 3)  # deg/kN
    0.065

    Opposed forces do not move a soft rack:

    >>> soft = {"rack": {"axial_N_per_mm": 5000.0}}
    >>> right = compliance.linear(kintrafo.load("reference_axle"), soft, [0.0]).sel(wheel="right")
    >>> for how in ("parallel", "opposed"):
    ...     print(round(abs(float(np.rad2deg(right[f"toe_by_lateral_{how}"][0]))) * 1e3, 4))
    0.0189
    0.0

    A Panhard rod of 5 kN/mm under 1 kN on each wheel:

    >>> soft = {"panhard_rod_chassis": {"axial_N_per_mm": 5000.0}}
    >>> found = compliance.linear(kintrafo.load("rigid_axle"), soft, [0.0])
    >>> round(1e6 * float(found["axle_lateral_by_lateral_parallel"][0]), 2)  # mm/kN
    0.38
    """
    with Validator("compliance") as given:
        assembly = given_assembly(given, subject)
        rack_position = given.number("rack_position", rack_position, "m")
        given.among("held", held, HELD)
        if travel is not None:
            travel = positions_given(given, "travel", travel, "m")
        if not given.failed:
            assembly.refuse_holding(given, assembly.usual_motion, 0.0, rack_position)
            bushes = assembly.bushes(given, bushings)
            refuse_rigid(given, bushes.every, bushes.rack)
            refuse_without_rate(given, held, *assembly.tyres)
            refuse_without_radius(given, assembly)
    if travel is None:
        travel = assembly.usual(assembly.usual_motion, rack=rack_position)
    travels = np.asarray(travel)
    poses = assembly.poses(assembly.at_travel(travels, rack_position))
    lines = {} if held == "locked" else assembly.soft_lines(poses)
    bars = assembly.bar_loads(poses)
    sides = [
        Side(own, bushes.by_suffix[suffix], lines.get(suffix), bars.get(suffix, ()))
        for suffix, own in poses.items()
    ]
    by_torque = 1.0 / assembly.bar.rate if assembly.bar and bars else 0.0
    flexible = flexibility(sides, held, rack=bushes.rack, bar=by_torque)
    wheels = [one for own in poses.values() for one in own.wheels.values()]
    found = _dataset(assembly, wheels, flexible, travels)
    without = " and ".join(filter(None, [left_out(bushes.every), *assembly.simplified]))
    return found.assign_attrs(title="compliance", held=HELD[held], left_out=without)


def refuse_without_radius(given: Validator, assembly: HeldAssembly) -> None:
    """Add an error if the file has no tyre radius."""
    if None in assembly.tyre_radii:
        given.fail("[tyre] radius_mm is needed: where the road touches the wheel.")


def _dataset(
    assembly: HeldAssembly, wheels: Sequence[RoadWheel], flexible: Array, travels: Array
) -> xr.Dataset:
    """Return the motions of the wheels under each load, and the flexibility of their contacts."""
    over, found = TRAVEL.name, dict[str, xr.Variable]()
    axes = np.zeros((len(travels), *2 * [len(flexible[0])]))
    for which, one in enumerate(wheels):
        for begin in (6 * which, 6 * which + 3):
            axes[:, begin : begin + 3, begin : begin + 3] = wheel_axes(one)
    for test, how, moved in _under_loads(wheels, flexible):
        found |= _of_wheels(test, how, wheels, moved)
        if assembly.on_a_beam:
            found |= _of_beam(test, how, wheels, moved)
    words = "displacement and rotation of the contacts by forces and moments there, tyre axes"
    found["flexibility"] = variable((over, "moved", "by"), axes @ flexible @ axes.mT, words, "SI")
    ends = [f"_{wheel}" for wheel in assembly.wheels] if len(wheels) > 1 else [""]
    coordinates = {
        over: xr.Variable(over, travels, TRAVEL.attributes()),
        WHEEL: wheel_coordinate(assembly.wheels),
        "moved": [f"{name}{end}" for end in ends for name in MOVED],
        "by": [f"{name}{end}" for end in ends for name in LOADED],
    }
    return xr.Dataset(found, coordinates)


def _under_loads(
    wheels: Sequence[RoadWheel], flexible: Array
) -> Iterator[tuple[RigLoad, Loading, Sequence[Array]]]:
    """Yield the displacement and rotation of each contact under each load, (n, 6), chassis axes."""
    for test in RIG_LOADS:
        loads = [load_at_contact(test, wheel) for wheel in wheels]
        for how in loadings(test, wheels):
            parts = zip(how.parts, loads, strict=True)
            load = np.concatenate([part * one for part, one in parts], axis=-1)
            yield test, how, np.split(np.einsum("nab,nb->na", flexible, load), len(wheels), axis=-1)


def _of_wheels(
    test: RigLoad, how: Loading, wheels: Sequence[RoadWheel], moved: Sequence[Array]
) -> dict[str, xr.Variable]:
    """Return the motions of the wheels under a load, by the formulas of the characteristics."""
    of_each = [_of_wheel(test, *own) for own in zip(wheels, moved, how.parts, strict=True)]
    found = {}
    for kind, quantity in quantities_under(test, how).items():
        if all(kind in values for values in of_each):
            values = [values[kind] for values in of_each]
            found[quantity.name] = of_wheels(quantity, TRAVEL.name, values)
    return found


def _of_wheel(test: RigLoad, on_road: RoadWheel, moved: Array, part: float) -> dict[str, Array]:
    """Return changes of toe, camber and position of a wheel under a part of a load."""
    turn = moved[:, 3:]
    shift = moved[:, :3] + cross(turn, where_of(test, on_road) - touching(on_road))
    motion = CarrierMotion(shift, turn)
    found = {
        "toe": wheel.toe_rate(on_road, motion),
        "camber": wheel.camber_rate(on_road, motion),
        "displacement": (sense_of(test, on_road) * shift).sum(axis=-1),
    }
    if soft := give_of_tyre(test, on_road):
        found["patch_displacement"] = found["displacement"] + part * soft
    return found


def _of_beam(
    test: RigLoad, how: Loading, wheels: Sequence[RoadWheel], moved: Sequence[Array]
) -> dict[str, xr.Variable]:
    """Return the motion of the line through the wheel centres of a beam under a load."""
    left, right = wheels
    one, other = (
        own[:, :3] + cross(own[:, 3:], wheel.center - touching(wheel))
        for own, wheel in zip(moved, wheels, strict=True)
    )
    middle, apart = 0.5 * (one + other), one - other
    line = (left.center - right.center)[:, :2]
    turn = (line[:, 0] * apart[:, 1] - line[:, 1] * apart[:, 0]) / (line**2).sum(-1)
    values = {"axle_steer": turn, "axle_lateral": middle[:, 1], "axle_longitudinal": middle[:, 0]}
    return {
        quantity.name: xr.Variable(TRAVEL.name, values[kind], quantity.attributes())
        for kind, quantity in quantities_of_beam(test, how).items()
    }


# -- quantities -----------------------------------------------------------------------------------

OF_BEAM = {
    "axle_steer": ("rad", "steer angle of the axle", "positive to the left"),
    "axle_lateral": ("m", "lateral displacement of the axle", "positive to the left"),
    "axle_longitudinal": ("m", "longitudinal displacement of the axle", "positive forward"),
}
"""Unit, words and sign of the motions of a beam."""


def quantities_under(test: RigLoad, how: Loading) -> dict[str, Quantity]:
    """Return the compliances of a wheel under a load, by their kind."""
    toe, camber = "toe angle", "camber"
    kinds = [
        ("toe", "rad", toe, f"change of {toe}", "positive toe-in"),
        ("camber", "rad", camber, f"change of {camber}", "positive with the top outboard"),
    ]
    words, sign = f"displacement {test.where}", f"positive {test.where}"
    if test.where:
        at = test.at.replace("_", " ").replace("center", "centre")
        kinds.append(("displacement", "m", words, f"{words} of the {at}", sign))
    if test.through:
        words += " of the contact patch"
        kinds.append(("patch_displacement", "m", words, f"{words}, on a tyre that deflects", sign))
    return {kind: _quantity(test, how, kind, *texts) for kind, *texts in kinds}


def quantities_of_beam(test: RigLoad, how: Loading) -> dict[str, Quantity]:
    """Return the compliances of the line through the wheel centres of a beam under a load."""
    by = "by the line through the wheel centres, for each wheel's load"
    return {
        kind: _quantity(test, how, kind, unit, words, f"change of the {words}, {by}", sign)
        for kind, (unit, words, sign) in OF_BEAM.items()
    }


def _quantity(
    test: RigLoad, how: Loading, kind: str, unit: str, words: str, meaning: str, sign: str
) -> Quantity:
    shown, words = display_of({"units": unit}), f"{words} by {how.title(test)}"
    display = Display(f"{shown.units}/{test.shown.units}", shown.factor * test.shown.factor)
    per = f"{unit}/({test.unit})" if " " in test.unit else f"{unit}/{test.unit}"
    return Quantity(how.key(kind, test), per, words, meaning, sign, display=display)


COMPLIANCES = {
    quantity.name: quantity
    for test in RIG_LOADS
    for how in loadings(test, ("wheel",))
    for quantity in quantities_under(test, how).values()
}
"""Compliances of a corner by name."""


def _columns(wheels: Sequence[str], axles: Sequence[str]) -> dict[str, Quantity]:
    """Return the compliances of wheels and axles by the names of their columns."""
    return {
        quantity.name: quantity
        for test in RIG_LOADS
        for how in loadings(test, SIDES)
        for quantity in (
            *(q.of_wheel(wheel) for wheel in wheels for q in quantities_under(test, how).values()),
            *(q.of_wheel(axle) for axle in axles for q in quantities_of_beam(test, how).values()),
        )
    }


COMPLIANCES_OF_AXLES, COMPLIANCES_OF_CARS = _columns(SIDES, [""]), _columns(WHEELS, ENDS)
"""Compliances of an axle and of a car by the names of their columns."""
