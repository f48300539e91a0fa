"""Simulation of many systems at once."""

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator, shown
from ..simulation.accuracy import accuracy_of, outputs_of, span_of
from ..simulation.lanes import library
from ..simulation.lanes.problem import Problem, Systems
from ..simulation.lanes.run import run, usual_threads
from ..simulation.validity import bounds_of
from ..systems.state import inputs_of
from ..systems.system import System
from .chunks.checkpoint import checkpoint_in
from .chunks.gather import run_in_chunks
from .chunks.workers import workers_of
from .collected import Collected
from .input_sets import InputSets, input_sets_of
from .output_spec import OutputSpec, asked_of
from .results import dataset_of
from .room import Room
from .stiff_fallback import StiffFallback
from .variants import (
    BOUND,
    FREQUENCY,
    RESULTS,
    STATE,
    TIME,
    Variants,
    impossible_sets,
    variants_of,
)

_OUTPUTS = 201
# Steps in lanes that take about the time of BDF for a system (``make benchmark-stiff``): after as
# many, a stiff system goes to BDF.
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
    """Return simulations of many systems of one model.

    Each system, such as a car, may have parameters, an initial state and inputs of its own.

    Dormand and Prince's method of order 5 integrates them in the lanes of vectors, each with a step
    size of its own, on all cores. The results of a system have the same bits for any number of
    lanes, threads and workers, and beside any other systems.

    Parameters
    ----------
    model : System or Model
    variants : mapping or xarray.Dataset
        Values that differ between systems, by name, SI units: parameters, elements of the initial
        state, inputs that do not vary with time. Rows of numbers are over the dimension ``car``;
        of a dataset, all combinations along its dimensions are simulated.
    t_span : tuple of float
        First and last time [s].
    y0 : array_like, optional
        Initial state of all, SI units, or one row for each system; by default each begins at rest
        in its own design position.
    inputs : mapping, optional
        Inputs by name, as for `kintrafo.simulate`, for all systems; or several time series by
        label, where ``variants`` has the label for each system under the name of the input.
    signals : sequence of str, optional
        Signals, or elements of the state, that the result has at the times ``t_eval``.
    reductions : mapping, optional
        One reduction, or a list of them, for each signal, over the times ``t_eval``: 'max', 'min',
        'mean', 'rms' (about the mean); ('above', level), the time for which straight lines between
        the outputs are above a level, in the unit of the signal; ('percentile', percent) of the
        outputs, linearly interpolated; or the power spectral density by Welch's method, 'psd' or
        ('psd', outputs in a segment), over ``frequency`` [Hz].
    t_eval : array_like, optional
        Times of the outputs [s], by default 201 from the first to the last.
    rtol, atol : float, array_like, optional
        Relative tolerance, and absolute tolerance: one number, or one for each element of the
        state in its SI unit.
    max_step, first_step : float, optional
        Longest step, and first step [s].
    max_steps : int, optional
        Largest number of steps of a system. With more it ends with a reason, or is simulated again,
        see `stiff`.
    stiff : str or None, optional
        By default, systems that the explicit method does not finish within `max_steps`, and those
        that are stiff after 10,000 steps, are simulated again by 'BDF' of `kintrafo.simulate`.
        With None such a system ends with a reason, and stiffness is not checked.
    threads : int, optional
        Number of threads; by default one for each core.
    lanes : int, optional
        Number of systems in a vector, 2, 4 or 8; by default the most that the processor supports.
    cluster : int, str or dask.distributed.Client, optional
        By default the systems are simulated in threads of this process. A number: in as many local
        processes, which share the threads. An address such as 'tcp://10.0.0.1:8786', or a client:
        by the workers of that scheduler of Dask, which need the same versions of packages.
    kept : str or Path, optional
        A folder for results as they come, some thousand systems a file. After an interruption, a
        call with the same arguments, on any machine, continues from them.
    progress : bool, optional
        Whether to show a progress bar.

    Returns
    -------
    xarray.Dataset
        Over the dimensions of the variants: the signals over ``time``, the reductions,
        ``final_state``, ``end_time`` [s], ``steps``, and the ``solver`` that found them;
        ``success``, and the ``reason`` where it is False; ``valid``, which is True where a
        simulation succeeded and no output passed a bound of the model, and the values that passed
        one in ``beyond``. A system that did not reach the end has NaN after its ``end_time``, and
        in its reductions.

    Raises
    ------
    InputError
        If an argument cannot be used, the folder is of another ensemble, or workers have other
        versions. Impossible parameters of a system are not an error, but its ``reason``.
    MissingPackageError
        If the packages of the extra "cluster" are not installed.
    ClusterError
        If the scheduler is lost, or several workers are lost one after the other with the same
        systems. The systems of a single lost worker are simulated by another one.

    Notes
    -----
    An explicit method takes many steps for friction and stops, which are stiff: such systems are
    simulated by BDF with the same tolerances, inputs and times. The default tolerances are those
    of an explicit method; BDF damps oscillations by a part of its error.

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
            profiles = given.mapping("inputs", {} if inputs is None else inputs, "names, profiles")
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
    own = variants_of(model, variants, profiles, rows, Room(model, asked, cores, width))
    _check_together(model, y0, profiles, own, asked)
    held = inputs_of(y0, model.names_of_states)
    drives = input_sets_of(model, profiles, own, span, held=held, max_step=accuracy.max_step)
    asked = replace(asked, bounds=tuple(bounds_of(model, own.parameters)))
    systems = _systems(model, own, state, drives)
    stiff_after = _STIFF_AFTER if stiff else 0
    problem = Problem(model, systems, asked.for_c(model), accuracy, width, stiff_after)
    collected = Collected(problem, asked, StiffFallback(problem) if stiff else None)
    folder = None if kept is None else checkpoint_in(kept, collected)
    with _shown_progress(own.count, wanted=progress) as report:
        if workers or folder:
            run_in_chunks(collected, workers, cores, folder, report)
        else:
            run(problem, cores, collected, report)
    return dataset_of(model, own, collected)


# -- arguments ------------------------------------------------------------------------------------


def _start(given: Validator, model: System, y0: Any) -> Array:
    """Return the initial states, one row for all or one for each; NaN for the design position."""
    size = len(model.state_names)
    if not size:
        given.fail(
            f"the inputs prescribe the motion of {model.equations.NAME}: it has no state to "
            "integrate. Use kintrafo.simulate for each, or the signals of a System at many inputs."
        )
    if y0 is None:
        return np.full((1, size), np.nan)
    states = given.array("y0", y0, dimensions=[1, 2], last=size, empty=not size)
    return np.atleast_2d(states)


def _check_together(
    model: System, y0: Any, profiles: Mapping[str, Any], own: Variants, asked: OutputSpec
) -> None:
    """Refuse arguments that contradict each other."""
    with Validator("ensemble") as given:
        _check_rows(given, model, y0, {*profiles, *own.inputs, *own.labels})
        _check_results(given, asked, own)


def _check_rows(given: Validator, model: System, y0: Any, names: set[str]) -> None:
    """Refuse rows of states that were found under inputs which are not given."""
    for row in y0 if isinstance(y0, list | tuple) else ():
        held = inputs_of(row, model.names_of_states)
        moved = [] if held is None else [model.input_names[i] for i in np.flatnonzero(held)]
        forgotten = [name for name in moved if name not in names]
        if forgotten:
            given.fail(
                f"y0 has states that belong to {', '.join(forgotten)}, and as rows of numbers they "
                f"do not keep that: give {' and '.join(forgotten)} in variants or inputs."
            )
            return


def _check_results(given: Validator, asked: OutputSpec, own: Variants) -> None:
    """Refuse results with the name of a variant, or with that of another result."""
    spectra = any(reduced.kind == "psd" for reduced in asked.reduced)
    coordinates = {*map(str, own.coordinates), *map(str, own.shape)}
    starts = {f"{name}_at_start" for name in own.states if name not in own.coordinates}
    kinds = {
        "a variable of every result": [TIME, STATE, BOUND, *RESULTS, *[FREQUENCY] * spectra],
        "a variant": {*own.parameters, *own.inputs, *own.labels, *coordinates, *starts},
        "a signal": asked.signals,
        "a reduction": [reduced.name for reduced in asked.reduced],
    }
    owners: dict[str, str] = {}
    for kind, names in kinds.items():
        for name in sorted(names):
            if name in owners:
                given.fail(
                    f"the results would have two variables {name!r}, {owners[name]} and {kind}: "
                    "leave one of them out, or rename it in the declaration."
                )
            owners.setdefault(name, kind)


def _span(given: Validator, t_span: Any) -> tuple[float, float]:
    first, last = span_of(given, t_span)
    if last < first:
        given.fail(f"t_span = {shown(t_span)}: the first time must be the earlier one.")
    return min(first, last), max(first, last)


def _width(given: Validator, model: System, lanes: Any) -> int:
    """Return the number of lanes; refuse equations that have none."""
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
    """Return the values of each system as arrays."""
    names = [*model.equations.PARAMETERS]
    return Systems(
        count=own.count,
        parameters=np.array([model.parameters[name] for name in names]),
        varied=np.array([names.index(name) for name in own.parameters], dtype=np.int32),
        variants=np.array([*own.parameters.values()]).reshape(-1, own.count).T,
        states=_states(model, state, own),
        inputs=drives.constant,
        drives=drives.different,
        drive_of=drives.of,
        left_out=impossible_sets(model, own),
    )


def _states(model: System, state: Array, own: Variants) -> Array:
    """Return the initial states with the elements that systems have of their own."""
    if not own.states:
        return state
    states = np.broadcast_to(state, (own.count, state.shape[1])).copy()
    for name, values in own.states.items():
        states[:, model.state_names.index(name)] = values
    return states


def _shown_progress(count: int, *, wanted: bool) -> Any:
    """Return a context that shows progress; without `wanted`, one that does nothing."""
    if not wanted:
        return nullcontext()
    from .progress import bar  # noqa: PLC0415 (slow to import)

    shown_bar: Callable[[int], Any] = bar
    return shown_bar(count)
