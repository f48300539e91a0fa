"""The loads on every part of an axle that stands still under load cases."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from ...assembly.axle_coupling import (
    SIDES,
    Between,
    pull_of_bar,
    rules_of,
)
from ...assembly.coupling import STEERING
from ...assembly.equilibrium import equilibrium
from ...assembly.load import RACK, Load
from ...assembly.poses import Poses
from ...core.arguments import Arguments
from ...core.quantities import variable
from ...core.vectors import unit_vector
from ...suspension.axle import Axle
from ...suspension.corner import Array
from ...suspension.positions import PositionError, arm_angles, design_height
from ...suspension.reach import at_rest
from ..loads.cases import GREATEST, Case
from ..loads.dataset import CASE
from ..loads.standing import standing
from ..loads.static import Side, dataset_of_cases, in_parts_of_it
from .cases import cases_of_sides, standard_cases, tables_of
from .standing import Wheel, balanced


def static_loads(
    axle: Axle,
    cases: Mapping[str, Any] | None = None,
    *,
    static_load: float | None = None,
) -> xr.Dataset:
    """Return the loads on every part of an axle in some load cases, each at rest.

    Parameters
    ----------
    axle : Axle
    cases : mapping, optional
        By name, keys as of `kintrafo.loads.static`, which count for both wheels; in ``left`` and
        ``right`` those of one. Both have the axes of the tyre, y to the left. By default usual
        cases.
    static_load : float, optional
        Vertical force on each wheel [N]; by default that of the rest on the road at z = 0.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.loads.static`; names of parts, points and what exerts a load end in
        ``_left`` and ``_right``, and so do ``travel``, ``wheel_load`` and ``holding_force``.
        Further parts are ``drop_link_left`` and ``_right``, the ``anti_roll_bar`` and the ``rack``,
        which the ``steering`` holds along its axis and the chassis in all else. ``bar_torque``
        [N m] is positive with the left half turned the farther, ``rack_force`` [N] what the
        steering exerts on the rack along its axis.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If none of the cases can be carried.

    Notes
    -----
    As of `kintrafo.loads.static`; where both wheels stand with the bar between them is the stable
    equilibrium that was found nearest to design.

    Examples
    --------
    >>> turn = {"left": {"contact_g": [0, 0, 1]}, "right": {"contact_g": [0, 0, 1.5]}}
    >>> found = static_loads(Axle.load("reference_axle"), {"turn": turn})
    >>> [round(1e3 * float(found[f"travel_{side}"][0]), 1) for side in ("left", "right")]
    [15.5, 57.9]
    """
    with Arguments("static_loads") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        if not given.refused:
            if any(side.tyre_radius() is None for side in axle.sides.values()):
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
            described = standard_cases() if cases is None else cases
            described = given.mapping("cases", described, "names and load cases")
            if not described:
                given.refuse("cases: one or more are needed.")
        if not given.refused:
            if static_load is None:
                at_rest = _at_rest_on_the_road(given, axle, described)
            else:
                load = given.number("static_load", static_load, "N", above=0.0, below=GREATEST)
                at_rest = dict.fromkeys(SIDES, load)
            wanted = cases_of_sides(given, described, at_rest)
    angles, torques, reasons = _standing(axle, wanted)

    def pulled(side: str, poses: Poses, rows: Sequence[int]) -> list[Load]:
        return [pull_of_bar(axle, side, poses, torques[[*rows]])] if axle.halves else []

    sides = {
        f"_{side}": Side(axle.models[side], wanted[side], angles[side], partial(pulled, side))
        for side in SIDES
    }
    found = dataset_of_cases(sides, reasons, Between(axle))
    return with_shared(axle, found, CASE, torques)


def _at_rest_on_the_road(
    given: Arguments, axle: Axle, described: Mapping[str, Any]
) -> dict[str, float]:
    """Return the vertical forces on both wheels at rest, where a case needs them [N]."""
    if not in_parts_of_it(tables_of(described)):
        return dict.fromkeys(SIDES, 0.0)
    try:
        if axle.halves:
            wheels = {side: Wheel(axle, side, 0.0, _tyre) for side in SIDES}
            arms = dict(zip(SIDES, balanced(axle, wheels)[0], strict=True))
        else:
            arms = {side: float(equilibrium(model)[0]) for side, model in axle.models.items()}
    except PositionError as error:
        given.refuse(f"static_load is needed, [N]: {error}")
        return dict.fromkeys(SIDES, 1.0)
    poses = {side: Poses.of(m, *at_rest(m, [arms[side]])) for side, m in axle.models.items()}
    return {side: float(poses[side].push_of_tyre()[0, 2]) for side in SIDES}


def _tyre(poses: Poses) -> Array:
    """Return the force of the tyre as `Case.vector`."""
    outside = np.zeros((len(poses.states), 12))
    outside[:, 6:9] = np.einsum("nij,nj->ni", poses.wheel_axes(), poses.push_of_tyre())
    return outside


def _standing(
    axle: Axle, cases: Mapping[str, list[Case]]
) -> tuple[dict[str, Array], Array, list[str]]:
    """Return the arms' angles in each case, the torque of the bar, and why there are none."""
    count = len(cases[SIDES[0]])
    if not axle.halves:
        found = {side: standing(axle.models[side], cases[side]) for side in SIDES}
        reasons = [
            "; ".join(f"{side}: {found[side][1][i]}" for side in SIDES if found[side][1][i])
            for i in range(count)
        ]
        return {side: found[side][0] for side in SIDES}, np.zeros(count), reasons
    angles = {side: np.full(count, np.nan) for side in SIDES}
    torques, reasons = np.full(count, np.nan), [""] * count
    for i in range(count):
        try:
            both, torques[i] = _with_bar(axle, {side: cases[side][i] for side in SIDES})
        except PositionError as error:
            reasons[i] = str(error)
        else:
            for side, angle in zip(SIDES, both, strict=True):
                angles[side][i] = angle
    return angles, torques, reasons


def _with_bar(axle: Axle, cases: Mapping[str, Case]) -> tuple[Array, float]:
    """Return the arms' angles in a case, and the torque of the bar."""
    wheels = {}
    for side, case in cases.items():
        model, held = axle.models[side], None
        if case.travel is not None:
            height = design_height(model) + case.travel
            try:
                held = float(arm_angles(model, height, case.rack))
            except PositionError as error:
                raise PositionError(f"{side}: {error}") from None
        wheels[side] = Wheel(axle, side, case.rack, partial(_given, case), held)
    angles, torque = balanced(axle, wheels)
    for angle, (side, wheel) in zip(angles, wheels.items(), strict=True):
        vertical = wheel.holding(angle, torque)
        if vertical < 0.0 and wheel.held is not None:
            problem = f"{side}: the road would have to pull the wheel there with {-vertical:.4g} N."
            raise PositionError(problem)
    return angles, torque


def _given(case: Case, poses: Poses) -> Array:
    """Return what acts on a wheel in a case, wherever it is."""
    del poses
    return case.vector[None]


def with_shared(axle: Axle, found: xr.Dataset, over: str, torques: Array) -> xr.Dataset:
    """Return loads with the torque of the bar and the force of the steering told."""
    if axle.steered():
        (row,) = np.flatnonzero((found["part"] == RACK) & (found["by"] == STEERING))
        force = found["force"].values[:, row] @ unit_vector(axle.right.rack.axis)
        words = "force of the steering on the rack along its axis"
        found["rack_force"] = variable(over, force, words, "N")
    if axle.halves:
        words = (
            "torque of the anti-roll bar, positive with the left half turned the farther, "
            "right-handed about the axis that points left"
        )
        found["bar_torque"] = variable(over, torques, words, "N m")
    rules = [rule for side in axle.sides.values() for rule in side.structure().rules]
    return found.assign_attrs(rules="; ".join(dict.fromkeys([*rules, *rules_of(axle)])))
