"""Time what agrees: nanoseconds of a right-hand side, milliseconds of the second, build times."""

import os
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field

import numpy as np

from .agreement import DisagreementError, acceleration_error
from .case import ACCURACY, Array, angle_error, random_instants
from .compiled import FLAGS, Library, compile_source
from .models import Built, Candidate
from .simulations import Run, Simulator, seconds_of

KINDS = ("dependent", "independent")
ROUNDS = 200
"""Each loop is run this often, all peers in turn."""
LOOP_SECONDS = 0.001
"""Aimed at for one run of a loop: short, so that the least time is that of a quiet moment."""

TURNS = 10
"""Each simulation is run for `TURN_SECONDS` so often, all in turn."""
TURN_SECONDS = 0.1

Report = Callable[[str], None]
"""Called with what is being done."""


@dataclass
class Evaluation:
    """Measured times of one compiled right-hand side."""

    name: str
    parameters: str
    flags: str
    error: float  # of the accelerations against the reference, see `acceleration_error`
    # build time by phase
    derive_seconds: float
    generate_seconds: float
    compile_seconds: float
    # by kind of loop: `least` and `median` over the rounds
    nanoseconds: dict[str, dict[str, float]] = field(default_factory=dict)


@dataclass
class Second:
    """Measured time of the second of simulation."""

    # tool and method, and the loosest setting that was accurate enough
    name: str
    setting: str
    error: float  # of the arm angle, rad
    # of the run
    least_milliseconds: float
    median_milliseconds: float
    build_seconds: float  # to prepare the run


@dataclass(frozen=True)
class Entry:
    """A compiled right-hand side and its measurements."""

    built: Built
    library: Library
    evaluation: Evaluation
    table: Array


def use_one_core() -> None:
    """Keep this process on the last of its cores, where the system allows it."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def compile_all(
    candidates: Iterable[Candidate], report: Report
) -> tuple[list[Entry], dict[str, str]]:
    """Build, compile and check all right-hand sides with all compiler flags.

    Parameters
    ----------
    candidates : iterable of Candidate
        What to build.
    report : callable
        Called before each.

    Returns
    -------
    entries : list of Entry
        Those that agree with the reference.
    skipped : dict of str
        Reasons, by name, for the others.
    """
    entries: list[Entry] = []
    skipped: dict[str, str] = {}
    for candidate in candidates:
        label = f"{candidate.name} ({candidate.parameters})"
        report(f"building {label}")
        if candidate.missing:
            skipped[label] = f"not installed: {', '.join(candidate.missing)}"
            continue
        try:
            entries += _compiled(candidate)
        except (DisagreementError, OSError) as error:
            skipped[label] = str(error)
        except Exception as error:  # noqa: BLE001  # a peer's failure is a result
            skipped[label] = f"{type(error).__name__}: {str(error)[:200]}"
    return entries, skipped


def _compiled(candidate: Candidate) -> list[Entry]:
    built = candidate.make()
    table = np.array([built.state(instant) for instant in random_instants()])
    entries = []
    for name in candidate.flags:
        library = compile_source(built.source, built.constants, FLAGS[name])
        evaluation = Evaluation(
            candidate.name,
            candidate.parameters,
            name,
            acceleration_error(built, library),
            built.derive_seconds,
            built.generate_seconds,
            library.compile_seconds,
        )
        entries.append(Entry(built, library, evaluation, table))
    return entries


def time_evaluations(entries: list[Entry], report: Report) -> None:
    """Time all loops in turn, so that a busy moment of the machine hits all alike.

    Parameters
    ----------
    entries : list of Entry
        Filled in.
    report : callable
        Called now and then.
    """
    counts = [_count(entry) for entry in entries]
    times = np.empty((ROUNDS, len(entries), len(KINDS)))
    for turn in range(ROUNDS):
        if turn % 20 == 0:
            report(f"right-hand sides, round {turn + 1} of {ROUNDS}")
        for i, (entry, count) in enumerate(zip(entries, counts, strict=True)):
            for j, kind in enumerate(KINDS):
                times[turn, i, j] = entry.library.seconds(kind, count, entry.table) / count
    for i, entry in enumerate(entries):
        for j, kind in enumerate(KINDS):
            entry.evaluation.nanoseconds[kind] = {
                "least": 1e9 * float(times[:, i, j].min()),
                "median": 1e9 * float(np.median(times[:, i, j])),
            }


def _count(entry: Entry) -> int:
    trial = 500
    entry.library.seconds("dependent", trial, entry.table)
    seconds = entry.library.seconds("dependent", trial, entry.table)
    return max(trial, int(LOOP_SECONDS / seconds * trial))


@dataclass(frozen=True)
class Contender:
    """A simulator at the loosest setting that is accurate enough."""

    # see `Second`
    name: str
    setting: str
    error: float  # of the arm angle, rad
    build_seconds: float  # to prepare the run
    run: Run  # simulates the second


def loosest(simulator: Simulator) -> Contender:
    """Find the loosest setting that is accurate enough.

    Parameters
    ----------
    simulator : Simulator
        A tool and method.

    Returns
    -------
    Contender
        Ready to be timed.

    Raises
    ------
    DisagreementError
        If no setting is accurate enough.
    """
    best = np.inf
    failure = ""
    for setting in simulator.settings:
        try:
            run, build_seconds = _prepared(simulator, setting)
            error = angle_error(run())
        except Exception as problem:  # noqa: BLE001  # a solver may give up at a loose setting
            failure = f"; {type(problem).__name__}: {str(problem)[:120]}"
            continue
        best = min(best, error)
        if error <= ACCURACY:
            return Contender(simulator.name, str(setting), error, build_seconds, run)
    message = f"no setting is accurate enough, the best error is {best:.1e} rad{failure}"
    raise DisagreementError(message)


def time_seconds(contenders: list[Contender], report: Report) -> list[Second]:
    """Time all simulations in turn, so that a busy moment of the machine hits all alike.

    Parameters
    ----------
    contenders : list of Contender
        From `loosest`.
    report : callable
        Called before each turn.

    Returns
    -------
    list of Second
        Their measurements.
    """
    times: list[list[float]] = [[] for _ in contenders]
    for turn in range(TURNS):
        report(f"the second, turn {turn + 1} of {TURNS}")
        for contender, seconds in zip(contenders, times, strict=True):
            seconds.extend(seconds_of(contender.run, TURN_SECONDS))
    return [
        Second(c.name, c.setting, c.error, 1e3 * min(s), 1e3 * float(np.median(s)), c.build_seconds)
        for c, s in zip(contenders, times, strict=True)
    ]


def _prepared(simulator: Simulator, setting: object) -> tuple[Callable[[], Array], float]:
    begin = time.perf_counter()
    run = simulator.prepare(setting)
    return run, time.perf_counter() - begin


def as_data(
    evaluations: list[Evaluation], seconds: list[Second], skipped: dict[str, str]
) -> dict[str, object]:
    """Return everything measured, for JSON."""
    return {
        "evaluations": [asdict(evaluation) for evaluation in evaluations],
        "seconds": [asdict(second) for second in seconds],
        "skipped": skipped,
        "accuracy": ACCURACY,
        "flags": {name: list(flags) for name, flags in FLAGS.items()},
    }
