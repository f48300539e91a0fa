"""Many systems of one model in the form that C integrates."""

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...systems.system import System
from ..accuracy import Accuracy
from ..dead_points import meanings
from ..signals import TimeInputs
from . import library

Numbers = NDArray[np.int32]


class End(IntEnum):
    """The end of a system; the numbers of ``ensemble.h``."""

    WAITING = 0
    DONE = 1
    PARAMETERS = 2
    REFUSED = 3
    DEAD_POINT = 4
    SMALL_STEP = 5
    MANY_STEPS = 6
    STIFF = 7


class Kind(IntEnum):
    """A number that C accumulates of a signal; the numbers of ``ensemble.h``."""

    GREATEST = 0
    LEAST = 1
    FIRST = 2
    SUM = 3
    SQUARES = 4
    ABOVE = 5
    LAST = 6


class Reduction(NamedTuple):
    """A number that C accumulates of one signal."""

    item: int  # index among the items
    kind: Kind
    # for a sum: index of the reduction with the first value, which is before it; for `Kind.ABOVE`:
    # that with the last value, which is after it
    origin: int = 0
    level: float = 0.0  # of `Kind.ABOVE`


@dataclass(frozen=True)
class Systems:
    """The values of the systems."""

    count: int
    parameters: Array  # common values, in the order of the model's parameters
    varied: Numbers  # indices of the parameters that differ between systems
    variants: Array  # (count, number of varied)
    # initial states; NaN for elements of the design position, (count or 1, number of state
    # elements)
    states: Array
    inputs: Array  # values of the inputs that do not vary with time, (count or 1, number of inputs)
    drives: Sequence[TimeInputs]  # inputs over time; the same inputs vary in all
    drive_of: Numbers  # index into the drives for each system, (count,)
    # systems with parameters out of their ranges, which are not integrated, (count,)
    left_out: NDArray[np.bool_]


@dataclass(frozen=True)
class LaneOutputs:
    """The results of each motion."""

    times: Array  # of the outputs, increasing [s]
    items: Numbers  # indices of signals, followed by those of elements of the state
    sample_count: int  # number of items, from the first, that are kept at all times
    reductions: Sequence[Reduction]
    weights: Array  # weight of each output in time [s]
    bound_items: Numbers  # indices of signals that have a bound
    above: Numbers  # 1 for an upper bound, else 0
    limits: Array  # (count or 1, number of bounds)


class Outcome:
    """The results of many integrations, an element or a row for each system.

    `ends` has an `End` each; `codes` are details: the return value of prepare, a status word, or
    the index of a guard. `ended` is the time that was reached, or at which a state was refused [s],
    `finals` the state that was reached, `beyond` the value farthest beyond each bound, NaN if it
    was not passed.
    """

    def __init__(self, systems: Systems, wanted: LaneOutputs, state_count: int) -> None:
        count, bounds = systems.count, wanted.bound_items.size
        self.ends = np.where(systems.left_out, End.PARAMETERS, End.WAITING).astype(np.int32)
        self.codes = np.zeros(count, dtype=np.int32)
        self.ended = np.full(count, np.nan)
        self.finals = np.full((count, state_count), np.nan)
        self.steps = np.zeros(count, dtype=np.dtype(ctypes.c_long))
        self.reduced = np.full((count, len(wanted.reductions)), np.nan)
        self.beyond = np.full((count, bounds), np.nan)


_DOUBLES, _INTS = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int)


class _Profile(ctypes.Structure):
    _fields_ = [("pieces", ctypes.c_int), ("breaks", _DOUBLES), ("coefficients", _DOUBLES)]


class _Segment(ctypes.Structure):
    _fields_ = [
        ("end", ctypes.c_double),
        ("profiles", ctypes.POINTER(_Profile)),
        ("milestone_count", ctypes.c_long),
        ("milestones", _DOUBLES),
        ("turn_count", ctypes.c_long),
        ("turns", _DOUBLES),
        ("reaches", _DOUBLES),
    ]


class _Drive(ctypes.Structure):
    _fields_ = [("segment_count", ctypes.c_int), ("segments", ctypes.POINTER(_Segment))]


class _Reduction(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_int) for name in ("item", "kind", "origin")),
        ("level", ctypes.c_double),
    ]


