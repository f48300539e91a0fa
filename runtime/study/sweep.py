"""Positions over wheel travel and rack displacement: where the wheel and the joints go.

Wheel travel is the height of the wheel centre above its design position [m], positive in bump; the
rack is displaced along its axis [m]. Both are zero at design.
"""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..core.arguments import Arguments
from ..core.errors import InputError
from ..core.named_types import ArrayLike
from ..core.quantities import variable
from ..suspension.model import Model
from ..suspension.points import hardpoints
from ..suspension.positions import PositionError, arm_angles, design_height, travel_range
from ..suspension.reach import at_rest

Array = NDArray[np.float64]

TRAVEL, RACK = "wheel_travel", "rack_position"

# What a sweep covers where nothing is said, as far as it can be reached.
USUAL_TRAVEL = 0.080  # bump and rebound of a passenger car [m]
USUAL_RACK = 0.060  # to either side [m]
# A sweep that is not told otherwise keeps clear of the ends of the motion by this part of them.
_CLEARANCE = 0.02
_MOST_POINTS = 100_000
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
        travels = given.array("travel", 0.0 if travel is None else travel, "m", dimensions=[0, 1])
        racks = given.array("rack", 0.0 if rack is None else rack, "m", dimensions=[0, 1])
    travels = usual_travel(model) if travel is None else travels
    if racks.ndim:
        model.suspension.refuse_without_rack("positions over the rack")
    # travels go down, racks across; a single one of either has no dimension
    heights = design_height(model) + (travels[:, None] if travels.ndim and racks.ndim else travels)
    angles = arm_angles(model, heights, racks)
    return _dataset(model, travels, racks, _evaluated(model, angles, racks))


def grid(lowest: float, highest: float, step: float) -> Array:
    """Return equally spaced values that include zero, with the two ends.

    Parameters
    ----------
    lowest, highest : float
        Ends of the range; zero lies between them or is one of them.
    step : float
        Distance of the values.

    Returns
    -------
    ndarray

    Examples
    --------
    >>> grid(-0.025, 0.02, 0.01).tolist()
    [-0.025, -0.02, -0.01, 0.0, 0.01, 0.02]
    """
    with Arguments("sweep") as given:
        lowest = given.number("lowest", lowest)
        highest = given.number("highest", highest)
        step = given.number("step", step)
    if not (step > 0.0 and lowest <= 0.0 <= highest):
        problem = (
            f"from {lowest * 1e3:g} mm to {highest * 1e3:g} mm by {step * 1e3:g} mm: the ends must "
            "lie on either side of zero (the design position), and the step be more than 0 mm."
        )
        raise InputError([problem], "sweep")
    if (highest - lowest) / step > _MOST_POINTS:
        problem = (
            f"a step of {step * 1e3:g} mm makes more than {_MOST_POINTS} positions from "
            f"{lowest * 1e3:g} mm to {highest * 1e3:g} mm. Choose a larger step."
        )
        raise InputError([problem], "sweep")
    # a step that fits up to rounding ends at the end itself
    below, above = (int(np.floor(abs(end) / step + 1e-9)) for end in (lowest, highest))
    values = np.arange(-below, above + 1) * step
    near = 1e-9 * step
    inner = values[(values > lowest + near) & (values < highest - near)]
    return np.union1d(inner, [lowest, 0.0, highest])


def usual_travel(
    model: Model,
    *,
    rebound: float | None = None,
    bump: float | None = None,
    step: float = 0.002,
    rack: float = 0.0,
) -> Array:
    """Return wheel travels for a sweep.

    Parameters
    ----------
    model : Model
    rebound, bump : float, optional
        How far down and up, both positive [m]; by default 80 mm, or less where the suspension
        cannot go so far.
    step : float, optional
        Distance of the positions [m].
    rack : float, optional
        Displacement of the rack at which the range is looked up [m].

    Returns
    -------
    ndarray
        From ``-rebound`` to ``bump``, the design position included [m].
    """
    with Arguments("sweep") as given:
        given.kind("model", model, Model, Model.NEEDED)
        rack = given.number("rack", rack, "m")
    _check_amounts(rebound=rebound, bump=bump)
    if rebound is None or bump is None:
        reach = travel_range(model, rack)
        design = design_height(model)
        down, up = ((1.0 - _CLEARANCE) * abs(height - design) for height in reach.height)
        rebound = min(USUAL_TRAVEL, down) if rebound is None else rebound
        bump = min(USUAL_TRAVEL, up) if bump is None else bump
    return grid(-rebound, bump, step)


def usual_rack(
    model: Model, *, extent: float | None = None, step: float = 0.002, travel: float = 0.0
) -> Array:
    """Return displacements of the rack for a sweep.

    Parameters
    ----------
    model : Model
    extent : float, optional
        How far to either side [m]; by default 60 mm, or less where the steering cannot go so far.
    step : float, optional
        Distance of the positions [m].
    travel : float, optional
        Wheel travel at which the range is looked up [m].

    Returns
    -------
    ndarray
        From ``-extent`` to ``extent``, zero included [m].
    """
    with Arguments("sweep") as given:
        given.kind("model", model, Model, Model.NEEDED)
        travel = given.number("travel", travel, "m")
    model.suspension.refuse_without_rack("positions over the rack")
    _check_amounts(extent=extent)
    if extent is None:
        extent = _reachable_rack(model, travel)
    return grid(-extent, extent, step)


def _reachable_rack(model: Model, travel: float) -> float:
    """Return the usual extent of the rack, halved until the wheel gets there on both sides."""
    extent = USUAL_RACK
    while extent > 1e-3:
        if all(_reaches(model, travel, sign * extent) for sign in (-1.0, 1.0)):
            return extent
        extent /= 2.0
    message = (
        f"at {travel * 1e3:g} mm of wheel travel the rack moves by less than 1 mm to either side. "
        "Choose another travel, or check the tie rod's hardpoints."
    )
    raise PositionError(message)


def _reaches(model: Model, travel: float, rack: float) -> bool:
    try:
        arm_angles(model, design_height(model) + travel, rack)
    except PositionError:
        return False
    return True


def _check_amounts(**amounts: float | None) -> None:
    with Arguments("sweep") as given:
        for name, value in amounts.items():
            if value is not None and given.number(name, value, "m") < 0.0:
                given.refuse(
                    f"{name} = {value * 1e3:g} mm: a distance of 0 mm or more is needed, without a "
                    "sign."
                )


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
