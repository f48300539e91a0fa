"""The loads on every part of a rigid axle that stands still under load cases."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...assembly.beam import SIDES
from ...assembly.coupling import Place
from ...assembly.equilibrium import equilibrium
from ...assembly.load import Load
from ...assembly.parts import MIDDLE, Parts
from ...core.arguments import Arguments
from ...core.quantities import variable
from ...suspension.axle.file import Held
from ...suspension.corner import UP
from ...suspension.reach import PositionError
from ...suspension.rigid.axle import RigidAxle
from ...suspension.rigid.model import RigidAxleModel
from ..axles import cases as of_axles
from ..loads.cases import GREATEST, Case
from ..loads.dataset import CASE, dataset_of, over_cases, refuse_if_none
from ..loads.static import in_parts_of_it
from .balance import Balance
from .standing import outside_of, standing

Array = NDArray[np.float64]

ROD = "rod"
"""Dimension of the forces along rods."""

_RACK = "rack_mm"
_USUAL = of_axles.standard_cases()


def standard_cases(axle: RigidAxle) -> dict[str, dict[str, Any]]:
    """Return the usual load cases of a rigid axle, in parts of the static load of each wheel.

    They are those of other axles, but forces along x act where the axle holds the torque: at the
    contacts with brakes or the final drive on the axle, and at the wheel centres with these on the
    body. An axle that is not driven has no case ``drive``.

    Parameters
    ----------
    axle : RigidAxle

    Returns
    -------
    dict
        As `static_loads` takes them.

    Examples
    --------
    >>> standard_cases(RigidAxle.load("rigid_axle"))["drive"]
    {'contact_g': [0.5, 0.0, 0.9]}
    """
    with Arguments("standard_cases") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
    drive = axle.drive
    held = {name: axle.brakes.torque_on for name in _USUAL if name != "drive" or drive is not None}
    if drive is not None:
        held["drive"] = drive.torque_on
    return {name: _with_torque_on(_USUAL[name], of) for name, of in held.items()}


def _with_torque_on(case: Mapping[str, Any], held: Held) -> dict[str, Any]:
    """Return a case with its forces along x where they find what holds the torque."""
    if "contact_g" not in case:
        return {side: _with_torque_on(own, held) for side, own in case.items()}
    x, y, z = case["contact_g"]
    along = x + case.get("center_g", [0.0])[0]
    if held == "carrier" or along == 0.0:
        return {"contact_g": [along, y, z]}
    return {"contact_g": [0.0, y, z], "center_g": [along, 0.0, 0.0]}


def static_loads(
    axle: RigidAxle,
    cases: Mapping[str, Any] | None = None,
    *,
    static_load: float | None = None,
) -> xr.Dataset:
    """Return the loads on every part of a rigid axle in some load cases, each at rest.

    Parameters
    ----------
    axle : RigidAxle
    cases : mapping, optional
        By name, keys as of `kintrafo.loads.static` without ``rack_mm``, which count for both
        wheels; in ``left`` and ``right`` those of one. Both have the axes of the tyre, y to the
        left. A wheel is held by the axle under forces at its contact; those that a brake or a final
        drive on the body takes belong to ``center_N`` or ``center_g``. By default those of
        `standard_cases`.
    static_load : float, optional
        Vertical force on each wheel [N]; by default that of the rest on the road at z = 0.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.axles.static_loads`. The parts are ``beam``, ``wheel_left``,
        ``wheel_right`` and the rods by their names; a rod touches the others at the points
        ``NAME_chassis`` and ``NAME_axle``. ``by`` spring_left and so on, damper_left (with its
        stops) and bar are forces on axle and chassis. ``rod_force`` [N] over ``case`` and ``rod``
        is positive where a rod pulls, ``bar_torque`` [N m] with the left wheel up.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If none of the cases can be carried.

    Notes
    -----
    Equilibrium of every part, linear in the forces along the rods, which have no mass. Both wheels
    go from design to where springs, stops and bar carry the case, to a position that is stable.

    Examples
    --------
    >>> turn = {"corner": {"left": {"contact_N": [0, 2000, 3000]},
    ...                    "right": {"contact_N": [0, 6000, 9000]}}}
    >>> found = static_loads(RigidAxle.load("rigid_axle"), turn)
    >>> round(float(found["rod_force"].sel(case="corner", rod="panhard_rod")))
    7628
    """
    with Arguments("static_loads") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
        if not given.refused:
            if axle.tyre_radius() is None:
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheels.")
            described = standard_cases(axle) if cases is None else cases
            described = given.mapping("cases", described, "names and load cases")
            if not described:
                given.refuse("cases: one or more are needed.")
            _refuse_racks(given, described)
        if not given.refused:
            model = RigidAxleModel(axle)
            if static_load is None:
                at_rest = _at_rest_on_the_road(given, model, described)
            else:
                load = given.number("static_load", static_load, "N", above=0.0, below=GREATEST)
                at_rest = dict.fromkeys(SIDES, load)
            wanted = of_axles.cases_of_sides(given, described, at_rest)
    return _over_cases(model, wanted)


def _refuse_racks(given: Arguments, described: Mapping[str, Any]) -> None:
    """Refuse what moves a rack, of a case or of one of its sides."""
    for name, table in described.items():
        if any(_RACK in one for one in of_axles.tables_of({name: table})):
            given.refuse(f"[cases.{name}] {_RACK}: a rigid axle has no rack. Leave it out.")


def _at_rest_on_the_road(
    given: Arguments, model: RigidAxleModel, described: Mapping[str, Any]
) -> dict[str, float]:
    """Return the vertical forces on both wheels at rest, where a case needs them [N]."""
    if not in_parts_of_it(of_axles.tables_of(described)):
        return dict.fromkeys(SIDES, 0.0)
    try:
        rest = equilibrium(model)
    except PositionError as error:
        given.refuse(f"static_load is needed, [N]: {error}")
        return dict.fromkeys(SIDES, 1.0)
    parts = Parts.of(model, np.asarray(rest)[None])
    return {side: float(parts.push_of_tyre(side)[0, 2]) for side in SIDES}


def _over_cases(model: RigidAxleModel, cases: Mapping[str, Sequence[Case]]) -> xr.Dataset:
    """Return the loads in load cases of both wheels, by their sides."""
    travels, reasons = standing(model, cases)
    names = [case.name for case in cases[SIDES[0]]]
    carried = [row for row, reason in enumerate(reasons) if not reason]
    refuse_if_none(names, carried, reasons)
    both = [tuple(cases[side][row] for side in SIDES) for row in carried]
    parts = Parts.of(model, model.placed(*travels[carried].T))
    acting, outside = parts.acting(), outside_of(parts, both)
    balance = Balance(parts, [*acting, *outside])
    told, missing = {}, {}
    for i, side in enumerate(SIDES):
        # the road has what holds a wheel that is held; nothing has what is left of others
        held = np.array([case[i].travel is not None for case in both])
        vertical = np.where(held, balance.missing[side], 0.0)
        missing[side] = balance.missing[side] - vertical
        outside = [_with_upward(load, side, vertical) for load in outside]
        of_road = sum(load.force[:, 2] for load in outside if load.by == f"road_{side}")
        words = f"wheel travel, positive in bump, {side}"
        told[f"travel_{side}"] = variable(CASE, travels[carried, i], words, "m")
        words = f"vertical force of the road, {side}"
        told[f"wheel_load_{side}"] = variable(CASE, of_road, words, "N")
    loads = [*balance.carried(), *acting, *outside]
    found = dataset_of_parts(CASE, balance, loads, missing).assign(told)
    return over_cases(found, names, carried, reasons)


def _with_upward(load: Load, side: str, vertical: Array) -> Load:
    """Return a load with a vertical force besides, if it is that of the road on this side."""
    if load.by != f"road_{side}":
        return load
    return replace(load, force=load.force + vertical[:, None] * UP)


def dataset_of_parts(
    over: str, balance: Balance, loads: Sequence[Load], missing: Mapping[str, Array]
) -> xr.Dataset:
    """Return loads on the parts of a rigid axle over the positions.

    Parameters
    ----------
    over : str
        Dimension of the positions.
    balance : Balance
    loads : sequence of Load
        All that there are.
    missing : mapping of str to ndarray
        The vertical forces that wheels need besides [N].
    """
    parts = balance.parts
    places = {name: Place(parts.centers[name], parts.turned[name]) for name in parts.centers}
    # how the bar gets to the body is left out
    found = dataset_of(over, loads, places, {MIDDLE: ""}).assign_coords({ROD: [*balance.pulls]})
    told = {
        f"holding_force_{side}": variable(
            over, force, f"vertical force at the contact that is missing, {side}", "N"
        )
        for side, force in missing.items()
    }
    pulls = np.stack([*balance.pulls.values()], axis=-1)
    told["rod_force"] = variable((over, ROD), pulls, "force along a rod, positive in tension", "N")
    if parts.axle.anti_roll_bar is not None:
        words = "torque of the anti-roll bar, positive with the left wheel up"
        told["bar_torque"] = variable(over, parts.torque_of_bar(), words, "N m")
    return found.assign(told).assign_attrs(rules="")
