"""The solvers of `simulate`: those in C, which are SUNDIALS and our own, and SciPy.

Both integrate one segment of time, in which the inputs are smooth, and return the same
`SolvedSegment`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import import_module
from itertools import pairwise
from math import factorial, isinf
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from ..core.named_types import Array
from ..core.validator import Validator
from ..equations.errors import ModelError
from ..systems.system import System
from .accuracy import Accuracy
from .dead_points import Approach, DeadPoint, meanings
from .events import Events
from .signals import Segment, TimeInputs
from .watched import TooManySteps, watched

# Names of the methods in C: a multistep family or a Butcher table of SUNDIALS, or our own method.
NATIVE_METHODS = {
    "BDF": "BDF",
    "Adams": "Adams",
    "Verner": "ARKODE_VERNER_8_5_6",
    "DormandPrince": "DormandPrince",
    "RK4": "RK4",
    "RODASP": "RODASP",
    "Tsitouras": "ARKODE_TSITOURAS_7_4_5",
}
FIXED_STEP_METHODS = ("RK4", "RODASP")
_OF_OUR_OWN = ("DormandPrince", *FIXED_STEP_METHODS)
_FIRST_WITH_TSITOURAS = (7, 3)
# Methods of SciPy, also instead of those in C without SUNDIALS.
SCIPY_METHODS = {
    "BDF": "BDF",
    "DormandPrince": "RK45",
    "Radau": "Radau",
    "LSODA": "LSODA",
    "RK45": "RK45",
    "DOP853": "DOP853",
}
_IMPLICIT = ("BDF", "Radau", "LSODA")
# Methods with the exact Jacobian; RK4 checks with it whether a step is stable.
_WITH_JACOBIAN = (*_IMPLICIT, "Adams", *FIXED_STEP_METHODS)


@dataclass(frozen=True, kw_only=True)
class Options(Accuracy):
    """How to integrate one motion; the names are those of SciPy."""

    method: str
    dense_output: bool
    stop_at_outputs: bool
    stopped: Callable[[], bool] | None = None


@dataclass
class SolvedSegment:
    """The integration of one segment."""

    # output times [s], and states with one row each
    t: Array
    y: Array
    outcome: str  # 'done', 'event', or the name of an error
    counts: dict[str, int]  # statistics by name
    # end of the last step, which need not be an output
    reached_time: float
    reached_state: Array
    # (index of the event, time, state), in the order of time
    events: list[tuple[int, float, Array]] = field(default_factory=list)
    # (first time, last time, function of time) of every step, if requested
    interpolants: list[tuple[float, float, Callable[[Array], Array]]] = field(default_factory=list)
    # time and state that the model refused
    refused_time: float = 0.0
    refused_state: Array | None = None
    # guard at whose dead point the motion ends; None if a state was refused for another reason
    refused_guard: int | None = None
    longest_step: float = 0.0  # longest stable step, if fixed steps are not stable [s]
    detail: str = ""


_NOT_BUILT = (
    "kintrafo was built without SUNDIALS. Install it (Debian: libsundials-dev; conda, Homebrew: "
    "sundials) and build again"
)


def _load_native() -> tuple[Any, str]:
    """Return the module that links SUNDIALS, or None and the reason."""
    try:
        return import_module(f"{__package__}.native._sundials"), ""
    except ModuleNotFoundError:  # built without SUNDIALS
        return None, _NOT_BUILT
    except ImportError as error:
        return None, f"the module that links SUNDIALS cannot be loaded: {error}. Build it again"


sundials, _why_not = _load_native()


def why_not_native() -> str:
    """Return why SUNDIALS is not linked, and advice."""
    return _why_not or _NOT_BUILT


def native_available() -> bool:
    """Return whether SUNDIALS is linked."""
    return sundials is not None


def native_version() -> str:
    """Return the version of SUNDIALS, or 'none'."""
    return sundials.version() if native_available() else "none"


def native_name(method: str) -> str:
    """Return the name of the solver for a method in C."""
    return "kintrafo" if method in _OF_OUR_OWN else f"SUNDIALS {native_version()}"


def native_methods(*, fixed_step: bool = False) -> tuple[str, ...]:
    """Return the methods in C, with the linked SUNDIALS; optionally those of fixed step, too."""
    if not native_available():
        return ()
    return _methods_of(native_version(), fixed_step)


@cache
def _methods_of(version: str, fixed_step: bool) -> tuple[str, ...]:
    release = tuple(int(part) for part in version.split(".")[:2])
    missing = set() if release >= _FIRST_WITH_TSITOURAS else {"Tsitouras"}
    missing |= set() if fixed_step else {*FIXED_STEP_METHODS}
    return tuple(method for method in NATIVE_METHODS if method not in missing)


def check_jacobian(given: Validator, model: System, method: str) -> None:
    """Refuse a method that needs the Jacobian where the equations have none."""
    if method in _WITH_JACOBIAN and not hasattr(model.equations, "rhs_jacobian"):
        given.fail(
            f"method {method!r} needs the Jacobian of the rates, and {model.equations.NAME} was "
            "derived without derivatives: derive it with them, or use method 'DormandPrince'."
        )


# Return value of solvers in C if an event's function stays at zero (arguments have been checked).
_ILL_INPUT = -22
# Return values for a step that has become too small.
_WHY = {
    -3: "its steps became too small, since the error stays too large",
    -4: "its steps became too small, since Newton's method does not converge",
}


# -- in C ---------------------------------------------------------------------------------------


def solve_native(
    model: System,
    inputs: TimeInputs,
    segment: Segment,
    state: Array,
    times: Array,
    *,
    every_step: bool,
    options: Options,
    events: Events,
) -> SolvedSegment:
    """Integrate a segment in C, from the first step to the last."""
    equations = model.equations
    names = (f"rhs{inputs.variant}", f"rhs_jacobian{inputs.variant}", "signals", "margins")
    signals = model.signal_names
    raw = sundials.integrate(
        tuple(equations.ADDRESSES.get(name, 0) for name in names),  # there may be no signals
        model.layout,
        model.constants,
        inputs.constant,
        [
            (np.ascontiguousarray(s.curve.x), np.ascontiguousarray(s.curve.c), s.targets)
            for s in segment.splines
        ],
        *_times_of(segment, options),
        np.ascontiguousarray(state),
        np.ascontiguousarray(times),
        method=NATIVE_METHODS[options.method],
        rtol=options.rtol,
        atol=options.atol,
        first_step=options.first_step or 0.0,
        max_step=0.0 if isinf(options.max_step) else options.max_step,
        max_steps=options.max_steps,
        every_step=every_step,
        stop_at_outputs=options.stop_at_outputs,
        dense=options.dense_output,
        signal_count=len(signals),
        events=[(signals.index(e.signal), e.level) for e in events.signal],
        roots=events.functions,
        directions=events.directions,
        terminal=events.terminal,
        guards=meanings(model.equations),
        usual_margins=model.usual_margins,
        stopped=options.stopped,
    )
    counts = ("nfev", "njev", "nlu", "steps", "error_test_failures", "order")
    output = raw["output"] if len(raw["output"]) else np.array([[segment.start, *state]])
    return SolvedSegment(
        t=output[:, 0].copy(),
        y=output[:, 1:].copy(),
        outcome="flat_event" if raw["code"] == _ILL_INPUT and len(events) else raw["outcome"],
        counts={name: raw[name] for name in counts},
        reached_time=raw["time"],
        reached_state=np.array(raw["state"]),
        events=[(int(row[0]), float(row[1]), row[2:]) for row in raw["events"]],
        interpolants=[_taylor(row, state.size) for row in raw["dense"]],
        refused_time=raw["refused_time"],
        refused_state=np.array(raw["refused_state"]),
        refused_guard=raw["refused_guard"] if raw["refused_guard"] >= 0 else None,
        longest_step=raw["longest_step"],
        detail=_WHY.get(raw["code"], f"{native_name(options.method)} returned {raw['code']}"),
    )


def _times_of(segment: Segment, options: Options) -> tuple[Array, Array]:
    """Return the times that no step passes over, and extrema of inputs that some steps may pass."""
    if options.method == "DormandPrince":
        return segment.free
    step = options.max_step if options.method in FIXED_STEP_METHODS else np.inf
    return segment.milestones_of(step), np.empty((2, 0))


@dataclass(frozen=True)
class _Taylor:
    """The polynomial of a step from its derivatives at its end, shape (order + 1, n)."""

    end: float
    terms: Array

    def __call__(self, times: Array) -> Array:
        powers = (times[:, None] - self.end) ** np.arange(len(self.terms))
        return powers @ self.terms


def _taylor(row: Array, size: int) -> tuple[float, float, Callable[[Array], Array]]:
    """Return the first and last time of a step, and its polynomial."""
    start, end, order = float(row[0]), float(row[1]), int(row[2])
    terms = row[3:].reshape(-1, size)[: order + 1]
    return start, end, _Taylor(end, terms / np.array([[factorial(k)] for k in range(order + 1)]))


# -- SciPy --------------------------------------------------------------------------------------


class _RightHandSide:
    """The compiled functions in the form that SciPy calls."""

    def __init__(
        self, model: System, inputs: TimeInputs, segment: Segment, max_evaluations: float
    ) -> None:
        self._function = getattr(model.equations, f"rhs{inputs.variant}")
        self._derivative = getattr(model.equations, f"rhs_jacobian{inputs.variant}")
        self._model, self._inputs, self._segment = model, inputs, segment
        self.evaluations = 0
        self._most = max_evaluations
        self.time, self.state = segment.start, model.design_state

    def __call__(self, time: float, state: Array) -> Array:
        self.time, self.state = time, state.copy()
        self.evaluations += 1
        if self.evaluations > self._most:
            raise TooManySteps
        given = self._inputs.at(time, self._segment)
        return self._function(state, given, self._model.constants)

    def jacobian(self, time: float, state: Array) -> Array:
        """Return the exact derivative with respect to the state."""
        self.time, self.state = time, state.copy()
        given = self._inputs.at(time, self._segment)
        return self._derivative(state, given, self._model.constants)

    def event(self, signal: str, level: float) -> Callable[[float, Array], float]:
        """Return a signal's distance from a level as a function of time and state."""

        def distance(time: float, state: Array) -> float:
            given = self._inputs.at(time, self._segment)
            return float(self._model.signal(signal, state, given)) - level

        return distance


