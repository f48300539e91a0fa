"""Wheels on bushes over travel and a load together, as in the combined test of a rig."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ....core.named_types import ArrayLike
from ....core.validator import Validator
from ...assembly.by_wheel import WHEEL, of_wheels, wheel_coordinate
from ...assembly.quantity import TRAVEL
from .flexibility import WheelSupport
from .on_bushes import CURVES, WHEEL_LOAD, Hardpoints, on_bushes
from .under_load import LOAD, WheelsUnderLoad, load_coordinate


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
        Stiffnesses by hardpoint; None for those of the file.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        The load: a lateral force, braking or an aligning torque at the contact, or a rearward force
        at the wheel centre.
    amounts : array_like, shape (m,)
        Amounts of the load, of either sign: forces [N], or torques for 'aligning' [N m].
    travel : array_like, shape (n,), optional
        Heights of the wheel centres with rigid joints above design, of an axle in parallel [m]; by
        default the usual range.
    wheels, rack_position, held, hardpoints
        Loaded wheels, constant rack displacement [m], support of the wheels, and the state in which
        the joints are at the hardpoints; see `nonlinear`.

    Returns
    -------
    xarray.Dataset
        Over ``wheel``, ``load`` and ``wheel_travel``: ``toe`` and ``camber`` [rad],
        ``half_track_change`` and ``wheelbase_change`` [m] of the wheel without the deflection of
        its tyre, and ``wheel_load``, the vertical force of the road [N].

    Raises
    ------
    InputError, PositionError
        If an argument cannot be used, or a position is out of reach.

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
        if travel is not None:
            travel = given.array("travel", travel, "m", dimensions=[1])
        loaded = WheelsUnderLoad.given(
            given, subject, bushings, under, amounts,
            wheels=wheels, rack_position=rack_position, held=held, hardpoints=hardpoints,
        )  # fmt: skip
    assembly = loaded.assembly
    if travel is None:
        travel = assembly.usual(assembly.usual_motion, rack=loaded.rack_position)
    travels = np.asarray(travel)
    suspension, _, states = loaded.equilibria(travels)
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
        LOAD: load_coordinate(loaded.load, loaded.amounts),
        TRAVEL.name: xr.Variable(TRAVEL.name, travels, TRAVEL.attributes()),
        WHEEL: wheel_coordinate(assembly.wheels),
    }
    title = {"title": f"wheels under {loaded.load.words}"}
    return xr.Dataset(data, coordinates, title | loaded.described)
