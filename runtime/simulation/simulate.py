"""Integration of the equations of motion."""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeAliasType

from ..core.errors import InputError
from ..core.memory import refuse_beyond
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator
from ..equations.errors import ModelError
from ..systems.state import inputs_of
from ..systems.system import System
from .accuracy import Accuracy, accuracy_of, outputs_of, span_of
from .dead_points import refuse
from .events import Event, Events, events_of
from .input_profiles import Signal
from .result import DenseOutput, Signals, Simulation, SimulationError
from .signals import Segment, TimeInputs, time_inputs
from .solvers import (
    FIXED_STEP_METHODS,
    NATIVE_METHODS,
    SCIPY_METHODS,
    Options,
    SolvedSegment,
    check_jacobian,
    native_available,
    native_methods,
    native_name,
    native_version,
    solve_native,
    solve_scipy,
    why_not_native,
)

Method = TypeAliasType("Method", Literal[
    "BDF", "Adams", "Verner", "DormandPrince", "RK4", "RODASP", "Tsitouras", "Radau", "LSODA",
    "RK45", "DOP853",
])  # fmt: skip
Backend = Literal["auto", "sundials", "scipy"]

# Default tolerances. In 1,000 s an undamped wheel hop of 25 mm loses 0.5 % of its amplitude by BDF
# with its own tolerances, and 22 % with the others (``python -m benchmarks.amplitude``).
_TOLERANCE = (1e-6, 1e-9)
_TOLERANCE_OF_BDF = (1e-8, 1e-10)
# Steps of BDF for about a thousand oscillations, after which its damping matters.
_LONG = 200_000