def solve_scipy(
    model: System,
    inputs: TimeInputs,
    segment: Segment,
    state: Array,
    times: Array,
    *,
    every_step: bool,
    options: Options,
    events: Events,
) -> SolvedSegment:
    """Integrate a segment with SciPy's ``solve_ivp``."""
    # an explicit method evaluates at most twelve times a step, an implicit one fewer
    function = _RightHandSide(model, inputs, segment, 12.0 * options.max_steps)
    steps: list[tuple[float, Array]] = []
    name = SCIPY_METHODS[options.method]
    extra: dict[str, Any] = {"jac": function.jacobian} if name in _IMPLICIT else {}
    approach = Approach(
        model,
        lambda time: inputs.at(time, segment),
        1.0 if segment.end > segment.start else -1.0,
    )
    first = options.first_step  # SciPy refuses one that is longer than the time
    first = None if first is None else min(first, abs(segment.end - segment.start))
    watched_events = _scipy_events(function, events)
    failures: list[Exception] = []
    method = watched(name, approach, lambda: function.time, segment.milestones, failures.append)
    try:
        result = solve_ivp(
            function,
            (segment.start, segment.end),
            state,
            method,
            t_eval=None if every_step else times,
            rtol=options.rtol,
            atol=options.atol,
            max_step=options.max_step,
            first_step=first,
            dense_output=options.dense_output,
            events=[*watched_events, _recorder(steps)],
            **extra,
        )
    except (DeadPoint, ModelError, TooManySteps) as error:  # at the first state, or of an event
        started = steps or [(segment.start, state)]
        piece = SolvedSegment(
            t=np.array([time for time, _ in started]),
            y=np.array([y for _, y in started]),
            outcome="failed",
            counts={"nfev": function.evaluations},
            reached_time=started[-1][0],
            reached_state=started[-1][1],
        )
        return _failed(piece, error, function)
    piece = _piece_of(result, steps, events, options)
    if failures:
        return _checked_outputs(_failed(piece, failures[0], function), approach)
    crossed = zip(watched_events, result.t_events or (), strict=False)  # and that of the recorder
    if any(event.stays(steps) for event, times in crossed if times.size > 1):
        piece.outcome = "flat_event"
    return _checked_outputs(piece, approach)


