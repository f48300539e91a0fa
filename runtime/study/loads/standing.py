"""Where a suspension stands under load cases."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from ...assembly.load import known
from ...assembly.poses import CENTER, CONTACT, Poses
from ...suspension.model import Model
from ...suspension.positions import PositionError, arm_angles, design_height
from ...suspension.reach import at_rest, travel_range
from .balance import DEAD_POINT
from .cases import Case
from .outside import outside_loads
from .reactions import Equations
from .swing import Swing

Array = NDArray[np.float64]

# Positions over the travel between which an equilibrium is looked for: every 2 mm or so.
GRID = 101
# At which missing force [N], or within which arm angles [rad], a position is found. A rounding of
# the angle is 2e-16 rad, and by that some 1e7 N/rad change.
_FOUND = {"fatol": 4e-9, "xatol": 1e-15, "xrtol": 0.0}


def standing(model: Model, cases: Sequence[Case]) -> tuple[Array, list[str]]:
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
    grid = np.linspace(*reach.arm_angle, GRID)[1:-1]
    everywhere = Swing.of(Poses.of(model, *at_rest(model, grid, rack)))
    outside = np.array([case.vector for case in cases])
    holding = holding_forces(everywhere, outside[:, None])
    # from low to high the wheel needs more and more of a load to stay, where it is stable
    stable: NDArray[np.bool_] = (holding[:, :-1] <= 0.0) & (holding[:, 1:] > 0.0)
    distance = np.where(stable, np.abs(grid[:-1] - model.design_state[0]), np.inf)
    there = np.flatnonzero(stable.any(axis=1))
    at = distance.argmin(axis=1)[there]
    angles = np.full(len(cases), np.nan)
    if there.size:

        def left(angle: Array, row: Array) -> Array:
            swing = Swing.of(Poses.of(model, *at_rest(model, angle, rack)))
            return holding_forces(swing, outside[row.astype(int)])

        elementwise: Any = find_root  # its stubs know no arguments beside the first
        bracket = grid[at], grid[at + 1]
        args = (there.astype(float),)
        angles[there] = elementwise(left, bracket, args=args, tolerances=_FOUND).x
    return [
        (float(angle), "" if np.isfinite(angle) else not_carried(model, reach.height, held))
        for angle, held in zip(angles, holding, strict=True)
    ]


def not_carried(model: Model, height: tuple[float, float], held: Array) -> str:
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


def holding_forces(swing: Swing, outside: Array) -> Array:
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
    outside = outside_loads(cases, poses.wheel_axes(), poses.points)
    return Equations(poses).applied([*known(poses), *outside])
