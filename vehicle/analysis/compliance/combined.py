"""Wheels on their bushes over travel and a load at once, as in the combined test of a rig."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ....core.named_types import ArrayLike
from ...assembly.by_wheel import of_wheels
from ...assembly.quantity import TRAVEL
from .flexibility import WheelSupport
from .nonlinear import LOAD, LoadedWheels
from .on_bushes import CURVES, WHEEL_LOAD, Hardpoints, on_bushes


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
        As of `nonlinear`.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        As of `nonlinear`.
    amounts : array_like, shape (m,)
        Amounts of the load, of either sign [N], [N m].
    travel : array_like, shape (n,), optional
        Heights of the wheel centres with rigid joints above design, of an axle in parallel [m]; by
        default the usual range.
    wheels, rack_position, held, hardpoints
        As of `nonlinear`.

    Returns
    -------
    xarray.Dataset
        Over ``wheel``, ``load`` and ``wheel_travel``: ``toe`` and ``camber`` [rad],
        ``half_track_change`` and ``wheelbase_change`` [m] of the wheel without the deflection of
        its tyre, and ``wheel_load``, the vertical force of the road [N].

    Raises
    ------
    InputError, PositionError
        As of `nonlinear`.

    Notes
    -----
    The equilibria of `nonlinear` at many travels: the deflection of bushes under a load depends on
    where the suspension is, and on the vertical force there.

    Examples
    --------
    >>> import kintrafo
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> car = kintrafo.load("reference_car")
    >>> found = combined(car, bushes, "lateral", [0.0, 4000.0], [-0.04, 0.0, 0.04])
    >>> np.rad2deg(found["toe"]).values.round(2).tolist()
    [[-0.22, 0.0, 0.21], [0.06, 0.27, 0.46]]
    """
    loaded = LoadedWheels.of(
        "combined",
        (subject, bushings, under, amounts),
        travel,
        several=True,
        wheels=wheels,
        rack_position=rack_position,
        held=held,
        hardpoints=hardpoints,
    )
    moved = [
        [on_bushes(loaded.on, state, which) for state in loaded.states]
        for which in range(len(loaded.assembly.wheels))
    ]
    dims = (LOAD, TRAVEL.name)
    data = {}
    for quantity, formula in CURVES.items():
        values = [np.stack([formula(one) for one in own]) for own in moved]
        data[quantity.name] = of_wheels(quantity, dims, values)
    road = np.moveaxis(np.stack([state.road for state in loaded.states]), -1, 0)
    data[WHEEL_LOAD.name] = of_wheels(WHEEL_LOAD, dims, [*road])
    along = xr.Variable(TRAVEL.name, loaded.travels, TRAVEL.attributes())
    coordinates = {**loaded.coordinates, TRAVEL.name: along}
    return xr.Dataset(data, coordinates, loaded.attributes("wheels"))
