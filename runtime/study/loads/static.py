"""The loads on every part of a suspension that stands still under load cases."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.quantities import variable
from ...suspension.corner import UP
from ...suspension.model import Model
from ...suspension.positions import PositionError, arm_angles, design_height, equilibrium
from ...suspension.reach import at_rest, travel_range
from ..characteristics.wheel import upward_across
from .cases import GREATEST, Case, cases_of, standard_cases
from .dataset import CASE, dataset_of
from .poses import CENTER, CONTACT, Poses
from .reactions import DEAD_POINT, Equations, Load, known
from .swing import Swing

Array = NDArray[np.float64]

# Positions over the travel between which an equilibrium is looked for: every 2 mm or so.
_GRID = 101
# At which missing force [N], or within which arm angles [rad], a position is found. A rounding of
# the angle is 2e-16 rad, and by that some 1e7 N/rad change.
_FOUND = {"fatol": 4e-9, "xatol": 1e-15, "xrtol": 0.0}


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
        to rounding.

    Raises
    ------
    InputError
        If an argument cannot be used.

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
    angles, reasons = _positions(model, wanted)
    return _dataset(model, wanted, angles, reasons)


def _at_rest_on_the_road(given: Arguments, model: Model, described: Mapping[str, Any]) -> float:
    """Return the vertical force on the wheel at rest, where a case needs it [N]."""
    tables = [table for table in described.values() if isinstance(table, Mapping)]
    if not any(key.endswith("_g") for table in tables for key in map(str, table)):
        return 0.0
    try:
        rest = equilibrium(model)
    except PositionError as error:
        given.refuse(f"static_load is needed, [N]: {error}")
        return 1.0
    poses = Poses.of(model, *at_rest(model, [rest[0]]))
    # the tyre pushes in the plane of the wheel
    upright = float(upward_across(poses.axis)[0, 2])
    return upright * float(model.signal("tyre_force", rest, model.inputs()))


# -- positions ------------------------------------------------------------------------------------


def _positions(model: Model, cases: Sequence[Case]) -> tuple[Array, list[str]]:
    """Return the arm angle of each case, and why there is none."""
    angles = np.full(len(cases), np.nan)
    reasons = [""] * len(cases)
    for rack in dict.fromkeys(case.rack for case in cases):
        free = [i for i, c in enumerate(cases) if c.rack == rack and c.travel is None]
        held = [i for i, c in enumerate(cases) if c.rack == rack and c.travel is not None]
        found = [(i, _held(model, cases[i])) for i in held]
        if free:
            found += zip(free, _equilibria(model, rack, [cases[i] for i in free]), strict=True)
        for i, (angle, reason) in found:
            angles[i], reasons[i] = angle, reason
    return angles, reasons


def _held(model: Model, case: Case) -> tuple[float, str]:
    """Return where a suspension stands that is held at a travel, or why it cannot."""
    height = design_height(model) + (case.travel or 0.0)
    try:
        angle = float(arm_angles(model, height, case.rack))
    except PositionError as error:
        return np.nan, str(error)
    poses = Poses.of(model, *at_rest(model, [angle], case.rack))
    unknowns, sound = Equations(poses).solved(_applied(poses, [case]))
    if not sound.all():
        return np.nan, DEAD_POINT
    vertical = float(unknowns[0, -1])
    if vertical < 0.0:
        return np.nan, f"the road would have to pull the wheel there with {-vertical:.4g} N."
    return angle, ""


def _equilibria(model: Model, rack: float, cases: Sequence[Case]) -> list[tuple[float, str]]:
    """Return where the suspension carries some cases, nothing holding it, or why it does not."""
    try:
        reach = travel_range(model, rack)
    except PositionError as error:
        return [(np.nan, str(error))] * len(cases)
    # a linkage that locks at the end of its reach carries anything, with forces that break it
    grid = np.linspace(*reach.arm_angle, _GRID)[1:-1]
    everywhere = Swing.of(Poses.of(model, *at_rest(model, grid, rack)))
    outside = np.array([case.vector for case in cases])
    holding = _holding(everywhere, outside[:, None])
    # from low to high the wheel needs more and more of a load to stay, where it is stable
    stable: NDArray[np.bool_] = (holding[:, :-1] <= 0.0) & (holding[:, 1:] > 0.0)
    distance = np.where(stable, np.abs(grid[:-1] - model.design_state[0]), np.inf)
    there = np.flatnonzero(stable.any(axis=1))
    at = distance.argmin(axis=1)[there]
    angles = np.full(len(cases), np.nan)
    if there.size:

        def left(angle: Array, row: Array) -> Array:
            swing = Swing.of(Poses.of(model, *at_rest(model, angle, rack)))
            return _holding(swing, outside[row.astype(int)])

        elementwise: Any = find_root  # its stubs know no arguments beside the first
        bracket = grid[at], grid[at + 1]
        args = (there.astype(float),)
        angles[there] = elementwise(left, bracket, args=args, tolerances=_FOUND).x
    return [
        (float(angle), "" if np.isfinite(angle) else _not_carried(model, reach.height, held))
        for angle, held in zip(angles, holding, strict=True)
    ]


def _not_carried(model: Model, height: tuple[float, float], held: Array) -> str:
    """Say why spring and stops do not carry a case, and what would help."""
    low, high = (1e3 * end for end in height)
    ends = f"between wheel heights of {low:.1f} mm and {high:.1f} mm"
    advice = "Give the case its travel_mm, or correct the forces."
    if held[-1] < 0.0:
        problem = f"{-held[-1]:.4g} N too much for spring and stops even near the upper end"
        if model.suspension.bump_stop is None:
            advice = "Give the file its [bump_stop], or the case its travel_mm."
    elif held[0] > 0.0:
        problem = f"it lifts the wheel by {held[0]:.4g} N too much even near the lower end"
        if model.suspension.rebound_stop is None:
            advice = "Give the file its [rebound_stop], or the case its travel_mm."
    else:
        problem = "no position is stable"
    return f"it is not carried {ends}: {problem}. {advice}"


def _holding(swing: Swing, outside: Array) -> Array:
    """Return the vertical force of the road that each position needs besides [N].

    Parameters
    ----------
    swing : Swing
        Of n positions.
    outside : ndarray, shape (..., n or 1, 12)
        What acts on the wheel, as `Case.vector`.
    """
    poses = swing.poses
    axes, turning = poses.wheel_axes(), swing.turning("wheel")
    contact, center = (swing.velocity("wheel", poses.points[at]) for at in (CONTACT, CENTER))
    units = np.concatenate(
        [np.einsum("nij,nj->ni", axes, v) for v in (contact, turning, center, turning)], axis=-1
    )
    power = swing.power(known(poses)) + (outside * units).sum(-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        holding: Array = -power / contact[:, 2]
    return np.where(np.isfinite(holding), holding, np.nan)


def _applied(poses: Poses, cases: Sequence[Case]) -> Array:
    """Return what acts on the parts as a vector, see `Equations.applied`."""
    return Equations(poses).applied([*known(poses), *_outside(poses, cases)])


def _outside(poses: Poses, cases: Sequence[Case]) -> list[Load]:
    """Return what acts on the wheel in each position."""
    axes = poses.wheel_axes()

    def turned(vectors: list[Array]) -> Array:
        rotated: Array = np.einsum("nij,ni->nj", axes, np.array(vectors))
        return rotated

    return [
        Load(
            "wheel",
            CONTACT,
            "road",
            turned([case.contact for case in cases]),
            turned([case.contact_moment for case in cases]),
            poses.points[CONTACT],
        ),
        Load(
            "wheel",
            CENTER,
            "drive",
            turned([case.center for case in cases]),
            turned([case.center_moment for case in cases]),
            poses.points[CENTER],
        ),
    ]


# -- results --------------------------------------------------------------------------------------


def _dataset(
    model: Model, cases: Sequence[Case], angles: Array, reasons: Sequence[str]
) -> xr.Dataset:
    every = np.arange(len(cases))
    carried = np.flatnonzero(np.isfinite(angles))
    if not carried.size:
        names = [f"{c.name}: {reason}" for c, reason in zip(cases, reasons, strict=True)]
        raise InputError(["none of the cases can be carried", *names[:3]], "loads")
    possible = [case for case, angle in zip(cases, angles, strict=True) if np.isfinite(angle)]
    racks = np.array([case.rack for case in possible])
    poses = Poses.of(model, *at_rest(model, angles[carried], racks))
    equations = Equations(poses)
    outside = _outside(poses, possible)
    road, _ = outside
    acting = known(poses)
    unknowns, sound = equations.solved(equations.applied([*acting, *outside]))
    if not sound.all():  # these are not carried either
        lost = carried[~sound]
        reasons = [DEAD_POINT if i in lost else text for i, text in enumerate(reasons)]
        return _dataset(model, cases, np.where(np.isin(every, lost), np.nan, angles), reasons)
    # the road has what holds a suspension that is held, and nothing has what is left of others
    held = np.array([case.travel is not None for case in possible])
    vertical = np.where(held, unknowns[:, -1], 0.0)
    pushed = road.force + vertical[:, None] * UP
    outside[0] = Load("wheel", CONTACT, "road", pushed, road.moment, road.at)
    found = dataset_of(poses, CASE, equations.carried(unknowns) + acting + outside)
    travel = poses.points[CENTER][:, 2] - design_height(model)
    missing = unknowns[:, -1] - vertical
    described = {
        "travel": (travel, "wheel travel, positive in bump", "m"),
        "rack": (racks, "displacement of the rack", "m"),
        "wheel_load": (pushed[:, 2], "vertical force of the road", "N"),
        "holding_force": (missing, "vertical force at the contact that is missing", "N"),
    }
    found = found.assign({name: variable(CASE, *told) for name, told in described.items()})
    found = found.assign_coords({CASE: [case.name for case in possible]})
    found = found.reindex({CASE: [case.name for case in cases]})
    found["reason"] = variable(CASE, np.array(reasons), "why the case cannot be carried", "1")
    found.attrs |= {
        "title": "loads in load cases",
        "rules": "; ".join(model.suspension.structure().rules),
        "message": f"{carried.size} of {len(cases)} cases are carried",
    }
    return found