class _Problem(ctypes.Structure):
    """``kt_problem`` of ``ensemble.h``."""

    _fields_ = [
        *((n, ctypes.c_void_p) for n in ("prepare", "design_state", "rhs", "signals", "margins")),
        *(
            (f"{n}_count", ctypes.c_int)
            for n in (
                "parameter",
                "constant",
                "state",
                "input",
                "signal",
                "guard",
                "position",
            )
        ),
        ("guards", _INTS),
        ("parameters", _DOUBLES),
        ("varied_count", ctypes.c_int),
        ("varied", _INTS),
        ("variants", _DOUBLES),
        ("states", _DOUBLES),
        ("state_stride", ctypes.c_long),
        ("inputs", _DOUBLES),
        ("input_stride", ctypes.c_long),
        ("drives", ctypes.POINTER(_Drive)),
        ("drive_of", _INTS),
        ("course_count", ctypes.c_int),
        ("targets", _INTS),
        ("start", ctypes.c_double),
        ("end", ctypes.c_double),
        ("time_count", ctypes.c_long),
        ("times", _DOUBLES),
        ("rtol", ctypes.c_double),
        ("atol", _DOUBLES),
        ("first_step", ctypes.c_double),
        ("max_step", ctypes.c_double),
        ("max_steps", ctypes.c_long),
        ("stiff_after", ctypes.c_long),
        ("items", _INTS),
        ("sample_count", ctypes.c_int),
        ("samples", _DOUBLES),
        ("first_sampled", ctypes.c_long),
        ("reduction_count", ctypes.c_int),
        ("reductions", ctypes.POINTER(_Reduction)),
        ("weights", _DOUBLES),
        ("reduced", _DOUBLES),
        ("bound_count", ctypes.c_int),
        ("bound_items", _INTS),
        ("above", _INTS),
        ("limits", _DOUBLES),
        ("limit_stride", ctypes.c_long),
        ("beyond", _DOUBLES),
        ("ends", _INTS),
        ("codes", _INTS),
        ("ended", _DOUBLES),
        ("finals", _DOUBLES),
        ("steps", ctypes.POINTER(ctypes.c_long)),
    ]


