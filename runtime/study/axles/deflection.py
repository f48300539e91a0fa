"""How far both wheels of an axle give way under loads of any size, beside first order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ...assembly.axle_coupling import SIDES
from ...assembly.pair import Pair
from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...core.quantities import variable
from ...suspension.axle import Axle
from ...suspension.corner import Array
from ..loads.compliance import RigLoad
from ..loads.elastic.deflection import (
    BY_NAME,
    LOAD,
    amounts_of,
    beside,
    changes,
    coordinates_of,
    under_amounts,
    unit_load,
)
from ..loads.elastic.equilibrium import Equilibrium, State
from ..loads.elastic.held import HARDPOINTS, Hardpoints, at_height, gives_way
from ..loads.flexibility import HELD, Held, refuse_without_rate
from .compliance import LOADINGS, WORDS, compliance
from .on_bushes import axle_on, softs_of

WHEELS = {
    "parallel": "both wheels, in one direction",
    "opposed": "both wheels, oppositely",
    "left": "the left wheel",
    "right": "the right wheel",
}
"""Which wheels are loaded."""

_ONE = {"left": (1.0, 0.0), "right": (0.0, 1.0)}


def deflection(
    axle: Axle,
    bushings: Mapping[str, Any] | None,
    under: str,
    amounts: ArrayLike,
    *,
    wheels: str | Sequence[float] = "parallel",
    travel: float = 0.0,
    rack_position: float = 0.0,
    held: Held = "height",
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return how far both wheels of an axle give way under loads of any size.

    Parameters
    ----------
    axle : Axle
    bushings : mapping or None
        As of `compliance`, with curves as of `kintrafo.loads.elastokinematics`; None: those of the
        files.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        As of `kintrafo.loads.deflection`.
    amounts : array_like, shape (n,)
        How great the load is, of either sign [N], [N m].
    wheels : {'parallel', 'opposed', 'left', 'right'} or two numbers, optional
        Which wheels have it: as of `compliance`, or one of them. Or the parts of it that the left
        and the right wheel have, counted as on one suspension: ``[1.0, 0.5]`` under ``lateral``
        pushes both inward, the right one with half the force.
    travel, rack_position : float, optional
        Where both wheels and the rack are before [m].
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        What holds each wheel; the anti-roll bar acts besides.
    hardpoints : {'loaded', 'relaxed'}, optional
        As of `kintrafo.loads.elastokinematics`.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.loads.deflection`, of each wheel with ``_left`` and ``_right`` at the end;
        displacements count as under a positive load on this wheel by itself. And ``bar_torque``
        [N m], positive with the left half turned the farther.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If the travel is out of reach, or there is no equilibrium.

    Notes
    -----
    As of `kintrafo.loads.deflection`, with all parts of both sides in one equilibrium: the rack is
    one further part, if it gives way, and the bar has the energy of its twist, which follows from
    the feet of its drop links in closed form.

    Examples
    --------
    >>> from kintrafo import Axle
    >>> bushes = {"rack": {"axial_N_per_mm": 2500.0}}
    >>> axle = Axle.load("reference_axle")
    >>> for wheels in ("parallel", "opposed"):  # opposed forces do not move the rack
    ...     found = deflection(axle, bushes, "lateral", [5000.0], wheels=wheels)
    ...     toe = np.rad2deg(float(found["toe_change_right"].sel(data_set="equilibrium")[0]))
    ...     print(abs(round(toe, 3)))
    0.188
    0.0
    """
    with Arguments("deflection") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        given.among("under", under, BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        parts = parts_of(given, under, wheels)
        travel = given.number("travel", travel, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        wanted = amounts_of(given, amounts)
        softs = softs_of(given, axle, bushings, hardpoints)
        if not given.refused:
            refuse_without_rate(given, held, *(side.tyre for side in axle.sides.values()))
    load = replace(BY_NAME[under], words=words_of(under, wheels, parts))
    at, rack = np.array([travel]), np.array([rack_position])
    pair = Pair.at(axle, at, at, rack)
    suspension = axle_on(pair, rack, softs)
    base = at_height(suspension, at)
    states = under_amounts(suspension, base, of_both(suspension, load, parts), held, load, wanted)
    linear = None
    if any(gives_way(soft) for soft in softs.values()):
        linear = compliance(axle, bushings, at, rack_position=rack_position, held=held)
    amounts = np.multiply.outer(parts, wanted)
    first_order = straight(linear, load, parts, wanted)
    data = deflected(suspension, base, states, load, amounts, first_order)
    if axle.halves:
        torque = np.concatenate([suspension.torque_of_bar(state) for state in states])
        words = "torque of the anti-roll bar, positive with the left half turned the farther"
        data["bar_torque"] = variable(LOAD, torque, words, "N m")
    how = {"held": HELD[held], "hardpoints": HARDPOINTS[hardpoints]}
    title = f"deflection under {load.words}"
    return xr.Dataset(data, coordinates_of(load, wanted), {"title": title} | how)


def of_both(suspension: Equilibrium, load: RigLoad, parts: tuple[float, float]) -> Array:
    """Return a unit of a load of which both wheels have parts, (n, 2, 9)."""
    of_each = zip(parts, suspension.wheels, strict=True)
    return np.stack([part * unit_load(load, wheel) for part, wheel in of_each], axis=1)


def deflected(
    suspension: Equilibrium,
    base: State,
    states: list[State],
    load: RigLoad,
    amounts: Array,
    linear: Callable[[str, str], Array],
) -> dict[str, xr.Variable]:
    """Return what both wheels do under some amounts of a load, and what they carry.

    Parameters
    ----------
    suspension : Equilibrium
        Of both wheels, the left one first.
    base : State
        Without the load.
    states : list of State
        Under each amount.
    load : RigLoad
    amounts : ndarray, shape (2, n)
        How much of it each wheel has.
    linear : callable
        Returns what is told to first order, by the kind and the side.
    """
    data: dict[str, xr.Variable] = {}
    for which, side in enumerate(SIDES):
        changed = changes(suspension, base, states, load, amounts[which], which)
        data |= beside(changed, {kind: linear(kind, side) for kind in changed}, side)
    for which, side in enumerate(SIDES):
        road = np.concatenate([state.road[:, which] for state in states])
        data[f"wheel_load_{side}"] = variable(LOAD, road, f"wheel load, {side}", "N")
    return data


def straight(
    linear: xr.Dataset | None, load: RigLoad, parts: tuple[float, float], wanted: Array
) -> Callable[[str, str], Array]:
    """Return what tells what loads do to first order, as the sum of what is alike and opposed."""
    ways = LOADINGS[load.name]
    shares = np.linalg.solve(np.transpose([how.parts for how in ways]), parts)

    def told(kind: str, side: str) -> Array:
        if linear is None:
            return np.zeros_like(wanted)
        stems = (f"{kind}_by_{load.name}_{how.name}{side and f'_{side}'}" for how in ways)
        return wanted * float(shares @ [float(linear[stem][0]) for stem in stems])

    return told


def parts_of(given: Arguments, under: str, wheels: Any) -> tuple[float, float]:
    """Return the parts of a load that the left and the right wheel have."""
    if given.refused:
        return 0.0, 0.0
    if isinstance(wheels, str):
        given.among("wheels", wheels, WHEELS)
        ways = {how.name: how.parts for how in LOADINGS[under]} | _ONE
        return ways.get(wheels, (0.0, 0.0))
    both = given.array("wheels", wheels, "1", dimensions=[1])
    if both.shape != (len(SIDES),) or not (np.abs(both) <= 1.0).all():
        given.refuse("wheels: two numbers from -1 to 1 are needed, of the left and right wheel.")
        return 0.0, 0.0
    left, right = both.tolist()
    return left, right


def words_of(under: str, wheels: str | Sequence[float], parts: tuple[float, float]) -> str:
    """Return a load of both wheels in words."""
    for how in LOADINGS[under]:
        if how.name == wheels:
            return f"{WORDS[under]}, {how.words}"
    if isinstance(wheels, str):
        return f"{BY_NAME[under].words} of {WHEELS[wheels]}"
    return f"{BY_NAME[under].words}, {parts[0]:g} of it left and {parts[1]:g} right"
