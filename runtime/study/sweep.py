"""Positions over wheel travel and rack displacement: where the wheel and the joints go.

Wheel travel is the height of the wheel centre above its design position [m], positive in bump; the
rack is displaced along its axis [m]. Both are zero at design.
"""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..assembly.usual import grid, usual_rack, usual_travel
from ..core.arguments import Arguments
from ..core.memory import positions_given
from ..core.named_types import ArrayLike
from ..core.quantities import variable
from ..suspension.model import Model
from ..suspension.points import hardpoints
from ..suspension.positions import arm_angles, design_height
from ..suspension.reach import at_rest

__all__ = ["grid", "positions", "usual_rack", "usual_travel"]

Array = NDArray[np.float64]

TRAVEL, RACK = "wheel_travel", "rack_position"

# Signals in these units follow from the position alone; forces and rates need more.
_OF_POSITION = ("m", "rad")


def positions(
    model: Model,
    travel: ArrayLike | None = None,
    rack: ArrayLike | None = None,
) -> xr.Dataset:
    """Return wheel and joint positions over travel, over the rack, or over both.

    Parameters
    ----------
    model : Model
    travel : array_like, optional
        Wheel travel [m]: one value or many, by default what `usual_travel` returns.
    rack : array_like, optional
        Displacement of the rack [m]: one value or many, by default zero.

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel`` and ``rack_position``, of which one that is a single number is a
        scalar coordinate. Variables: the signals of the model that the position decides (wheel
        centre, camber, toe, steer angle, strut length, ...), the moving hardpoints
        (``ball_joint_x``, ...) and the arm angle; SI units, chassis axes.

    Raises
    ------
    PositionError
        If a position is out of reach; the message states the range.

    Examples
    --------
    >>> curves = positions(Model("reference_car"), [-0.05, 0.0, 0.05])
    >>> curves["camber"].values[[0, 2]].round(4).tolist()
    [0.0231, -0.016]
    """
    with Arguments("sweep") as given:
        given.kind("model", model, Model, Model.NEEDED)
        travels = positions_given(
            given, "travel", 0.0 if travel is None else travel, "m", dimensions=[0, 1]
        )
        racks = positions_given(
            given, "rack", 0.0 if rack is None else rack, "m", dimensions=[0, 1], times=travels.size
        )
    travels = usual_travel(model) if travel is None else travels
    if racks.ndim:
        model.suspension.refuse_without_rack("positions over the rack")
    # travels go down, racks across; a single one of either has no dimension
    heights = design_height(model) + (travels[:, None] if travels.ndim and racks.ndim else travels)
    angles = arm_angles(model, heights, racks)
    return _dataset(model, travels, racks, _evaluated(model, angles, racks))


def _evaluated(model: Model, angles: Array, racks: Array) -> dict[str, Array]:
    """Return everything that the position decides, by name."""
    states, inputs = at_rest(model, angles, racks)
    signals = model.signals(states, inputs)
    described = model.equations.SIGNALS
    columns = {n: v for n, v in signals.items() if described[n]["unit"] in _OF_POSITION}
    points = hardpoints(model, states, inputs)
    for point in model.suspension.hardpoints.JOINTS:
        columns |= {f"{point}_{axis}": points[point][..., i] for i, axis in enumerate("xyz")}
    return columns | {"arm_angle": angles}


def _dataset(model: Model, travels: Array, racks: Array, columns: dict[str, Array]) -> xr.Dataset:
    """Put columns over travels and racks into a dataset."""
    along = (TRAVEL,) * travels.ndim
    across = (RACK,) * racks.ndim
    meaning = "wheel travel, positive in bump"
    coordinates = {TRAVEL: variable(along, travels, meaning, "m")}
    if model.suspension.steered():
        meaning = "rack displacement, positive along its axis"
        coordinates[RACK] = variable(across, racks, meaning, "m")
    data = {
        name: variable(along + across, values, *_described(name, model))
        for name, values in columns.items()
    }
    return xr.Dataset(data, coordinates, {"title": "positions of the suspension"})


def _described(name: str, model: Model) -> tuple[str, str]:
    """Return meaning and SI unit of a column."""
    if name in model.signal_names:
        signal = model.equations.SIGNALS[name]
        return signal["meaning"], signal["unit"]
    if name == "arm_angle":
        return str(model.equations.STATE[model.names.arm]["meaning"]), "rad"
    point, _, axis = name.rpartition("_")
    return f"{point.replace('_', ' ')}, {axis} in chassis axes", "m"
