"""Characteristics over the motions of a rig, as labelled arrays."""

from typing import Any

import xarray as xr

from ....core.memory import positions_given
from ....core.named_types import Array, ArrayLike
from ....core.validator import Validator
from ...assembly.assembly import Assembly
from ...assembly.by_wheel import axle_coordinate, of_wheels, wheel_coordinate
from ...assembly.measures import axle, corner, of_whole_axles
from ...assembly.measures.measure import columns
from ...assembly.of import given_assembly
from ...assembly.quantity import RACK, ROLL, STEERING_WHEEL, TRAVEL, Quantity
from ...assembly.rig import SweepRange
from ...models.car.car import WHEELS
from ...models.car.file import ENDS
from ...models.sides import SIDES

DATA_SET = "data_set"
"""Dimension of several sets of curves."""

ALONG = {"travel": TRAVEL, "rack": RACK}
"""Positions along the curves of a corner, by motion."""

KNOWN: dict[str, dict[str, Quantity]] = {
    "travel": columns(corner.OVER_TRAVEL, ["left"]),
    "rack": columns(corner.OVER_RACK, ["left"]),
}
"""Characteristics of a corner by name, over wheel travel and over the rack."""

_MOVING = columns((*axle.OVER_TRAVEL, *of_whole_axles()), SIDES)
_STEERED = columns(axle.OVER_RACK, SIDES)
OF_AXLES = {
    TRAVEL.name: _MOVING,
    ROLL.name: _MOVING,
    RACK.name: _STEERED,
    STEERING_WHEEL.name: _STEERED | {RACK.name: RACK},
}
"""Characteristics of axles by the names of their columns, for each position that they are over."""

OF_CARS = columns(corner.OVER_TRAVEL, ["left"]) | {
    each.name: each
    for measure in (*axle.OVER_TRAVEL, *of_whole_axles())
    for place in (WHEELS if measure.scope == "wheel" else ENDS)
    for each in [measure.quantity.of_wheel(place)]
}
"""Characteristics of cars by the names of their columns, over the motions of the body."""


