"""Characteristics of an axle over the motions of a rig, as labelled arrays."""

from collections.abc import Iterable

import numpy as np
import xarray as xr

from ...assembly import motions
from ...assembly.pair import Pair
from ...assembly.quantity import RACK, ROLL, STEERING_WHEEL, TRAVEL, Quantity
from ...assembly.rig import Extent
from ...assembly.steering_wheel import rack_of
from ...assembly.wheel import steer as steer_angle
from ...assembly.wheel import steer_gradient
from ...core.arguments import Arguments
from ...core.memory import positions_given
from ...core.named_types import ArrayLike
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array
from ...suspension.positions import PositionError
from ..characteristics import axle as of_both
from ..characteristics import catalogue as of_wheels
from .catalogue import OVER_STEERING, OVER_TRAVEL, Measure

_SIDES = xr.Variable("data_set", [LEFT, RIGHT], {"long_name": "side"})


def bump(axle: Axle, travel: ArrayLike | None = None, *, rack_position: float = 0.0) -> xr.Dataset:
    """Return the characteristics over parallel wheel travel, the rack held.

    Parameters
    ----------
    axle : Axle
    travel : array_like, shape (n,), optional
        Heights of both wheel centres above design [m]; by default from -80 mm to 80 mm, or as far
        as both go.
    rack_position : float, optional
        Displacement of the rack [m].

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
        If a value is not finite, or a drop link does not reach.

    Examples
    --------
    >>> from kintrafo import Axle
    >>> curves = bump(Axle.load("reference_axle"), [-0.05, 0.0, 0.05])
    >>> (curves["roll_center_height"].values * 1e3).round(1).tolist()
    [224.8, 106.3, -18.2]
    """
    rack, travels = _checked(axle, rack_position, "travel", travel, "m")
    values = motions.travels(axle, Extent()) if travels is None else travels
    pair = Pair.at(axle, values, values, rack)
    title = "characteristics over parallel wheel travel"
    return _dataset(pair, OVER_TRAVEL, TRAVEL, values, _held(axle, rack), title)


def roll(axle: Axle, angle: ArrayLike | None = None, *, rack_position: float = 0.0) -> xr.Dataset:
    """Return the characteristics over roll of the body, the wheels moving oppositely.

    Parameters
    ----------
    axle : Axle
    angle : array_like, shape (n,), optional
        Roll angles of the body, positive with the right side down [rad]; by default from -4 deg to
        4 deg, or as far as both wheels go.
    rack_position : float, optional
        Displacement of the rack [m].

    Returns
    -------
    xarray.Dataset
        Over ``roll_angle`` [rad], otherwise as of `bump`.

    Raises
    ------
    PositionError, InputError
        As `bump`.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import Axle
    >>> curves = roll(Axle.load("reference_axle"), np.deg2rad([0.0, 2.0]))
    >>> curves["roll_stiffness"].attrs["display_units"]
    'N m/deg'
    """
    rack, angles = _checked(axle, rack_position, "angle", angle, "rad")
    values = motions.rolls(axle, Extent()) if angles is None else angles
    pair = Pair.at(axle, *motions.opposite(axle, values, rack), rack)
    title = "characteristics over roll"
    return _dataset(pair, OVER_TRAVEL, ROLL, values, _held(axle, rack), title)