def simulate(
    model: System,
    t_span: tuple[float, float],
    y0: ArrayLike,
    *,
    inputs: Mapping[str, Signal] | None = None,
    method: Method = "BDF",
    step: float | None = None,
    t_eval: ArrayLike | None = None,
    rtol: float | None = None,
    atol: ArrayLike | None = None,
    max_step: float = np.inf,
    first_step: float | None = None,
    max_steps: int = 10_000_000,
    dense_output: bool = False,
    events: Event | Sequence[Event] | None = None,
    stop_at_outputs: bool = False,
    backend: Backend = "auto",
) -> Simulation:
    """Return the motion of a mechanism over time, by integration of its equations of motion.

    Parameters
    ----------
    model : System or Model
    t_span : tuple of float
        First and last time [s].
    y0 : array_like, shape (number of state elements,)
        Initial state, SI units, see `System.state`, `state_at_height` and `equilibrium`.
    inputs : mapping, optional
        Inputs by name, SI units: numbers, samples ``(times, values)`` or `Samples`, piecewise
        cubics of SciPy, or functions of time; see Notes. Other inputs have the values of the state
        if it comes from `equilibrium` or `state_at_height`, or else zero.
    method : str, optional
        'BDF' (Gear's formulas) or 'Adams'; Runge-Kutta 'DormandPrince' (order 5, as in
        `ensemble`), 'Tsitouras' (order 5) or 'Verner' (8 stages, order 6); 'RK4', the classical
        method of order 4 with a fixed `step`, for real time; 'RODASP', also of order 4 with a fixed
        step, for stiff equations; or SciPy's 'Radau', 'LSODA', 'RK45', 'DOP853'. Implicit methods
        use the exact Jacobian.
    step : float, optional
        Fixed step of 'RK4' and 'RODASP' [s], which have no tolerances. A step is shorter where an
        input jumps or has a fast extremum, at the end, and near a dead point.
    t_eval : array_like, optional
        Times of the outputs [s]; by default the end of every step. If they are given, the time of a
        terminal event is in ``t_events`` only, as in SciPy.
    rtol, atol : float, array_like, optional
        Relative tolerance, and absolute tolerance: one number, or one for each element of the
        state in its SI unit. By default 1e-8 and 1e-10 for 'BDF', which damps oscillations by a
        part of its error, and 1e-6 and 1e-9 for the other methods.
    max_step, first_step : float, optional
        Longest and first step [s]; by default the method chooses.
    max_steps : int, optional
        Number of steps after which an error is raised; ``numpy.inf`` for no limit.
    dense_output : bool, optional
        Whether the result has the state as a function of time, ``sol``.
    events : str, SignalEvent, callable, or sequence of these, optional
        A name of ``model.event_names``, such as 'wheel_leaves_ground' or 'strut_fully_extended'; a
        `SignalEvent`; or a function of time and state with SciPy's attributes ``terminal`` and
        ``direction``.
    stop_at_outputs : bool, optional
        Whether steps end at every output time, instead of interpolation. Not with SciPy.
    backend : str, optional
        'sundials' (all in C), 'scipy', or 'auto': 'sundials' if it was built and has the method.

    Returns
    -------
    Simulation

    Raises
    ------
    InputError
        If an argument cannot be used.
    SimulationError
        If a loop cannot close during the motion, or the solver fails. The message has the time, the
        place and advice; ``partial`` is the result until then.

    Notes
    -----
    Between samples an input only rises or only falls, so it never leaves their range; `Samples` has
    other interpolations. At a time that is given twice it jumps, and the integration starts again.
    A function of time is called at least every millisecond and every `max_step`, and a spline
    follows it to 1e-10 of its range; changes shorter than two calls may be missed, and a function
    that jumps is refused. Velocity and acceleration of a prescribed position are the derivatives of
    the curve through the samples, or of the spline. No step passes over an extremum of an input, or
    of a derivative that the model reads; steps of 'RK4', 'RODASP' and, with several varying inputs,
    of 'DormandPrince' pass over an extremum that is slow compared with the step.

    If its data have no stops, a strut may become longer than its greatest length, or very short.
    The event 'strut_fully_extended' detects the former, a `SignalEvent` of ``strut_length`` the
    latter.

    The error of 'RK4' and 'RODASP' is not estimated: halve `step` and compare, which makes the
    error 16 times smaller. Before each step of 'RK4' the eigenvalues of the exact Jacobian are
    bounded; if one times the step may exceed 2.61, up to which the method is stable for motions
    that do not grow, an error with the longest stable step is raised.

    'RODASP' is L-stable: motions too fast for a step decay in it. Each step needs six evaluations,
    one exact Jacobian and one factorisation, and with varying inputs two more evaluations for the
    derivative with respect to time. Rates that alternate from step to step, such as those of
    friction that sticks within less than a step, raise an error.

    Examples
    --------
    >>> from kintrafo import Model, simulate, state_at_height
    >>> model = Model("reference_car")
    >>> start = state_at_height(model, 0.325, spin_rate=93.0)
    >>> result = simulate(model, (0.0, 1.0), start)
    >>> result.success, bool(abs(result.signals["wheel_center_z"][-1] - 0.3) < 1e-6)
    (True, True)
    """
    usual = _TOLERANCE_OF_BDF if method == "BDF" else _TOLERANCE
    with Validator("simulate") as arguments:
        arguments.instance("model", model, System, System.NEEDED)
        arguments.among("method", method, NATIVE_METHODS | SCIPY_METHODS)
        if not arguments.failed:
            state = _state(arguments, model, y0)
            span = span_of(arguments, t_span)
            times = None if t_eval is None else outputs_of(arguments, t_eval, span)
            check_jacobian(arguments, model, method)
            if method in FIXED_STEP_METHODS or step is not None:
                refused = {"rtol": rtol, "atol": atol, "first_step": first_step}
                max_step = _fixed_step(arguments, method, step, max_step, refused)
            accuracy = accuracy_of(
                arguments,
                state.size,
                rtol=usual[0] if rtol is None else rtol,
                atol=usual[1] if atol is None else atol,
                max_step=max_step,
                first_step=first_step,
                max_steps=max_steps,
            )
            if method in FIXED_STEP_METHODS and not arguments.failed:
                _check_count(arguments, span, accuracy)
            if not arguments.failed:
                _check_memory(arguments, model, method, span, times, accuracy)
            arguments.flag("dense_output", dense_output)
            arguments.flag("stop_at_outputs", stop_at_outputs)
    options = Options(
        **vars(accuracy), method=method, dense_output=dense_output, stop_at_outputs=stop_at_outputs
    )
    held = inputs_of(y0, model.names_of_states)
    given = time_inputs(model, inputs, span, held=held, max_step=options.max_step)
    watched = events_of(model, events)
    solve = _choose_backend(model, backend, options)
    return _Run(model, given, options, watched, times, solve).over(state)


