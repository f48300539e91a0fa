"""How a rigid axle moves over the motions of a rig on its bushes, and without any."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from ...assembly.quantity import ROLL, TRAVEL, Quantity
from ...assembly.rig import Extent
from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...suspension.rigid.axle import RigidAxle
from ..axles.elastokinematics import on_both, over_motion
from ..characteristics.datasets import DATA_SET
from ..loads.elastic.held import HARDPOINTS, Hardpoints, at_height
from .catalogue import MEASURES
from .datasets import MOTIONS, travels_along, usual
from .on_bushes import RIGID, axle_on, guided, parts_at, place_of, soft_of, torque_of_bar

# So many positions at a time: their matrices take 50 MB.
_TOGETHER = 50
_UNITS = {"bump": "m", "roll": "rad", "left": "m", "right": "m"}
_KNOWN = {measure.quantity.name: measure.quantity for measure in MEASURES}


def elastokinematics(
    axle: RigidAxle,
    bushings: Mapping[str, Any] | None = None,
    motion: str = "bump",
    along: ArrayLike | None = None,
    *,
    extent: Extent | None = None,
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return how a rigid axle moves over a motion with rigid joints, and on its bushes.

    Parameters
    ----------
    axle : RigidAxle
    bushings : mapping, optional
        As of `compliance`, with curves as of `kintrafo.loads.elastokinematics`.
    motion : str, optional
        Of `MOTIONS`.
    along : array_like, shape (n,), optional
        Wheel travels [m] or roll angles [rad], by default the usual range. All are those with rigid
        joints: the road holds the contacts at the heights where they then are.
    extent : Extent, optional
        How far the usual range goes.
    hardpoints : {'loaded', 'relaxed'}, optional
        As of `kintrafo.loads.elastokinematics`.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.axles.elastokinematics`; and ``axle_steer`` [rad], ``axle_lateral`` and
        ``axle_longitudinal`` [m] as of `bump`, of the line through the wheel centres. Of an axle on
        five rods there are the curves on the bushes alone.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a position is out of reach, or there is no equilibrium.

    Examples
    --------
    >>> soft = {"axial_N_per_mm": 800.0, "radial_N_per_mm": 800.0}
    >>> bushes = {f"{side}_link_chassis": soft for side in ("left", "right")}
    >>> found = elastokinematics(RigidAxle.load("rigid_axle"), bushes, "roll", [0.0, 0.05])
    >>> np.rad2deg(found["axle_steer"][:, 1]).values.round(3).tolist()
    [0.076, 0.068]
    """
    with Arguments("elastokinematics") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
        given.among("motion", motion, MOTIONS)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        far = Extent() if extent is None else given.kind("extent", extent, Extent, "an Extent")
        if along is not None:
            along = given.array("along", along, _UNITS.get(motion, "m"), dimensions=[1])
        soft = soft_of(given, axle, bushings, hardpoints)
    over = ROLL if motion == "roll" else TRAVEL
    values = usual(axle, motion, far) if along is None else np.asarray(along)
    model, found = guided(axle), []
    # five rigid rods would not let it move
    softs = [soft] if axle.overheld else [RIGID, soft]
    for begin in range(0, values.size, _TOGETHER):
        some = values[begin : begin + _TOGETHER]
        parts = parts_at(model, *travels_along(axle, motion, some))
        both = [axle_on(parts, each) for each in softs]
        states = [at_height(suspension, some, over) for suspension in both]
        dims = (DATA_SET, over.name)
        data = over_motion(both, states, over, {})
        places = [place_of(one, state) for one, state in zip(both, states, strict=True)]
        for name in places[0]:
            each = np.stack([place[name] for place in places])
            data[name] = _variable(_KNOWN[name], dims, each)
        if axle.anti_roll_bar is not None:
            data["bar_torque"] = torque_of_bar(both, states, dims)
        found.append(on_both(data, over, some))
    whole = xr.concat(found, over.name, join="override", combine_attrs="override")
    title = f"elastokinematics: {MOTIONS[motion]}"
    return whole.assign_attrs(title=title, over=motion, hardpoints=HARDPOINTS[hardpoints])


def _variable(quantity: Quantity, dims: tuple[str, str], values: Any) -> xr.Variable:
    return xr.Variable(dims, values, quantity.attributes())
