"""Wheels on bushes over travel and a load together, as in the combined test of a rig."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ....core.named_types import ArrayLike
from ....core.validator import Validator
from ...assembly.by_wheel import WHEEL, of_wheels, wheel_coordinate
from ...assembly.of import given_assembly
from ...assembly.quantity import TRAVEL
from .flexibility import HELD, WheelSupport, refuse_without_rate
from .nonlinear import (
    LOAD,
    amounts_of,
    load_coordinate,
    parts_of,
    under_amounts,
    unit_load,
    words_of,
)
from .on_bushes import (
    CURVES,
    HARDPOINTS,
    WHEEL_LOAD,
    Hardpoints,
    at_height,
    on_bushes,
    on_joints,
    softs_of,
)
from .rig_loads import BY_NAME


def combined(
    subject: Any,
    bushings: Mapping[str, Any] | None,
    under: str,
    amounts: ArrayLike,
    travel: ArrayLike | None = None,
    *,
    wheels: str | Sequence[float] | None = None,
    rack_position: float = 0.0,
    held: WheelSupport = "height",
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return the positions of the wheels at each wheel travel under each amount of a load.

    Parameters
    ----------
    subject : Suspension, Model, Axle or RigidAxle
    bushings : mapping or None
        As in `nonlinear`.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        As in `nonlinear`.
    amounts : array_like, shape (m,)
        Amounts of the load, of either sign: forces [N], or torques for 'aligning' [N m].
    travel : array_like, shape (n,), optional
        Heights of the wheel centres with rigid joints above design, of an axle in parallel [m]; by
        default the usual range.
    wheels, rack_position, held, hardpoints
        As in `nonlinear`.

    Returns
    -------
    xarray.Dataset
        Over ``wheel``, ``load`` and ``wheel_travel``: ``toe`` and ``camber`` [rad],
        ``half_track_change`` and ``wheelbase_change`` [m] of the wheel without the deflection of
        its tyre, and ``wheel_load``, the vertical force of the road [N].

    Raises
    ------
    InputError, PositionError
        As in `nonlinear`.

    Notes
    -----
    These are the equilibria of `nonlinear` at many travels: the deflection of bushes under a load
    depends on the position of the suspension and on the vertical force there.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import compliance
    >>> import kintrafo
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> car = kintrafo.load("reference_car")
    >>> found = compliance.combined(car, bushes, "lateral", [0.0, 4000.0], [-0.04, 0.0, 0.04])
    >>> np.rad2deg(found["toe"]).values.round(2).tolist()
    [[-0.22, 0.0, 0.21], [0.06, 0.27, 0.46]]
    """
    with Validator("combined") as given:
        assembly = given_assembly(given, subject)
        given.among("under", under, BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        rack_position = given.number("rack_position", rack_position, "m")
        wanted = amounts_of(given, amounts)
        if travel is not None:
            travel = given.array("travel", travel, "m", dimensions=[1])
        if not given.failed:
            assembly.refuse_holding(given, assembly.usual_motion, 0.0, rack_position)
            parts = parts_of(given, assembly, under, wheels)
        softs = softs_of(given, assembly, bushings, hardpoints)
        if not given.failed:
            refuse_without_rate(given, held, *assembly.tyres)
    if travel is None:
        travel = assembly.usual(assembly.usual_motion, rack=rack_position)
    travels = np.asarray(travel)
    load = replace(BY_NAME[under], words=words_of(under, wheels, parts))
    poses = assembly.poses(assembly.at_travel(travels, rack_position))
    suspension = on_joints(assembly, poses, softs)
    base = at_height(suspension, travels)
    of_each = zip(parts, suspension.wheels, strict=True)
    unit = np.stack([part * unit_load(load, one) for part, one in of_each], axis=1)
    states = under_amounts(suspension, base, unit, held, load, wanted)
    moved = [
        [on_bushes(suspension, state, which) for state in states]
        for which in range(len(assembly.wheels))
    ]
    dims = (LOAD, TRAVEL.name)
    data = {}
    for quantity, formula in CURVES.items():
        values = [np.stack([formula(one) for one in own]) for own in moved]
        data[quantity.name] = of_wheels(quantity, dims, values)
    road = np.moveaxis(np.stack([state.road for state in states]), -1, 0)
    data[WHEEL_LOAD.name] = of_wheels(WHEEL_LOAD, dims, [*road])
    coordinates = {
        LOAD: load_coordinate(load, wanted),
        TRAVEL.name: xr.Variable(TRAVEL.name, travels, TRAVEL.attributes()),
        WHEEL: wheel_coordinate(assembly.wheels),
    }
    how = {"held": HELD[held], "hardpoints": HARDPOINTS[hardpoints]}
    return xr.Dataset(data, coordinates, {"title": f"wheels under {load.words}"} | how)