def simulate_inputs(
    model: System,
    inputs: TimeInputs,
    state: Array,
    times: Array | None,
    accuracy: Accuracy,
    *,
    method: Method,
    stopped: Callable[[], bool] | None = None,
) -> Simulation:
    """Integrate one motion of many, with arguments that have been checked.

    `state` is that at the start; `times` are those of the outputs [s], by default every step.
    `stopped` is called now and then; KeyboardInterrupt is raised if it returns True.
    """
    options = Options(
        **vars(accuracy), method=method, dense_output=False, stop_at_outputs=False, stopped=stopped
    )
    solve = _choose_backend(model, "auto", options)
    return _Run(model, inputs, options, events_of(model, None), times, solve).over(state)


# -- arguments ----------------------------------------------------------------------------------


def _state(given: Validator, model: System, y0: Any) -> Array:
    """Return the checked initial state."""
    state = given.array("y0", y0, empty=True, finite=False)
    if state.shape != model.design_state.shape:
        given.fail(
            f"y0 has shape {state.shape}; the state of {model.equations.NAME} has the elements "
            f"{', '.join(model.state_names)}."
        )
    elif not np.isfinite(state).all():
        bad = [n for n, v in zip(model.state_names, state, strict=True) if not np.isfinite(v)]
        given.fail(f"y0 is NaN or infinite in {', '.join(bad)}.")
    return state


def _fixed_step(
    given: Validator, method: str, step: Any, max_step: Any, others: Mapping[str, Any]
) -> float:
    """Return the fixed step [s]; refuse arguments that contradict it."""
    if method not in FIXED_STEP_METHODS:
        given.fail(
            f"step is for methods 'RK4' and 'RODASP', and {method!r} chooses its steps: give "
            "max_step, or one of these methods."
        )
        return 1.0
    lines = [name for name, value in others.items() if value is not None]
    lines += [] if isinstance(max_step, float) and max_step == np.inf else ["max_step"]
    if lines:
        given.fail(f"method {method!r} has fixed steps: leave out {', '.join(lines)}.")
    if step is None:
        given.fail(
            f"method {method!r} needs step, the length of all steps in seconds, such as 1e-3."
        )
        return 1.0
    return given.number("step", step, "s", above=0.0)


def _check_count(given: Validator, span: tuple[float, float], accuracy: Accuracy) -> None:
    """Refuse more fixed steps than are allowed."""
    step, most = accuracy.max_step, accuracy.max_steps
    needed = abs(span[1] - span[0]) / step
    if needed > most:
        given.fail(f"step = {step:g} s makes {needed:.3g} steps, and max_steps is {most}.")


def _check_memory(
    given: Validator,
    model: System,
    method: str,
    span: tuple[float, float],
    times: Array | None,
    accuracy: Accuracy,
) -> None:
    """Refuse more outputs than memory holds, if their number is known."""
    count = 0.0 if times is None else times.size
    if times is None and method in FIXED_STEP_METHODS:
        count = abs(span[1] - span[0]) / accuracy.max_step
    # the table of times and states from C, its transpose, and the inputs
    of_one = 2 * (1 + len(model.state_names)) + len(model.input_names)
    what = f"{count:,.0f} outputs of {len(model.state_names)} elements of the state"
    refuse_beyond(given, 8.0 * count * of_one, what, "Ask for fewer, by t_eval.")


