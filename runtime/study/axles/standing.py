"""Where an axle stands under load cases, its anti-roll bar between both wheels.

Each wheel by itself needs a vertical force of the road at every position, which the torque of the
bar changes in proportion. Where both need none is looked for between positions of both wheels, then
by Newton's method.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import root

from ...assembly.axle_coupling import SIDES, pull_of_bar, turn_of_half
from ...assembly.poses import CONTACT, Poses
from ...equations.errors import ModelError
from ...suspension.axle import Axle
from ...suspension.corner import Array
from ...suspension.model import Model
from ...suspension.positions import PositionError
from ...suspension.reach import at_rest, travel_range
from ..loads.standing import GRID, holding_forces, not_carried
from ..loads.swing import Swing

Outside = Callable[[Poses], Array]
"""What acts on a wheel in some positions, (n, 12), as `Case.vector`."""

# Step for slopes by the arm angle: its square is their error, and rounding over it [rad].
_STEP = 1e-5
# How a wheel that is held opposes its turning [N/rad]: as springs do, for equations of one size.
_HELD = 1e5
# So much missing force is rounding: 2e-16 rad of an angle by 1e7 N/rad, and as much of all sums.
_FOUND = 1e-6
# Cells from which the search begins, the nearest to design first.
_MOST = 20


@dataclass(frozen=True)
class Wheel:
    """A wheel of an axle with a bar, under a load.

    Attributes
    ----------
    axle : Axle
    side : str
    rack : float
        Displacement of the rack [m].
    outside : callable
    held : float or None
        Angle of the arm at which it is held [rad].
    """

    axle: Axle
    side: str
    rack: float
    outside: Outside
    held: float | None = None

    @property
    def model(self) -> Model:
        """The equations of its side."""
        return self.axle.models[self.side]

    def grid(self) -> Array:
        """Return angles of the arm over its travel, or about that at which it is held [rad]."""
        if self.held is not None:
            return self.held + np.array([-0.5, 0.5]) * _STEP
        # a linkage that locks at the end of its reach carries anything
        return np.linspace(*travel_range(self.model, self.rack).arm_angle, GRID)[1:-1]

    def needs(self, angles: Array) -> tuple[Array, Array, Array]:
        """Return the missing force [N], that by a torque of the bar, and its half's angle."""
        poses = Poses.of(self.model, *at_rest(self.model, angles, self.rack))
        _, turn = turn_of_half(self.axle, self.side, poses)
        if self.held is not None:
            return _HELD * (angles - self.held), np.zeros_like(angles), turn
        return *self._missing(poses), turn

    def _missing(self, poses: Poses) -> tuple[Array, Array]:
        """Return the missing force without the bar, and that by its torque."""
        swing = Swing.of(poses)
        rise = swing.velocity("wheel", poses.points[CONTACT])[:, 2]
        pull = swing.power([pull_of_bar(self.axle, self.side, poses)])
        return holding_forces(swing, self.outside(poses)), -pull / rise

    def holding(self, angle: float, torque: float) -> float:
        """Return the vertical force of the road besides, with which it stands [N]."""
        poses = Poses.of(self.model, *at_rest(self.model, [angle], self.rack))
        missing, by_torque = self._missing(poses)
        return float(missing[0] + torque * by_torque[0])

    def why(self, most: float, least: float) -> str:
        """Say why it is not carried, if its upper or its lower end says so: the forces missing."""
        if self.held is not None or not (least > 0.0 or most < 0.0):
            return ""
        ends = np.array([least, most])
        height = travel_range(self.model, self.rack).height
        return f"{self.side}, with the anti-roll bar: {not_carried(self.model, height, ends)}"


