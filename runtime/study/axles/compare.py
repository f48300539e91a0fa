"""Several axles side by side over one motion of a rig, as `kintrafo.compare` has suspensions."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ...assembly import motions
from ...assembly.motions import MOTIONS
from ...assembly.rig import Extent
from ...core.arguments import Arguments
from ...core.errors import InputError
from ...suspension.axle import Axle
from ...suspension.corner import Array
from ..characteristics.datasets import DATA_SET
from .datasets import bump, roll, single, steer


def over(
    axle: Axle,
    motion: str,
    extent: Extent | None = None,
    *,
    rack: float = 0.0,
    travel: float = 0.0,
) -> xr.Dataset:
    """Return the characteristics over a motion by its name.

    Parameters
    ----------
    axle : Axle
    motion : str
        Of `MOTIONS`.
    extent : Extent, optional
        How far it goes, where that is not the usual.
    rack : float, optional
        Displacement of the rack, but for 'steer' [m].
    travel : float, optional
        Height of both wheel centres above design, for 'steer' [m].

    Returns
    -------
    xarray.Dataset
    """
    with Arguments("axles") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        given.among("motion", motion, MOTIONS)
        far = Extent() if extent is None else given.kind("extent", extent, Extent, "an Extent")
    return _curves(axle, motion, _positions([axle], motion, far), rack=rack, travel=travel)


def compare(axles: Mapping[str, Axle], *, over: str = "bump") -> xr.Dataset:
    """Return the characteristics of several axles over the same positions.

    Parameters
    ----------
    axles : mapping of str to Axle
        Two or more, by the names that stand beside their curves.
    over : str, optional
        The motion, of `MOTIONS`; as far as all of them go.

    Returns
    -------
    xarray.Dataset
        As over one axle, with the further dimension ``data_set``; what not all have is left out.
        `kintrafo.compare.differences` takes it.
    """
    with Arguments("compare") as given:
        given.by_name("axles", axles, "axles", Axle, Axle.NEEDED)
        given.among("over", over, MOTIONS)
    if len(axles) < 2:
        problem = f"{len(axles)} axle; two or more are needed for a comparison."
        raise InputError([problem], "compare")
    positions = _positions(list(axles.values()), over, Extent())
    found = [_curves(axle, over, positions) for axle in axles.values()]
    common = [name for name in found[0] if all(name in dataset for dataset in found)]
    names = xr.Variable(DATA_SET, list(axles), {"long_name": "data set"})
    return xr.concat(
        [dataset[common] for dataset in found],
        names,
        coords="minimal",
        compat="override",
        combine_attrs="override",
    )


def _positions(axles: list[Axle], motion: str, extent: Extent) -> tuple[str, Array]:
    """Return what varies over a motion, and the usual positions that all axles reach."""
    if motion == "steer":
        angles = [motions.steering_angles(axle, extent) for axle in axles]
        known = [found for found in angles if found is not None]
        if len(known) == len(axles):
            return "angle", _common(known)
        return "rack", _common([motions.racks(axle, extent) for axle in axles])
    if motion == "roll":
        return "angle", _common([motions.rolls(axle, extent) for axle in axles])
    sides = (motion,) if motion in ("left", "right") else ("left", "right")
    return "travel", _common([motions.travels(axle, extent, sides) for axle in axles])


def _common(grids: list[Array]) -> Array:
    """Return the positions of the first grid that all of them have within, with the nearest end."""
    low, high = max(found[0] for found in grids), min(found[-1] for found in grids)
    first = grids[0]
    return np.union1d(first[(first > low) & (first < high)], [low, high])


def _curves(
    axle: Axle, motion: str, positions: tuple[str, Array], *, rack: float = 0.0, travel: float = 0.0
) -> xr.Dataset:
    name, values = positions
    if motion == "steer":
        return steer(axle, **{name: values}, travel=travel)
    if motion == "roll":
        return roll(axle, values, rack_position=rack)
    if motion == "bump":
        return bump(axle, values, rack_position=rack)
    return single(axle, values, side=motion, rack_position=rack)
