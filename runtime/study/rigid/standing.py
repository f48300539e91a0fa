"""Where a rigid axle stands under load cases.

Each wheel needs a vertical force of the road at every position. From design on, both wheels go to
where they need none by Newton's method, in steps that are bounded and down to where it is stable.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...assembly.beam import SIDES
from ...assembly.load import Load
from ...assembly.parts import Parts
from ...assembly.poses import CENTER, CONTACT
from ...suspension.reach import PositionError
from ...suspension.rigid.model import RigidAxleModel
from ..loads.balance import DEAD_POINT
from ..loads.cases import Case
from ..loads.dataset import of_side
from ..loads.outside import outside_loads
from .balance import Balance

Array = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Rows = NDArray[np.int64]

# Steps for slopes by the travel: a tenth of the way that was made last, so that a stop which is
# hardly touched is not smeared over the gap beside it, at most and at least [m].
_WIDEST, _LEAST = 1e-5, 1e-10
_AROUND = np.array([[0, 0], [-1, 0], [1, 0], [0, -1], [0, 1]])
# Rounding of a missing force: of a travel [m], by what the rates are there, and of what acts.
_ROUNDING, _PART = 1e-13, 1e-12
# So much of it is none in any case [N].
_FOUND = 1e-7
# No stiffness that is followed is less [N/m], and no step of a wheel is longer [m].
_LEAST_RATE, _LONGEST = 100.0, 0.05
# A way of 0.5 m, and what a stop that is hit takes besides; steps that lead out of the reach are
# halved until they are shorter than this [m].
_MOST, _SHORTEST = 60, 1e-4

# An axle that locks at the end of its reach carries anything, with forces that break it: where it
# stands, it could go as many times as far.
_CLEAR = 1.02

_LOCKED = (
    "it is not carried: the axle would be in balance only at the end of its reach, where its rods "
    "lock, or beyond a gap of it. Give the file its [bump_stop] and [rebound_stop], or the case "
    "its travel_mm."
)
_UNSTABLE = (
    "it is not carried: no position was found that is stable. Give a wheel its travel_mm, or "
    "correct the forces."
)


@dataclass(frozen=True)
class _Search:
    """Cases on their way to where they stand.

    Attributes
    ----------
    model : RigidAxleModel
    cases : sequence of tuple of Case
        For the left and the right wheel.
    free : ndarray of bool, shape (cases, 2)
        Whether a wheel is not held.
    travels : ndarray, shape (cases, 2)
        Of both wheels [m].
    widths : ndarray, shape (cases,)
        Of the differences for slopes [m].
    reasons : list of str
        Why a case is not carried; empty where it is.
    """

    model: RigidAxleModel
    cases: Sequence[tuple[Case, ...]]
    free: Booleans
    travels: Array
    widths: Array
    reasons: list[str]

    @classmethod
    def of(cls, model: RigidAxleModel, cases: Sequence[tuple[Case, ...]]) -> "_Search":
        """Begin at design, but with wheels that are held where they are."""
        travels = np.array([[case.travel or 0.0 for case in both] for both in cases])
        free = np.array([[case.travel is None for case in both] for both in cases])
        reasons = [""] * len(cases)
        for row in np.flatnonzero(model.parts_of_ways(*travels.T) < 1.0):
            try:
                model.states_at(*travels[row])
            except PositionError as error:
                reasons[row] = str(error)
        return cls(model, cases, free, travels, np.full(len(cases), _WIDEST), reasons)

    def go(self) -> None:
        """Bring cases to where they stand, or say why they do not."""
        rows = np.array([row for row, reason in enumerate(self.reasons) if not reason], dtype=int)
        for _ in range(_MOST):
            if rows.size == 0:
                return
            missing, slopes = self.needs(rows)
            going = ~self._ended(rows, missing, slopes)
            rows, missing, slopes = rows[going], missing[going], slopes[going]
            steps = _steps(missing, slopes)
            moved = self._moved(rows, steps)
            self.widths[rows] = np.clip(0.1 * np.abs(steps).max(axis=-1), _LEAST, _WIDEST)
            for row, force in zip(rows[~moved], missing[~moved], strict=True):
                self.reasons[row] = _at_the_end(self.model, self.travels[row], force)
            rows = rows[moved]
        for row in rows:
            self.reasons[row] = _UNSTABLE

    def refuse_ends(self, rows: Rows) -> None:
        """Refuse cases that are carried only where the axle locks, or behind a gap."""
        rows = rows[self.free[rows].any(axis=-1)]
        beyond = self.model.parts_of_ways(*self.travels[rows].T) < 1.0
        margins = self.model.margins(self.model.placed(*(_CLEAR * self.travels[rows]).T))
        # those of the rods; a damper may be near the end of its length
        closing = margins[:, : len(self.model.equations.GUARDS)]
        locked = ~np.asarray((closing > 0.0).all(axis=-1))
        for row in rows[beyond | locked]:
            self.reasons[row] = _LOCKED

    def refuse_pulls(self, rows: Rows) -> None:
        """Refuse cases in which the road would have to pull at a wheel that is held."""
        rows = np.array([row for row in rows if not self.reasons[row]], dtype=int)
        if rows.size == 0:
            return
        missing = self._missing(rows, self.travels[rows][:, None])[:, 0]
        for row, forces in zip(rows, np.where(self.free[rows], 0.0, missing), strict=True):
            words = [
                f"{side}: the road would have to pull the wheel there with {-force:.4g} N."
                for side, force in zip(SIDES, forces, strict=True)
                if force < 0.0
            ]
            lost = not np.isfinite(forces).all()
            self.reasons[row] = DEAD_POINT if lost else "; ".join(words)

    def _missing(self, rows: Rows, travels: Array) -> Array:
        """Return the missing forces of cases at some travels each, (rows, travels, 2) [N]."""
        parts = Parts.of(self.model, self.model.placed(*travels.reshape(-1, 2).T))
        cases = [self.cases[row] for row in rows for _ in range(travels.shape[1])]
        balance = Balance(parts, [*parts.acting(), *outside_of(parts, cases)])
        return np.stack([balance.missing[side] for side in SIDES], -1).reshape(travels.shape)

    def needs(self, rows: Rows) -> tuple[Array, Array]:
        """Return the missing forces, (rows, 2) [N], and their slopes by the travels [N/m].

        A wheel that is held misses none, and does not ask for more than a soft spring does.
        """
        widths = self.widths[rows][:, None, None]
        found = self._missing(rows, self.travels[rows][:, None] + widths * _AROUND)
        slopes = np.stack([found[:, 2] - found[:, 1], found[:, 4] - found[:, 3]], -1)
        free = self.free[rows]
        both = free[:, :, None] & free[:, None]
        missing = np.where(free, found[:, 0], 0.0)
        return missing, np.where(both, slopes / (2.0 * widths), _LEAST_RATE * np.eye(2))

    def _ended(self, rows: Rows, missing: Array, slopes: Array) -> Booleans:
        """Tell which cases go no farther, and why those are not carried that are not."""
        lost = np.asarray(~np.isfinite(missing).all(axis=-1))
        acting = np.abs([[case.vector for case in self.cases[row]] for row in rows]).max((-2, -1))
        stiffest = np.abs(slopes).max(axis=(-2, -1))
        most = np.maximum(_FOUND, _PART * acting + _ROUNDING * stiffest)[:, None]
        still = np.asarray((np.abs(missing) < most).all(axis=-1))
        for row in rows[lost]:
            self.reasons[row] = DEAD_POINT
        # less travel needs less force
        rates = np.linalg.eigvals(np.nan_to_num(slopes)).real
        unstable = still & ~np.asarray((rates > 0.0).all(axis=-1))
        for row in rows[unstable]:
            self.reasons[row] = _UNSTABLE
        ended: Booleans = lost | still
        return ended

    def _moved(self, rows: Rows, steps: Array) -> Booleans:
        """Go so far of each step as the axle reaches, and tell which have gone anywhere."""
        waiting, part = np.ones(rows.size, dtype=bool), 1.0
        while waiting.any() and part * _LONGEST > _SHORTEST:
            which = np.flatnonzero(waiting)
            aims = self.travels[rows[which]] + part * steps[which]
            around = aims[:, None] + _WIDEST * _AROUND
            states = self.model.placed(*around.reshape(-1, 2).T)
            reached = np.asarray((self.model.margins(states) > 0.0).all(axis=-1))
            there = np.asarray(reached.reshape(-1, len(_AROUND)).all(axis=-1))
            parts = Parts.of(self.model, self.model.placed(*aims[there].T))
            there[there] = parts.upright()
            self.travels[rows[which[there]]] = aims[there]
            waiting[which[there]], part = False, 0.5 * part
        return ~waiting


def standing(model: RigidAxleModel, cases: Mapping[str, Sequence[Case]]) -> tuple[Array, list[str]]:
    """Return where both wheels stand in each case, and why they do not.

    Parameters
    ----------
    model : RigidAxleModel
    cases : mapping of str to sequence of Case
        By the sides.

    Returns
    -------
    travels : ndarray, shape (cases, 2)
        Of the left and the right wheel [m]; no numbers in cases that are not carried.
    reasons : list of str
        Empty where a case is carried.
    """
    search = _Search.of(model, [*zip(*(cases[side] for side in SIDES), strict=True)])
    search.go()
    rows = np.flatnonzero([not reason for reason in search.reasons])
    search.refuse_ends(rows)
    search.refuse_pulls(rows)
    lost = np.array([bool(reason) for reason in search.reasons])
    return np.where(lost[:, None], np.nan, search.travels), search.reasons


def outside_of(parts: Parts, cases: Sequence[tuple[Case, ...]]) -> list[Load]:
    """Return what acts on both wheels in each position."""
    loads = []
    for i, side in enumerate(SIDES):
        own = [both[i] for both in cases]
        points = {CONTACT: parts.contact(side), CENTER: parts.points[f"{CENTER}_{side}"]}
        found = outside_loads(own, parts.wheel_axes(side), points)
        loads += [of_side(load, f"_{side}") for load in found]
    return loads


def _steps(missing: Array, slopes: Array) -> Array:
    """Return Newton's steps of both wheels, (n, 2) [m]; where it is not stable, steps downhill."""
    rates, ways = np.linalg.eigh(0.5 * (slopes + slopes.mT))
    downhill = (ways * np.maximum(np.abs(rates), _LEAST_RATE)[:, None]) @ ways.mT
    stable = np.asarray((rates > _LEAST_RATE).all(axis=-1))
    followed = np.where(stable[:, None, None], slopes, downhill)
    steps = np.asarray(-np.linalg.solve(followed, missing[..., None])[..., 0], dtype=float)
    longest = np.abs(steps).max(axis=-1, keepdims=True)
    bounded: Array = steps * np.minimum(1.0, _LONGEST / np.maximum(longest, _SHORTEST))
    return bounded


def _at_the_end(model: RigidAxleModel, travels: Array, missing: Array) -> str:
    """Say why springs and stops do not carry a case, and what would help."""
    most = int(np.abs(missing).argmax())
    side, force = SIDES[most], missing[most]
    advice = "Give the case its travel_mm, or correct the forces."
    if force < 0.0:
        problem = f"{-force:.4g} N too much for spring and stops"
        if model.axle.bump_stop is None:
            advice = "Give the file its [bump_stop], or the case its travel_mm."
    else:
        problem = f"a lift of {force:.4g} N too much"
        if model.axle.rebound_stop is None:
            advice = "Give the file its [rebound_stop], or the case its travel_mm."
    left, right = 1e3 * travels
    return (
        f"it is not carried: at travels of {left:.1f} mm at the left and {right:.1f} mm at the "
        "right wheel a rod or a damper reaches no farther, or a spring or a damper has turned by a "
        f"right angle, and at the {side} one there is {problem}. {advice}"
    )
