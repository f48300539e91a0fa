"""Characteristics of a rigid axle over the motions of a rig, as labelled arrays."""

from collections.abc import Container, Mapping

import numpy as np
import xarray as xr

from ...assembly.beam import Beam
from ...assembly.motions import MOTIONS as OF_ALL_AXLES
from ...assembly.motions import USUAL_ROLL, USUAL_ROLL_STEP
from ...assembly.quantity import ROLL, TRAVEL, Quantity
from ...assembly.rig import Extent
from ...assembly.usual import USUAL_TRAVEL, grid
from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.memory import positions_given
from ...core.named_types import ArrayLike
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array
from ...suspension.reach import PositionError
from ...suspension.rigid.axle import RigidAxle
from ...suspension.rigid.model import RigidAxleModel
from ..characteristics.datasets import DATA_SET
from .catalogue import MEASURES

MOTIONS = {name: words for name, words in OF_ALL_AXLES.items() if name != "steer"}
"""The motions of a rig, by name: a rigid axle is not steered."""

_TITLES = {
    "bump": "characteristics over parallel wheel travel",
    "roll": "characteristics over roll",
    "left": "characteristics over travel of the left wheel",
    "right": "characteristics over travel of the right wheel",
}
# What each wheel travels per metre of what varies; in roll it is the half track times the sine.
_SHARES = {"bump": (1.0, 1.0), "left": (1.0, 0.0), "right": (0.0, 1.0)}
_MOST_ROLL = np.pi / 4.0
# A sweep that is not told otherwise keeps clear of the ends of the motion by this part of them.
_CLEARANCE = 0.02


def bump(axle: RigidAxle, travel: ArrayLike | None = None) -> xr.Dataset:
    """Return the characteristics of a rigid axle over parallel wheel travel.

    Parameters
    ----------
    axle : RigidAxle
    travel : array_like, shape (n,), optional
        Heights of both wheel centres above design [m]; by default from -80 mm to 80 mm, or as far
        as the axle goes.

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel`` [m]. What each wheel has ends in ``_left`` and ``_right``. SI units;
        attributes as of `kintrafo.characteristics.travel`. What needs data of the vehicle that are
        not given is left out.

    Raises
    ------
    PositionError
        If a travel is out of reach; the message states the range.
    InputError
        If a value is not finite.

    Examples
    --------
    >>> from kintrafo import RigidAxle
    >>> curves = bump(RigidAxle.load("rigid_axle"), [-0.05, 0.0, 0.05])
    >>> (curves["axle_lateral"].values[[0, 2]] * 1e3).round(2).tolist()
    [-3.11, 0.2]
    """
    return _curves(axle, "bump", _given("travel", travel, "m"))


def roll(axle: RigidAxle, angle: ArrayLike | None = None) -> xr.Dataset:
    """Return the characteristics of a rigid axle over roll of the body.

    Parameters
    ----------
    axle : RigidAxle
    angle : array_like, shape (n,), optional
        Roll angles of the body to the axle, positive with the right side down [rad]; by default
        from -4 deg to 4 deg, or as far as the axle goes.

    Returns
    -------
    xarray.Dataset
        Over ``roll_angle`` [rad], otherwise as of `bump`.

    Raises
    ------
    PositionError, InputError
        As `bump`.
    """
    return _curves(axle, "roll", _given("angle", angle, "rad"))


def single(axle: RigidAxle, travel: ArrayLike | None = None, *, side: str = LEFT) -> xr.Dataset:
    """Return the characteristics of a rigid axle over the travel of one wheel, the other at design.

    Parameters
    ----------
    axle : RigidAxle
    travel : array_like, shape (n,), optional
        Heights of the wheel centre above design [m].
    side : {'left', 'right'}, optional
        Which wheel moves.

    Returns
    -------
    xarray.Dataset
        As of `bump`.

    Raises
    ------
    PositionError, InputError
        As `bump`.
    """
    with Arguments("rigid axle") as given:
        given.among("side", side, (LEFT, RIGHT))
    return _curves(axle, side, _given("travel", travel, "m"))


def over(axle: RigidAxle, motion: str, extent: Extent | None = None) -> xr.Dataset:
    """Return the characteristics of a rigid axle over a motion by its name.

    Parameters
    ----------
    axle : RigidAxle
    motion : {'bump', 'roll', 'left', 'right'}
    extent : Extent, optional
        How far it goes, where that is not the usual.

    Returns
    -------
    xarray.Dataset
    """
    with Arguments("rigid axle") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
        given.among("motion", motion, MOTIONS)
        far = Extent() if extent is None else given.kind("extent", extent, Extent, "an Extent")
    return _curves(axle, motion, usual(axle, motion, far))


