"""The default ranges of wheel travel and of the rack."""

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from ..models.model import Model
from ..models.positions import PositionError, arm_angles, design_height, travel_range

# Default ends of a sweep, if they can be reached.
USUAL_TRAVEL = 0.080  # bump and rebound of a passenger car [m]
USUAL_RACK = 0.060  # to either side [m]
# By default a sweep ends before the ends of the motion, by this part of the distance.
CLEARANCE = 0.02
_MOST_POINTS = 100_000


def grid(lowest: float, highest: float, step: float) -> Array:
    """Return equally spaced values, of which one is zero, and the two ends of their range.

    Parameters
    ----------
    lowest, highest : float
        Ends of the range; zero lies between them or is one of them.
    step : float
        Distance between two values.

    Returns
    -------
    ndarray

    Examples
    --------
    >>> from kintrafo import sweep
    >>> sweep.grid(-0.025, 0.02, 0.01).tolist()
    [-0.025, -0.02, -0.01, 0.0, 0.01, 0.02]
    """
    with Validator("sweep") as given:
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
    # a grid point within rounding of an end is the end
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
    """Return equally spaced wheel travels for a sweep.

    Parameters
    ----------
    model : Model
    rebound, bump : float, optional
        Greatest travel downward and upward from design, both positive [m]; by default 80 mm, or
        less if the suspension does not reach them.
    step : float, optional
        Distance between two travels [m].
    rack : float, optional
        Displacement of the rack [m].

    Returns
    -------
    ndarray
        Wheel travels from ``-rebound`` to ``bump``, of which one is zero [m].
    """
    with Validator("sweep") as given:
        given.instance("model", model, Model, Model.NEEDED)
        rack = given.number("rack", rack, "m")
    _check_amounts(rebound=rebound, bump=bump)
    if rebound is None or bump is None:
        reach = travel_range(model, rack)
        design = design_height(model)
        down, up = ((1.0 - CLEARANCE) * abs(height - design) for height in reach.height)
        rebound = min(USUAL_TRAVEL, down) if rebound is None else rebound
        bump = min(USUAL_TRAVEL, up) if bump is None else bump
    return grid(-rebound, bump, step)


def usual_rack(
    model: Model, *, extent: float | None = None, step: float = 0.002, travel: float = 0.0
) -> Array:
    """Return equally spaced displacements of the rack for a sweep.

    Parameters
    ----------
    model : Model
    extent : float, optional
        Greatest displacement to either side [m]; by default 60 mm, or less if the steering does not
        reach it.
    step : float, optional
        Distance between two displacements [m].
    travel : float, optional
        Constant wheel travel [m].

    Returns
    -------
    ndarray
        Displacements from ``-extent`` to ``extent``, of which one is zero [m].
    """
    with Validator("sweep") as given:
        given.instance("model", model, Model, Model.NEEDED)
        travel = given.number("travel", travel, "m")
    model.suspension.refuse_without_rack("positions over the rack")
    _check_amounts(extent=extent)
    if extent is None:
        extent = _reachable_rack(model, travel)
    return grid(-extent, extent, step)


def _reachable_rack(model: Model, travel: float) -> float:
    """Return the default extent of the rack, halved until both ends are in range [m]."""
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
    with Validator("sweep") as given:
        for name, value in amounts.items():
            if value is not None and given.number(name, value, "m") < 0.0:
                given.fail(
                    f"{name} = {value * 1e3:g} mm: a distance of 0 mm or more is needed, without a "
                    "sign."
                )
