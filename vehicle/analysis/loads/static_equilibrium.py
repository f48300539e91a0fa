"""Equilibrium positions of the wheels of an assembly under load cases.

Virtual work gives the missing vertical force of the road on each wheel at every position. Newton's
method with bounded steps finds a stable position at which no force is missing: for a single wheel
between the two positions of a grid over its travel nearest to design that enclose one; for several
wheels from the cells of such a grid nearest to design, or from design if there are none.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ....core.named_types import Array
from ...assembly.assembly import HeldAssembly
from ...assembly.load import known
from ...assembly.rig import WheelReach
from ...models.reach import PositionError
from .applied_loads import AppliedLoads, wheels_of
from .balance import DEAD_POINT
from .virtual_work import VirtualWork

Booleans = NDArray[np.bool_]
Rows = NDArray[np.int64]

# Positions over the travel, about 2 mm apart. The first and last are left out: a linkage that locks
# at the end of its reach carries any load, with forces that break it.
_GRID = 101
# Steps of differences: a tenth of the last step, so that a stop just in contact does not affect
# the gap beside it; at most and at least [m or rad].
_WIDEST, _LEAST = 1e-5, 1e-10
# Rounding of a missing force, as a part of the stiffness and of the loads.
_ROUNDING, _PART = 1e-13, 1e-12
# A missing force below this is zero [N].
_FOUND = 1e-7
# The least stiffness in a step [N/m or N/rad], and the longest step of a wheel [m or rad].
_LEAST_RATE, _LONGEST = 100.0, 0.05
# Most steps: for 0.5 m and contact with a stop; steps that lead out of the reach are halved until
# they are shorter than this.
_MOST, _SHORTEST = 60, 1e-4
# Cells from which the search of several wheels begins.
_TRIES = 20
# Positions of a wheel this close, with missing forces of either sign, are a dead point [rad].
_POLE = 1e-9

_LOCKED = (
    "there is no equilibrium: the axle would be in balance only at the end of its reach, where its "
    "rods lock, or beyond a gap of it. Add a [bump_stop] and a [rebound_stop] to the file, or give "
    "the case a travel_mm."
)
_UNSTABLE = (
    "there is no stable equilibrium near design. Give a wheel a travel_mm, or correct the forces."
)


def static_equilibrium(assembly: HeldAssembly, loads: AppliedLoads) -> tuple[Array, list[str]]:
    """Return the equilibrium positions of wheels under loads, or reasons why there is none.

    Positions, (n, wheels), are as in `HeldAssembly.at_wheel_coordinates`, and NaN in cases without
    equilibrium; reasons are empty for the others.
    """
    found, why, first = [], [], 0
    for one in assembly.independent:
        own = slice(first, first + len(one.wheels))
        search = _CoupledSearch.of(one, loads.on(own))
        search.go()
        found.append(search.coordinates)
        several = len(one.wheels) < len(assembly.wheels)
        words = f"{' and '.join(one.wheels)}: " if several else ""
        why.append([reason and words + reason for reason in search.reasons])
        first = own.stop
    reasons = [" ".join(filter(None, text)) for text in zip(*why, strict=True)]
    lost = np.array([bool(reason) for reason in reasons])
    return np.where(lost[:, None], np.nan, np.concatenate(found, axis=1)), reasons


@dataclass(frozen=True)
class _CoupledSearch:
    """The search for equilibria of coupled wheels in n cases, whose arrays change in place."""

    assembly: HeldAssembly
    loads: AppliedLoads
    coordinates: Array  # (n, wheels), and their bounds
    low: Array
    high: Array
    widths: Array  # of differences, (n,)
    reasons: list[str]  # why a case has no equilibrium

    @classmethod
    def of(cls, assembly: HeldAssembly, loads: AppliedLoads) -> "_CoupledSearch":
        """Return a search that begins at design, or at the given travel of held wheels."""
        count = len(loads.racks)
        coordinates = np.tile(assembly.design_wheel_coordinates, (count, 1))
        ends = np.full((2, *coordinates.shape), np.inf)
        search = cls(
            assembly, loads, coordinates, -ends[0], ends[1], np.full(count, _WIDEST), [""] * count
        )
        for row in np.flatnonzero(~loads.free.all(axis=1)):
            travels = [None if np.isnan(t) else float(t) for t in loads.travels[row]]
            try:
                coordinates[row] = assembly.wheel_coordinates(travels, float(loads.racks[row]))
            except PositionError as error:
                search.reasons[row] = str(error)
        return search

    @property
    def single(self) -> bool:
        """Whether there is one wheel."""
        return len(self.assembly.wheels) == 1

    @property
    def _around(self) -> Array:
        """Directions of differences: none, down for each wheel, up for each wheel."""
        one = np.eye(len(self.assembly.wheels))
        return np.concatenate([0.0 * one[:1], -one, one])

    def open(self) -> Rows:
        """Return the cases without a reason against them."""
        return np.array([i for i, reason in enumerate(self.reasons) if not reason], dtype=int)

    def go(self) -> None:
        """Move the cases to equilibrium, or note the reasons why there is none."""
        self._bound()
        rows = self.open()
        for row in rows[~self.assembly.reached(self.coordinates[rows], self.loads.racks[rows])]:
            self.reasons[row] = _UNSTABLE
        self._walk(self._near_cells(self.open()))
        rows = self.open()
        rows = rows[self.loads.free[rows].any(axis=-1)]
        for row in rows[self.assembly.locked(self.coordinates[rows], self.loads.racks[rows])]:
            self.reasons[row] = _LOCKED

    # -- start ------------------------------------------------------------------------------------

    def _bound(self) -> None:
        """Set the bounds of free wheels: their reach, or about an equilibrium of a single one."""
        rows = self.open()
        rows = rows[self.loads.free[rows].any(axis=-1)]
        for rack in dict.fromkeys(self.loads.racks[rows]):
            own = rows[self.loads.racks[rows] == rack]
            try:
                reach = self.assembly.wheel_reach(float(rack))
            except PositionError as error:
                for row in own:
                    self.reasons[row] = str(error)
                continue
            if reach is None:
                continue
            if self.single:
                self._bracket(own, reach[0])
                continue
            ends = np.array([np.linspace(*one.coordinate, _GRID)[[1, -2]] for one in reach])
            self.low[own], self.high[own] = ends.T

    def _bracket(self, rows: Rows, reach: WheelReach) -> None:
        """Set the bounds of cases to the grid positions nearest to design about an equilibrium."""
        grid = np.linspace(*reach.coordinate, _GRID)[1:-1]
        racks = np.full(grid.shape, self.loads.racks[rows[0]])
        poses = self.assembly.at_wheel_coordinates(grid[:, None], racks)
        work = VirtualWork.of(poses, self.assembly.acting(poses))
        away = np.abs(grid[:-1] - self.assembly.design_wheel_coordinates)
        for row in rows:
            held = work.missing(self.loads.at(poses, np.full(grid.size, row)))[:, 0]
            # about a stable position the missing force increases with height
            stable = (held[:-1] <= 0.0) & (held[1:] > 0.0)
            if not stable.any():
                self.reasons[row] = self._not_carried(reach, held)
                continue
            at = int(np.where(stable, away, np.inf).argmin())
            self.low[row], self.high[row] = grid[at], grid[at + 1]
            self.coordinates[row] = 0.5 * (grid[at] + grid[at + 1])

    # -- iteration --------------------------------------------------------------------------------

    def _near_cells(self, rows: Rows) -> Rows:
        """Move cases of several wheels to equilibrium in a cell of a grid; return the others.

        In these cells, the nearest to design first, the missing forces of all free wheels change
        their signs.
        """
        if self.single or not np.isfinite(self.low[rows]).any():
            return rows
        start, low, high = (each.copy() for each in (self.coordinates, self.low, self.high))
        cells = self._cells(rows)
        for tried in range(_TRIES):
            now = np.array([row for row in rows if tried < len(cells[row])], dtype=int)
            for row in now:
                middle, size = cells[row][tried]
                self.coordinates[row], self.widths[row] = middle, _WIDEST
                self.low[row], self.high[row] = middle - size, middle + size
            self._walk(now)
            lost = np.array([row for row in now if self.reasons[row]], dtype=int)
            for row in lost:
                self.reasons[row] = ""
            rows = np.setdiff1d(rows, np.setdiff1d(now, lost))
        for mine, begun in ((self.coordinates, start), (self.low, low), (self.high, high)):
            mine[rows] = begun[rows]
        self.widths[rows] = _WIDEST
        return rows

    def _cells(self, rows: Rows) -> dict[int, list[tuple[Array, Array]]]:
        """Return middle and size of the cells of each case, the nearest to design first."""
        together: dict[tuple[Any, ...], list[int]] = {}
        for row in rows:
            # all cases with free wheels and the same rack position have one grid
            alone = () if self.loads.free[row].all() else (int(row),)
            together.setdefault((float(self.loads.racks[row]), *alone), []).append(int(row))
        return {
            row: cells
            for own in together.values()
            for row, cells in zip(own, self._on_a_grid(own), strict=True)
        }

    def _on_a_grid(self, rows: list[int]) -> Iterator[list[tuple[Array, Array]]]:
        """Yield the cells of cases on one grid.

        The missing force of a wheel is that without the bar, which depends on its own coordinate,
        plus the torque of the bar, which depends on both, times a factor.
        """
        first, free = rows[0], self.loads.free[rows[0]]
        ends = zip(self.low[first], self.high[first], self.coordinates[first], free, strict=True)
        grids = [np.linspace(a, b, _GRID - 2) if f else np.array([at]) for a, b, at, f in ends]
        shape = tuple(grid.size for grid in grids)
        places = np.stack(np.broadcast_arrays(*grids), axis=-1)
        mesh = _on_mesh(places, shape)
        racks = np.full(len(places), self.loads.racks[first])
        poses = self.assembly.at_wheel_coordinates(places, racks)
        alone = VirtualWork.of(poses, {suffix: known(group) for suffix, group in poses.items()})
        by_torque = VirtualWork.of(poses, self.assembly.bar_loads(poses)).missing()  # [1/m]
        by_torque = _on_mesh(by_torque, shape)
        assert self.assembly.bar is not None  # it couples the wheels
        twists = np.stack([*self.assembly.bar_twist(poses).values()], axis=-1)
        torque = self.assembly.bar.torque(_on_mesh(twists, shape).sum(axis=-1, keepdims=True))
        sizes = np.array([grid[1] - grid[0] if grid.size > 1 else 0.0 for grid in grids])
        for row in rows:
            missing = alone.missing(self.loads.at(poses, np.full(len(places), row)))
            values = (_on_mesh(missing, shape) + torque * by_torque)[..., free]
            inside = _changes_sign(values, np.flatnonzero(free)).all(axis=-1)
            middles = mesh[tuple(np.argwhere(inside).T)] + 0.5 * sizes
            away = ((middles - self.assembly.design_wheel_coordinates)[:, free] ** 2).sum(axis=-1)
            yield [(middles[i], sizes) for i in np.argsort(away, kind="stable")[:_TRIES]]

    def _walk(self, rows: Rows) -> None:
        for _ in range(_MOST):
            if rows.size == 0:
                return
            missing, slopes = self._needs(rows)
            going = ~self._ended(rows, missing, slopes)
            rows, missing, slopes = rows[going], missing[going], slopes[going]
            if self.single:  # the bounds on either side of the equilibrium
                below = missing <= 0.0
                self.low[rows] = np.where(below, self.coordinates[rows], self.low[rows])
                self.high[rows] = np.where(below, self.high[rows], self.coordinates[rows])
            steps, at_end = self._within(rows, _steps(missing, slopes))
            moved = self._moved(rows, steps) & ~at_end
            self.widths[rows] = np.clip(0.1 * np.abs(steps).max(axis=-1), _LEAST, _WIDEST)
            for row, force in zip(rows[~moved], missing[~moved], strict=True):
                # a force that changes its sign without a zero is unbounded in between
                self.reasons[row] = DEAD_POINT if self.single else self._at_the_end(row, force)
            rows = rows[moved]
        for row in rows:
            self.reasons[row] = _UNSTABLE

    def _needs(self, rows: Rows) -> tuple[Array, Array]:
        """Return the missing forces, (rows, wheels) [N], and their derivatives in the coordinates.

        The missing force of a held wheel is zero, with the slope of a soft spring.
        """
        size, around = len(self.assembly.wheels), self._around
        widths = self.widths[rows][:, None, None]
        places = (self.coordinates[rows][:, None] + widths * around).reshape(-1, size)
        every = np.repeat(rows, len(around))
        poses = self.assembly.at_wheel_coordinates(places, self.loads.racks[every])
        found = VirtualWork.of(poses, self.assembly.acting(poses)).missing(
            self.loads.at(poses, every)
        )
        found = found.reshape(len(rows), len(around), size)
        slopes = (found[:, 1 + size :] - found[:, 1 : 1 + size]).mT / (2.0 * widths)
        free = self.loads.free[rows]
        both = free[:, :, None] & free[:, None]
        return np.where(free, found[:, 0], 0.0), np.where(both, slopes, _LEAST_RATE * np.eye(size))

    def _ended(self, rows: Rows, missing: Array, slopes: Array) -> Booleans:
        """Return which cases end, with reasons for those without equilibrium."""
        lost = np.asarray(~np.isfinite(missing).all(axis=-1))
        vectors = self.loads.vectors
        acting = np.zeros(len(rows)) if vectors is None else np.abs(vectors[rows]).max((-2, -1))
        stiffest = np.abs(slopes).max(axis=(-2, -1))
        most = np.maximum(_FOUND, _PART * acting + _ROUNDING * stiffest)[:, None]
        still = np.asarray((np.abs(missing) < most).all(axis=-1))
        for row in rows[lost]:
            self.reasons[row] = DEAD_POINT
        stable = np.asarray((np.linalg.eigvals(np.nan_to_num(slopes)).real > 0.0).all(axis=-1))
        for row in rows[still & ~stable]:
            self.reasons[row] = _UNSTABLE
        last = still & stable  # a last step, down to rounding
        self.coordinates[rows[last]] += _steps(missing[last], slopes[last])
        return lost | still

    def _within(self, rows: Rows, steps: Array) -> tuple[Array, Booleans]:
        """Return steps, halfway to a bound instead of beyond it, and where that is too short."""
        here, low, high = self.coordinates[rows], self.low[rows], self.high[rows]
        free = self.loads.free[rows]
        aims, shortest = here + steps, _POLE if self.single else _SHORTEST
        over, under = free & (aims > high + _POLE), free & (aims < low - _POLE)
        inside = np.select([over, under], [0.5 * (high - here), 0.5 * (low - here)], steps)
        return inside, np.asarray(((over | under) & (np.abs(inside) < shortest)).any(axis=-1))

    def _moved(self, rows: Rows, steps: Array) -> Booleans:
        """Move along each step within the reach of the wheels; return which cases moved."""
        if self.single:
            self.coordinates[rows] += steps
            return np.ones(rows.size, dtype=bool)
        waiting, part = np.ones(rows.size, dtype=bool), 1.0
        around = self._around
        while waiting.any() and part * _LONGEST > _SHORTEST:
            which = np.flatnonzero(waiting)
            aims = self.coordinates[rows[which]] + part * steps[which]
            places = (aims[:, None] + _WIDEST * around).reshape(-1, aims.shape[1])
            racks = np.repeat(self.loads.racks[rows[which]], len(around))
            reached = self.assembly.reached(places, racks).reshape(-1, len(around))
            there = np.asarray(reached.all(axis=-1))
            self.coordinates[rows[which[there]]] = aims[there]
            waiting[which[there]], part = False, 0.5 * part
        return ~waiting

    # -- reasons against an equilibrium -----------------------------------------------------------

    def _not_carried(self, reach: WheelReach, held: Array) -> str:
        """Return why spring and stops of a single wheel do not carry a case, with advice."""
        low, high = (1e3 * end for end in reach.height)
        if held[-1] < 0.0:
            problem = f"{_excess(held[-1])}, also near the upper end"
        elif held[0] > 0.0:
            problem = f"{_excess(held[0])}, also near the lower end"
        else:
            problem = "no position is stable"
        return (
            f"there is no equilibrium between wheel heights of {low:.1f} mm and {high:.1f} mm: "
            f"{problem}. {self._advice(0, pressed=held[-1] < 0.0, pulled=held[0] > 0.0)}"
        )

    def _at_the_end(self, row: int, missing: Array) -> str:
        """Return why springs and stops of several wheels do not carry a case, with advice."""
        most = int(np.abs(missing).argmax())
        force = missing[most]
        poses = self.assembly.at_wheel_coordinates(self.coordinates[[row]], self.loads.racks[[row]])
        travels = [1e3 * (w.center - w.design_center)[0, 2] for _, _, w in wheels_of(poses)]
        where = " and ".join(
            f"{travel:.1f} mm at the {wheel}"
            for travel, wheel in zip(travels, self.assembly.wheels, strict=True)
        )
        return (
            f"there is no equilibrium: at travels of {where} wheel {self.assembly.ENDS}, and at "
            f"the {self.assembly.wheels[most]} one {_excess(force)}. "
            f"{self._advice(most, pressed=force < 0.0, pulled=force > 0.0)}"
        )

    def _advice(self, wheel: int, *, pressed: bool, pulled: bool) -> str:
        """Return advice for a wheel that is pressed up or pulled down too much."""
        name = self.assembly.wheels[wheel]
        if pressed and not self.assembly.has_stop(name, "bump_stop"):
            return "Add a [bump_stop] to the file, or give the case a travel_mm."
        if not pressed and pulled and not self.assembly.has_stop(name, "rebound_stop"):
            return "Add a [rebound_stop] to the file, or give the case a travel_mm."
        return "Give the case a travel_mm, or correct the forces."


def _excess(force: float) -> str:
    """Return by how much a load is not carried; `force` is the carried part less the load [N]."""
    direction = "upward" if force < 0.0 else "downward"
    return f"spring and stops carry {abs(force):.4g} N less than the {direction} load"


def _changes_sign(values: Array, axes: NDArray[np.int64]) -> Booleans:
    """Return which values, (..., k), change their signs between the corners of each cell."""
    least = most = values
    for axis in axes:
        count = values.shape[axis] - 1
        ends = [np.arange(count), np.arange(1, count + 1)]
        least = np.minimum(*(np.take(least, end, axis) for end in ends))
        most = np.maximum(*(np.take(most, end, axis) for end in ends))
    return (least <= 0.0) & (most >= 0.0)


def _on_mesh(values: Array, shape: tuple[int, ...]) -> Array:
    """Return values along the grids of wheels, (n, wheels), on their mesh, (..., wheels)."""
    grids = (own[:size] for own, size in zip(values.T, shape, strict=True))
    return np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1)


def _steps(missing: Array, slopes: Array) -> Array:
    """Return Newton's steps, (n, wheels); steps of decreasing energy where it is not stable."""
    rates, ways = np.linalg.eigh(0.5 * (slopes + slopes.mT))
    downhill = (ways * np.maximum(np.abs(rates), _LEAST_RATE)[:, None]) @ ways.mT
    stable = np.asarray((rates > _LEAST_RATE).all(axis=-1))
    followed = np.where(stable[:, None, None], slopes, downhill)
    steps = np.asarray(-np.linalg.solve(followed, missing[..., None])[..., 0], dtype=float)
    longest = np.abs(steps).max(axis=-1, keepdims=True)
    return steps * np.minimum(1.0, _LONGEST / np.maximum(longest, _SHORTEST))
