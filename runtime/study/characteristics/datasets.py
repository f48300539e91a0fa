"""Characteristics over wheel travel and over rack travel, as labelled arrays."""

from collections.abc import Container, Iterable

import numpy as np
import xarray as xr

from ...assembly.from_model import corner
from ...assembly.quantity import RACK, TRAVEL, Quantity
from ...assembly.usual import usual_rack, usual_travel
from ...assembly.wheel import steer, steer_gradient, toe
from ...core.arguments import Arguments
from ...core.memory import positions_given
from ...core.named_types import ArrayLike
from ...suspension.corner import Array, Corner
from ...suspension.kinds import Suspension
from ...suspension.model import Model
from ...suspension.positions import PositionError, arm_angles, design_height
from . import axle, catalogue

DATA_SET = "data_set"
"""The dimension of several sets of curves beside each other."""

ALONG = {"travel": TRAVEL, "rack": RACK}
"""What varies along the curves."""

KNOWN: dict[str, dict[str, Quantity]] = {
    "travel": {q.name: q for q in catalogue.CORNER + catalogue.TRAVEL},
    "rack": {q.name: q for q in (*catalogue.CORNER, *catalogue.STEERING, *catalogue.AXLE.values())},
}
"""Characteristics by name, over wheel travel and over the rack."""


_OF_STEERING = {
    q.name
    for known in KNOWN.values()
    for q in known.values()
    if "steered" in q.needs or q.name not in KNOWN["travel"]
}


def refuse_of_steering(suspension: Suspension, names: Iterable[str]) -> None:
    """Refuse characteristics that have no meaning for a wheel that nothing steers.

    Parameters
    ----------
    suspension : Suspension
    names : iterable of str
        What somebody asked for; names that nothing has are left to others.

    Raises
    ------
    InputError
        If it has no rack and one of them needs it.
    """
    for name in names:
        if isinstance(name, str) and name in _OF_STEERING:
            suspension.refuse_without_rack(name)


def travel(
    model: Model, travel: ArrayLike | None = None, *, rack_position: float = 0.0
) -> xr.Dataset:
    """Return the characteristics over wheel travel, the rack held.

    Parameters
    ----------
    model : Model
    travel : array_like, shape (n,), optional
        Heights of the wheel centre above its design height [m]; by default from -80 mm to 80 mm,
        or as far as the suspension goes.
    rack_position : float, optional
        Displacement of the rack [m].

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel`` [m]. SI units; each variable carries ``units``, ``long_name``,
        ``definition``, ``sign`` and the unit for people as ``display_units`` and
        ``display_factor``. What needs data of the vehicle that are not given is left out.

    Raises
    ------
    PositionError
        If a travel is out of reach; the message states the range.
    InputError
        If a value is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> curves = travel(Model("reference_car"), [-0.05, 0.05])
    >>> np.rad2deg(curves["camber"].values).round(4).tolist()
    [1.3246, -0.9139]
    >>> curves["motion_ratio"].attrs["definition"]
    'compression of the spring per wheel travel; some programs print the inverse'
    """
    with Arguments("characteristics") as given:
        given.kind("model", model, Model, Model.NEEDED)
        rack_position = given.number("rack_position", rack_position, "m")
        if travel is not None:
            travel = positions_given(given, "travel", travel, "m")
    travels = usual_travel(model, rack=rack_position) if travel is None else travel
    data = over_travel(model, travels, rack_position)
    held = {RACK: rack_position} if model.suspension.steered() else {}
    return _dataset(data, TRAVEL, travels, held)


def steering(model: Model, rack: ArrayLike | None = None, *, travel: float = 0.0) -> xr.Dataset:
    """Return the characteristics over rack travel, the wheel centre held at its height.

    Both wheels have the same height; the other side of the vehicle is the mirror image.

    Parameters
    ----------
    model : Model
    rack : array_like, shape (n,), optional
        Displacements of the rack [m]; by default from -60 mm to 60 mm, or as far as the steering
        goes.
    travel : float, optional
        Height of the wheel centre above its design height [m].

    Returns
    -------
    xarray.Dataset
        Over ``rack_position`` [m], otherwise as of `kintrafo.characteristics.travel`.

    Raises
    ------
    PositionError
        If a position is out of reach; the message states the range.
    InputError
        If a value is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> curves = steering(Model("reference_car"), [-0.04, 0.04])
    >>> np.rad2deg(curves["steer_left"].values).round(3).tolist()
    [18.174, -17.836]
    """
    with Arguments("characteristics") as given:
        given.kind("model", model, Model, Model.NEEDED)
        travel = given.number("travel", travel, "m")
        if rack is not None:
            rack = positions_given(given, "rack", rack, "m")
    racks = usual_rack(model, travel=travel) if rack is None else rack
    return _dataset(over_rack(model, racks, travel), RACK, racks, {TRAVEL: travel})