def single(
    axle: Axle, travel: ArrayLike | None = None, *, side: str = LEFT, rack_position: float = 0.0
) -> xr.Dataset:
    """Return the characteristics over the travel of one wheel, the other one at design.

    Parameters
    ----------
    axle : Axle
    travel : array_like, shape (n,), optional
        Heights of the wheel centre above design [m]; by default from -80 mm to 80 mm, or as far as
        it goes.
    side : {'left', 'right'}, optional
        Which wheel moves.
    rack_position : float, optional
        Displacement of the rack [m].

    Returns
    -------
    xarray.Dataset
        As of `bump`.

    Raises
    ------
    PositionError, InputError
        As `bump`.
    """
    with Arguments("axle") as given:
        given.among("side", side, (LEFT, RIGHT))
    rack, travels = _checked(axle, rack_position, "travel", travel, "m")
    values = motions.travels(axle, Extent(), (side,)) if travels is None else travels
    both = {side: values, (RIGHT if side == LEFT else LEFT): np.zeros_like(values)}
    pair = Pair.at(axle, both[LEFT], both[RIGHT], rack)
    title = f"characteristics over travel of the {side} wheel"
    return _dataset(pair, OVER_TRAVEL, TRAVEL, values, _held(axle, rack), title)


def steer(
    axle: Axle,
    angle: ArrayLike | None = None,
    *,
    rack: ArrayLike | None = None,
    travel: float = 0.0,
) -> xr.Dataset:
    """Return the characteristics over the steering wheel, or over the rack.

    Parameters
    ----------
    axle : Axle
    angle : array_like, shape (n,), optional
        Angles of the steering wheel, positive to the left [rad].
    rack : array_like, shape (n,), optional
        Displacements of the rack instead [m]. By default the steering wheel turns, if the files say
        how it moves the rack, and the rack moves by 60 mm to either side, or as far as it goes.
    travel : float, optional
        Height of both wheel centres above design [m].

    Returns
    -------
    xarray.Dataset
        Over ``steering_wheel_angle`` [rad] or ``rack_position`` [m], otherwise as of `bump`.

    Raises
    ------
    PositionError, InputError
        As `bump`; also if an angle is beyond the curve, or nothing says how the angle moves the
        rack.
    """
    with Arguments("axle") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        travel = given.number("travel", travel, "m")
        if not given.refused:
            axle.right.refuse_without_rack("the motion 'steer'")
        if angle is not None and rack is not None:
            given.refuse("angle and rack are both given. Give one of them.")
        angles = None if angle is None else positions_given(given, "angle", angle, "rad")
        racks = None if rack is None else positions_given(given, "rack", rack, "m")
        if not given.refused and angles is not None:
            _refuse_angles(given, axle, angles)
    if angles is None and racks is None:
        angles = motions.steering_angles(axle, Extent())
        racks = motions.racks(axle, Extent()) if angles is None else None
    title = "characteristics over steering"
    if angles is None:
        assert racks is not None
        found = Pair.at(axle, travel, travel, racks)
        dataset = _dataset(found, OVER_STEERING, RACK, racks, {TRAVEL: travel}, title)
        return dataset.assign(_variables(_of_both(found, None), RACK))
    positions, per_turn = rack_of(axle, angles)
    found = Pair.at(axle, travel, travel, positions)
    held = {TRAVEL: travel}
    dataset = _dataset(found, OVER_STEERING, STEERING_WHEEL, angles, held, title)
    dataset = dataset.assign(_variables({RACK: positions}, STEERING_WHEEL))
    return dataset.assign(_variables(_of_both(found, per_turn), STEERING_WHEEL))


def by_side(dataset: xr.Dataset) -> xr.Dataset:
    """Return a dataset in which the two wheels are a dimension, as they are drawn.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `bump`, `roll`, `single` or `steer`.

    Returns
    -------
    xarray.Dataset
        Where there are ``camber_left`` and ``camber_right`` there is ``camber`` over ``data_set``,
        left and right.
    """
    with Arguments("axle") as given:
        given.dataset(dataset)
    return by_ends(dataset, "{stem}_{side}")


