"""Characteristics of many suspensions that differ in values of their files, all together.

They go through one evaluation of the equations with constants of their own, some hundred at a time,
on all cores. The results agree with those of single suspensions to rounding: both ways find the
arm's angle for a height to its last digits, by different steps. Suspensions that cannot be built
like the others, or may not reach all positions, are evaluated one by one; so are all of them if an
equation refuses a position, so that the reasons are those of single suspensions.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import KintrafoError
from ...core.named_types import Array
from ...core.threads import shared_out
from ...equations.errors import ClosureError
from ...simulation.lanes.run import usual_threads
from ..analysis.compliance.flexibility import HELD
from ..assembly.corner_kinematics import corner
from ..assembly.measures.corner import OVER_RACK, OVER_TRAVEL
from ..assembly.measures.measure import some_of_axle, values
from ..assembly.mirrored_corner import MirroredCorner
from ..assembly.of import assembly_of
from ..corner.corner import Corner
from ..kinds import Suspension
from ..models.model_batch import ModelBatch
from ..models.positions import arm_angles_of_batch
from .curves import Curves, changed
from .design_variables import DesignVariable, is_factor, names_bushes
from .evaluation import Subject

# Cars of a batch: enough that work done once for all is negligible, and few enough that their
# results stay in the cache.
_TOGETHER = 256
# Fewer cars are quicker one by one.
_FEWEST = 3
# How often those who are in the way are left out before all go one by one.
_MOST_TRIES = 8

Finish = Callable[[slice, list[Array], list[str]], None]


def moved_by(places: Sequence[DesignVariable], off: Array) -> dict[str, Array]:
    """Return the values of many files, by place and in its unit there.

    Parameters
    ----------
    places : sequence of DesignVariable
    off : ndarray, shape (count, places)
        By how much they are off, SI units.
    """
    return {
        name: column
        for place, by in zip(places, off.T, strict=True)
        for name, column in place.moved_all(by).items()
    }


def curves_of_many(
    suspension: Subject,
    values: Mapping[str, Array],
    looks: Sequence[Curves],
    finish: Finish,
    *,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> None:
    """Evaluate some curves of many suspensions.

    Parameters
    ----------
    suspension : Suspension, Axle or RigidAxle
        What they are otherwise; axles and rigid axles are evaluated one by one.
    values : mapping of str to ndarray, shape (count,)
        What they have of their own, by place, in the unit of the file.
    looks : sequence of Curves
    finish : callable
        Called for some suspensions at a time, from the thread of the caller: which they are, the
        values of each look, (some, names, positions), and a reason for each, empty where it has
        curves; without they are NaN.
    threads : int, optional
        By default as many as there are cores.
    progress : callable, optional
        Called with the part that is done, up to 1.
    """
    count = next(iter(values.values())).size
    parts = [slice(a, min(a + _TOGETHER, count)) for a in range(0, count, _TOGETHER)]

    def found_in(part: slice, unwanted: Callable[[], bool]) -> tuple[slice, list[Array], list[str]]:
        own = {place: column[part] for place, column in values.items()}
        return part, *_some(suspension, own, looks, unwanted)

    done = 0

    def take(some: tuple[slice, list[Array], list[str]]) -> None:
        nonlocal done
        finish(*some)
        done += some[0].stop - some[0].start
        if progress is not None:
            progress(done / count)

    shared_out(found_in, parts, take, min(threads or usual_threads(), len(parts)))


def _some(
    suspension: Subject,
    values: Mapping[str, Array],
    looks: Sequence[Curves],
    unwanted: Callable[[], bool],
) -> tuple[list[Array], list[str]]:
    """Return the values of each look and the reasons, of some suspensions."""
    count = next(iter(values.values())).size
    found = [np.full((count, len(look.names), look.positions.size), np.nan) for look in looks]
    reasons = [""] * count
    together = np.zeros(count, dtype=bool)
    alone = any(look.over in HELD for look in looks)
    alone = alone or any(map(is_factor, values))
    alone = alone or any(map(names_bushes, values))
    if isinstance(suspension, Suspension) and count >= _FEWEST and not alone:
        together = _together(suspension, values, looks, found)
    for car in np.flatnonzero(~together).tolist():
        if unwanted():
            break
        changes = {place: float(column[car]) for place, column in values.items()}
        try:
            model = assembly_of(changed(suspension, changes))
            own = [look.of(model) for look in looks]
        except KintrafoError as error:
            reasons[car] = str(error)
            own = [np.full(rows.shape[1:], np.nan) for rows in found]
        for rows, curves in zip(found, own, strict=True):
            rows[car] = curves
    return found, reasons


def _together(
    suspension: Suspension,
    values: Mapping[str, Array],
    looks: Sequence[Curves],
    found: Sequence[Array],
) -> NDArray[np.bool_]:
    """Fill what can be found of all together, and return for whom."""
    nominal = _in_file(suspension, values)
    valid = np.ones(next(iter(values.values())).size, dtype=bool)
    for _ in range(_MOST_TRIES):
        cars = np.flatnonzero(valid)
        if cars.size < _FEWEST:
            break
        whole = {place: np.append(nominal[place], values[place][cars]) for place in values}
        try:
            curves, fit = _of_batch(suspension, whole, looks)
        except ClosureError as error:
            # of one that is at a position which the equations refuse
            which = error.index[0] - 1 if error.index else -1
            if which < 0:
                break
            valid[cars[which]] = False
            continue
        except KintrafoError:
            break
        valid[cars] = fit
        if curves:
            for rows, each in zip(found, curves, strict=True):
                rows[cars] = each
            return valid
    return np.zeros_like(valid)


def _of_batch(
    suspension: Suspension, whole: Mapping[str, Array], looks: Sequence[Curves]
) -> tuple[list[Array], NDArray[np.bool_]]:
    """Return the curves of all behind the first, if all of them can be, and who can be."""
    batch = ModelBatch(suspension, whole, free_rack=bool(suspension.neglected_masses()))
    corners = [list(_corners(batch, look)) for look in looks if batch.valid.all()]
    if not batch.valid.all():
        return [], batch.valid[1:]
    every = [_values(look, own) for look, own in zip(looks, corners, strict=True)]
    shape = batch.valid.size
    curves = [
        np.stack(
            [np.broadcast_to(by[n], (shape, look.positions.size))[1:] for n in look.names], axis=1
        )
        for look, by in zip(looks, every, strict=True)
    ]
    return curves, batch.valid[1:]


def _corners(batch: ModelBatch, look: Curves) -> Iterator[Corner]:
    """Yield the corner at the positions of a look, and those of both sides if they are needed.

    These are that of the other side, and the own one with the rack in its middle.

    Suspensions that do not reach the positions are taken out, and no more corners follow then.
    """
    at = look.positions
    still = np.zeros(at.size)
    travel, rack = (at, still) if look.over == "travel" else (still, at)
    both = look.over == "rack" and some_of_axle(OVER_RACK, look.names)
    sides = [(batch, travel, rack)]
    if both:
        sides += [(batch.mirror_image, travel, rack), (batch, still[:1], still[:1])]
    for side, *place in sides:
        angles, reached = arm_angles_of_batch(side, *place)
        batch.mask.valid &= side.valid & reached
        if not batch.valid.all():
            return
        yield corner(side, angles, place[1])


def _values(look: Curves, corners: Sequence[Corner]) -> dict[str, Array]:
    own, *others = corners
    of = MirroredCorner(own, lambda: others[0], lambda: others[1])
    measures = OVER_TRAVEL if look.over == "travel" else OVER_RACK
    return values(measures, of, [*of.corners], look.names)


def _in_file(suspension: Suspension, places: Mapping[str, Array]) -> dict[str, float]:
    """Return the numbers that a file has in some places."""
    data = suspension.to_dict()
    found = {}
    for place in places:
        at: Any = data
        for key in place.split("."):
            at = at["xyz".index(key)] if isinstance(at, list) else at[key]
        found[place] = float(at)
    return found
