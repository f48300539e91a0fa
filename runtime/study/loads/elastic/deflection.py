"""How far a wheel gives way under loads of any size, beside what first order tells."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ....core.arguments import Arguments
from ....core.errors import InputError
from ....core.quantities import attributes, variable
from ....suspension.corner import Corner
from ....suspension.model import Model
from ...characteristics import wheel
from ...compare import DATA_SET
from ..compliance import RIG_LOADS, RigLoad, compliance, load_at_contact, sense_of
from ..flexibility import HELD, Held
from ..poses import CENTER, CONTACT, Poses
from .equilibrium import Equilibrium, State
from .held import HARDPOINTS, Hardpoints, at_height, gives_way, soft_of, suspension_on

Array = NDArray[np.float64]

LOAD = "load"
"""The dimension: how great the load is."""

_MEANINGS = {
    "toe": ("change of toe angle, positive toe-in", "rad"),
    "camber": ("change of camber, positive with the top outboard", "rad"),
    "displacement": ("displacement in the direction of the force", "m"),
}
_BY_NAME = {load.name: load for load in RIG_LOADS}
_GREATEST = 1e6
# A part of a load that is a step too small to go on with.
_LEAST_STEP = 1e-3


def deflection(
    model: Model,
    bushings: Mapping[str, Any] | None,
    under: str,
    amounts: ArrayLike,
    *,
    travel: float = 0.0,
    rack_position: float = 0.0,
    held: Held = "height",
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return how far the wheel gives way under loads of any size.

    Parameters
    ----------
    model : Model
    bushings : mapping or None
        As of `elastokinematics`; None: those of the file.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        A lateral force inward or a braking force at the contact, a rearward force at the wheel
        centre, or a torque about the vertical towards toe-out.
    amounts : array_like, shape (n,)
        How great the load is, of either sign [N], [N m].
    travel, rack_position : float, optional
        Where the suspension is before [m], see `elastokinematics`.
    held : {'height', 'spring', 'locked'}, optional
        What holds the wheel, see `compliance`.
    hardpoints : {'loaded', 'relaxed'}, optional
        See `elastokinematics`.

    Returns
    -------
    xarray.Dataset
        Over ``data_set`` ('equilibrium', 'linear') and ``load``: ``toe_change`` and
        ``camber_change`` [rad], and ``displacement`` in the direction of a force [m], all against
        what is there without the load; and ``wheel_load`` [N]. The linear ones are those of
        `compliance`.

    Raises
    ------
    InputError
        If an argument cannot be used, or there is no equilibrium, or one only with damper or strut
        beyond a length that the file allows.
    PositionError
        If the travel is out of reach.

    Notes
    -----
    As of `elastokinematics`; forces act at the lowest point of the wheel, wherever it goes, in
    directions that stay: those of the tyre with rigid joints, without the load. The displacement is
    that of the point of the wheel that was lowest there, or of its centre.

    `compliance` leaves out that bushes carry the static load in turned directions; with relaxed
    bushes and no static load, both agree as the load goes to zero, and differ by a part in
    proportion to it.

    Examples
    --------
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> found = deflection(Model("reference_car"), bushes, "lateral", [0.0, 1000.0, 5000.0])
    >>> np.rad2deg(found["toe_change"]).sel(data_set="equilibrium").values.round(3).tolist()
    [0.0, 0.066, 0.333]
    """
    with Arguments("deflection") as given:
        given.kind("model", model, Model, Model.NEEDED)
        given.among("under", under, _BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        travel = given.number("travel", travel, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        wanted = given.array("amounts", amounts, "N or N m", dimensions=[1])
        if not (np.abs(wanted) <= _GREATEST).all():
            given.refuse(f"amounts: numbers of {_GREATEST:g} N or N m or less are needed.")
        soft = soft_of(given, model, bushings, hardpoints)
    load = _BY_NAME[under]
    suspension, there = suspension_on(model, np.array([travel]), rack_position, soft)
    base = at_height(suspension, np.array([travel]))
    states = _under(suspension, base, _unit(load, suspension.poses, there), held, load, wanted)
    _refuse_beyond(suspension, states, load, wanted)
    linear = None
    if gives_way(soft):
        linear = compliance(model, bushings, [travel], rack_position=rack_position, held=held)
    found = _over_load(suspension, there, base, states, (load, wanted, linear))
    return found.assign_attrs(
        title=f"deflection under {load.words}", held=HELD[held], hardpoints=HARDPOINTS[hardpoints]
    )


def _unit(load: RigLoad, poses: Poses, there: Corner) -> Array:
    """Return a load of 1 N or 1 N m as an equilibrium takes it, (1, 9)."""
    at_contact = load_at_contact(load, poses, there)
    force, still = at_contact[:, :3], np.zeros((len(at_contact), 3))
    if load.at == CENTER:
        return np.concatenate([still, still, force], axis=1)
    return np.concatenate([at_contact, still], axis=1)


def _under(
    suspension: Equilibrium, base: State, unit: Array, held: Held, load: RigLoad, wanted: Array
) -> list[State]:
    """Return the equilibria under some amounts of a load, each found from a smaller one."""
    found: dict[float, State] = {}
    for sense in (1.0, -1.0):
        state, at = base, 0.0
        for amount in sorted({a for a in wanted.tolist() if sense * a >= 0.0}, key=abs):
            state = _towards(suspension, state, (at, amount), unit, held, load)
            at, found[amount] = amount, state
    return [found[amount] for amount in wanted.tolist()]


def _towards(
    suspension: Equilibrium,
    state: State,
    amounts: tuple[float, float],
    unit: Array,
    held: Held,
    load: RigLoad,
) -> State:
    """Return the equilibrium under a load from that under another one, by steps if need be."""
    begin, end = amounts
    while True:
        step = end
        while not (there := suspension.under(step * unit, held, state)).found.all():
            if abs(step - begin) <= _LEAST_STEP * abs(end):
                problem = (
                    f"no equilibrium that lasts was found under {load.words} of more than "
                    f"{begin:.4g} {load.unit}: the bushes do not hold the linkage. Leave greater "
                    "ones out, or make the bushes stiffer."
                )
                raise InputError([problem], "deflection")
            step = 0.5 * (begin + step)
        state, begin = there, step
        if step == end:
            return state


def _refuse_beyond(
    suspension: Equilibrium, states: list[State], load: RigLoad, wanted: Array
) -> None:
    """Refuse loads that bring damper or strut beyond a length that the file allows."""
    for which in np.argsort(np.abs(wanted), kind="stable"):
        if words := suspension.beyond(states[which]):
            problem = (
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {words[0]}. Leave greater "
                "ones out, or give the file stops that hold it before."
            )
            raise InputError([problem], "deflection")


# -- results --------------------------------------------------------------------------------------


def _over_load(
    suspension: Equilibrium,
    there: Corner,
    base: State,
    states: list[State],
    beside: tuple[RigLoad, Array, xr.Dataset | None],
) -> xr.Dataset:
    load, amounts, linear = beside
    before = replace(
        there, center=suspension.center(base.places), axis=suspension.axis(base.places)
    )
    point = suspension.contact(base.places) if load.at == CONTACT else before.center
    along = sense_of(load, suspension.poses, there)
    found: dict[str, list[Array]] = {"toe": [], "camber": [], "displacement": []}
    for state in states:
        after = replace(before, axis=suspension.axis(state.places))
        found["toe"].append(wheel.toe(after) - wheel.toe(before))
        found["camber"].append(wheel.camber(after) - wheel.camber(before))
        shift = suspension.moved(point, base.places, state.places)
        found["displacement"].append((along * shift).sum(axis=-1))
    data = {}
    for name, values in found.items():
        by_one = f"{name}_by_{load.name}"
        if name != "displacement" or load.where:
            straight = (0.0 if linear is None else float(linear[by_one][0])) * amounts
            both = np.stack([np.concatenate(values), straight])
            key = name if name == "displacement" else f"{name}_change"
            data[key] = variable((DATA_SET, LOAD), both, *_MEANINGS[name])
    road = np.concatenate([state.road for state in states])
    data["wheel_load"] = variable(LOAD, road, "wheel load", "N")
    words = load.words.partition(" ")[2]
    shown = {"display_units": "kN", "display_factor": 1e-3} if load.unit == "N" else {}
    coordinates = {
        DATA_SET: ["equilibrium", "linear"],
        LOAD: xr.Variable(LOAD, amounts, attributes(words, load.unit) | shown),
    }
    return xr.Dataset(data, coordinates)