def _failed(piece: SolvedSegment, error: Exception, function: _RightHandSide) -> SolvedSegment:
    """Return a piece with the reason why it ends early."""
    dead = error if isinstance(error, DeadPoint) else None
    return replace(
        piece,
        outcome="too_many_steps" if isinstance(error, TooManySteps) else "state",
        refused_time=dead.time if dead else function.time,
        refused_state=dead.state if dead else function.state,
        refused_guard=dead.guard if dead else None,
    )


def _checked_outputs(piece: SolvedSegment, approach: Approach) -> SolvedSegment:
    """End a piece before the first output at which the model cannot be evaluated."""
    for place, (time, state) in enumerate(zip(piece.t, piece.y, strict=True)):
        guard = approach.crossed(approach.margins(time, state))
        if guard is not None:
            piece.refused_time, piece.refused_state, piece.refused_guard = time, state, guard
            piece.t, piece.y = piece.t[:place], piece.y[:place]
            piece.outcome = "state"
            break
    return piece


def _scipy_events(function: _RightHandSide, events: Events) -> list["_Waiting"]:
    given: list[Callable[[float, Array], float]] = [
        *(function.event(event.signal, event.level) for event in events.signal),
        *events.functions,
    ]
    senses = events.directions.tolist(), events.terminal.tolist()
    return [_Waiting(*each) for each in zip(given, *senses, strict=True)]


