"""Characteristics of many suspensions that differ in values of their files.

Some hundred suspensions are evaluated together, on all cores, each with its own constants. The
results agree with those of single suspensions to rounding: the arm's angles are found to their last
digits in both cases, by different steps. Suspensions that cannot be built like the others, or may
not reach all positions, are evaluated one by one; so are all of them if the equations have no
solution at a position, so that the reasons are those of single suspensions.
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
from ..assembly.corner_kinematics import corner
from ..assembly.measures.corner import OVER_RACK, OVER_TRAVEL
from ..assembly.measures.measure import values
from ..assembly.mirrored_corner import MirroredCorner
from ..assembly.of import assembly_of
from ..corner.corner import Corner
from ..kinds import Suspension
from ..models.model_batch import ModelBatch
from ..models.positions import arm_angles_of_batch
from .curves import Curves, changed
from .design_variables import DesignVariable, is_factor, names_bushes
from .evaluation import Subject
from .sweep_axes import sweep_axis

# Cars of a batch: many enough to make common work negligible, few enough for the cache.
_TOGETHER = 256
# Fewer cars are evaluated faster one by one.
_FEWEST = 3
# Attempts to evaluate a batch without those that fail, before all are evaluated one by one.
_MOST_TRIES = 8


def moved_by(places: Sequence[DesignVariable], off: Array) -> dict[str, Array]:
    """Return the values of many files by place, in the unit of the file.

    Deviations from the values of the file have the shape (count, places), SI units.
    """
    return {
        name: column
        for place, by in zip(places, off.T, strict=True)
        for name, column in place.moved(by).items()
    }


def curves_of_many(
    suspension: Subject,
    values: Mapping[str, Array],
    looks: Sequence[Curves],
    *,
    reduced: Callable[[Array], Array] = lambda curves: curves,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> tuple[list[Array], NDArray[np.object_]]:
    """Return the values of each of `looks` for many suspensions, and reasons why some have none.

    Values of each suspension are by place, in the unit of the file; axles and rigid axles are
    evaluated one by one. Curves, (count, names, positions), may be reduced along the positions;
    those of a suspension with a reason are NaN, and other reasons are empty. The default number of
    threads is that of cores.
    """
    count = next(iter(values.values())).size
    parts = [slice(a, min(a + _TOGETHER, count)) for a in range(0, count, _TOGETHER)]
    found: list[Array] = []
    why = np.full(count, "", dtype=object)

    def found_in(part: slice, unwanted: Callable[[], bool]) -> tuple[slice, list[Array], list[str]]:
        own = {place: column[part] for place, column in values.items()}
        return part, *_some(suspension, own, looks, unwanted)

    done = 0

    def take(some: tuple[slice, list[Array], list[str]]) -> None:
        nonlocal done
        part, curves, why[part] = some
        for which, own in enumerate(map(reduced, curves)):
            if not done:
                found.append(np.full((count, *own.shape[1:]), np.nan))
            found[which][part] = own
        done += part.stop - part.start
        if progress is not None:
            progress(done / count)

    shared_out(found_in, parts, take, min(threads or usual_threads(), len(parts)))
    return found, why


def _some(
    suspension: Subject,
    values: Mapping[str, Array],
    looks: Sequence[Curves],
    unwanted: Callable[[], bool],
) -> tuple[list[Array], list[str]]:
    """Return the curves of some suspensions, and reasons for those without."""
    count = next(iter(values.values())).size
    found = [np.full((count, len(look.names), look.positions.size), np.nan) for look in looks]
    reasons = [""] * count
    together = np.zeros(count, dtype=bool)
    alone = any(sweep_axis(look.over).curves is not None for look in looks)
    alone = alone or any(is_factor(place) or names_bushes(place) for place in values)
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
    """Evaluate suspensions together into `found`, and return for which this was possible."""
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
            # the first suspension at a position without a solution
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
    """Return the curves of all but the first, if all are valid, and which of them are."""
    batch = ModelBatch(suspension, whole, free_rack=bool(suspension.neglected_masses()))
    corners = [list(_corners(batch, look)) for look in looks if batch.valid.all()]
    if not batch.valid.all():
        return [], batch.valid[1:]
    curves = []
    for look, own in zip(looks, corners, strict=True):
        by, shape = _values(look, own), (batch.valid.size, look.positions.size)
        curves.append(np.stack([np.broadcast_to(by[n], shape)[1:] for n in look.names], axis=1))
    return curves, batch.valid[1:]


def _corners(batch: ModelBatch, look: Curves) -> Iterator[Corner]:
    """Yield the corner at the positions of curves; if needed also the other side, and the centre.

    Suspensions that do not reach the positions become invalid, and the corners end there.
    """
    at = look.positions
    still = np.zeros(at.size)
    travel, rack = (at, still) if look.over == "travel" else (still, at)
    of_axle = {measure.name for measure in OVER_RACK if measure.scope == "axle"}
    both = look.over == "rack" and not of_axle.isdisjoint(look.names)
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
    """Return the numbers of a file in some places."""
    data = suspension.to_dict()
    found = {}
    for place in places:
        at: Any = data
        for key in place.split("."):
            at = at["xyz".index(key)] if isinstance(at, list) else at[key]
        found[place] = float(at)
    return found