def balanced(axle: Axle, wheels: Mapping[str, Wheel]) -> tuple[Array, float]:
    """Return the arms' angles [rad] and the torque of the bar [N m] where both wheels need nothing.

    Raises
    ------
    PositionError
        If there is no stable position near design, with what would help.
    """
    both = [wheels[side] for side in SIDES]
    grids = [wheel.grid() for wheel in both]
    ways = np.sign([grid[-1] - grid[0] for grid in grids])
    forces, _ = _together(axle, both, grids)
    cells = np.argwhere(np.all([_changes_sign(force) for force in forces], axis=0))
    corners = np.stack([grid[cells[:, i]] for i, grid in enumerate(grids)], axis=-1)
    sizes = np.stack([np.diff(grid)[cells[:, i]] for i, grid in enumerate(grids)], axis=-1)
    middles = corners + 0.5 * sizes
    design = np.array([wheel.model.design_state[0] for wheel in both])
    for i in np.argsort(((middles - design) ** 2).sum(axis=-1), kind="stable")[:_MOST]:
        found = _newton(axle, both, middles[i], ways, grids)
        # an equilibrium outside of its cell is found from its own
        if found is not None and (np.abs(found[0] - middles[i]) <= np.abs(sizes[i])).all():
            return found
    # of all positions of the other wheel that its drop link reaches
    words = [
        wheel.why(np.fmax.reduce(force[-1]), np.fmin.reduce(force[0]))
        for wheel, force in zip(both, (forces[0], forces[1].T), strict=True)
    ]
    unstable = (
        "it is not carried: no position of both wheels was found that the drop links reach and "
        "that is stable. Give a wheel its travel_mm, or correct the forces."
    )
    raise PositionError("; ".join(filter(None, words)) or unstable)


def _together(axle: Axle, wheels: Sequence[Wheel], grids: Sequence[Array]) -> tuple[Array, Array]:
    """Return the missing forces, (2, left, right) [N], and the torque of the bar [N m]."""
    (left, by_left, one), (right, by_right, other) = (
        wheel.needs(grid) for wheel, grid in zip(wheels, grids, strict=True)
    )
    assert axle.bar is not None
    torque = axle.bar.rate() * (one[:, None] - other - axle.bar.free_twist())
    return np.stack([left[:, None] + by_left[:, None] * torque, right + by_right * torque]), torque


def _newton(
    axle: Axle, wheels: Sequence[Wheel], begin: Array, ways: Array, grids: Sequence[Array]
) -> tuple[Array, float] | None:
    """Return a stable equilibrium near some angles, with the torque of the bar there."""
    low, high = ([end(grid) for grid in grids] for end in (np.min, np.max))

    def at(angles: Array) -> tuple[Array, Array, float]:
        angles = np.clip(angles, low, high)  # a step of the search may lead out of the reach
        near = [angle + np.array([-_STEP, 0.0, _STEP]) for angle in angles]
        forces, torque = _together(axle, wheels, near)
        slopes = [forces[:, 2, 1] - forces[:, 0, 1], forces[:, 1, 2] - forces[:, 1, 0]]
        return forces[:, 1, 1], np.stack(slopes, axis=-1) / (2.0 * _STEP), float(torque[1, 1])

    search: Any = root  # its stubs know no function that gives its slopes as well
    try:
        solved = search(lambda angles: at(angles)[:2], begin, jac=True, options={"xtol": 1e-14})
        missing, slopes, _ = at(solved.x)
        angles = solved.x - np.linalg.solve(slopes, missing)
        missing, slopes, torque = at(angles)
    except (ModelError, np.linalg.LinAlgError):  # it has come to where a drop link does not reach
        return None
    stiffness = slopes * ways  # upward
    stable = (np.diag(stiffness) > 0.0).all() and np.linalg.det(stiffness) > 0.0
    return (angles, torque) if stable and np.abs(missing).max() < _FOUND else None


def _changes_sign(values: Array) -> NDArray[np.bool_]:
    """Tell of each cell of a grid whether there is a zero between its corners."""
    corners = np.stack([values[:-1, :-1], values[1:, :-1], values[:-1, 1:], values[1:, 1:]])
    found: NDArray[np.bool_] = (corners.min(axis=0) <= 0.0) & (corners.max(axis=0) >= 0.0)
    return found
