"""Positions of the wheels of an assembly under load cases.

Each wheel needs a vertical force of the road at every position, by virtual work. All wheels go to
where they need none by Newton's method, in steps that are bounded and down to where it is stable: a
single wheel between two positions of a grid over its travel, those nearest to design between which
it is stable; several wheels from the cells of such a grid that are nearest to design, and from
design where there are none.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...assembly.assembly import HeldAssembly
from ...assembly.load import known
from ...assembly.part_poses import PartPoses
from ...assembly.rig import WheelReach
from ...models.reach import PositionError
from .applied_loads import AppliedLoads, wheels_of
from .balance import DEAD_POINT
from .virtual_work import VirtualWork

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Rows = NDArray[np.int64]

# Positions over the travel between which an equilibrium is looked for: every 2 mm or so. A linkage
# that locks at the end of its reach carries anything, with forces that break it: the first and the
# last are left out.
_GRID = 101
# Steps for slopes: a tenth of the way that was made last, so that a stop which is hardly touched is
# not smeared over the gap beside it, at most and at least [m or rad].
_WIDEST, _LEAST = 1e-5, 1e-10
# Rounding of a missing force: of a coordinate, by what the rates are there, and of what acts.
_ROUNDING, _PART = 1e-13, 1e-12
# So much of it is none in any case [N].
_FOUND = 1e-7
# No stiffness that is followed is less [N/m or N/rad], and no step of a wheel is longer [m or rad].
_LEAST_RATE, _LONGEST = 100.0, 0.05
# A way of 0.5 m, and what a stop that is hit takes besides; steps that lead out of the reach are
# halved until they are shorter than this.
_MOST, _SHORTEST = 60, 1e-4
# Cells from which the search of several wheels begins, the nearest to design first.
_TRIES = 20
# Between so near positions a single wheel that needs a force either way is at a dead point [rad].
_POLE = 1e-9

_LOCKED = (
    "it is not carried: the axle would be in balance only at the end of its reach, where its rods "
    "lock, or beyond a gap of it. Give the file its [bump_stop] and [rebound_stop], or the case "
    "its travel_mm."
)
_UNSTABLE = (
    "it is not carried: no position was found that is stable. Give a wheel its travel_mm, or "
    "correct the forces."
)


def static_equilibrium(assembly: HeldAssembly, loads: AppliedLoads) -> tuple[Array, list[str]]:
    """Return the positions of wheels under loads, and why there is none.

    Parameters
    ----------
    assembly : HeldAssembly
    loads : AppliedLoads

    Returns
    -------
    coordinates : ndarray, shape (n, wheels)
        As of `HeldAssembly.at_wheel_coordinates`; not numbers in cases that are not carried.
    reasons : list of str
        Empty where a case is carried.
    """
    found, why, first = [], [], 0
    for one in assembly.independent:
        own = slice(first, first + len(one.wheels))
        search = _Search.of(one, loads.on(own))
        search.go()
        found.append(search.coordinates)
        several = len(one.wheels) < len(assembly.wheels)
        words = f"{' and '.join(one.wheels)}: " if several else ""
        why.append([reason and words + reason for reason in search.reasons])
        first = own.stop
    reasons = ["; ".join(filter(None, text)) for text in zip(*why, strict=True)]
    lost = np.array([bool(reason) for reason in reasons])
    return np.where(lost[:, None], np.nan, np.concatenate(found, axis=1)), reasons


@dataclass(frozen=True)
class _Search:
    """Cases on their way to the equilibrium of wheels that depend on each other.

    Attributes
    ----------
    assembly : HeldAssembly
    loads : AppliedLoads
    coordinates, low, high : ndarray, shape (n, wheels)
        Where they are, and between which they stay.
    widths : ndarray, shape (n,)
        Of the differences for slopes.
    reasons : list of str
        Why a case is not carried; empty where it is.
    """

    assembly: HeldAssembly
    loads: AppliedLoads
    coordinates: Array
    low: Array
    high: Array
    widths: Array
    reasons: list[str]

    @classmethod
    def of(cls, assembly: HeldAssembly, loads: AppliedLoads) -> "_Search":
        """Begin at design, but with wheels that are held where they are."""
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
        """Positions about one, by wheels: there, below it, and above it."""
        one = np.eye(len(self.assembly.wheels))
        return np.concatenate([0.0 * one[:1], -one, one])

    def open(self) -> Rows:
        """Return the cases that are not given up."""
        return np.array([i for i, reason in enumerate(self.reasons) if not reason], dtype=int)

    def go(self) -> None:
        """Bring cases to equilibrium, or say why there is none."""
        self._bound()
        rows = self.open()
        for row in rows[~self.assembly.reached(self.coordinates[rows], self.loads.racks[rows])]:
            self.reasons[row] = _UNSTABLE
        self._walk(self._near_cells(self.open()))
        rows = self.open()
        rows = rows[self.loads.free[rows].any(axis=-1)]
        for row in rows[self.assembly.locked(self.coordinates[rows])]:
            self.reasons[row] = _LOCKED

    # -- where they begin -------------------------------------------------------------------------

    def _bound(self) -> None:
        """Keep free wheels within their reach, a single one where it is stable."""
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
        """Put cases between the positions nearest to design between which they are stable."""
        grid = np.linspace(*reach.coordinate, _GRID)[1:-1]
        racks = np.full(grid.shape, self.loads.racks[rows[0]])
        poses = self.assembly.at_wheel_coordinates(grid[:, None], racks)
        work = VirtualWork.of(poses, self.assembly.acting(poses))
        away = np.abs(grid[:-1] - self.assembly.design_wheel_coordinates)
        for row in rows:
            held = work.missing(self.loads.at(poses, np.full(grid.size, row)))[:, 0]
            # from low to high the wheel needs more and more of a load to stay, where it is stable
            stable = (held[:-1] <= 0.0) & (held[1:] > 0.0)
            if not stable.any():
                self.reasons[row] = self._not_carried(reach, held)
                continue
            at = int(np.where(stable, away, np.inf).argmin())
            self.low[row], self.high[row] = grid[at], grid[at + 1]
            self.coordinates[row] = 0.5 * (grid[at] + grid[at + 1])

    # -- their way --------------------------------------------------------------------------------

    def _near_cells(self, rows: Rows) -> Rows:
        """Bring cases to equilibrium within a cell of a grid; return those without one.

        Of several wheels each of which has a reach of its own. The cells are those in which the
        missing force of every free wheel changes its sign, the nearest to design first.
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
            free = self.loads.free[row]
            # a grid is that of all cases with one rack whose wheels are free
            alone = () if free.all() else (int(row),)
            together.setdefault((float(self.loads.racks[row]), *alone), []).append(int(row))
        return {
            row: cells
            for own in together.values()
            for row, cells in zip(own, self._on_a_grid(own), strict=True)
        }

    def _on_a_grid(self, rows: list[int]) -> Iterator[list[tuple[Array, Array]]]:
        """Yield the cells of cases whose wheels are on one grid.

        Each wheel misses on its own grid what it does without the bar, and more in proportion to
        the torque of the bar, which depends on both.
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
        by_torque = _on_mesh(self._by_torque(poses), shape)
        torque = self._torque(poses, shape)
        sizes = np.array([grid[1] - grid[0] if grid.size > 1 else 0.0 for grid in grids])
        for row in rows:
            missing = alone.missing(self.loads.at(poses, np.full(len(places), row)))
            values = (_on_mesh(missing, shape) + torque * by_torque)[..., free]
            inside = _changes_sign(values, np.flatnonzero(free)).all(axis=-1)
            middles = mesh[tuple(np.argwhere(inside).T)] + 0.5 * sizes
            away = ((middles - self.assembly.design_wheel_coordinates)[:, free] ** 2).sum(axis=-1)
            yield [(middles[i], sizes) for i in np.argsort(away, kind="stable")[:_TRIES]]

    def _by_torque(self, poses: Mapping[str, PartPoses]) -> Array:
        """Return what each wheel misses by a unit torque of the bar, (n, wheels) [1/m]."""
        return VirtualWork.of(poses, self.assembly.bar_loads(poses)).missing()

    def _torque(self, poses: Mapping[str, PartPoses], shape: tuple[int, ...]) -> Array:
        """Return the torque of the bar on a mesh, (..., 1) [N m]."""
        assert self.assembly.bar is not None  # nothing else joins them
        twists = np.stack([*self.assembly.bar_twist(poses).values()], axis=-1)
        return self.assembly.bar.torque(_on_mesh(twists, shape).sum(axis=-1, keepdims=True))

    def _walk(self, rows: Rows) -> None:
        for _ in range(_MOST):
            if rows.size == 0:
                return
            missing, slopes = self._needs(rows)
            going = ~self._ended(rows, missing, slopes)
            rows, missing, slopes = rows[going], missing[going], slopes[going]
            if self.single:  # what is on either side of the equilibrium
                below = missing <= 0.0
                self.low[rows] = np.where(below, self.coordinates[rows], self.low[rows])
                self.high[rows] = np.where(below, self.high[rows], self.coordinates[rows])
            steps, at_end = self._within(rows, _steps(missing, slopes))
            moved = self._moved(rows, steps) & ~at_end
            self.widths[rows] = np.clip(0.1 * np.abs(steps).max(axis=-1), _LEAST, _WIDEST)
            for row, force in zip(rows[~moved], missing[~moved], strict=True):
                # what changes its sign without a zero is without bound between
                self.reasons[row] = DEAD_POINT if self.single else self._at_the_end(row, force)
            rows = rows[moved]
        for row in rows:
            self.reasons[row] = _UNSTABLE

    def _needs(self, rows: Rows) -> tuple[Array, Array]:
        """Return the missing forces, (rows, wheels) [N], and their slopes by the coordinates.

        A wheel that is held misses none, and does not ask for more than a soft spring does.
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
        missing = np.where(free, found[:, 0], 0.0)
        return missing, np.where(both, slopes, _LEAST_RATE * np.eye(size))

    def _ended(self, rows: Rows, missing: Array, slopes: Array) -> Booleans:
        """Return which cases go no farther, and why those are not carried that are not."""
        lost = np.asarray(~np.isfinite(missing).all(axis=-1))
        vectors = self.loads.vectors
        acting = np.zeros(len(rows)) if vectors is None else np.abs(vectors[rows]).max((-2, -1))
        stiffest = np.abs(slopes).max(axis=(-2, -1))
        most = np.maximum(_FOUND, _PART * acting + _ROUNDING * stiffest)[:, None]
        still = np.asarray((np.abs(missing) < most).all(axis=-1))
        for row in rows[lost]:
            self.reasons[row] = DEAD_POINT
        # less travel needs less force
        rates = np.linalg.eigvals(np.nan_to_num(slopes)).real
        stable = np.asarray((rates > 0.0).all(axis=-1))
        for row in rows[still & ~stable]:
            self.reasons[row] = _UNSTABLE
        last = still & stable  # a last step, down to rounding
        self.coordinates[rows[last]] += _steps(missing[last], slopes[last])
        ended: Booleans = lost | still
        return ended

    def _within(self, rows: Rows, steps: Array) -> tuple[Array, Booleans]:
        """Return steps, over an end as half the way to it, and where that is none."""
        here, low, high = self.coordinates[rows], self.low[rows], self.high[rows]
        free = self.loads.free[rows]
        aims, shortest = here + steps, _POLE if self.single else _SHORTEST
        over, under = free & (aims > high + _POLE), free & (aims < low - _POLE)
        inside = np.select([over, under], [0.5 * (high - here), 0.5 * (low - here)], steps)
        return inside, np.asarray(((over | under) & (np.abs(inside) < shortest)).any(axis=-1))

    def _moved(self, rows: Rows, steps: Array) -> Booleans:
        """Go as far along each step as the wheels reach, and return which have moved."""
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

    # -- why they are not carried -----------------------------------------------------------------

    def _not_carried(self, reach: WheelReach, held: Array) -> str:
        """Say why spring and stops of a single wheel do not carry a case, and what would help."""
        low, high = (1e3 * end for end in reach.height)
        if held[-1] < 0.0:
            problem = f"{-held[-1]:.4g} N too much for spring and stops even near the upper end"
        elif held[0] > 0.0:
            problem = f"it lifts the wheel by {held[0]:.4g} N too much even near the lower end"
        else:
            problem = "no position is stable"
        return (
            f"it is not carried between wheel heights of {low:.1f} mm and {high:.1f} mm: "
            f"{problem}. {self._advice(0, pressed=held[-1] < 0.0, lifted=held[0] > 0.0)}"
        )

    def _at_the_end(self, row: int, missing: Array) -> str:
        """Say why springs and stops of several wheels do not carry a case, and what would help."""
        most = int(np.abs(missing).argmax())
        force = missing[most]
        problem = (
            f"{-force:.4g} N too much for spring and stops"
            if force < 0.0
            else f"a lift of {force:.4g} N too much"
        )
        poses = self.assembly.at_wheel_coordinates(self.coordinates[[row]], self.loads.racks[[row]])
        travels = [1e3 * (w.center - w.design_center)[0, 2] for _, _, w in wheels_of(poses)]
        where = " and ".join(
            f"{travel:.1f} mm at the {wheel}"
            for travel, wheel in zip(travels, self.assembly.wheels, strict=True)
        )
        return (
            f"it is not carried: at travels of {where} wheel {self.assembly.ENDS}, and at the "
            f"{self.assembly.wheels[most]} one there is {problem}. "
            f"{self._advice(most, pressed=force < 0.0, lifted=force > 0.0)}"
        )

    def _advice(self, wheel: int, *, pressed: bool, lifted: bool) -> str:
        """Say what would help a wheel that is pressed or lifted too much."""
        name = self.assembly.wheels[wheel]
        if pressed and not self.assembly.has_stop(name, "bump_stop"):
            return "Give the file its [bump_stop], or the case its travel_mm."
        if not pressed and lifted and not self.assembly.has_stop(name, "rebound_stop"):
            return "Give the file its [rebound_stop], or the case its travel_mm."
        return "Give the case its travel_mm, or correct the forces."


