"""How both wheels of an axle move over the motions of a rig on their bushes, and without any."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ...assembly import motions, wheel
from ...assembly.axle_coupling import SIDES
from ...assembly.motions import MOTIONS
from ...assembly.pair import Pair
from ...assembly.quantity import RACK, ROLL, STEERING_WHEEL, TRAVEL, Quantity
from ...assembly.rig import Extent
from ...assembly.steering_wheel import rack_of
from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...core.quantities import Display, variable
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array, RoadWheel
from ..characteristics.datasets import DATA_SET, KNOWN
from ..loads.elastic.elastokinematics import CONTACT_RATE, CURVES
from ..loads.elastic.equilibrium import LOADS, Equilibrium, State
from ..loads.elastic.held import HARDPOINTS, Hardpoints, at_height, on_bushes
from .catalogue import of_side
from .on_bushes import RIGID, axle_on, levers, softs_of

_IN_ROLL = Quantity(
    "roll_stiffness_at_contacts",
    "N m/rad",
    "roll stiffness at the contacts",
    "y' K y: levers y of the contacts, held, and rates K at the contacts of bushes, springs, stops "
    "and bar, weights included; the roll stiffness of the characteristics has those of springs, "
    "stops and bar by the heights of the wheel centres",
    "positive when it resists roll",
    display=Display("N m/deg", np.pi / 180.0),
)
# So many positions at a time: their matrices take 50 MB.
_TOGETHER = 50
_KINDS = ("kinematic", "elastokinematic")
_UNITS = {"bump": "m", "roll": "rad", "left": "m", "right": "m", "steer": "rad or m"}


def elastokinematics(
    axle: Axle,
    bushings: Mapping[str, Any] | None = None,
    motion: str = "bump",
    along: ArrayLike | None = None,
    *,
    extent: Extent | None = None,
    travel: float = 0.0,
    rack_position: float = 0.0,
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return how both wheels move over a motion with rigid joints, and on their bushes.

    Parameters
    ----------
    axle : Axle
    bushings : mapping, optional
        As of `compliance`, with curves as of `kintrafo.loads.elastokinematics`.
    motion : str, optional
        Of `MOTIONS`.
    along : array_like, shape (n,), optional
        Wheel travels [m] or roll angles [rad]; for 'steer' angles of the steering wheel [rad], or
        displacements of the rack [m] where nothing says how the steering wheel moves it. By default
        the usual range. All are those with rigid joints: the road holds the contacts at the
        heights where they then are.
    extent : Extent, optional
        How far the usual range goes.
    travel : float, optional
        Height of both wheel centres above design, for 'steer' [m].
    rack_position : float, optional
        Displacement of the rack, but for 'steer' [m].
    hardpoints : {'loaded', 'relaxed'}, optional
        As of `kintrafo.loads.elastokinematics`; the anti-roll bar loads the bushes at design, too,
        if it is twisted there.

    Returns
    -------
    xarray.Dataset
        Over ``data_set`` ('kinematic', 'elastokinematic') and ``wheel_travel``, ``roll_angle``,
        ``steering_wheel_angle`` or ``rack_position``: what
        `kintrafo.loads.elastokinematics` tells of a wheel, with ``_left`` and ``_right`` at the
        end, the rate at the contact with the other wheel held; ``steer`` of both for 'steer';
        ``roll_stiffness_at_contacts`` [N m/rad], y' K y with the levers y of the contacts and the
        rates K at them; and ``bar_torque`` [N m]. ``over`` among the attributes is the motion.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a position is out of reach, or there is no equilibrium.

    Notes
    -----
    As of `deflection`, without a load. ``roll_stiffness`` of `roll` is y' K y, too, with the
    stiffness K of springs, stops and bar by the heights of the wheel centres; here that is by the
    heights of the contacts, of bushes besides, and with unsprung weights.

    Examples
    --------
    >>> from kintrafo import Axle
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> axle = Axle.load("reference_axle")
    >>> found = elastokinematics(axle, bushes, "roll", np.deg2rad([0.0, 2.0]))
    >>> (found["roll_stiffness_at_contacts"].values * np.pi / 180.0).round(1).tolist()  # N m/deg
    [[851.2, 856.2], [850.8, 856.0]]
    """
    with Arguments("elastokinematics") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        given.among("motion", motion, MOTIONS)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        far = Extent() if extent is None else given.kind("extent", extent, Extent, "an Extent")
        travel = given.number("travel", travel, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        if along is not None:
            along = given.array("along", along, _UNITS.get(motion, "m"), dimensions=[1])
        if motion == "steer" and not given.refused:
            axle.right.refuse_without_rack("the motion 'steer'")
        if motion == "steer" and rack_position:
            given.refuse("rack_position: the motion 'steer' moves the rack. Leave it out.")
        if motion != "steer" and travel:
            given.refuse("travel: it is for the motion 'steer'; others move the wheels by along.")
        softs = softs_of(given, axle, bushings, hardpoints)
    over, usual = _usual(axle, motion, far)
    values = usual if along is None else np.asarray(along)
    held = {TRAVEL: travel} if motion == "steer" else {RACK: rack_position}
    left, right, racks = _where(axle, motion, over, values, *held.values())
    found = []
    for begin in range(0, values.size, _TOGETHER):
        some = slice(begin, begin + _TOGETHER)
        pair = Pair.at(axle, left[some], right[some], racks[some])
        both = [axle_on(pair, racks[some], each) for each in (dict.fromkeys(SIDES, RIGID), softs)]
        states = [at_height(suspension, values[some], over) for suspension in both]
        further = {KNOWN["rack"]["steer"]: wheel.steer} if motion == "steer" else {}
        data = over_motion(both, states, over, further)
        if axle.halves:
            data |= _torque_of_bar(both, states, over)
        found.append(on_both(data, over, values[some]))
    whole = xr.concat(found, over.name, join="override", combine_attrs="override")
    if axle.steered():
        whole = whole.assign_coords(
            {q.name: xr.Variable((), value, q.attributes()) for q, value in held.items()}
        )
    title = f"elastokinematics: {MOTIONS[motion]}"
    return whole.assign_attrs(title=title, over=motion, hardpoints=HARDPOINTS[hardpoints])


def _usual(axle: Axle, motion: str, extent: Extent) -> tuple[Quantity, Array]:
    """Return what varies over a motion, and its usual positions."""
    if motion == "roll":
        return ROLL, motions.rolls(axle, extent)
    if motion == "steer":
        angles = motions.steering_angles(axle, extent)
        return (RACK, motions.racks(axle, extent)) if angles is None else (STEERING_WHEEL, angles)
    sides = (motion,) if motion in SIDES else SIDES
    return TRAVEL, motions.travels(axle, extent, sides)


def _where(
    axle: Axle, motion: str, over: Quantity, values: Array, held: float
) -> tuple[Array, Array, Array]:
    """Return the travels of the left and the right wheel, and displacements of the rack [m]."""
    still = np.full_like(values, held)
    if motion == "steer":
        racks = rack_of(axle, values)[0] if over is STEERING_WHEEL else values
        return still, still, racks
    if motion == "roll":
        return (*motions.opposite(axle, values, held), still)
    nothing = np.zeros_like(values)
    left = nothing if motion == RIGHT else values
    right = nothing if motion == LEFT else values
    return left, right, still


def on_both(data: Mapping[str, xr.Variable], over: Quantity, values: Array) -> xr.Dataset:
    """Return what is told with rigid joints and on bushes over some positions."""
    coordinates = {
        DATA_SET: list(_KINDS[-next(iter(data.values())).shape[0] :]),
        over.name: xr.Variable(over.name, values, over.attributes()),
    }
    return xr.Dataset(dict(data), coordinates)


def over_motion(
    both: Sequence[Equilibrium],
    states: Sequence[State],
    over: Quantity,
    further: Mapping[Quantity, Callable[[RoadWheel], Array]],
) -> dict[str, xr.Variable]:
    """Return what both wheels do with rigid joints and on bushes, and what they carry.

    Parameters
    ----------
    both : sequence of Equilibrium
        Of both wheels, the left one first: with rigid joints if that can be, and on bushes.
    states : sequence of State
        Of each.
    over : Quantity
        What varies.
    further : mapping
        Formulas of a wheel beside the usual ones.
    """
    dims = (DATA_SET, over.name)
    data: dict[str, xr.Variable] = {}
    curves: dict[Quantity, Callable[[RoadWheel], Array]]
    curves = {KNOWN["travel"][name]: formula for name, formula in CURVES.items()}
    for quantity, formula in (curves | dict(further)).items():
        for which, side in enumerate(SIDES):
            # with rigid joints, where there is such a motion
            there = [one.wheels[which] for one in both[:-1]]
            moved = on_bushes(both[-1], states[-1], which)
            told = np.stack([formula(wheel) for wheel in (*there, moved)])
            named = of_side(quantity, side)
            data[named.name] = xr.Variable(dims, told, named.attributes())
    return data | _forces(both, states, dims)


def _torque_of_bar(
    both: Sequence[Equilibrium], states: Sequence[State], over: Quantity
) -> dict[str, xr.Variable]:
    """Return the torque of the bar with rigid joints and on bushes."""
    torque = [one.torque_of_bar(state) for one, state in zip(both, states, strict=True)]
    words = "torque of the anti-roll bar, positive with the left half turned the farther"
    return {"bar_torque": variable((DATA_SET, over.name), np.stack(torque), words, "N m")}


def _forces(
    both: Sequence[Equilibrium], states: Sequence[State], dims: tuple[str, str]
) -> dict[str, xr.Variable]:
    """Return what the wheels carry, and how stiff the axle is, of two equilibria."""
    rates, stiffness = [], []
    for one, state in zip(both, states, strict=True):
        rate = one.rate(state, np.zeros((*state.road.shape, LOADS)))
        y = levers(one, state)
        rates.append(np.diagonal(rate, axis1=1, axis2=2))
        stiffness.append(np.einsum("ni,nij,nj->n", y, rate, y))
    data = {}
    for which, side in enumerate(SIDES):
        loads = np.stack([state.road[:, which] for state in states])
        data[f"wheel_load_{side}"] = variable(dims, loads, f"wheel load, {side}", "N")
    for which, side in enumerate(SIDES):
        own = np.stack([rate[:, which] for rate in rates])
        named = of_side(CONTACT_RATE, side)
        data[named.name] = xr.Variable(dims, own, named.attributes())
    data[_IN_ROLL.name] = xr.Variable(dims, np.stack(stiffness), _IN_ROLL.attributes())
    return data