def over(
    subject: Any,
    motion: str | None = None,
    along: ArrayLike | None = None,
    *,
    extent: SweepRange | None = None,
    travel: float = 0.0,
    rack_position: float = 0.0,
) -> xr.Dataset:
    """Return the characteristics of a suspension, an axle or a car over a motion of a rig.

    Parameters
    ----------
    subject : Suspension, Model, Axle, AxleModel, RigidAxle, RigidAxleModel, Car or CarModel
    motion : str, optional
        Of a suspension 'travel' or, if it is steered, 'rack'. Of an axle 'bump' (both wheels in
        parallel), 'roll', 'left' and 'right' (one wheel, the other one at design); of a steered
        axle also 'steer' and 'rack'. Of a car 'heave', 'pitch' and 'roll' of the body; of a quarter
        car 'heave' only. By default the first of these.
    along : array_like, shape (n,), optional
        Positions of the motion. 'travel', 'bump', 'left', 'right': heights of wheel centres above
        design [m]; 'rack': displacements of the rack [m]; 'roll': roll angles of the body, positive
        with the right side down [rad]; 'steer': angles of the steering wheel, positive to the left
        [rad]; 'heave', positive upward [m]; 'pitch', positive nose down [rad]. By default the usual
        range, limited to the reach of the wheels: 80 mm of travel and 60 mm of the rack to either
        side, 4 deg of roll.
    extent : SweepRange, optional
        Ends of the motion that differ from the usual range; not together with `along`.
    travel : float, optional
        Constant height of the wheel centres above design in a motion of the rack [m].
    rack_position : float, optional
        Constant displacement of the rack in a motion of the wheels [m].

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel`` [m], ``roll_angle`` [rad], ``steering_wheel_angle`` [rad] or
        ``rack_position`` [m], of a car also ``body_heave`` [m] or ``body_pitch`` [rad]; of an axle,
        characteristics of the wheels also over ``wheel``. The motion 'steer' is over the rack if
        the file has no steering ratio. Values are in SI units. Each variable has the attributes
        ``units``, ``long_name``, ``definition``, ``sign``, and ``display_units``, the unit in which
        tables and figures show it, of which ``display_factor`` are one SI unit. Characteristics
        that need missing data of the vehicle are left out.

    Raises
    ------
    PositionError
        If a position is out of reach; the message states the range.
    InputError
        If an argument cannot be used, a drop link does not reach, or an axle does not move with
        rigid joints.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import characteristics, load
    >>> curves = characteristics.over(load("reference_car"), "travel", [-0.05, 0.05])
    >>> np.rad2deg(curves["camber"].values).round(4).tolist()
    [1.3246, -0.9139]
    >>> steered = characteristics.over(load("reference_car"), "rack", [-0.04, 0.04])
    >>> np.rad2deg(steered["steer_left"].values).round(3).tolist()
    [18.174, -17.836]
    >>> axle = characteristics.over(load("reference_axle"), "bump", [-0.05, 0.0, 0.05])
    >>> (axle["roll_center_height"].values * 1e3).round(1).tolist()
    [224.8, 106.3, -18.2]
    >>> axle["camber"].dims
    ('wheel', 'wheel_travel')
    """
    with Validator("characteristics") as given:
        assembly = given_assembly(given, subject, cars=True)
        travel = given.number("travel", travel, "m")
        rack = given.number("rack_position", rack_position, "m")
        if extent is not None:
            given.instance(
                "extent", extent, SweepRange, "a kintrafo.characteristics.SweepRange is needed"
            )
        if extent is not None and along is not None:
            given.fail("along and extent are both given. Give one of them.")
    motion = given_motion(assembly, motion)
    with Validator("characteristics") as given:
        assembly.refuse_holding(given, motion, travel, rack)
        quantity = assembly.motions[motion].along
        if along is not None:
            along = positions_given(given, "along", along, quantity.units)
            if not given.failed:
                assembly.refuse_positions(given, motion, along)
    if along is None:
        along = assembly.usual(motion, extent, travel=travel, rack=rack)
    return dataset(assembly, motion, along, travel=travel, rack=rack)


def given_motion(assembly: Assembly, motion: Any, name: str = "motion") -> str:
    """Return a motion of an assembly, by default the usual one, or raise an `InputError`."""
    if motion is None:
        return assembly.usual_motion
    if isinstance(motion, str):
        assembly.refuse_motion(motion)
    with Validator("characteristics") as given:
        given.among(name, motion, assembly.motions)
    return str(motion)


def dataset(
    assembly: Assembly, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
) -> xr.Dataset:
    """Return the characteristics at some positions of a motion; see `over`."""
    how = assembly.motions[motion]
    held = assembly.held_in(motion, travel, rack)
    of = assembly.kinematics(assembly.position(motion, along, travel=travel, rack=rack))
    variables = {}
    for measure in assembly.measures(motion):
        if not measure.defined_for(of):
            continue
        found = [measure.at(of, wheel) for wheel in measure.columns(assembly.wheels).values()]
        if measure.scope == "wheel":
            variables[measure.name] = of_wheels(measure.quantity, how.along.name, found)
        else:
            dims = ("axle", how.along.name) if assembly.axles else (how.along.name,)
            quantity = measure.quantity
            if quantity is RACK:
                quantity = assembly.steering_displacement
            variables[measure.name] = xr.Variable(dims, found[0], quantity.attributes())
    coordinates = {
        how.along.name: xr.Variable(how.along.name, along, how.along.attributes()),
        "wheel": wheel_coordinate(assembly.wheels),
    }
    if assembly.axles:
        coordinates["axle"] = axle_coordinate(assembly.axles)
    for quantity, value in held.items():
        coordinates[quantity.name] = xr.Variable((), float(value), quantity.attributes())
    return xr.Dataset(variables, coordinates, {"title": f"characteristics over {how.title}"})
