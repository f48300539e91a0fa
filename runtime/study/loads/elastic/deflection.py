"""How far a wheel gives way under loads of any size, beside what first order tells."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ....assembly import wheel
from ....assembly.poses import CENTER, CONTACT
from ....core.arguments import Arguments
from ....core.named_types import ArrayLike
from ....core.quantities import attributes, variable
from ....suspension.corner import RoadWheel
from ....suspension.model import Model
from ....suspension.reach import PositionError
from ...characteristics.datasets import DATA_SET
from ..compliance import (
    RIG_LOADS,
    RigLoad,
    compliance,
    give_of_tyre,
    load_at_contact,
    sense_of,
)
from ..flexibility import HELD, Held, refuse_without_rate
from .equilibrium import Equilibrium, State
from .held import (
    HARDPOINTS,
    Hardpoints,
    at_height,
    gives_way,
    on_bushes,
    soft_of,
    suspension_on,
)

Array = NDArray[np.float64]

LOAD = "load"
"""The dimension: how great the load is."""

_MEANINGS = {
    "toe": ("change of toe angle, positive toe-in", "rad"),
    "camber": ("change of camber, positive with the top outboard", "rad"),
    "displacement": ("displacement in the direction of the force", "m"),
    "patch_displacement": ("displacement of the contact patch in the direction of the force", "m"),
}
BY_NAME = {load.name: load for load in RIG_LOADS}
_GREATEST = 1e6
# A tyre slides before it gives way so far [m].
_FARTHEST_TYRE = 0.2
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
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        What holds the wheel, see `compliance`; ``tyre``: on a road that stays where the tyre
        carries the wheel without the load.
    hardpoints : {'loaded', 'relaxed'}, optional
        See `elastokinematics`.

    Returns
    -------
    xarray.Dataset
        Over ``data_set`` ('equilibrium', 'linear') and ``load``: ``toe_change`` and
        ``camber_change`` [rad], and ``displacement`` in the direction of a force [m], all against
        what is there without the load; ``patch_displacement`` on the standing tyre where the file
        has its rate, see `compliance`; and ``wheel_load`` [N]. The linear ones are those of
        `compliance`.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If the travel is out of reach, or there is no equilibrium, or one only with damper or strut
        beyond a length that the file allows, or with a bush that deflects by more than 100 mm, or
        a tyre by more than 200 mm.

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
        given.among("under", under, BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        travel = given.number("travel", travel, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        wanted = amounts_of(given, amounts)
        soft = soft_of(given, model, bushings, hardpoints)
        if not given.refused:
            refuse_without_rate(given, held, model.suspension.tyre)
    load = BY_NAME[under]
    suspension = suspension_on(model, np.array([travel]), rack_position, soft)
    base = at_height(suspension, np.array([travel]))
    unit = unit_load(load, suspension.wheels[0])[:, None]
    states = under_amounts(suspension, base, unit, held, load, wanted)
    changed = changes(suspension, base, states, load, wanted)
    straight = {kind: np.zeros_like(wanted) for kind in changed}
    if gives_way(soft):
        linear = compliance(model, bushings, [travel], rack_position=rack_position, held=held)
        straight = {k: float(linear[f"{k}_by_{load.name}"][0]) * wanted for k in changed}
    data = beside(changed, straight)
    road = np.concatenate([state.road[:, 0] for state in states])
    data["wheel_load"] = variable(LOAD, road, "wheel load", "N")
    how = {"held": HELD[held], "hardpoints": HARDPOINTS[hardpoints]}
    title = f"deflection under {load.words}"
    return xr.Dataset(data, coordinates_of(load, wanted), {"title": title} | how)


def amounts_of(given: Arguments, amounts: ArrayLike) -> Array:
    """Read how great a load is."""
    wanted = given.array("amounts", amounts, "N or N m", dimensions=[1])
    if not (np.abs(wanted) <= _GREATEST).all():
        given.refuse(f"amounts: numbers of {_GREATEST:g} N or N m or less are needed.")
    return wanted


def unit_load(load: RigLoad, on_road: RoadWheel) -> Array:
    """Return a load of 1 N or 1 N m as an equilibrium takes it, (n, 9)."""
    at_contact = load_at_contact(load, on_road)
    force, still = at_contact[:, :3], np.zeros((len(at_contact), 3))
    if load.at == CENTER:
        return np.concatenate([still, still, force], axis=1)
    return np.concatenate([at_contact, still], axis=1)


def under_amounts(
    suspension: Equilibrium, base: State, unit: Array, held: Held, load: RigLoad, wanted: Array
) -> list[State]:
    """Return the equilibria under some amounts of a load, each found from a smaller one."""
    _refuse_on_tyres(suspension, load, wanted)
    found: dict[float, State] = {}
    for sense in (1.0, -1.0):
        state, at = base, 0.0
        for amount in sorted({a for a in wanted.tolist() if sense * a >= 0.0}, key=abs):
            state = _towards(suspension, base, state, (at, amount), unit, held, load)
            at, found[amount] = amount, state
    states = [found[amount] for amount in wanted.tolist()]
    _refuse_beyond(suspension, states, load, wanted)
    return states


def _towards(
    suspension: Equilibrium,
    base: State,
    state: State,
    amounts: tuple[float, float],
    unit: Array,
    held: Held,
    load: RigLoad,
) -> State:
    """Return the equilibrium under a load from that under another one, by steps if need be."""
    at, end = amounts
    step = end - at
    while at != end:
        to = end if abs(step) >= abs(end - at) else at + step
        there = suspension.under(to * unit, held, state, base)
        if there.found.all():
            state, at, step = there, to, 2.0 * step
            continue
        step *= 0.5
        if abs(step) <= _LEAST_STEP * abs(end):
            problem = (
                f"no equilibrium that lasts was found under {load.words} of more than "
                f"{at:.4g} {load.unit}: the bushes do not hold the linkage. Leave greater "
                "ones out, or make the bushes stiffer."
            )
            raise PositionError(problem)
    return state


def _refuse_on_tyres(suspension: Equilibrium, load: RigLoad, wanted: Array) -> None:
    """Refuse loads under which a standing tyre would give way farther than one can."""
    soft = max(float(give_of_tyre(load, wheel) or 0.0) for wheel in suspension.wheels)
    worst = float(wanted[np.abs(wanted).argmax()]) if wanted.size else 0.0
    if abs(worst) * soft > _FARTHEST_TYRE:
        problem = (
            f"under {load.words} of {worst:.4g} {load.unit} the standing tyre deflects by "
            f"{1e3 * abs(worst) * soft:.4g} mm, more than any tyre can: "
            f"{1e3 * _FARTHEST_TYRE:g} mm: it slides before. Leave greater loads out, or correct "
            "its rates in [tyre]."
        )
        raise PositionError(problem)


def _refuse_beyond(
    suspension: Equilibrium, states: list[State], load: RigLoad, wanted: Array
) -> None:
    """Refuse loads that bring a bush, or damper and strut, farther than it goes."""
    for which in np.argsort(np.abs(wanted), kind="stable"):
        if strained := suspension.overstretched(states[which]):
            problem = (
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {strained}. Leave greater "
                "loads out, or make it stiffer."
            )
            raise PositionError(problem)
        if words := suspension.beyond(states[which]):
            problem = (
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {words[0]}. Leave greater "
                "ones out, or give the file stops that hold it before."
            )
            raise PositionError(problem)


# -- results --------------------------------------------------------------------------------------


def changes(
    suspension: Equilibrium,
    base: State,
    states: list[State],
    load: RigLoad,
    amounts: Array,
    side: int = 0,
) -> dict[str, Array]:
    """Return what a wheel does under some amounts of a load, by the kind of it.

    Parameters
    ----------
    suspension : Equilibrium
    base : State
        Without the load.
    states : list of State
        Under each amount.
    load : RigLoad
    amounts : ndarray, shape (n,)
        How much of it this wheel has.
    side : int, optional
        Which wheel.
    """
    before = on_bushes(suspension, base, side)
    point = suspension.contact(base.places, side) if load.at == CONTACT else before.center
    along = sense_of(load, suspension.wheels[side])
    found: dict[str, list[Array]] = {"toe": [], "camber": [], "displacement": []}
    for state in states:
        after = replace(before, axis=suspension.axis(state.places, side))
        found["toe"].append(wheel.toe(after) - wheel.toe(before))
        found["camber"].append(wheel.camber(after) - wheel.camber(before))
        shift = suspension.moved(point, base.places, state.places, side)
        found["displacement"].append((along * shift).sum(axis=-1))
    if not load.where:
        del found["displacement"]
    changed = {kind: np.concatenate(values) for kind, values in found.items()}
    if soft := give_of_tyre(load, suspension.wheels[side]):
        changed["patch_displacement"] = changed["displacement"] + amounts * soft
    return changed


def beside(changed: dict[str, Array], straight: dict[str, Array], side: str = "") -> dict[str, Any]:
    """Return what equilibrium tells of a wheel beside what is linear, as variables.

    Parameters
    ----------
    changed, straight : dict of str to ndarray
        By the kind.
    side : str, optional
        Of an axle.
    """
    found = {}
    for kind, values in changed.items():
        words, unit = _MEANINGS[kind]
        name, mark, sign = words.partition(", positive")
        key = f"{kind}_change" if name.startswith("change") else kind
        both = np.stack([values, straight[kind]])
        of_it = f"{name}{side and f', {side}'}{mark}{sign}"
        found[f"{key}{side and f'_{side}'}"] = variable((DATA_SET, LOAD), both, of_it, unit)
    return found


def coordinates_of(load: RigLoad, amounts: Array) -> dict[str, Any]:
    """Return the coordinates of results over a load."""
    words = load.words.partition(" ")[2]
    shown = {"display_units": "kN", "display_factor": 1e-3} if load.unit == "N" else {}
    return {
        DATA_SET: ["equilibrium", "linear"],
        LOAD: xr.Variable(LOAD, amounts, attributes(words, load.unit) | shown),
    }
