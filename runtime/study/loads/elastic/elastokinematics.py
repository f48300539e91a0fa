"""How a wheel moves over its travel on its bushes, beside how it does with rigid joints."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ....assembly import wheel
from ....assembly.quantity import RACK, TRAVEL, Quantity
from ....assembly.usual import usual_travel
from ....core.arguments import Arguments
from ....core.named_types import ArrayLike
from ....core.quantities import variable
from ....suspension.model import Model
from ...characteristics.datasets import DATA_SET, KNOWN
from .connections import Soft
from .equilibrium import LOADS, Equilibrium, State
from .held import HARDPOINTS, Hardpoints, at_height, on_bushes, soft_of, suspension_on

Array = NDArray[np.float64]

# So many positions at a time: their matrices take 50 MB.
_TOGETHER = 200
CONTACT_RATE = Quantity(
    "contact_rate",
    "N/m",
    "rate at the contact",
    "derivative of the vertical force of the road by the height of the contact, other wheels held: "
    "of springs, stops, bar and bushes, weights included; the wheel rate of the characteristics is "
    "that of spring and stops by the height of the wheel centre",
    "positive when the force grows with the height",
)
CURVES = {
    "toe": wheel.toe,
    "camber": wheel.camber,
    "half_track_change": wheel.half_track_change,
    "wheelbase_change": wheel.wheelbase_change,
}


def elastokinematics(
    model: Model,
    bushings: Mapping[str, Any] | None = None,
    travel: ArrayLike | None = None,
    *,
    rack_position: float = 0.0,
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return how the wheel moves over its travel with rigid joints, and on its bushes.

    Parameters
    ----------
    model : Model
    bushings : mapping, optional
        In the place of those of the file, as `compliance` takes them; besides, ``axial_curve`` and
        ``radial_curve`` in the place of stiffnesses, ``{"mm": [...], "N": [...]}``.
    travel : array_like, shape (n,), optional
        Heights of the wheel centre with rigid joints above its design height [m]: the road holds
        the contact where it then is. By default the usual range.
    rack_position : float, optional
        [m].
    hardpoints : {'loaded', 'relaxed'}, optional
        Whether the hardpoints are where the joints are at design with bushes that carry what the
        suspension has to carry there, or with bushes that carry nothing.

    Returns
    -------
    xarray.Dataset
        Over ``data_set`` ('kinematic', 'elastokinematic') and ``wheel_travel``: toe and camber
        [rad], half-track and wheelbase change [m], ``wheel_load``, the vertical force of the road
        [N], and ``contact_rate``, its derivative by the height of the contact [N/m]. That is not
        the ``wheel_rate`` of the characteristics, of spring and stops by the wheel centre. ``over``
        among the attributes is what `kintrafo.variation.goals` calls these curves' way: 'travel'.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a travel is out of reach, or there is no equilibrium.

    Notes
    -----
    Equilibrium of all parts at rest by Newton's method in six coordinates a part; displacements
    may be of any size. Bushes turn with the joint's first part; what resists their torsion or
    tilting is relaxed at design.

    Examples
    --------
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> found = elastokinematics(Model("reference_car"), bushes, [-0.04, 0.0, 0.04])
    >>> toe = np.rad2deg(found["toe"].sel(data_set="elastokinematic") - found["toe"][0])
    >>> (toe.values.round(3) + 0.0).tolist()
    [0.023, 0.0, -0.023]
    """
    with Arguments("elastokinematics") as given:
        given.kind("model", model, Model, Model.NEEDED)
        rack_position = given.number("rack_position", rack_position, "m")
        given.among("hardpoints", hardpoints, HARDPOINTS)
        if travel is not None:
            travel = given.array("travel", travel, "m", dimensions=[1])
        soft = soft_of(given, model, bushings, hardpoints)
    travels = usual_travel(model, rack=rack_position) if travel is None else np.asarray(travel)
    parts = [travels[begin : begin + _TOGETHER] for begin in range(0, travels.size, _TOGETHER)]
    found = []
    for some in parts:
        suspension = suspension_on(model, some, rack_position, soft)
        found.append(_over_travel(suspension, at_height(suspension, some), some))
    whole = xr.concat(found, TRAVEL.name, join="override", combine_attrs="override")
    if model.suspension.steered():
        held = xr.Variable((), rack_position, RACK.attributes())
        whole = whole.assign_coords({RACK.name: held})
    return whole.assign_attrs(
        title="elastokinematics", over="travel", hardpoints=HARDPOINTS[hardpoints]
    )


def _over_travel(suspension: Equilibrium, base: State, travels: Array) -> xr.Dataset:
    there, moved = suspension.wheels[0], on_bushes(suspension, base)
    dims = (DATA_SET, TRAVEL.name)
    data = {
        name: xr.Variable(
            dims,
            np.stack([formula(there), formula(moved)]),
            KNOWN["travel"][name].attributes(),
        )
        for name, formula in CURVES.items()
    }
    # the same parts with nothing soft
    suspensions = Equilibrium([(suspension.poses[0], Soft({}, 0.0, {}))]), suspension
    both = at_height(suspensions[0], travels), base
    nothing = np.zeros((len(travels), 1, LOADS))
    loads = np.stack([state.road[:, 0] for state in both])
    rates = np.stack(
        [one.rate(state, nothing)[:, 0, 0] for one, state in zip(suspensions, both, strict=True)]
    )
    data["wheel_load"] = variable(dims, loads, "wheel load", "N")
    data[CONTACT_RATE.name] = xr.Variable(dims, rates, CONTACT_RATE.attributes())
    coordinates = {
        DATA_SET: ["kinematic", "elastokinematic"],
        TRAVEL.name: xr.Variable(TRAVEL.name, travels, TRAVEL.attributes()),
    }
    return xr.Dataset(data, coordinates)
