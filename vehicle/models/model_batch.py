"""A batch of suspensions of one kind that differ in values of their files, as one model.

The file of the first one is read and checked as usual. The sections of the batch have numbers of a
batch as values that differ (see `core.columns`), so that the code of one suspension computes
checks, centres of mass, free lengths and all parameters once for all: in 20 microseconds per
suspension, while reading and checking a file takes a millisecond. A suspension that fails a check
that the first one passes, or takes another branch, is not in the batch.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.columns import BatchMask, BatchNumber, stacked
from ...core.named_types import Array
from ...core.physical import impossible
from ...systems.allowed import LengthLimit
from ..corner.geometry import problems_of_sections
from ..input.section import Section, metadata_of
from ..kinds import Suspension
from .model import Model
from .packaged import equations_of

_COMPONENTS = {"x": 0, "y": 1, "z": 2}
# Values with the opposite sign in the mirror image, by section and the end of the place.
_REVERSED = {
    "hardpoints": (".y",),
    "bodies": (".com_mm.y", ".inertia_xy_kg_m2", ".inertia_yz_kg_m2"),
    "rack": (".axis.x", ".axis.z"),
}


class ModelBatch(Model):
    """The models of a batch of suspensions as one model, whose arrays have a leading axis for them.

    It is evaluated as a `Model`, with states of shape (count, positions, elements). `values` are
    those that differ, by place in the file and in its unit, (count,) each; the first ones are those
    of `suspension`, whose model is `first`. The attribute `suspension` has numbers of a batch as
    these values; `constants` and `design_state` have the shape (count, 1, ...).
    """

    def __init__(
        self, suspension: Suspension, values: Mapping[str, Array], *, free_rack: bool
    ) -> None:
        # the attributes of a `Model`, whose __init__ is not called
        count = next(iter(values.values())).size
        mask = BatchMask(count)
        self._first, self._values = suspension, values
        self.mask = mask
        columns = {place: BatchNumber(column, mask) for place, column in values.items()}
        mask.valid &= np.isfinite(np.array([*values.values()])).all(axis=0)
        self.suspension = _with_columns(suspension, columns)
        self.free_rack, self.wheel_loads = free_rack, False
        self.names = suspension.NAMES
        self.equations = equations_of(suspension, free_rack=free_rack)
        _check(self.suspension)
        # these choose equations and limits; suspensions with other ones are removed
        equations_of(self.suspension, free_rack=free_rack)
        self.suspension.neglected_masses()
        self.suspension.tyre_radius()
        self._allowed = tuple(map(_allowed, self.suspension.allowed_lengths()))
        self.first = Model(suspension, free_rack=free_rack)
        parameters = self.first.parameters
        own = {name: stacked(value) for name, value in self.suspension.parameters().items()}
        table = np.array(
            [np.broadcast_to(own.get(name, known), count) for name, known in parameters.items()]
        ).T
        mask.valid &= np.isfinite(table).all(axis=1)
        table[~mask.valid] = table[0]
        named = dict(zip(parameters, table.T, strict=True))
        mask.valid &= ~impossible(named, self.equations.PARAMETERS, count)
        table[~mask.valid] = table[0]
        constants, design, failed = self.equations.prepare_many(table)
        mask.valid &= ~failed
        constants[failed], design[failed] = constants[0], design[0]
        self.parameters = parameters
        self.constants, self.design_state = constants[:, None], design[:, None]

    @property
    def valid(self) -> NDArray[np.bool_]:
        """Which suspensions are in the batch."""
        return self.mask.valid

    def of(self, some: NDArray[np.int64]) -> "ModelBatch":
        if some.size == len(self.constants):
            return self
        part = object.__new__(ModelBatch)
        vars(part).update(vars(self))
        part.constants, part.design_state = self.constants[some], self.design_state[some]
        part._allowed = tuple(_allowed_of(one, some) for one in self._allowed)
        return part

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return the lengths that the files allow; limits that differ have the shape (count, 1)."""
        return self._allowed

    @cached_property
    def mirror_image(self) -> "ModelBatch":
        values = {
            place: 0.0 - column
            if place.endswith(_REVERSED.get(place.partition(".")[0], ()))
            else column
            for place, column in self._values.items()
        }
        return ModelBatch(self._first.mirrored(), values, free_rack=self.free_rack)


def _allowed(one: LengthLimit) -> LengthLimit:
    limit: Any = one.limit
    if not isinstance(limit, BatchNumber):
        return one
    limits: Any = limit.values[:, None]
    return one._replace(limit=limits)


def _allowed_of(one: LengthLimit, some: NDArray[np.int64]) -> LengthLimit:
    limit: Any = one.limit
    return one._replace(limit=limit[some]) if np.ndim(limit) else one


def _with_columns(section: Any, columns: Mapping[str, BatchNumber]) -> Any:
    """Return a section with numbers of a batch at some places, their ranges checked."""
    inner: dict[str, dict[str, BatchNumber]] = {}
    changed: dict[str, Any] = {}
    for place, column in columns.items():
        key, _, rest = place.partition(".")
        if rest:
            inner.setdefault(key, {})[rest] = column
        else:
            _check_range(type(section), key, column)
            changed[key] = column
    for key, further in inner.items():
        part = getattr(section, key)
        if isinstance(part, Section):
            changed[key] = _with_columns(part, further)
        else:
            point = list(part)
            for axis, column in further.items():
                point[_COMPONENTS[axis]] = column
            changed[key] = tuple(point)
    return section.model_copy(update=changed)


def _check_range(kind: type[Section], key: str, column: BatchNumber) -> None:
    """Remove suspensions with a value that the field does not allow."""
    for limit in metadata_of(kind.model_fields[key]):
        for name, question in _QUESTIONS.items():
            bound = getattr(limit, name, None)
            if bound is not None:
                column.mask.valid &= question(column.values, bound)


_QUESTIONS: dict[str, Callable[[Array, float], NDArray[np.bool_]]] = {
    "ge": np.greater_equal,
    "gt": np.greater,
    "le": np.less_equal,
    "lt": np.less,
}


def _check(suspension: Suspension) -> None:
    """Remove suspensions that fail a check."""
    sections = {name: getattr(suspension, name) for name in type(suspension).model_fields}
    for section in _sections(suspension):
        section.problems()
    parts = {n: s for n, s in sections.items() if s is None or isinstance(s, Section)}
    suspension.hardpoints.unit_problems()
    problems_of_sections(parts, suspension.further_problems)


def _sections(section: Section) -> Iterator[Section]:
    for name in type(section).model_fields:
        part = getattr(section, name)
        if isinstance(part, Section):
            yield part
            yield from _sections(part)