def _changes_sign(values: Array, axes: NDArray[np.int64]) -> Booleans:
    """Return for each cell of a grid which values, (..., k), have a zero between its corners."""
    least = most = values
    for axis in axes:
        count = values.shape[axis] - 1
        ends = [np.arange(count), np.arange(1, count + 1)]
        least = np.minimum(*(np.take(least, end, axis) for end in ends))
        most = np.maximum(*(np.take(most, end, axis) for end in ends))
    found: Booleans = (least <= 0.0) & (most >= 0.0)
    return found


def _on_mesh(values: Array, shape: tuple[int, ...]) -> Array:
    """Return what is along the grids of wheels, (n, wheels), on the mesh of them, (..., wheels)."""
    grids = (own[:size] for own, size in zip(values.T, shape, strict=True))
    return np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1)


def _steps(missing: Array, slopes: Array) -> Array:
    """Return Newton's steps of all wheels, (n, wheels); where it is not stable, steps downhill."""
    rates, ways = np.linalg.eigh(0.5 * (slopes + slopes.mT))
    downhill = (ways * np.maximum(np.abs(rates), _LEAST_RATE)[:, None]) @ ways.mT
    stable = np.asarray((rates > _LEAST_RATE).all(axis=-1))
    followed = np.where(stable[:, None, None], slopes, downhill)
    steps = np.asarray(-np.linalg.solve(followed, missing[..., None])[..., 0], dtype=float)
    longest = np.abs(steps).max(axis=-1, keepdims=True)
    bounded: Array = steps * np.minimum(1.0, _LONGEST / np.maximum(longest, _SHORTEST))
    return bounded
