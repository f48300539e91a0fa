"""Simulate many systems at once."""

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..core.errors import InputError
from ..core.named_types import ArrayLike
from ..core.validator import Validator, shown
from ..simulation.accuracy import accuracy_of, outputs_of, span_of
from ..simulation.lanes import library
from ..simulation.lanes.problem import Problem, Systems
from ..simulation.lanes.run import run, usual_threads
from ..simulation.validity import bounds_of
from ..systems.state import inputs_of
from ..systems.system import System
from .again import Again
from .collected import Collected
from .drives import InputSets, drives_of
from .pieces.kept import kept_in
from .pieces.whole import run_in_pieces
from .pieces.workers import workers_of
from .results import dataset_of
from .room import Room
from .variants import Variants, impossible_sets, variants_of
from .wanted import OutputSpec, asked_of

Array = NDArray[np.float64]

_OUTPUTS = 201
# Steps in lanes that cost about what BDF does for a system: what is stiff is tried for so long.
# ``make benchmark-stiff`` measures both.
_STIFF_AFTER = 10_000
_MOST_THREADS = 1024


def ensemble(
    model: System,
    variants: Mapping[str, ArrayLike] | xr.Dataset | None,
    t_span: tuple[float, float],
    y0: ArrayLike | None = None,
    *,
    inputs: Mapping[str, Any] | None = None,
    signals: tuple[str, ...] | list[str] = (),
    reductions: Mapping[str, Any] | None = None,
    t_eval: ArrayLike | None = None,
    rtol: float = 1e-6,
    atol: ArrayLike = 1e-9,
    max_step: float = np.inf,
    first_step: float | None = None,
    max_steps: int = 1_000_000,
    stiff: Literal["BDF"] | None = "BDF",
    threads: int | None = None,
    lanes: int | None = None,
    cluster: Any = None,
    kept: str | Path | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Simulate many systems of one model, each with parameters, start and inputs of its own.

    They are integrated by Dormand and Prince's method of order 5 in the lanes of vectors, each with
    a step size of its own, on all cores. The results are the same to the last bit however many
    lanes, threads and workers there are, and any other systems.

    Parameters
    ----------
    model : System or Model
    variants : mapping or xarray.Dataset
        What the systems have of their own: parameters, elements of the state at the start, inputs
        that do not vary with time, by name; SI units. Rows of numbers are over the dimension
        ``car``; of a dataset, all combinations along its dimensions are simulated.
    t_span : tuple of float
        First and last time [s].
    y0 : array_like, optional
        Initial state of all, or one row for each; by default each has its own design position.
    inputs : mapping, optional
        Inputs by name, as `kintrafo.simulate` takes them, for all systems; or several of them by
        label, of which ``variants`` says by that label which one each system has.
    signals : sequence of str, optional
        Signals, or elements of the state, that are kept at the times ``t_eval``.
    reductions : mapping, optional
        What is kept of signals, over the times ``t_eval``: 'max', 'min', 'mean', 'rms' (about the
        mean); ('above', level), the time for which the straight lines between the outputs are
        above a level; ('percentile', percent) of the outputs, between two of them by the straight
        line; or the power spectral density by Welch's method, 'psd' or ('psd', outputs in a
        segment), over ``frequency``. One or a list of them for each signal.
    t_eval : array_like, optional
        Times of the outputs, by default 201 from the first to the last.
    rtol, atol : float, array_like, optional
        Relative tolerance, and absolute tolerances: one, or one for each element of the state.
    max_step, first_step : float, optional
        [s]
    max_steps : int, optional
        A system that takes more ends with a reason, or is done again, see `stiff`.
    stiff : str or None, optional
        By default, what the explicit method cannot do within its steps, and what is stiff after
        10,000 of them, is done again by 'BDF' of `kintrafo.simulate`. With None it ends with a
        reason, and stability is not asked for.
    threads : int, optional
        By default as many as there are cores.
    lanes : int, optional
        How many systems a vector holds, 2, 4 or 8; by default as many as the processor can.
    cluster : int, str or dask.distributed.Client, optional
        Where it runs: by default in threads of this process; in so many local processes, which
        share the threads; by the workers of a scheduler of Dask at an address such as
        'tcp://10.0.0.1:8786', or of a client. They need the same versions as are here.
    kept : str or Path, optional
        A folder in which what was found is kept as it comes, some thousand systems a file. After
        an interruption, a call with the same arguments, wherever it runs, goes on from there.
    progress : bool, optional
        Whether to show how far it is.

    Returns
    -------
    xarray.Dataset
        Over the dimensions of the variants: the signals over ``time``, the reductions,
        ``final_state``, ``end_time``, ``steps``, and by which ``solver`` they were found;
        ``success``, and ``reason`` where that is false;
        ``valid`` where besides no output passes a bound of what the model describes, and what was
        passed in ``beyond``. What did not reach the end has NaN from there on, and in its
        reductions.

    Raises
    ------
    InputError
        If an argument cannot be used, a folder is of another ensemble, or workers have other
        versions. Parameters of no mechanism are no such error: they are the reason of their system.
    MissingPackageError
        If the packages of the extra "cluster" are not installed.
    ClusterError
        If a scheduler is lost, or several workers are lost one after another with the same systems.
        What a lost worker had to do is done by another.

    Notes
    -----
    The method is an explicit one. Friction and stops, which are stiff, take it many steps: such
    systems go to BDF, by the same tolerances, inputs and times. ``rtol`` and ``atol`` are those of
    an explicit method by default; BDF damps what swings by a part of its error.

    Examples
    --------
    >>> import kintrafo
    >>> model = kintrafo.Model("reference_car")
    >>> start = kintrafo.state_at_height(model, 0.310)
    >>> rates = {"damper_rate": [800.0, 1500.0, 2200.0]}
    >>> found = kintrafo.ensemble(model, rates, (0.0, 1.0), start,
    ...                           reductions={"tyre_force": "min"})
    >>> found.sizes["car"], bool(found["valid"].all())
    (3, True)
    """
    with Validator("ensemble") as given:
        given.instance("model", model, System, System.NEEDED)
        if not given.failed:
            state = _start(given, model, y0)
            span = _span(given, t_span)
            times = outputs_of(
                given, np.linspace(*span, _OUTPUTS) if t_eval is None else t_eval, span
            )
            asked = asked_of(given, model, times, signals, {} if reductions is None else reductions)
            accuracy = accuracy_of(
                given,
                len(model.state_names),
                rtol=rtol,
                atol=atol,
                max_step=max_step,
                first_step=first_step,
                max_steps=max_steps,
            )
            courses = given.mapping("inputs", {} if inputs is None else inputs, "names, courses")
            cores = usual_threads() if threads is None else threads
            cores = given.whole("threads", cores, most=_MOST_THREADS)
            workers = workers_of(given, cluster, cores, threads=threads)
            if kept is not None:
                given.path("kept", kept)
            width = _width(given, model, lanes)
            given.flag("progress", progress)
            if stiff is not None:
                given.among("stiff", stiff, ["BDF"])
    rows = None if len(state) == 1 else len(state)
    own = variants_of(model, variants, courses, rows, Room(model, asked, cores, width))
    _check_together(model, y0, courses, own, asked)
    held = inputs_of(y0, model.names_of_states)
    drives = drives_of(model, courses, own, span, held=held, max_step=accuracy.max_step)
    asked = replace(asked, bounds=tuple(bounds_of(model, own.parameters)))
    systems = _systems(model, own, state, drives)
    stiff_after = _STIFF_AFTER if stiff else 0
    problem = Problem(model, systems, asked.for_c(model), accuracy, width, stiff_after)
    collected = Collected(problem, asked, Again(problem) if stiff else None)
    folder = None if kept is None else kept_in(kept, collected)
    with _shown_progress(own.count, wanted=progress) as report:
        if workers or folder:
            run_in_pieces(collected, workers, cores, folder, report)
        else:
            run(problem, cores, collected, report)
    return dataset_of(model, own, collected)


# -- arguments ------------------------------------------------------------------------------------


def _start(given: Validator, model: System, y0: Any) -> Array:
    """Return the initial states, one row for all or one for each; NaN for the design position."""
    size = len(model.state_names)
    if not size:
        given.fail(
            f"{model.equations.NAME} moves as its inputs say, and has no state to be integrated. "
            "Use kintrafo.simulate for each, or the signals of a System at many inputs."
        )
    if y0 is None:
        return np.full((1, size), np.nan)
    states = given.array("y0", y0, dimensions=[1, 2], last=size, empty=not size)
    return np.atleast_2d(states)


def _check_together(
    model: System, y0: Any, courses: Mapping[str, Any], own: Variants, asked: OutputSpec
) -> None:
    """Refuse arguments that are right each for itself."""
    with Validator("ensemble") as given:
        _check_rows(given, model, y0, {*courses, *own.inputs, *own.labels})
        _check_results(given, asked, own)


def _check_rows(given: Validator, model: System, y0: Any, names: set[str]) -> None:
    """Refuse rows of states that were found under inputs that are not known."""
    for row in y0 if isinstance(y0, list | tuple) else ():
        held = inputs_of(row, model.names_of_states)
        moved = [] if held is None else [model.input_names[i] for i in np.flatnonzero(held)]
        forgotten = [name for name in moved if name not in names]
        if forgotten:
            given.fail(
                f"y0 has rows of states that belong to {', '.join(forgotten)}, and rows of numbers "
                f"do not know that: give {' and '.join(forgotten)} in variants or inputs."
            )
            return


def _check_results(given: Validator, asked: OutputSpec, own: Variants) -> None:
    """Refuse results that are called as what varies."""
    varied = {*own.parameters, *own.inputs, *own.labels, *map(str, own.coordinates)}
    results = {*asked.signals, *(reduced.name for reduced in asked.reduced)}
    for name in sorted(varied & results):
        given.fail(
            f"{name!r} is both a variant and a result: keep another result, such "
            "as the signal itself over time."
        )


def _span(given: Validator, t_span: Any) -> tuple[float, float]:
    first, last = span_of(given, t_span)
    if last < first:
        given.fail(f"t_span = {shown(t_span)}: the first time must be the earlier one.")
    return min(first, last), max(first, last)


def _width(given: Validator, model: System, lanes: Any) -> int:
    """Return how many lanes are used; equations that have none are refused at once."""
    there = library.widths()
    width = there[-1] if there else 0
    try:
        library.functions(model.equations, width, "")
    except InputError as error:
        for problem in error.problems:
            given.fail(problem)
        return width
    if lanes is None:
        return width
    wanted = given.whole("lanes", lanes)
    if wanted not in there:
        known = ", ".join(map(str, there))
        given.fail(f"lanes = {shown(lanes)}: on this machine there are {known}.")
    return wanted


# -- arrays ---------------------------------------------------------------------------------------


def _systems(model: System, own: Variants, state: Array, drives: InputSets) -> Systems:
    """Return what the systems have of their own as arrays."""
    names = model.equations.PARAMETERS
    return Systems(
        count=own.count,
        parameters=np.array([model.parameters[name] for name in names]),
        varied=_places(own.parameters, names),
        variants=_table(own.parameters, own.count),
        states=_states(model, state, own),
        inputs=drives.constant,
        drives=drives.different,
        drive_of=drives.of,
        left_out=impossible_sets(model, own),
    )


def _places(columns: Mapping[str, Array], names: Mapping[str, Any]) -> NDArray[np.int32]:
    order = list(names)
    return np.array([order.index(name) for name in columns], dtype=np.int32)


def _table(columns: Mapping[str, Array], count: int) -> Array:
    return np.stack([*columns.values()], axis=1) if columns else np.zeros((count, 0))


def _states(model: System, state: Array, own: Variants) -> Array:
    """Return the initial states with what each system has of its own."""
    if not own.states:
        return state
    states = np.broadcast_to(state, (own.count, state.shape[1])).copy()
    for name, values in own.states.items():
        states[:, model.state_names.index(name)] = values
    return states


def _shown_progress(count: int, *, wanted: bool) -> Any:
    """Return what shows how far it is, while it lasts; or nothing that does nothing."""
    if not wanted:
        return nullcontext()
    from .progress import bar  # noqa: PLC0415 (slow to import)

    shown_bar: Callable[[int], Any] = bar
    return shown_bar(count)
