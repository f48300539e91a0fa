"""Positions of wheels and joints over wheel travel and rack displacement.

Wheel travel is the height of the wheel centre above its design position [m], positive in bump; the
displacement of the rack is along its axis [m]. Both are zero at design.
"""

from typing import Any

import numpy as np
import xarray as xr

from ...core.memory import positions_given
from ...core.named_types import Array, ArrayLike
from ...core.quantities import variable
from ...core.validator import Validator
from ..assembly.assembly import HeldAssembly
from ..assembly.by_wheel import by_ending
from ..assembly.of import given_assembly
from ..assembly.part_poses import PartPoses
from ..assembly.usual import grid, usual_rack, usual_travel

__all__ = ["grid", "positions", "usual_rack", "usual_travel"]


TRAVEL, RACK = "wheel_travel", "rack_position"

# Signals in these units follow from the position alone; forces and rates need more.
_OF_POSITION = ("m", "rad")


def positions(
    subject: Any, travel: ArrayLike | None = None, rack: ArrayLike | None = None
) -> xr.Dataset:
    """Return positions of wheels and joints over wheel travel, over the rack, or over both.

    Parameters
    ----------
    subject : Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel
    travel : array_like, optional
        Wheel travel, of both wheels of an axle in parallel [m]: a number, or an array of shape
        (n,); by default the usual range, see `usual_travel`.
    rack : array_like, optional
        Displacement of the rack [m]: a number, or an array of shape (m,); by default zero.

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel`` and ``rack_position`` (a single number is a scalar coordinate); of an
        axle, variables of the sides also over ``wheel``. Variables: the signals of the equations
        that depend on position alone (wheel centre, camber, toe, steer angle, strut length, ...),
        the moving hardpoints (``ball_joint_x``, ...) and the independent coordinates; SI units,
        chassis axes.

    Raises
    ------
    PositionError
        If a position is out of reach; the message states the range.
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> from kintrafo import load, sweep
    >>> curves = sweep.positions(load("reference_car"), [-0.05, 0.0, 0.05])
    >>> curves["camber"].values[[0, 2]].round(4).tolist()
    [0.0231, -0.016]
    """
    with Validator("sweep") as given:
        assembly = given_assembly(given, subject)
        travels = positions_given(
            given, "travel", 0.0 if travel is None else travel, "m", dimensions=[0, 1]
        )
        racks = positions_given(
            given, "rack", 0.0 if rack is None else rack, "m", dimensions=[0, 1], times=travels.size
        )
    if racks.ndim or np.any(racks):
        with Validator("sweep") as given:
            assembly.refuse_unsteered(given, "rack")
    travels = assembly.usual(assembly.usual_motion) if travel is None else travels
    # travels are rows, racks columns; a single value of either has no dimension
    heights, across = np.broadcast_arrays(
        travels[:, None] if travels.ndim and racks.ndim else travels, racks
    )
    held = assembly.at_travel(heights.ravel(), across.ravel())
    along = (TRAVEL,) * travels.ndim + (RACK,) * racks.ndim
    found: dict[str, xr.Variable] = {}
    for suffix, poses in assembly.poses(held).items():
        for name, (values, meaning, unit) in _of_group(assembly, suffix, poses).items():
            found[name] = variable(along, values.reshape(heights.shape), meaning, unit)
    meaning = "wheel travel, positive in bump"
    coordinates = {TRAVEL: variable((TRAVEL,) * travels.ndim, travels, meaning, "m")}
    if assembly.steered:
        gear = assembly.steering_displacement
        meaning = f"{gear.long_name}, {gear.sign}"
        coordinates[RACK] = variable((RACK,) * racks.ndim, racks, meaning, "m")
    flat = xr.Dataset(found, coordinates, {"title": "positions of the suspension"})
    return flat if len(assembly.wheels) == 1 else by_ending(flat, assembly.wheels)


Columns = dict[str, tuple[Array, str, str]]
"""Values, meaning and unit by name."""


def _of_group(assembly: HeldAssembly, suffix: str, poses: PartPoses) -> Columns:
    """Return the positions, angles and lengths of a group of parts, as columns."""
    model = poses.model
    found: Columns = {}
    for name, values in poses.signals().items():
        described = model.equations.SIGNALS[name]
        if described["unit"] in _OF_POSITION:
            column = f"{name}{suffix}" if suffix else _ended(assembly, name)
            found[column] = values, described["meaning"], described["unit"]
    for point in assembly.joints(suffix):
        words = point.replace("_", " ")
        for i, axis in enumerate("xyz"):
            name = f"{point}_{axis}{suffix}"
            for wheel in assembly.wheels if not suffix else ():
                if point.endswith(f"_{wheel}"):
                    name = f"{point.removesuffix(f'_{wheel}')}_{axis}_{wheel}"
            found[name] = poses.points[point][..., i], f"{words}, {axis} in chassis axes", "m"
    for state, name in assembly.coordinates_of(suffix).items():
        described = model.equations.STATE[state]
        values = poses.states[..., model.state_names.index(state)]
        found[f"{name}{suffix}"] = values, str(described["meaning"]), described["unit"]
    return found


def _ended(assembly: HeldAssembly, name: str) -> str:
    """Return the name of a signal with its wheel at the end rather than at the beginning."""
    if len(assembly.wheels) == 1:
        return name
    for wheel in assembly.wheels:
        names = assembly.names_of(wheel)
        for prefix in (names.signals, names.prefix):
            if name.startswith(prefix):
                return f"{name.removeprefix(prefix)}_{wheel}"
    return name