def _choose_backend(
    model: System, backend: Backend, options: Options
) -> Callable[..., SolvedSegment]:
    """Return the solver for a method; warn once if it is not in C."""
    method = options.method
    with Validator("simulate") as given:
        given.among("backend", backend, ("auto", "sundials", "scipy"))
    if backend != "scipy" and method in _in_c(model):
        return solve_native
    if backend == "sundials" or options.stop_at_outputs or method not in SCIPY_METHODS:
        text = f"{_why_none(model, backend, method)}. {_what_else(model, backend, options)}"
        raise InputError([text], "simulate")
    if backend == "auto" and method in NATIVE_METHODS and _could_be_in_c(model):
        _warn_once()
    return solve_scipy


def _could_be_in_c(model: System) -> bool:
    """Return whether a model is compiled and has a state, which SUNDIALS needs."""
    return bool(model.equations.ADDRESSES and model.state_names)


def _in_c(model: System) -> tuple[str, ...]:
    """Return the methods by which a model can be integrated in C."""
    return native_methods(fixed_step=True) if _could_be_in_c(model) else ()


def _why_none(model: System, backend: Backend, method: str) -> str:
    """Return why a method is not available with these arguments."""
    if backend == "scipy":
        return f"SciPy has {', '.join(SCIPY_METHODS)}, and does not stop at outputs"
    if method not in NATIVE_METHODS:
        others = f"; in C there are {', '.join(native_methods())}" if _in_c(model) else ""
        return f"method {method!r} is one of SciPy, which does not stop at outputs{others}"
    if not model.state_names:
        return (
            f"method {method!r} in C needs a state to integrate, and all that moves here is "
            "prescribed"
        )
    if not model.equations.ADDRESSES:
        return (
            f"method {method!r} in C needs compiled equations, and these are functions over NumPy "
            "arrays"
        )
    if not native_available():
        return f"method {method!r} in C needs SUNDIALS, and {why_not_native()}"
    return (
        f"method {method!r} is not in the installed SUNDIALS {native_version()}, which has "
        f"{', '.join(native_methods())}"
    )


def _what_else(model: System, backend: Backend, options: Options) -> str:
    """Return advice: the arguments with which it can be integrated, in C or else by SciPy."""
    in_c, method = _in_c(model), options.method
    other = [] if method in (in_c or SCIPY_METHODS) else ["method 'BDF'"]
    other += ["backend 'auto'"] if backend == ("scipy" if in_c else "sundials") else []
    given = {"step": method in FIXED_STEP_METHODS, "stop_at_outputs": options.stop_at_outputs}
    out = [] if in_c else [name for name, there in given.items() if there]
    words = [f"use {' and '.join(other)}"] if other else []
    words += [f"leave out {' and '.join(out)}"] if out else []
    advice = ", ".join(words)
    by = "the equations are then integrated in C" if in_c else "SciPy then integrates them"
    return f"{advice[0].upper()}{advice[1:]}: {by}."


@cache
def _warn_once() -> None:
    warnings.warn(
        f"{why_not_native()}. Until then SciPy integrates, with the same results but slower.",
        RuntimeWarning,
        stacklevel=4,
    )


def _among(some: Array, times: Array) -> NDArray[np.bool_]:
    """Return which of some times are among those of the outputs, which are in order."""
    known = times if times[-1] >= times[0] else times[::-1]
    place = np.minimum(np.searchsorted(known, some), known.size - 1)
    return known[place] == some


# -- running ------------------------------------------------------------------------------------