def compare(axles: Mapping[str, RigidAxle], *, over: str = "bump") -> xr.Dataset:
    """Return the characteristics of several rigid axles over the same positions.

    Parameters
    ----------
    axles : mapping of str to RigidAxle
        Two or more, by the names that stand beside their curves.
    over : str, optional
        The motion; as far as all of them go.

    Returns
    -------
    xarray.Dataset
        As over one axle, with the further dimension ``data_set``; what not all have is left out.
        `kintrafo.compare.differences` takes it.
    """
    with Arguments("compare") as given:
        given.by_name("axles", axles, "rigid axles", RigidAxle, RigidAxle.NEEDED)
        given.among("over", over, MOTIONS)
    if len(axles) < 2:
        problem = f"{len(axles)} axle; two or more are needed for a comparison."
        raise InputError([problem], "compare")
    grids = [usual(axle, over, Extent()) for axle in axles.values()]
    low, high = max(found[0] for found in grids), min(found[-1] for found in grids)
    inner = grids[0][(grids[0] > low) & (grids[0] < high)]
    found = [_curves(axle, over, np.union1d(inner, [low, high])) for axle in axles.values()]
    common = [name for name in found[0] if all(name in dataset for dataset in found)]
    names = xr.Variable(DATA_SET, list(axles), {"long_name": "data set"})
    return xr.concat(
        [dataset[common] for dataset in found],
        names,
        coords="minimal",
        compat="override",
        combine_attrs="override",
    )


def usual(axle: RigidAxle, motion: str, extent: Extent) -> Array:
    """Return the usual positions of a motion that the axle reaches, zero included [m or rad]."""
    if motion == "roll":
        with Arguments("roll") as given:
            amount = 0.0 if extent.roll is None else extent.roll
            given.number("roll", amount, "rad", least=0.0, below=_MOST_ROLL)
        most = _ends(axle, motion, USUAL_ROLL) if extent.roll is None else [-amount, amount]
        both = min(-most[0], most[1])
        return grid(-both, both, USUAL_ROLL_STEP)
    with Arguments("wheel travel") as given:
        for name in ("rebound", "bump"):
            value = getattr(extent, name)
            given.number(name, 0.0 if value is None else value, "m", least=0.0)
    low, high = _ends(axle, motion, USUAL_TRAVEL)
    low = low if extent.rebound is None else -extent.rebound
    high = high if extent.bump is None else extent.bump
    return grid(low, high, extent.step)


def _ends(axle: RigidAxle, motion: str, most: float) -> list[float]:
    """Return how far a motion goes either way, at most so far and clear of its ends."""
    model = RigidAxleModel(axle, guided=axle.overheld)
    ends = []
    for value in (-most, most):
        left, right = travels_along(axle, motion, np.array(value))
        part = model.farthest(float(left), float(right))
        ends.append(value if part == 1.0 else (1.0 - _CLEARANCE) * part * value)
    return ends


def travels_along(axle: RigidAxle, motion: str, values: Array) -> tuple[Array, Array]:
    """Return the travels of the left and the right wheel along a motion [m]."""
    if motion == "roll":
        half = axle.half_track * np.sin(values)
        return -half, half
    left, right = _SHARES[motion]
    return left * values, right * values


def _given(name: str, along: ArrayLike | None, unit: str) -> Array | None:
    with Arguments("rigid axle") as given:
        return None if along is None else positions_given(given, name, along, unit)


def _curves(axle: RigidAxle, motion: str, values: Array | None) -> xr.Dataset:
    with Arguments("rigid axle") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
    along = usual(axle, motion, Extent()) if values is None else values
    over = ROLL if motion == "roll" else TRAVEL
    data = values_over(RigidAxleModel(axle), motion, along)
    coordinates = {over.name: _variable(over, over, along)}
    known = {measure.quantity.name: measure.quantity for measure in MEASURES}
    variables = {name: _variable(known[name], over, array) for name, array in data.items()}
    return xr.Dataset(variables, coordinates, {"title": _TITLES[motion]})


def values_over(
    model: RigidAxleModel, motion: str, along: Array, names: Container[str] | None = None
) -> dict[str, Array]:
    """Return the characteristics over a motion by name, all that there are or some.

    Parameters
    ----------
    model : RigidAxleModel
    motion : {'bump', 'roll', 'left', 'right'}
    along : ndarray, shape (n,)
        Wheel travels [m], or roll angles [rad].
    names : container of str, optional

    Raises
    ------
    PositionError
        If a position is out of reach.
    """
    if motion == "roll" and np.abs(along).max(initial=0.0) >= _MOST_ROLL:
        worst = np.degrees(np.abs(along).max())
        message = f"roll of {worst:.4g} deg: less than 45 deg is needed; Python's unit is rad."
        raise PositionError(message)
    beam = Beam(model, model.states_at(*travels_along(model.axle, motion, along)))
    wanted = [m for m in MEASURES if names is None or m.quantity.name in names]
    return {m.quantity.name: m.formula(beam) for m in wanted if m.known_to(model.axle)}


def _variable(quantity: Quantity, over: Quantity, values: Array) -> xr.Variable:
    return xr.Variable(over.name, values, quantity.attributes())
