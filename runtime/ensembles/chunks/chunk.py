"""A chunk of an ensemble and its results, both of which are sent from machine to machine.

The results of a chunk have the same bits on any worker, and for any division into chunks.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.named_types import Array
from ...simulation.accuracy import Accuracy
from ...simulation.lanes.library import widths
from ...simulation.lanes.problem import LaneOutputs, Problem, Systems
from ...simulation.lanes.run import run
from ...simulation.signals import TimeInputs
from ...systems.compile.shipped import SerializedModel, shipped
from ...systems.system import System
from ..collected import Collected
from ..output_spec import OutputSpec
from ..stiff_fallback import StiffFallback
from .versions import differences, versions

Report = Callable[[int], None]


@dataclass(frozen=True)
class Common:
    """The data that all chunks share."""

    equations: SerializedModel
    parameters: Mapping[str, float]  # of the model
    drives: tuple[TimeInputs, ...]
    wanted: LaneOutputs  # without the limits, which differ between systems
    asked: OutputSpec
    accuracy: Accuracy
    # number of lanes; steps after which a stiff system ends, 0 if it does not
    width: int
    stiff_after: int
    again: bool  # whether systems that lanes do not finish are simulated again
    versions: Mapping[str, str]  # of the process that distributes the chunks


@dataclass(frozen=True)
class Chunk:
    """Some of the systems."""

    first: int  # index of the first of them in the ensemble
    systems: Systems  # without the drives, which are in `Common`
    limits: Array  # limits of the bounds


@dataclass(frozen=True)
class ChunkResult:
    """The results of some systems."""

    # first of them, and the one after the last
    first: int
    last: int
    outcome: Mapping[str, NDArray[Any]]  # arrays of `Outcome` by name
    samples: Array
    of_series: tuple[Array, ...]  # in the order of the requested reductions
    solvers: NDArray[np.str_]
    reasons: Mapping[int, str]  # by the index in the ensemble


def common_of(collected: Collected) -> Common:
    """Return the data that the chunks of an ensemble share."""
    problem, asked = collected.problem, collected.asked
    model = problem.model
    return Common(
        equations=shipped(model.equations),
        parameters=dict(model.parameters),
        drives=tuple(problem.systems.drives),
        wanted=replace(problem.wanted, limits=np.empty((0, 0))),
        asked=replace(asked, bounds=()),
        accuracy=problem.accuracy,
        width=problem.width,
        stiff_after=problem.stiff_after,
        again=collected.again is not None,
        versions=versions(),
    )


def chunk_of(problem: Problem, first: int, last: int) -> Chunk:
    """Return some of the systems of a problem."""
    systems = problem.systems

    def own(rows: NDArray[Any]) -> NDArray[Any]:
        """Return the rows of these systems; all systems share a single row."""
        return rows if len(rows) == 1 else rows[first:last]

    cut = replace(
        systems,
        count=last - first,
        variants=own(systems.variants),
        states=own(systems.states),
        inputs=own(systems.inputs),
        drives=(),
        drive_of=own(systems.drive_of),
        left_out=own(systems.left_out),
    )
    return Chunk(first, cut, own(problem.wanted.limits))


def found_of(
    common: Common, chunk: Chunk, threads: int, report: Report | None = None
) -> ChunkResult:
    """Return the results of a chunk, which is simulated here.

    Raises `InputError` if this process has no lanes, or other versions than the one that
    distributes the chunks.
    """
    other = differences(common.versions)
    if other:
        text = f"a worker was asked by a process that has {other}: install the same in both."
        raise InputError([text], "ensemble")
    problem = Problem(
        System(common.equations.module(), common.parameters),
        replace(chunk.systems, drives=common.drives),
        replace(common.wanted, limits=chunk.limits),
        common.accuracy,
        # vectors of another width give the same bits
        max((w for w in widths() if w <= common.width), default=0),
        common.stiff_after,
    )
    collected = Collected(problem, common.asked, StiffFallback(problem) if common.again else None)
    run(problem, threads, collected, report)
    return replace(
        taken(collected, 0, chunk.systems.count),
        first=chunk.first,
        last=chunk.first + chunk.systems.count,
        reasons={chunk.first + place: why for place, why in collected.reasons.items()},
    )


def taken(collected: Collected, first: int, last: int) -> ChunkResult:
    """Return the results of some systems from the whole; the inverse of `put`."""
    here = slice(first, last)
    return ChunkResult(
        first,
        last,
        outcome={name: values[here] for name, values in vars(collected.problem.outcome).items()},
        samples=collected.samples[here],
        of_series=tuple(values[here] for values in collected.of_series.values()),
        solvers=collected.solvers[here].astype(np.str_),
        reasons={p: why for p, why in collected.reasons.items() if first <= p < last},
    )


def put(found: ChunkResult, collected: Collected) -> None:
    """Put the results of a chunk into the whole."""
    here = slice(found.first, found.last)
    for name, values in found.outcome.items():
        getattr(collected.problem.outcome, name)[here] = values
    collected.samples[here] = found.samples
    for whole, values in zip(collected.of_series.values(), found.of_series, strict=True):
        whole[here] = values
    collected.solvers[here] = found.solvers.tolist()
    collected.reasons.update(found.reasons)