def by_ends(dataset: xr.Dataset, pattern: str) -> xr.Dataset:
    """Return a dataset in which variables are together whose names differ by the side."""
    together: dict[str, xr.DataArray] = {}
    for name, data in dataset.items():
        stem = next((s for side in _SIDES.values if (s := _stem(str(name), side, pattern))), "")
        sides = [pattern.format(stem=stem, side=side) for side in _SIDES.values]
        if not stem or not all(side in dataset for side in sides):
            together[str(name)] = data
        elif stem not in together:
            words = str(data.attrs["long_name"]).removesuffix(f", {LEFT}")
            words = words.removesuffix(f", {RIGHT}")
            both = xr.concat([dataset[side] for side in sides], _SIDES, combine_attrs="override")
            together[stem] = both.assign_attrs(long_name=words)
    return xr.Dataset(together, attrs=dataset.attrs)


def _stem(name: str, side: str, pattern: str) -> str:
    """Return a name without its side; empty if it has not this one."""
    before, after = pattern.format(stem="\0", side=side).split("\0")
    if name.startswith(before) and name.endswith(after):
        return name[len(before) : len(name) - len(after)]
    return ""


def _checked(
    axle: Axle, rack_position: float, name: str, along: ArrayLike | None, unit: str
) -> tuple[float, Array | None]:
    with Arguments("axle") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        rack = given.number("rack_position", rack_position, "m")
        if along is None:
            return rack, None
        return rack, positions_given(given, name, along, unit)


def _held(axle: Axle, rack: float) -> dict[Quantity, float]:
    """Return where the rack is held, if there is one."""
    return {RACK: rack} if axle.steered() else {}


def _refuse_angles(given: Arguments, axle: Axle, angles: Array) -> None:
    if axle.steering is None and motions.travel_per_turn(axle) is None:
        given.refuse(
            "angle: nothing says how the steering wheel moves the rack. Give [rack] "
            "travel_per_turn_mm in the hardpoint file, or [steering] in the axle's; or give rack."
        )
    elif axle.steering is not None:
        problem = axle.steering.beyond(angles)
        if problem:
            given.refuse(problem)


def _of_both(pair: Pair, per_turn: Array | None) -> dict[Quantity, Array]:
    """Return what both wheels decide together when they are steered."""
    left, right = pair.corners[LEFT], pair.corners[RIGHT]
    angles = steer_angle(left), steer_angle(right)
    values: dict[str, Array] = {}
    if left.vehicle.wheelbase is not None and pair.axle.end == "front":
        track, static = motions.track(pair.axle), _straight_ahead(pair)
        one, other = angles[0] - static[LEFT], angles[1] - static[RIGHT]
        values |= of_both.of_wheels(one, other, left.vehicle.wheelbase, track)
    if per_turn is not None:
        gradients = steer_gradient(left), steer_gradient(right)
        values["steering_ratio"] = of_both.steering_ratio(*gradients, np.abs(per_turn))
    return {of_wheels.AXLE[name]: array for name, array in values.items()}


def _straight_ahead(pair: Pair) -> dict[str, Array | float]:
    """Return the steer angles of both wheels with the rack in its middle, NaN where it is not."""
    try:
        middle = Pair.at(pair.axle, pair.travel[LEFT][:1], pair.travel[RIGHT][:1], 0.0)
    except PositionError:
        return {LEFT: np.nan, RIGHT: np.nan}
    return {side: steer_angle(middle.corners[side]) for side in (LEFT, RIGHT)}


def _dataset(
    pair: Pair,
    measures: Iterable[Measure],
    over: Quantity,
    along: Array,
    held: dict[Quantity, float],
    title: str,
) -> xr.Dataset:
    coordinates = {over.name: xr.Variable(over.name, along, over.attributes())}
    for quantity, value in held.items():
        coordinates[quantity.name] = xr.Variable((), float(value), quantity.attributes())
    data = {m.quantity: m.formula(pair) for m in measures if m.has_all(pair.axle)}
    return xr.Dataset(_variables(data, over), coordinates, {"title": title})


def _variables(data: dict[Quantity, Array], over: Quantity) -> dict[str, xr.Variable]:
    return {
        quantity.name: xr.Variable(over.name, values, quantity.attributes())
        for quantity, values in data.items()
    }
