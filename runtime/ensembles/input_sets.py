"""Inputs of many systems over time."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from ..core.named_types import Array
from ..simulation.signals import Segment, Spline, TimeInputs, time_inputs
from ..systems.system import System
from .variants import Variants, numbered


@dataclass(frozen=True)
class InputSets:
    """Inputs over time, and which of them each system has."""

    different: tuple[TimeInputs, ...]  # same inputs vary in all of them
    of: NDArray[np.int32]  # index into `different` for each system, (count,)
    constant: Array  # values of the inputs that do not vary, (count or 1, number of inputs)


def input_sets_of(
    model: System,
    inputs: Mapping[str, Any],
    variants: Variants,
    t_span: tuple[float, float],
    *,
    held: Array | None,
    max_step: float,
) -> InputSets:
    """Return the inputs of many systems in one form.

    `inputs` are signals by name of an input, see `time_inputs`, or by label, where systems differ;
    `held` are values of the others. `max_step` is the longest step of the integration, and the
    longest time between two calls of a function [s].
    """
    rows, of = _combinations(variants)
    different = []
    for row in rows:
        signals = {
            name: signal[row[name]] if name in row else signal for name, signal in inputs.items()
        }
        different.append(time_inputs(model, signals, t_span, held=held, max_step=max_step))
    constant = np.array([drive.constant for drive in different])
    if len(different) > 1 or variants.inputs:
        constant = constant[of]
        for name, values in variants.inputs.items():
            constant[:, model.input_names.index(name)] = values
    return InputSets(_alike(different), of.astype(np.int32), constant)


def _combinations(variants: Variants) -> tuple[list[dict[str, Any]], NDArray[np.int64]]:
    """Return the combinations of labels that occur, and the index of that of each system."""
    of = np.zeros(variants.count, dtype=np.int64)
    rows: list[dict[str, Any]] = [{}]
    for name, labels in variants.labels.items():
        known, which = numbered(labels)
        pairs, of = np.unique(of * len(known) + which, return_inverse=True)
        before, last = np.divmod(pairs, len(known))
        rows = [rows[i] | {name: known[j]} for i, j in zip(before, last, strict=True)]
    return rows, of


def _alike(drives: list[TimeInputs]) -> tuple[TimeInputs, ...]:
    """Let the same inputs vary in all, in the same order; a constant becomes a spline."""
    targets = {s.targets for drive in drives for g in drive.segments for s in g.splines}

    def completed(drive: TimeInputs, segment: Segment) -> Segment:
        there = {spline.targets: spline for spline in segment.splines}
        ends = np.array([segment.start, segment.end])

        def still(target: int) -> PPoly:
            return PPoly(np.array([[0.0], [0.0], [0.0], [drive.constant[target]]]), ends)

        splines = (there.get(t) or Spline(still(t[0]), t) for t in sorted(targets))
        return replace(segment, splines=tuple(splines))

    return tuple(
        replace(drive, segments=tuple(completed(drive, segment) for segment in drive.segments))
        for drive in drives
    )