def over_travel(
    model: Model, travels: Array, rack_position: float = 0.0, names: Container[str] | None = None
) -> dict[Quantity, Array]:
    """Return characteristics over wheel travel without labels, all or some; see `travel`."""
    angles = arm_angles(model, design_height(model) + travels, rack_position)
    return of_corner_over_travel(corner(model, angles, rack_position), names)


def over_rack(
    model: Model, racks: Array, travel: float = 0.0, names: Container[str] | None = None
) -> dict[Quantity, Array]:
    """Return characteristics over rack travel without labels, all or some; see `steering`."""
    model.suspension.refuse_without_rack("characteristics over the rack")
    own = _at_height(model, travel, racks)
    found = of_corner_over_rack(own, names)
    if needs_both_sides(names):
        other = _at_height(model.mirror_image, travel, racks)
        found |= of_both_sides(own, other, _straight_ahead(model, travel))
    return found


def of_corner_over_travel(
    found: Corner, names: Container[str] | None = None
) -> dict[Quantity, Array]:
    """Return characteristics over wheel travel of a corner, all or some."""
    return _evaluated(_chosen(catalogue.CORNER + catalogue.TRAVEL, names), found)


def of_corner_over_rack(
    found: Corner, names: Container[str] | None = None
) -> dict[Quantity, Array]:
    """Return characteristics over the rack of a corner by itself, all or some."""
    return _evaluated(_chosen(catalogue.CORNER + catalogue.STEERING, names), found)


def needs_both_sides(names: Container[str] | None) -> bool:
    """Tell whether some characteristics are about both wheels of an axle."""
    return bool(_chosen(catalogue.AXLE.values(), names))


def _chosen(quantities: Iterable[Quantity], names: Container[str] | None) -> tuple[Quantity, ...]:
    return tuple(q for q in quantities if names is None or q.name in names)


def _at_height(model: Model, travel: float, racks: Array) -> Corner:
    return corner(model, arm_angles(model, design_height(model) + travel, racks), racks)


def _evaluated(quantities: Iterable[Quantity], found: Corner) -> dict[Quantity, Array]:
    return {
        quantity: quantity.formula(found)
        for quantity in quantities
        if quantity.formula is not None and quantity.known_to(found.vehicle)
    }


def _straight_ahead(model: Model, travel: float) -> Corner | None:
    """Return the corner with the rack in its middle, if it can be there."""
    try:
        return _at_height(model, travel, np.zeros(1))
    except PositionError:
        return None


def of_both_sides(own: Corner, other: Corner, straight: Corner | None) -> dict[Quantity, Array]:
    """Return what both wheels decide, as far as the vehicle is known.

    Parameters
    ----------
    own, other : Corner
        Over the rack; the other one is the mirror image.
    straight : Corner or None
        The own one with the rack in its middle, at the same height. Without it nothing is known of
        what compares the wheels (NaN).
    """
    left, right = (own, other) if own.vehicle.side > 0.0 else (other, own)
    angles = steer(left), steer(right)
    values = {"steer_left": angles[0], "steer_right": angles[1]}
    wheelbase, per_turn = own.vehicle.wheelbase, own.vehicle.travel_per_turn
    if wheelbase is not None:
        track = 2.0 * abs(own.design_center[..., 1])
        # toe-in steers the left wheel to the right, and the right one to the left
        static = np.nan if straight is None else toe(straight)
        values |= axle.of_wheels(angles[0] + static, angles[1] - static, wheelbase, track)
    if per_turn is not None:
        gradients = steer_gradient(left), steer_gradient(right)
        values["steering_ratio"] = axle.steering_ratio(*gradients, per_turn)
    return {catalogue.AXLE[name]: array for name, array in values.items()}


def _dataset(
    data: dict[Quantity, Array], over: Quantity, along: Array, held: dict[Quantity, float]
) -> xr.Dataset:
    coordinates = {over.name: xr.Variable(over.name, along, over.attributes())}
    for quantity, value in held.items():
        coordinates[quantity.name] = xr.Variable((), float(value), quantity.attributes())
    variables = {
        quantity.name: xr.Variable(over.name, values, quantity.attributes())
        for quantity, values in data.items()
    }
    return xr.Dataset(variables, coordinates, {"title": f"characteristics over {over.long_name}"})