class _Run:
    """Integrates segment after segment, and joins the results."""

    def __init__(
        self,
        model: System,
        inputs: TimeInputs,
        options: Options,
        events: Events,
        times: Array | None,
        solve: Callable[..., SolvedSegment],
    ) -> None:
        self._model, self._inputs, self._options = model, inputs, options
        self._events, self._times, self._solve = events, times, solve
        self._pieces: list[tuple[Segment, SolvedSegment]] = []
        self._taken, self._passed = 0, [0] * len(events)  # steps and events so far

    def over(self, state: Array) -> Simulation:
        """Integrate over all segments."""
        for segment in self._inputs.segments:
            if self._pieces and self._jumped_over(segment, state):
                break
            options, taken = self._options, self._taken
            piece = self._solve(
                self._model,
                self._inputs,
                segment,
                state,
                self._asked(segment),
                every_step=self._times is None,
                options=replace(options, max_steps=options.max_steps - taken) if taken else options,
                events=self._events.after(self._passed),
            )
            self._pieces.append((segment, piece))
            self._taken += piece.counts.get("steps", 0)
            for index, _, _ in piece.events:
                self._passed[index] += 1
            if piece.outcome not in ("done", "event"):
                self._fail(segment, piece)
            state = piece.y[-1].copy()
            if piece.outcome == "event":
                break
        return self._assembled()

    def _jumped_over(self, segment: Segment, state: Array) -> bool:
        """Note events of signals that jump at a segment's start; return whether one is terminal."""
        before, piece = self._pieces[-1]
        signals = [
            self._model.signals(state, self._inputs.at(segment.start, part))
            for part in (before, segment)
        ]
        terminal = False
        for index, event in enumerate(self._events.after(self._passed).signal):
            low, high = (float(found[event.signal]) - event.level for found in signals)
            passes = low != 0.0 and np.sign(low) != np.sign(high)
            if passes and event.direction * (high - low) >= 0.0:
                piece.events.append((index, segment.start, state))
                self._passed[index] += 1
                terminal = terminal or event.terminal == 1
        if terminal:
            piece.outcome = "event"
        return terminal

    def _asked(self, segment: Segment) -> Array:
        """Return the output times of a segment, with its two ends."""
        if self._times is None:
            return np.array([segment.start, segment.end])
        if self._times[0] == segment.start and self._times[-1] == segment.end:
            return self._times
        low, high = min(segment.start, segment.end), max(segment.start, segment.end)
        inside = self._times[(self._times > low) & (self._times < high)]
        return np.concatenate(([segment.start], inside, [segment.end]))

    def _fail(self, segment: Segment, piece: SolvedSegment) -> None:
        time, state = piece.reached_time, piece.reached_state
        # after an overflow the refused state may not be finite
        refused = piece.refused_state
        if piece.outcome == "state" and refused is not None and np.isfinite(refused).all():
            time, state = piece.refused_time, refused
        reason, advice = self._reason(segment, piece, time, state)
        partial = self._assembled(f"{reason}. {advice}")
        raise SimulationError(reason, time, state, partial, advice)

    def _reason(
        self, segment: Segment, piece: SolvedSegment, time: float, state: Array
    ) -> tuple[str, str]:
        """Return the cause, without its point, and advice."""
        options = self._options
        if piece.outcome == "state":
            try:
                self._refuse(piece.refused_guard, state, self._inputs.at(time, segment))
            except ModelError as error:
                return str(error), (
                    "Try another initial state, smaller forces, or a simulation that ends earlier."
                )
        texts = {
            # the refused state is not finite
            "state": (
                "the motion overflows double precision",
                "Try another initial state, or smaller forces.",
            ),
            "too_many_steps": (
                f"more than {options.max_steps} steps",
                f"Raise max_steps, or loosen rtol = {options.rtol:g}.",
            ),
            "too_accurate": (
                (
                    f"rtol = {options.rtol:g} and the given atol ask for more accuracy than the "
                    "arithmetic has"
                ),
                "Loosen them.",
            ),
            "unstable": (
                (
                    f"steps of {options.max_step:g} s are not stable: the fastest motion here "
                    f"needs steps of {0.99 * piece.longest_step:.3g} s or less"
                ),
                "Give such a step, or another method: RODASP and BDF are for stiff equations.",
            ),
            "jumps": (
                (
                    f"rates alternate from step to step of {options.max_step:g} s, as those of "
                    "friction that sticks, and the result would be wrong"
                ),
                "Give a shorter step, or method 'BDF'.",
            ),
            "singular": (
                (
                    f"the linear equations of a step of {options.max_step:g} s have no one "
                    "solution here"
                ),
                "Give another step.",
            ),
            "bad_table": (
                f"method {options.method!r} is not in SUNDIALS {native_version()}",
                "Give another method.",
            ),
            "flat_event": (
                "the function of an event stays at zero",
                "Watch another level, or another signal.",
            ),
            "memory": ("out of memory", "Ask for fewer outputs with t_eval."),
        }
        failed = f"the solver failed ({piece.detail})", "Loosen rtol, or try another method."
        return texts.get(piece.outcome, failed)

    def _refuse(self, guard: int | None, state: Array, inputs: Array) -> None:
        """Raise the error of the state at which the motion ends."""
        if guard is not None:
            refuse(self._model, guard, state, inputs)
        self._model.evaluate("rhs", state, inputs)

    # -- assembling -------------------------------------------------------------------------------

    def _assembled(self, failure: str = "") -> Simulation:
        rows = [self._rows(segment, piece) for segment, piece in self._pieces]
        t, y, inputs = rows[0] if len(rows) == 1 else map(np.concatenate, zip(*rows, strict=True))
        ended = self._pieces[-1][1].outcome == "event"
        status = -1 if failure else int(ended)
        message = failure or (
            "A termination event occurred." if ended else "The end of the time was reached."
        )
        counts = self._counts()
        if self._options.method == "BDF" and counts.get("steps", 0) > _LONG:
            message += (
                " BDF damps what swings a little at every step, and these are many: "
                "method='Verner' keeps amplitudes better."
            )
        native = self._solve is solve_native
        simulation = Simulation()
        simulation.update(
            t=t,
            y=y.T,
            inputs=inputs,
            status=status,
            message=message,
            success=not failure,
            signals=Signals(self._model, y, inputs, failed=bool(failure)),
            sol=self._dense(),
            solver=native_name(self._options.method) if native else "SciPy",
            **self._crossings(),
            **counts,
        )
        return simulation

    def _rows(self, segment: Segment, piece: SolvedSegment) -> tuple[Array, Array, Array]:
        """Return times, states and inputs that belong to the output."""
        t, y = piece.t, piece.y
        if len(self._pieces) > 1 or not (self._times is None or np.array_equal(t, self._times)):
            keep = np.ones(t.size, dtype=bool) if self._times is None else _among(t, self._times)
            if self._pieces[0][0] is not segment:
                keep[0] = False  # the border is the end of the segment before
            t, y = t[keep], y[keep]
        return t, y, self._inputs.table(t, segment)

    def _dense(self) -> DenseOutput | None:
        parts = [part for _, piece in self._pieces for part in piece.interpolants]
        return DenseOutput(parts) if parts else None

    def _crossings(self) -> dict[str, list[Array] | None]:
        if not len(self._events):
            return {"t_events": None, "y_events": None}
        times: list[list[float]] = [[] for _ in self._events.order]
        states: list[list[Array]] = [[] for _ in self._events.order]
        for _, piece in self._pieces:
            for index, time, state in piece.events:
                times[self._events.order[index]].append(time)
                states[self._events.order[index]].append(state)
        return {
            "t_events": [np.array(t) for t in times],
            "y_events": [
                np.array(s).reshape(len(s), self._model.design_state.size) for s in states
            ],
        }

    def _counts(self) -> dict[str, Any]:
        total: dict[str, Any] = {"nfev": 0, "njev": 0, "nlu": 0}
        for _, piece in self._pieces:
            total |= {name: total.get(name, 0) + count for name, count in piece.counts.items()}
        if "order" in total:
            total["order"] = self._pieces[-1][1].counts["order"]
        return total
