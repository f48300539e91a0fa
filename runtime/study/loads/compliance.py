"""Compliance of the wheel by the unit-load theorem: what bushes do under loads, to first order."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...assembly import wheel
from ...assembly.from_model import corner
from ...assembly.poses import (
    CENTER,
    CONTACT,
    Poses,
    rotated,
    touching,
    wheel_axes,
)
from ...assembly.quantity import TRAVEL, Quantity
from ...assembly.soft_lines import soft_lines
from ...assembly.usual import usual_travel
from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...core.quantities import Display, display_of, variable
from ...core.vectors import cross
from ...suspension.bushes import described_bushings, left_out, refuse_rigid, softness_of_rack
from ...suspension.corner import Motion, RoadWheel
from ...suspension.model import Model
from ...suspension.positions import arm_angles, design_height
from ...suspension.reach import at_rest
from .flexibility import HELD, Held, Side, flexibility, refuse_without_rate

Array = NDArray[np.float64]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class RigLoad:
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
    through : str
        The rate of the tyre through which it goes, in `Vehicle`; empty where there is none.
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
    through: str = ""


_KILONEWTON = Display("kN", 1e3)
_INWARD, _REARWARD, _NOTHING = (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 0.0)
RIG_LOADS = (
    RigLoad("lateral", "a lateral force inward at the contact", CONTACT, _INWARD, _NOTHING, "N",
          _KILONEWTON, _INWARD, "inward", "tyre_lateral_rate"),
    RigLoad("braking", "a braking force at the contact", CONTACT, _REARWARD, _NOTHING, "N",
          _KILONEWTON, _REARWARD, "rearward", "tyre_longitudinal_rate"),
    RigLoad("recession", "a rearward force at the wheel centre", CENTER, _REARWARD, _NOTHING, "N",
          _KILONEWTON, _REARWARD, "rearward"),
    RigLoad("aligning", "a torque about the vertical towards toe-out", CONTACT, _NOTHING,
          (0.0, 0.0, 1.0), "N m", Display("100 N m", 1e2), _NOTHING, ""),
)  # fmt: skip


MOVED = ("x", "y", "z", "rx", "ry", "rz")
LOADED = ("fx", "fy", "fz", "mx", "my", "mz")
"""Components of what moves at a contact, and of what is exerted there."""


def compliance(
    model: Model,
    bushings: Mapping[str, Any] | None = None,
    travel: ArrayLike | None = None,
    *,
    rack_position: float = 0.0,
    held: Held = "height",
) -> xr.Dataset:
    """Return how the wheel gives way under loads, over wheel travel, to first order.

    Parameters
    ----------
    model : Model
    bushings : mapping, optional
        In the place of those of the file. By hardpoint: ``axial_N_per_mm`` along its axis and
        ``radial_N_per_mm`` across it, one number or two; what is left out is rigid. ``axis``, by
        default that of the arm's bearings, of the strut, the tie rod or the wheel; at other ball
        joints it must be given.
        ``radial_axis``, the direction of the first of two radial numbers. Both in chassis axes at
        design; they turn with the part that is nearer to the chassis. In the place of stiffnesses
        ``axial_curve`` and ``radial_curve``, of which the slope at zero counts. At
        ``wheel_center``, the bearing, ``tilt_Nm_per_deg`` about all axes across the spin axis.
        ``rack``: its ``axial_N_per_mm``, how stiff the steering holds the rack.
    travel : array_like, shape (n,), optional
        Heights of the wheel centre above its design height [m]; by default the usual range.
    rack_position : float, optional
        Displacement of the rack [m].
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        What holds the wheel: the contact of the rigid wheel stays at its height; or the pad beneath
        its tyre does, so that the wheel goes up and down as the tyre gives way; spring and stops,
        as on a rig that keeps the vertical force; or a locked spring.

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel``: toe, camber and displacement by a lateral force inward, a braking
        force, a rearward force at the wheel centre and an aligning torque. Where the file has the
        tyre's rates along these forces, ``patch_displacement_by_...``: the wheel's at the contact
        and what the standing tyre gives way, as the pad of a rig moves. And ``flexibility``,
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
    are at their hardpoints; what resists their torsion or tilting, and what the static load does in
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
        if not given.refused:
            described = described_bushings(given, bushings, model.suspension.bushings)
            bushes = model.suspension.bushes(given, described)
            rack = softness_of_rack(given, described)
            refuse_rigid(given, bushes, rack)
            refuse_without_rate(given, held, model.suspension.tyre)
            if model.suspension.tyre_radius() is None:
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
    travels = usual_travel(model, rack=rack_position) if travel is None else travel
    angles = arm_angles(model, design_height(model) + travels, rack_position)
    poses = Poses.of(model, *at_rest(model, angles, rack_position))
    lines = None if held == "locked" else soft_lines(corner(model, angles, rack_position))
    flexible = flexibility([Side(poses, bushes, lines)], held, rack=rack)
    found = _dataset(poses.wheels["wheel"], flexible, np.asarray(travels), held)
    return found.assign_attrs(left_out=left_out(bushes))


