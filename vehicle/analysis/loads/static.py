"""Loads on every part of an assembly at rest under load cases."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ....core.named_types import Array
from ....core.quantities import attributes, variable
from ....core.validator import Validator
from ...assembly.assembly import HeldAssembly
from ...assembly.by_wheel import stacked
from ...assembly.load import Load
from ...assembly.of import given_assembly
from ...assembly.part_poses import PartPoses
from ...corner.corner import UP
from .applied_loads import AppliedLoads, road_and_drive, wheels_of
from .balance import DEAD_POINT
from .cases import GREATEST, cases_of, in_parts_of_it, standard_cases
from .dataset import CASE, loads_of, over_cases, refuse_if_none
from .reactions import BalanceEquations
from .static_equilibrium import static_equilibrium


def static(
    subject: Any, cases: Mapping[str, Any] | None = None, *, static_load: float | None = None
) -> xr.Dataset:
    """Return the forces and moments on every part in load cases, each in static equilibrium.

    Parameters
    ----------
    subject : Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel
    cases : mapping, optional
        By name: ``contact_N`` and ``contact_Nm``, force and moment at the lowest point of the
        wheel, whose brake holds it; ``center_N`` and ``center_Nm``, force and moment at the wheel
        centre, for torques of a brake or a final drive on the body. Each has three numbers in the
        axes of the tyre (ISO 8855): x forward, y to the left, z up. ``contact_g`` and ``center_g``
        are such forces as fractions of the static load. ``rack_mm`` is a displacement of the rack,
        and ``travel_mm`` a given travel of the wheel instead of a vertical force at the contact.
        For an axle they apply to both wheels; ``left`` and ``right`` have those of one wheel. By
        default those of `standard_cases`.
    static_load : float, optional
        Static load of each wheel, the unit of ``contact_g`` and ``center_g`` [N]; by default the
        vertical force at rest on the road at z = 0.

    Returns
    -------
    xarray.Dataset
        Over ``case``, ``load`` and ``axis``: ``force`` [N] and ``moment`` [N m] about its point of
        action ``at`` [m], in chassis axes; and ``force_in_part``, ``moment_in_part`` and
        ``at_in_part`` in axes that are fixed in the part, and are those of the chassis at design.
        Every load has the ``part`` on which it acts, its ``point``, and the neighbour ``by`` which
        it is exerted. Forces between two parts occur twice, with both signs. Parts and points of
        both sides of an axle end in ``_left`` and ``_right``.

        Over ``case``, and of an axle over ``wheel``: ``travel`` [m], ``wheel_load`` [N], and
        ``holding_force`` [N], the residual of the vertical force at the contact: zero, to rounding.
        ``rack`` [m] if the suspension has one, and ``reason`` for a case without equilibrium.
        ``residual`` [N] and ``residual_moment`` [N m] over ``moving_part`` are the sums of forces
        and moments on it: zero, to rounding.

        ``total_force`` [N] and ``total_moment`` [N m] over ``mount`` are the sums of all loads on
        the chassis at a point to which parts are bolted, moments about that point (``total_at``
        [m]), and ``total_by`` names the loads; the spring of a strut belongs to the mount of the
        strut.

        A rack is held along its axis by ``steering``, and in other directions by the chassis: at
        ``rack_guide``, the end of the tie rod of a corner, or at the ``rack_middle`` of an axle,
        whose ``rack_force`` [N] is the force of the steering along the axis. A Pitman arm is held
        by the moment of the ``steering`` about its axis, ``pitman_moment`` [N m], and by the
        chassis at its pivot; ``rack_force`` is that moment over its length. ``bar_torque`` [N m]
        is that of an anti-roll bar, positive with the left half turned farther, or of a rigid axle
        with the left wheel up; parts of an axle with a bar are ``drop_link_left``, ``_right`` and
        the ``anti_roll_bar``. A rod of a rigid axle ends at the ``beam`` and the chassis, in the
        points ``NAME_axle`` and ``NAME_chassis``; ``rod_force`` [N] over ``rod`` is positive in
        tension.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If no case has an equilibrium.

    Notes
    -----
    The equilibrium of every part is linear in the forces of the joints. Springs, stops and bar
    carry the case in the stable position nearest to design, of those on a grid over the travels of
    the wheels; for a rigid axle it is searched from design. Two bearings of an arm on one axis
    share the force along it equally: it is statically indeterminate.

    Examples
    --------
    >>> from kintrafo import Axle, Model, RigidAxle, loads
    >>> found = loads.static(Model("reference_car"), {"static": {"contact_g": [0, 0, 1]}})
    >>> mount = found.sel(case="static", axis="z", load=found["point"] == "spring_top")
    >>> [round(float(force)) for force in mount["force"]]
    [3541]
    >>> turn = {"left": {"contact_g": [0, 0, 1]}, "right": {"contact_g": [0, 0, 1.5]}}
    >>> found = loads.static(Axle.load("reference_axle"), {"turn": turn})
    >>> [round(1e3 * float(travel), 1) for travel in found["travel"].sel(case="turn")]
    [15.5, 57.9]
    >>> turn = {"left": {"contact_N": [0, 2000, 3000]}, "right": {"contact_N": [0, 6000, 9000]}}
    >>> found = loads.static(RigidAxle.load("rigid_axle"), {"turn": turn})
    >>> round(float(found["rod_force"].sel(case="turn", rod="panhard_rod")))
    7628
    """
    with Validator("loads") as given:
        assembly = given_assembly(given, subject)
        if not given.failed:
            if None in assembly.tyre_radii:
                given.fail("[tyre] radius_mm is needed: where the road touches the wheel.")
            described = standard_cases(assembly) if cases is None else cases
            described = given.mapping("cases", described, "names and load cases")
        if not given.failed:
            assembly.require_rigid_motion()
            if static_load is None:
                static_loads = _at_rest_on_the_road(given, assembly, described)
            else:
                load = given.number("static_load", static_load, "N", above=0.0, below=GREATEST)
                static_loads = [load] * len(assembly.wheels)
            wanted = cases_of(given, assembly, described, static_loads)
    loads = AppliedLoads.of(wanted)
    coordinates, reasons = static_equilibrium(assembly, loads)
    return _in_cases(assembly, [wheels[0].name for wheels in wanted], loads, coordinates, reasons)


def _at_rest_on_the_road(
    given: Validator, assembly: HeldAssembly, described: Mapping[str, Any]
) -> list[float]:
    """Return the vertical forces on all wheels at rest [N]; zeros if no case needs them."""
    if not in_parts_of_it(described):
        return [0.0] * len(assembly.wheels)
    coordinates, (reason,) = static_equilibrium(
        assembly, AppliedLoads.of_tyres(len(assembly.wheels))
    )
    if reason:
        given.fail(f"static_load is needed, [N]: no stable rest on the road: {reason}")
        return [1.0] * len(assembly.wheels)
    poses = assembly.at_wheel_coordinates(coordinates, np.zeros(1))
    return [float(poses[suffix].tyre_forces()[part][0, 2]) for suffix, part, _ in wheels_of(poses)]


def _in_cases(
    assembly: HeldAssembly,
    names: Sequence[str],
    loads: AppliedLoads,
    coordinates: Array,
    reasons: list[str],
) -> xr.Dataset:
    """Return the loads in named cases, with wheels at coordinates of shape (cases, wheels).

    Reasons are those of cases without equilibrium; others are empty.
    """
    carried = np.array([row for row, reason in enumerate(reasons) if not reason], dtype=int)
    refuse_if_none(names, carried.tolist(), reasons)
    racks, held = loads.racks[carried], ~loads.free[carried]
    poses = assembly.at_wheel_coordinates(coordinates[carried], racks)
    acting, outside = assembly.acting(poses), _outside(poses, loads.at(poses, carried))
    balance = {
        suffix: _Balance.of(group, [*acting[suffix], *outside[suffix]])
        for suffix, group in poses.items()
    }
    missing = np.concatenate([one.missing for one in balance.values()], axis=1)
    refused = _refused(assembly, {s: ~one.sound for s, one in balance.items()}, missing, held)
    if any(refused):
        explained = [*reasons]
        for row, words in zip(carried, refused, strict=True):
            explained[row] = words
        return _in_cases(assembly, names, loads, coordinates, explained)
    # the road exerts the force that holds a wheel at its travel; that of other wheels is a residual
    vertical = np.where(held, missing, 0.0)
    of_road = iter(vertical.T)
    pushed = {
        suffix: [
            replace(load, force=load.force + next(of_road)[:, None] * UP)
            if _is_road(load)
            else load
            for load in own
        ]
        for suffix, own in outside.items()
    }
    every = {s: [*one.carried, *acting[s], *pushed[s]] for s, one in balance.items()}
    data = {
        "travel": (
            [(w.center - w.design_center)[:, 2] for _, _, w in wheels_of(poses)],
            "wheel travel, positive in bump",
            "m",
        ),
        "wheel_load": (
            [load.force[:, 2] for own in pushed.values() for load in own if _is_road(load)],
            "vertical force of the road",
            "N",
        ),
        "holding_force": (
            [*(missing - vertical).T],
            "vertical force at the contact that is missing",
            "N",
        ),
    }
    of_wheels = {
        name: stacked(CASE, values, attributes(words, unit))
        for name, (values, words, unit) in data.items()
    }
    of_rack = {"rack": variable(CASE, racks, "displacement of the rack", "m")}
    found = loads_of(CASE, assembly, poses, every)
    found = found.assign((of_rack if assembly.steered else {}) | of_wheels)
    return over_cases(found, names, carried.tolist(), reasons)


def _outside(poses: Mapping[str, PartPoses], vectors: Array) -> dict[str, list[Load]]:
    """Return the loads of road and drive by suffix, of vectors (n, wheels, 12) as `Case.vector`."""
    found: dict[str, list[Load]] = {suffix: [] for suffix in poses}
    for place, (suffix, part, wheel) in enumerate(wheels_of(poses)):
        found[suffix] += road_and_drive(part, wheel, vectors[:, place])
    return found


@dataclass(frozen=True)
class _Balance:
    """Loads of the joints of a group, residual forces at the contacts, and where they are sound."""

    carried: list[Load]
    missing: Array  # (n, wheels) [N]
    sound: NDArray[np.bool_]

    @classmethod
    def of(cls, group: PartPoses, loads: list[Load]) -> "_Balance":
        """Return the balance of a group under some loads."""
        equations = BalanceEquations(group)
        unknowns, sound = equations.solved(equations.applied(loads))
        return cls(equations.carried(unknowns), unknowns[:, -len(group.wheels) :], sound)


def _refused(
    assembly: HeldAssembly,
    dead: Mapping[str, NDArray[np.bool_]],
    missing: Array,
    held: NDArray[np.bool_],
) -> list[str]:
    """Return the reasons against equilibria: a dead point, or a road that would have to pull.

    Dead points are by suffix, (n,); forces of the road on held wheels have the shape (n, wheels).
    """
    heads = [f"{wheel}: " if len(assembly.wheels) > 1 else "" for wheel in assembly.wheels]
    found = []
    for row, (forces, holds) in enumerate(zip(missing, held, strict=True)):
        lost = [suffix for suffix, which in dead.items() if which[row]]
        if lost:
            where = " and ".join(suffix.strip("_") for suffix in lost if suffix)
            found.append(f"{where}: {DEAD_POINT}" if where else DEAD_POINT)
            continue
        found.append(
            " ".join(
                f"{head}the road would have to pull the wheel there with {-force:.4g} N."
                for head, force, holding in zip(heads, forces, holds, strict=True)
                if holding and force < 0.0
            )
        )
    return found


def _is_road(load: Load) -> bool:
    return load.by.startswith("road")
