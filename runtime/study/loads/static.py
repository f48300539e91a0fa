"""The loads on every part of a suspension that stands still under load cases."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...assembly.coupling import Between, alone, rules_of
from ...assembly.equilibrium import equilibrium
from ...assembly.load import Load, known
from ...assembly.poses import CENTER, Poses
from ...core.arguments import Arguments
from ...core.quantities import variable
from ...suspension.corner import UP
from ...suspension.model import Model
from ...suspension.positions import PositionError, design_height
from ...suspension.reach import at_rest
from .balance import DEAD_POINT
from .cases import GREATEST, Case, cases_of, standard_cases
from .dataset import CASE, dataset_of, joined, over_cases, refuse_if_none
from .outside import outside_loads
from .reactions import Equations
from .standing import standing

Array = NDArray[np.float64]


def static(
    model: Model,
    cases: Mapping[str, Any] | None = None,
    *,
    static_load: float | None = None,
) -> xr.Dataset:
    """Return the loads on every part in some load cases, each at rest.

    Parameters
    ----------
    model : Model
    cases : mapping, optional
        By name: ``contact_N`` and ``contact_Nm``, force and moment at the lowest point of the
        wheel, whose brake holds it; ``center_N`` and ``center_Nm``, at the wheel centre; all of
        them three numbers in the axes of the tyre. ``contact_g`` and ``center_g`` in parts of the
        static load. ``rack_mm``; ``travel_mm`` where the suspension is to stand there, instead of
        a vertical force at the contact. By default usual cases.
    static_load : float, optional
        Vertical force on the wheel [N]; by default that of the rest on the road at z = 0.

    Returns
    -------
    xarray.Dataset
        Over ``case``, ``load`` and ``axis``: ``force`` [N] and ``moment`` [N m] about the point at
        which it acts (``at`` [m]), in chassis axes, and ``force_in_part`` and ``moment_in_part`` in
        the axes that the part had at design. Every load says on which ``part`` it is, at which
        ``point`` and ``by`` whom: what two parts exert on each other is there twice, with both
        signs. Over ``case``: ``travel`` and ``rack`` [m], ``wheel_load`` [N], and ``reason`` where
        the suspension cannot carry the case. ``residual`` [N] and ``residual_moment`` [N m] over
        ``moving_part`` are what is left of the sums of forces and moments on it, and
        ``holding_force`` [N] the vertical force at the contact that is missing: all of them none,
        to rounding. A rack is held along its axis by ``steering``, and by the chassis, its guide,
        in all else, at ``rack_guide``, where the tie rod ends. ``total_force`` [N] and
        ``total_moment`` [N m] over ``mount`` are the sums of all loads on the chassis at a point to
        which parts are bolted, moments about that point (``total_at`` [m]), and ``total_by`` names
        what acts; the spring of a strut belongs to the mount of the strut.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If none of the cases can be carried.

    Notes
    -----
    Equilibrium of every part, linear in the forces of the joints. The suspension goes to the
    stable position nearest to design in which spring and stops carry the case. Two bearings of an
    arm on one axis share the force along it equally: statics does not decide that.

    Examples
    --------
    >>> found = static(Model("reference_car"), {"static": {"contact_g": [0, 0, 1]}})
    >>> mount = found.sel(case="static", axis="z", load=found["point"] == "spring_top")
    >>> [round(float(force)) for force in mount["force"]]
    [3541]
    """
    with Arguments("loads") as given:
        given.kind("model", model, Model, Model.NEEDED)
        if not given.refused:
            described = standard_cases(model.suspension.vehicle.sign) if cases is None else cases
            described = given.mapping("cases", described, "names and load cases")
            if static_load is None:
                static_load = _at_rest_on_the_road(given, model, described)
            else:
                static_load = given.number(
                    "static_load", static_load, "N", above=0.0, below=GREATEST
                )
            wanted = cases_of(given, described, static_load)
            if not wanted and not given.refused:
                given.refuse("cases: one or more are needed.")
            if model.suspension.tyre_radius() is None:
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
    angles, reasons = standing(model, wanted)
    found = dataset_of_cases({"": Side(model, wanted, angles)}, reasons)
    return found.assign_attrs(rules=rules_of(model.suspension))


def _at_rest_on_the_road(given: Arguments, model: Model, described: Mapping[str, Any]) -> float:
    """Return the vertical force on the wheel at rest, where a case needs it [N]."""
    if not in_parts_of_it(described.values()):
        return 0.0
    try:
        rest = equilibrium(model)
    except PositionError as error:
        given.refuse(f"static_load is needed, [N]: {error}")
        return 1.0
    return float(Poses.of(model, *at_rest(model, [rest[0]])).push_of_tyre()[0, 2])


def in_parts_of_it(tables: Iterable[Any]) -> bool:
    """Tell whether forces are given in parts of the static load."""
    keys = (str(key) for table in tables if isinstance(table, Mapping) for key in table)
    return any(key.endswith("_g") for key in keys)


@dataclass(frozen=True)
class Side:
    """A suspension under load cases.

    Attributes
    ----------
    model : Model
    cases : sequence of Case
    angles : ndarray, shape (cases,)
        Of its arm; no number where it does not carry a case.
    pulled : callable
        Takes poses and the cases that they are of, and returns what pulls at its parts besides.
    """

    model: Model
    cases: Sequence[Case]
    angles: Array
    pulled: Callable[[Poses, Sequence[int]], list[Load]] = field(default=lambda _poses, _rows: [])


@dataclass(frozen=True)
class _Stand:
    """What a suspension carries in the cases that it carries."""

    poses: Poses
    loads: list[Load]
    told: dict[str, tuple[Array, str, str]]
    sound: NDArray[np.bool_]

    @classmethod
    def of(cls, side: Side, rows: Sequence[int]) -> "_Stand":
        """Return it for some of the cases."""
        cases = [side.cases[i] for i in rows]
        racks = np.array([case.rack for case in cases])
        poses = Poses.of(side.model, *at_rest(side.model, side.angles[[*rows]], racks))
        equations = Equations(poses)
        road, drive = outside_loads(cases, poses.wheel_axes(), poses.points)
        acting = [*known(poses), *side.pulled(poses, rows)]
        unknowns, sound = equations.solved(equations.applied([*acting, road, drive]))
        # the road has what holds a suspension that is held; nothing has what is left of others
        held = np.array([case.travel is not None for case in cases])
        vertical = np.where(held, unknowns[:, -1], 0.0)
        road = replace(road, force=road.force + vertical[:, None] * UP)
        travel = poses.points[CENTER][:, 2] - design_height(side.model)
        missing = unknowns[:, -1] - vertical
        told = {
            "travel": (travel, "wheel travel, positive in bump", "m"),
            "wheel_load": (road.force[:, 2], "vertical force of the road", "N"),
            "holding_force": (missing, "vertical force at the contact that is missing", "N"),
        }
        return cls(poses, [*equations.carried(unknowns), *acting, road, drive], told, sound)


def dataset_of_cases(
    sides: Mapping[str, Side],
    reasons: Sequence[str],
    between: Between = alone,
) -> xr.Dataset:
    """Return the loads in load cases, of one suspension or of both of an axle.

    Parameters
    ----------
    sides : mapping of str to Side
        By what goes behind their names: nothing for one suspension.
    reasons : sequence of str
        Why a case is not carried; empty where it is.
    between : callable, optional
        Adds what both sides share, see `joined`.
    """
    cases = next(iter(sides.values())).cases
    finite = np.isfinite([side.angles for side in sides.values()]).all(axis=0)
    carried = np.flatnonzero(finite).tolist()
    names = [case.name for case in cases]
    refuse_if_none(names, carried, reasons)
    stands = {suffix: _Stand.of(side, carried) for suffix, side in sides.items()}
    sound = np.all([stand.sound for stand in stands.values()], axis=0)
    if not sound.all():  # these are not carried either
        lost = np.isin(np.arange(len(cases)), np.array(carried)[~sound])
        left = {s: replace(v, angles=np.where(lost, np.nan, v.angles)) for s, v in sides.items()}
        where = [s.strip("_") for s, stand in stands.items() if s and not stand.sound.all()]
        words = f"{' and '.join(where)}: {DEAD_POINT}" if where else DEAD_POINT
        told = [words if gone else text for gone, text in zip(lost, reasons, strict=True)]
        return dataset_of_cases(left, told, between)
    poses = {suffix: stand.poses for suffix, stand in stands.items()}
    loads = {suffix: stand.loads for suffix, stand in stands.items()}
    found = dataset_of(CASE, *joined(poses, loads, between))
    racks = np.array([cases[i].rack for i in carried])
    steered = next(iter(sides.values())).model.suspension.steered()
    of_rack = {"rack": (racks, "displacement of the rack", "m")} if steered else {}
    described = of_rack | {
        f"{name}{suffix}": (values, f"{words}{suffix.replace('_', ', ')}", unit)
        for suffix, stand in stands.items()
        for name, (values, words, unit) in stand.told.items()
    }
    found = found.assign({name: variable(CASE, *told) for name, told in described.items()})
    return over_cases(found, names, carried, reasons)