# -- results --------------------------------------------------------------------------------------


def _dataset(on_road: RoadWheel, flexible: Array, travels: Array, held: Held) -> xr.Dataset:
    axes = wheel_axes(on_road)
    found: dict[Any, Any] = {}
    for test in RIG_LOADS:
        moved = np.einsum("nab,nb->na", flexible, load_at_contact(test, on_road))
        for quantity, values in told(test, on_road, moved):
            found[quantity.name] = xr.Variable(TRAVEL.name, values, quantity.attributes())
    words = "displacement and rotation of the contact by force and moment there, tyre axes"
    found["flexibility"] = variable(
        (TRAVEL.name, "moved", "by"), rotated(flexible, axes), words, "SI"
    )
    coordinates = {
        TRAVEL.name: xr.Variable(TRAVEL.name, travels, TRAVEL.attributes()),
        "moved": list(MOVED),
        "by": list(LOADED),
    }
    return xr.Dataset(found, coordinates, {"title": "compliance", "held": HELD[held]})


def load_at_contact(test: RigLoad, on_road: RoadWheel) -> Array:
    """Return the load of a rig on a wheel, as force and moment at its contact, (n, 6).

    On a right wheel it is the mirror image of that on a left one. Chassis axes [N], [N m].
    """
    axes, side = wheel_axes(on_road), on_road.vehicle.side
    force, moment = (
        np.einsum("nij,i->nj", axes, vector)
        for vector in (_mirror(side) * test.force, side * _mirror(side) * test.moment)
    )
    arm = _where(test, on_road) - touching(on_road)
    return np.concatenate([force, moment + cross(arm, force)], axis=-1)


def _where(test: RigLoad, on_road: RoadWheel) -> Array:
    """Return where a load acts, (n, 3) [m]."""
    return on_road.center if test.at == CENTER else touching(on_road)


def sense_of(test: RigLoad, on_road: RoadWheel) -> Array:
    """Return the direction in which displacements under a load are told, (n, 3)."""
    sense = _mirror(on_road.vehicle.side) * test.sense
    along: Array = np.einsum("nij,i->nj", wheel_axes(on_road), sense)
    return along


def told(
    test: RigLoad, on_road: RoadWheel, moved: Array, *, how: str = "", part: float = 1.0
) -> Iterator[tuple[Quantity, Array]]:
    """Yield what the wheel does under a load, by the formulas of the characteristics.

    Parameters
    ----------
    test : RigLoad
    on_road : RoadWheel
    moved : ndarray, shape (n, 6)
        Displacement and rotation of the contact, chassis axes [m], [rad].
    how : str, optional
        How both wheels of an axle are loaded.
    part : float, optional
        How much of the load this wheel has.
    """
    turn = moved[:, 3:]
    shift = moved[:, :3] + cross(turn, _where(test, on_road) - touching(on_road))
    motion = Motion(shift, turn)
    values = {
        "toe": wheel.toe_rate(on_road, motion),
        "camber": wheel.camber_rate(on_road, motion),
        "displacement": (sense_of(test, on_road) * shift).sum(axis=-1),
    }
    for kind, quantity in quantities_under(test, how).items():
        if kind in values:
            yield quantity, values[kind]
        elif soft := give_of_tyre(test, on_road):
            yield quantity, values["displacement"] + part * soft


def give_of_tyre(test: RigLoad, on_road: RoadWheel) -> float | None:
    """Return how far the standing tyre gives way to a unit of a load [m/N].

    None where the load does not go through it, or its rate is not known.
    """
    rate = getattr(on_road.vehicle, test.through) if test.through else None
    return None if rate is None else 1.0 / rate


def quantities_under(test: RigLoad, how: str = "") -> dict[str, Quantity]:
    """Return what is told under a load, by what of the wheel it is; `how` as of `told`."""
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
        meaning = f"{words}, on a tyre that gives way"
        kinds.append(("patch_displacement", "m", words, meaning, sign))
    found = {}
    for name, unit, words, meaning, sign in kinds:
        shown = display_of({"units": unit})
        display = Display(f"{shown.units}/{test.shown.units}", shown.factor * test.shown.factor)
        found[name] = Quantity(
            f"{name}_by_{test.name}",
            f"{unit}/({test.unit})" if " " in test.unit else f"{unit}/{test.unit}",
            f"{words} by {test.words}{how and f', {how}'}",
            meaning,
            sign,
            display=display,
        )
    return found


def _mirror(side: float) -> Array:
    return np.array([1.0, side, 1.0])


COMPLIANCES = {q.name: q for test in RIG_LOADS for q in quantities_under(test).values()}
"""What is told of a wheel under loads, by name."""