@dataclass
class _Waiting:
    """An event for SciPy, which calls it at the ends of steps.

    A function that is zero at first was reported in the segment before, or crosses nothing: it
    returns NaN, which for SciPy is no crossing, while a step from zero to zero would be one.
    """

    event: Callable[[float, Array], float]
    direction: float
    terminal: int
    waits: bool = True

    def __call__(self, time: float, state: Array) -> float:
        value = self.event(time, state.copy())  # the caller's function may change it
        self.waits = self.waits and value == 0.0
        return np.nan if self.waits else value

    def stays(self, steps: list[tuple[float, Array]]) -> bool:
        """Return whether it is zero at both ends of a step, after it was not."""
        zero = [self.event(*step) == 0.0 for step in steps]
        first = zero.index(False) if False in zero else len(zero)
        return any(a and b for a, b in pairwise(zero[first:]))


def _recorder(steps: list[tuple[float, Array]]) -> Callable[[float, Array], float]:
    """Return an event that never occurs, and notes every accepted step."""

    def note(time: float, state: Array) -> float:
        steps.append((time, state.copy()))
        return 1.0

    return note


def _piece_of(
    result: Any, steps: list[tuple[float, Array]], events: Events, options: Options
) -> SolvedSegment:
    outcomes = {0: "done", 1: "event", -1: "failed"}
    crossings = [
        (index, float(time), state)
        for index in range(len(events))
        for time, state in zip(result.t_events[index], result.y_events[index], strict=True)
    ]
    counts = {name: int(result[name]) for name in ("nfev", "njev", "nlu")}
    interpolants: list[tuple[float, float, Callable[[Array], Array]]] = []
    if options.dense_output:
        interpolants = [
            (float(a), float(b), _Transposed(part))
            for a, b, part in zip(
                result.sol.ts[:-1], result.sol.ts[1:], result.sol.interpolants, strict=True
            )
        ]
    found = np.size(result.t) > 0  # SciPy has no array of outputs where the first step fails
    return SolvedSegment(
        t=result.t if found else np.array([steps[0][0]]),
        y=result.y.T if found else steps[0][1][None],
        outcome=outcomes[result.status],
        counts=counts | {"steps": len(steps) - 1},
        reached_time=steps[-1][0],
        reached_state=steps[-1][1],
        events=sorted(crossings, key=lambda c: c[1], reverse=bool(steps[-1][0] < steps[0][0])),
        interpolants=interpolants,
        detail=str(result.message),
    )


@dataclass(frozen=True)
class _Transposed:
    """A polynomial of SciPy with one row for each time."""

    part: Callable[[Array], Array]

    def __call__(self, times: Array) -> Array:
        return self.part(times).T
