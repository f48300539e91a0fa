"""Directions in which a system changes, along the steps of its motion: one in each lane."""

import ctypes
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.named_types import Array
from ...systems.system import System
from ..retraced import RetracedSteps, weights_within
from . import library
from .run import usual_threads

_DOUBLES, _INTS = ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_int)
_LONGS = ctypes.POINTER(ctypes.c_long)
_KINDS: dict[Any, Any] = {
    _DOUBLES: np.float64,
    _INTS: np.intc,
    _LONGS: np.dtype(ctypes.c_long),
}
_DONE, _NO_MEMORY = 0, 1


_FIELDS: list[tuple[str, Any]] = [
    *((name, ctypes.c_void_p) for name in ("rhs_tangent", "signals_tangent")),
    *((f"{n}_count", ctypes.c_int) for n in ("constant", "state", "input", "signal")),
    ("constants", _DOUBLES),
    ("step_count", ctypes.c_long),
    ("lengths", _DOUBLES),
    ("restarts", _INTS),
    *((name, _DOUBLES) for name in ("states", "inputs")),
    ("time_count", ctypes.c_long),
    ("step_of", _LONGS),
    *((name, _DOUBLES) for name in ("weights", "states_there", "inputs_there")),
    ("item_count", ctypes.c_int),
    ("items", _INTS),
    *((name, _DOUBLES) for name in ("of_constants", "of_start", "of_inputs", "found")),
]
"""Fields of ``kt_motion`` in ``directions.h``."""


class _Motion(ctypes.Structure):
    _fields_ = _FIELDS


@dataclass(frozen=True)
class Along:
    """Directions: changes of everything on which a motion depends."""

    # of the equations; of the initial state; of inputs that do not vary, (directions, elements)
    constants: Array
    start: Array
    inputs: Array


def followed(
    system: System,
    steps: RetracedSteps,
    times: Array,
    along: Along,
    items: Sequence[int],
    width: int | None = None,
) -> Array | None:
    """Return the derivatives of items of a motion along directions, (directions, times, items).

    Their bits do not depend on the number of lanes or on other directions. Items are evaluated at
    increasing times [s]: indices of signals, followed by those of elements of the state. `width` is
    the number of lanes, by default the most that the processor supports. None is returned if the
    equations cannot be compiled for lanes, refuse a state, or have no finite derivative.
    """
    there = library.widths()
    width = width or (there[-1] if there else 0)
    functions = library.tangents(system.equations, width) if width else None
    if functions is None:
        return None
    count = len(along.constants)
    found = np.empty((count, times.size, len(items)))
    described = _described(system, steps, times, along, items)
    motion, _kept = _in_c({**functions, **described, "found": found})
    call = library.solver("follow", width)

    def some(first: int) -> int:
        last = min(first + width, count)
        return call(ctypes.byref(motion), ctypes.c_long(first), ctypes.c_long(last))

    if count <= width:
        failed = {some(0)}
    else:  # without the interpreter's lock
        with ThreadPoolExecutor(usual_threads()) as pool:
            failed = set(pool.map(some, range(0, count, width)))
    if _NO_MEMORY in failed:
        raise MemoryError
    return found if failed == {_DONE} else None


def _described(
    system: System, steps: RetracedSteps, times: Array, along: Along, items: Sequence[int]
) -> dict[str, Any]:
    """Return the fields of ``kt_motion`` except functions and the result."""
    step, part = steps.places(times)
    states, inputs = steps.point(step, part)
    return {
        "constant_count": system.constants.size,
        "state_count": len(system.state_names),
        "input_count": len(system.input_names),
        "signal_count": len(system.signal_names),
        "constants": system.constants,
        "step_count": steps.length.size,
        "lengths": steps.length,
        "restarts": steps.restarts,
        "states": steps.states,
        "inputs": steps.inputs,
        "time_count": times.size,
        "step_of": step,
        "weights": weights_within(part),
        "states_there": states,
        "inputs_there": inputs,
        "item_count": len(items),
        "items": items,
        "of_constants": along.constants,
        "of_start": along.start,
        "of_inputs": along.inputs,
    }


def _in_c(values: Mapping[str, Any]) -> tuple[_Motion, list[NDArray[Any]]]:
    """Return values for C, and the arrays that it reads, which must stay in memory."""
    motion = _Motion()
    kept: list[NDArray[Any]] = []
    for name, kind in _FIELDS:
        value = values[name]
        if kind in _KINDS:
            kept.append(np.ascontiguousarray(value, dtype=_KINDS[kind]))
            value = kept[-1].ctypes.data_as(kind)
        setattr(motion, name, value)
    return motion, kept