@dataclass
class Problem:
    """Systems in the memory of C, which exists as long as this object.

    `width` is the number of lanes; a stiff system ends after `stiff_after` steps, unless this is 0.
    """

    model: System
    systems: Systems
    wanted: LaneOutputs
    accuracy: Accuracy
    width: int
    stiff_after: int = 0
    outcome: Outcome = field(init=False)
    _kept: list[Any] = field(init=False, default_factory=list)
    _c: _Problem = field(init=False)
    _shown: "_Shown" = field(init=False)

    def __post_init__(self) -> None:
        self.outcome = Outcome(self.systems, self.wanted, len(self.model.state_names))
        self._shown = _Shown.of(self.model, self.wanted)
        self._c = _Problem(
            **self._of_model(),
            **self._of_systems(),
            **self._of_drives(),
            **self._of_accuracy(),
            **self._of_wanted(),
            **self._of_outcome(),
            # samples are set in `integrate`
        )
        self._call = library.solver("integrate", self.width)

    def integrate(self, first: int, last: int, stop: "ctypes.c_int") -> Array:
        """Integrate some of the systems, until `stop` is not zero, and return their samples.

        They have the shape (last - first, sample_count, number of times), NaN after the end of a
        system.
        """
        wanted = self.wanted
        samples = np.full((last - first, wanted.sample_count, wanted.times.size), np.nan)
        own = _Problem.from_buffer_copy(self._c)
        own.samples, own.first_sampled = samples.ctypes.data_as(_DOUBLES), first
        failed = self._call(
            ctypes.byref(own), ctypes.c_long(first), ctypes.c_long(last), ctypes.byref(stop)
        )
        if failed:
            raise MemoryError
        return samples

    # -- arrays of C ------------------------------------------------------------------------------

    def _doubles(self, values: Any) -> Any:
        return self._pointer(values, np.float64, _DOUBLES)

    def _ints(self, values: Any) -> Any:
        return self._pointer(values, np.int32, _INTS)

    def _pointer(self, values: Any, kind: type, pointer: Any) -> Any:
        """Return a pointer to numbers, which stay in memory; those of an outcome are not copied."""
        array: NDArray[Any] = np.ascontiguousarray(values, dtype=kind)
        self._kept.append(array)
        return array.ctypes.data_as(pointer)

    def _array(self, kind: type[ctypes.Structure], elements: Sequence[Any]) -> Any:
        array: Any = (kind * max(1, len(elements)))(*elements)
        self._kept.append(array)
        return array

    # -- parts ------------------------------------------------------------------------------------

    def _of_model(self) -> dict[str, Any]:
        model, equations = self.model, self.model.equations
        variant = _common_variant(self.systems.drives)
        functions = dict(library.functions(equations, self.width, variant))
        bounded = functions.pop("bounded")
        if self._shown.bounded:
            functions["signals"] = bounded
        guards = meanings(equations)
        return {
            **functions,
            "parameter_count": len(equations.PARAMETERS),
            "constant_count": len(equations.CONSTANTS),
            "state_count": len(model.state_names),
            "input_count": len(model.input_names),
            "signal_count": self._shown.signal_count,
            "guard_count": len(guards),
            "position_count": model.layout.positions,
            "guards": self._ints(guards),
        }

    def _of_systems(self) -> dict[str, Any]:
        systems = self.systems
        states, inputs = systems.states, systems.inputs
        return {
            "parameters": self._doubles(systems.parameters),
            "varied_count": systems.varied.size,
            "varied": self._ints(systems.varied),
            "variants": self._doubles(systems.variants),
            "states": self._doubles(states),
            "state_stride": 0 if len(states) == 1 else states.shape[1],
            "inputs": self._doubles(inputs),
            "input_stride": 0 if len(inputs) == 1 else inputs.shape[1],
        }

    def _of_drives(self) -> dict[str, Any]:
        drives = self.systems.drives
        splines = drives[0].segments[0].splines
        found = [self._drive(drive) for drive in drives]
        return {
            "drives": self._array(_Drive, found),
            "drive_of": self._ints(self.systems.drive_of),
            "course_count": len(splines),
            "targets": self._ints([target for spline in splines for target in spline.targets]),
        }

    def _drive(self, drive: TimeInputs) -> _Drive:
        def profile(curve: Any) -> _Profile:
            return _Profile(curve.c.shape[1], self._doubles(curve.x), self._doubles(curve.c))

        segments = [
            _Segment(
                segment.end,
                self._array(_Profile, [profile(s.curve) for s in segment.splines]),
                milestones.size,
                self._doubles(milestones),
                turns.shape[1],
                self._doubles(turns[0]),
                self._doubles(turns[1]),
            )
            for segment in drive.segments
            for milestones, turns in (segment.free,)
        ]
        return _Drive(len(segments), self._array(_Segment, segments))

    def _of_accuracy(self) -> dict[str, Any]:
        accuracy, segments = self.accuracy, self.systems.drives[0].segments
        return {
            "start": segments[0].start,
            "end": segments[-1].end,
            "rtol": accuracy.rtol,
            "atol": self._doubles(accuracy.atol),
            "first_step": accuracy.first_step or 0.0,
            "max_step": accuracy.max_step,
            "max_steps": accuracy.max_steps,
            "stiff_after": self.stiff_after,
        }

    def _of_wanted(self) -> dict[str, Any]:
        wanted = self.wanted
        reductions = [_Reduction(*reduction) for reduction in wanted.reductions]
        return {
            "time_count": wanted.times.size,
            "times": self._doubles(wanted.times),
            "items": self._ints(self._shown.places[wanted.items]),
            "sample_count": wanted.sample_count,
            "reduction_count": len(reductions),
            "reductions": self._array(_Reduction, reductions),
            "weights": self._doubles(wanted.weights),
            "bound_count": wanted.bound_items.size,
            "bound_items": self._ints(self._shown.places[wanted.bound_items]),
            "above": self._ints(wanted.above),
            "limits": self._doubles(wanted.limits),
            "limit_stride": 0 if len(wanted.limits) == 1 else wanted.bound_items.size,
        }

    def _of_outcome(self) -> dict[str, Any]:
        outcome = self.outcome
        return {
            "reduced": self._doubles(outcome.reduced),
            "beyond": self._doubles(outcome.beyond),
            "ends": self._ints(outcome.ends),
            "codes": self._ints(outcome.codes),
            "ended": self._doubles(outcome.ended),
            "finals": self._doubles(outcome.finals),
            "steps": outcome.steps.ctypes.data_as(ctypes.POINTER(ctypes.c_long)),
        }


@dataclass(frozen=True)
class _Shown:
    """Signals that are evaluated at outputs: all, or those with ranges if no other is requested."""

    bounded: bool  # whether only those with ranges are evaluated
    signal_count: int
    # indices of all signals, followed by those of elements of the state, among the evaluated ones
    places: Numbers

    @classmethod
    def of(cls, model: System, wanted: LaneOutputs) -> "_Shown":
        described, count = model.equations.SIGNALS, len(model.signal_names)
        ranged = [i for i, name in enumerate(model.signal_names) if described[name].get("ranges")]
        asked = {*wanted.items.tolist(), *wanted.bound_items.tolist()}
        bounded = bool(ranged) and asked.isdisjoint({*range(count)}.difference(ranged))
        shown = ranged if bounded else [*range(count)]
        places = np.zeros(count + len(model.state_names), dtype=np.int32)
        places[shown] = np.arange(len(shown))
        places[count:] = len(shown) + np.arange(len(model.state_names))
        return cls(bounded, len(shown), places)


def _common_variant(drives: Sequence[TimeInputs]) -> str:
    """Return the suffix of functions for all drives; empty for the general ones."""
    variants = {drive.variant for drive in drives}
    return variants.pop() if len(variants) == 1 else ""
