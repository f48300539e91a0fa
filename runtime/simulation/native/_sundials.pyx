# cython: language_level=3, boundscheck=False, wraparound=False
"""Calls of `kt_integrate` with NumPy arrays, without the interpreter lock."""

import numpy as np

from cpython.exc cimport PyErr_CheckSignals
from libc.math cimport isfinite
from libc.stdint cimport uintptr_t
from libc.stdlib cimport calloc, free
from libc.string cimport memcpy

cdef extern from "integrate.h" nogil:
    ctypedef int (*kt_function)(const double *, const double *, const double *, double *)
    ctypedef int (*kt_root)(double, const double *, double *, void *)
    ctypedef int (*kt_interrupted)(void *)
    ctypedef struct kt_spline:
        int pieces
        const double *breaks
        const double *coefficients
        int target[3]
    ctypedef struct kt_event:
        int signal
        double level
    ctypedef struct kt_problem:
        kt_function rhs
        kt_function jacobian
        kt_function signals
        kt_function margins
        int state_count
        int input_count
        int signal_count
        int position_count
        int speed_count
        const double *constants
        const double *inputs
        int spline_count
        const kt_spline *splines
        long milestone_count
        const double *milestones
        long turn_count
        const double *turns
        const double *reaches
        int event_count
        const kt_event *events
        int root_count
        kt_root roots
        void *root_data
        const int *directions
        const int *terminal
        int guard_count
        const int *guards
        const double *usual_margins
        kt_interrupted interrupted
        void *interrupted_data
    ctypedef struct kt_options:
        int method
        const char *table
        double rtol
        const double *atol
        double first_step
        double max_step
        long max_steps
        int stop_at_outputs
        int dense
    ctypedef struct kt_statistics:
        long steps
        long evaluations
        long jacobians
        long factorisations
        long error_test_failures
        long order
    ctypedef struct kt_table:
        double *data
        long rows
        long capacity
        int width
    ctypedef struct kt_result:
        kt_table output
        kt_table events
        kt_table dense
        kt_statistics statistics
        double time
        double *state
        int refused_status
        int refused_guard
        double refused_time
        double *refused_state
        double longest_step
        int code
    int kt_integrate(const kt_problem *, const kt_options *, const double *, const double *, long,
                     int, kt_result *)
    void kt_free(kt_result *)
    ctypedef struct kt_motion:
        pass
    kt_motion *kt_open_motion(const kt_problem *, const kt_options *, const double *, double, kt_result *)
    int kt_advance(kt_motion *, const double *, const double *, const double *)
    void kt_close_motion(kt_motion *)
    const char *kt_version()

OUTCOMES = (
    "done", "event", "state", "too_many_steps", "too_accurate", "caller", "unstable", "jumps", "singular",
    "bad_table", "memory", "failed",
)
METHODS = {"BDF": 0, "Adams": 1, "DormandPrince": 2, "RK4": 3, "RODASP": 4}
RUNGE_KUTTA = 5


def version():
    """Return the version of the SUNDIALS library that is linked."""
    return kt_version().decode()


cdef class _Roots:
    """The caller's root functions, and the exception that one of them raised."""

    cdef list functions
    cdef int state_count
    cdef object stopped
    cdef object error

    def __init__(self, functions, state_count, stopped):
        self.functions = list(functions)
        self.stopped = stopped
        self.state_count = state_count
        self.error = None


cdef int _call_roots(double time, const double *state, double *out, void *data) noexcept with gil:
    cdef _Roots roots = <_Roots> data
    try:
        y = np.empty(roots.state_count)
        for i in range(roots.state_count):
            y[i] = state[i]
        for i, function in enumerate(roots.functions):
            out[i] = function(time, y)
    except BaseException as error:
        roots.error = error
        return 1
    return 0


cdef int _interrupted(void *data) noexcept with gil:
    """Raise KeyboardInterrupt, or any other exception of a signal: only Python handles signals."""
    cdef _Roots roots = <_Roots> data
    try:
        PyErr_CheckSignals()
        if roots.stopped is not None and roots.stopped(): # in a thread, which receives no signals
            raise KeyboardInterrupt
    except BaseException as error:
        roots.error = error
        return 1
    return 0


cdef _copy(const kt_table *table):
    """Return a table as an array."""
    array = np.empty((table.rows, table.width))
    cdef double[:, ::1] view
    if table.rows:
        view = array
        memcpy(&view[0, 0], table.data, table.rows * table.width * sizeof(double))
    return array


def integrate(
    addresses, layout, const double[::1] constants, const double[::1] inputs, splines,
    const double[::1] milestones, const double[:, ::1] turns, const double[::1] state,
    const double[::1] times, *, method, double rtol, const double[::1] atol, double first_step, double max_step, long max_steps,
    bint every_step, bint stop_at_outputs, bint dense, int signal_count, events, roots,
    const int[::1] directions, const int[::1] terminal, const int[::1] guards,
    const double[::1] usual_margins, stopped=None,
):
    """Integrate; ``integrate.h`` explains the arguments, `kintrafo.simulation.solvers` uses the result."""
    cdef kt_problem problem
    cdef kt_options options
    cdef kt_result result
    cdef int outcome
    cdef int n = state.shape[0]
    cdef _Roots caller = _Roots(roots, n, stopped)
    cdef const double[::1] breaks
    cdef const double[:, ::1] coefficients
    cdef kt_spline *spline_array = <kt_spline *> calloc(len(splines) + 1, sizeof(kt_spline))
    cdef kt_event *event_array = <kt_event *> calloc(len(events) + 1, sizeof(kt_event))
    table = b"" if method in METHODS else method.encode()
    keep = []
    try:
        for i, (spline_breaks, spline_coefficients, targets) in enumerate(splines):
            breaks, coefficients = spline_breaks, spline_coefficients
            keep.append((spline_breaks, spline_coefficients))
            spline_array[i].pieces = coefficients.shape[1]
            spline_array[i].breaks = &breaks[0]
            spline_array[i].coefficients = &coefficients[0, 0]
            for k in range(3):
                spline_array[i].target[k] = targets[k]
        for i, (signal, level) in enumerate(events):
            event_array[i].signal = signal
            event_array[i].level = level
        problem.rhs = <kt_function><uintptr_t> addresses[0]
        problem.jacobian = <kt_function><uintptr_t> addresses[1]
        problem.signals = <kt_function><uintptr_t> addresses[2]
        problem.margins = <kt_function><uintptr_t> addresses[3]
        problem.state_count = n
        problem.input_count = inputs.shape[0]
        problem.signal_count = signal_count
        problem.position_count, problem.speed_count = layout.positions, layout.speeds
        problem.constants = &constants[0]
        problem.inputs = &inputs[0]
        problem.spline_count = len(splines)
        problem.splines = spline_array
        problem.milestone_count = milestones.shape[0]
        problem.milestones = &milestones[0] if milestones.shape[0] else NULL
        problem.turn_count = turns.shape[1]
        problem.turns = &turns[0, 0] if turns.shape[1] else NULL
        problem.reaches = &turns[1, 0] if turns.shape[1] else NULL
        problem.event_count = len(events)
        problem.events = event_array
        problem.root_count = len(caller.functions)
        problem.roots = _call_roots
        problem.root_data = <void *> caller
        problem.directions = &directions[0] if directions.shape[0] else NULL
        problem.terminal = &terminal[0] if terminal.shape[0] else NULL
        problem.guard_count = usual_margins.shape[0]
        problem.guards = &guards[0] if guards.shape[0] else NULL
        problem.usual_margins = &usual_margins[0] if usual_margins.shape[0] else NULL
        problem.interrupted = _interrupted
        problem.interrupted_data = <void *> caller
        options.method = METHODS.get(method, RUNGE_KUTTA)
        options.table = table
        options.rtol = rtol
        options.atol = &atol[0]
        options.first_step = first_step
        options.max_step = max_step
        options.max_steps = max_steps
        options.stop_at_outputs = stop_at_outputs
        options.dense = dense
        with nogil:
            outcome = kt_integrate(&problem, &options, &state[0], &times[0], times.shape[0],
                                   every_step, &result)
        try:
            if caller.error is not None:
                raise caller.error
            return {
                "outcome": OUTCOMES[outcome],
                "output": _copy(&result.output),
                "events": _copy(&result.events),
                "dense": _copy(&result.dense),
                "steps": result.statistics.steps,
                "nfev": result.statistics.evaluations,
                "njev": result.statistics.jacobians,
                "nlu": result.statistics.factorisations,
                "error_test_failures": result.statistics.error_test_failures,
                "order": result.statistics.order,
                "time": result.time,
                "state": [result.state[i] for i in range(n)] if result.state != NULL else [],
                "refused_status": result.refused_status,
                "refused_guard": result.refused_guard,
                "refused_time": result.refused_time,
                "refused_state": [result.refused_state[i] for i in range(n)]
                if result.refused_state != NULL else [],
                "longest_step": result.longest_step,
                "code": result.code,
            }
        finally:
            kt_free(&result)
    finally:
        free(spline_array)
        free(event_array)


cdef class Motion:
    """A motion that is advanced piece by piece; `kintrafo.simulation.stepper` is its interface.

    State and inputs are the caller's arrays. After a piece they have the values at its end: inputs with a
    rate are integrated, and others do not change.
    """

    cdef kt_problem problem
    cdef kt_options options
    cdef kt_result result
    cdef kt_motion *motion
    cdef kt_spline *splines
    cdef double *curves  # 2 breaks and 4 coefficients of each spline
    cdef const double[::1] constants, atol, usual_margins
    cdef const int[::1] guards
    cdef double[::1] state, inputs
    cdef double start, length
    cdef public long taken

    def __cinit__(
        self, addresses, layout, const double[::1] constants, double[::1] state, double[::1] inputs, moving,
        double length, *, method, double rtol, const double[::1] atol, double max_step, long max_steps,
        const int[::1] guards, const double[::1] usual_margins,
    ):
        cdef int i, k
        self.constants, self.state, self.inputs, self.atol = constants, state, inputs, atol
        self.start, self.length, self.taken = 0.0, length, 0
        self.guards, self.usual_margins = guards, usual_margins
        self.splines = <kt_spline *> calloc(len(moving) + 1, sizeof(kt_spline))
        self.curves = <double *> calloc(6 * len(moving) + 1, sizeof(double))
        if self.splines == NULL or self.curves == NULL:
            raise MemoryError
        for i, targets in enumerate(moving):
            self.splines[i].pieces = 1
            self.splines[i].breaks = self.curves + 6 * i
            self.splines[i].coefficients = self.curves + 6 * i + 2
            for k in range(3):
                self.splines[i].target[k] = targets[k]
        self.problem.rhs = <kt_function><uintptr_t> addresses[0]
        self.problem.jacobian = <kt_function><uintptr_t> addresses[1]
        self.problem.margins = <kt_function><uintptr_t> addresses[2]
        self.problem.state_count = state.shape[0]
        self.problem.input_count = inputs.shape[0]
        self.problem.position_count, self.problem.speed_count = layout.positions, layout.speeds
        self.problem.constants = &constants[0]
        self.problem.inputs = &inputs[0] if inputs.shape[0] else NULL
        self.problem.spline_count = len(moving)
        self.problem.splines = self.splines
        self.problem.guard_count = usual_margins.shape[0]
        self.problem.guards = &guards[0] if guards.shape[0] else NULL
        self.problem.usual_margins = &usual_margins[0] if usual_margins.shape[0] else NULL
        self.options.method = METHODS[method]
        self.options.rtol = rtol
        self.options.atol = &atol[0]
        self.options.max_step = max_step
        self.options.max_steps = max_steps
        self.motion = kt_open_motion(&self.problem, &self.options, &state[0], length, &self.result)
        if self.motion == NULL:
            raise MemoryError

    def __dealloc__(self):
        kt_close_motion(self.motion)
        kt_free(&self.result)
        free(self.splines)
        free(self.curves)

    cdef void _let_inputs_move(self, double start, double end) noexcept nogil:
        """Set the curves of inputs with a rate, from it and from its own rate, within the piece."""
        cdef double *curve
        cdef int i, rate, second
        for i in range(self.problem.spline_count):
            curve = self.curves + 6 * i
            rate, second = self.splines[i].target[1], self.splines[i].target[2]
            curve[0], curve[1], curve[2] = start, end, 0.0
            curve[3] = 0.5 * self.inputs[second] if second >= 0 else 0.0
            curve[4] = self.inputs[rate]
            curve[5] = self.inputs[self.splines[i].target[0]]

    cdef void _put_inputs_to_the_end(self) noexcept nogil:
        cdef double *curve
        cdef double lapse
        cdef int i
        for i in range(self.problem.spline_count):
            curve = self.curves + 6 * i
            lapse = curve[1] - curve[0]
            self.inputs[self.splines[i].target[0]] = (curve[3] * lapse + curve[4]) * lapse + curve[5]
            self.inputs[self.splines[i].target[1]] = 2.0 * curve[3] * lapse + curve[4]

    def begin(self, double start):
        """Count steps from a time on."""
        self.start, self.taken = start, 0

    @property
    def time(self):
        return self.start + self.taken * self.length

    cpdef bint advance(self):
        """Advance by one step; return whether it succeeded. Else nothing has changed."""
        cdef double times[2]
        cdef int outcome
        # whole steps from the start, so that times do not drift
        times[0] = self.start + self.taken * self.length
        times[1] = self.start + (self.taken + 1) * self.length
        with nogil:
            self._let_inputs_move(times[0], times[1])
            outcome = kt_advance(self.motion, &self.state[0],
                                 &self.inputs[0] if self.inputs.shape[0] else NULL, times)
            if outcome == 0 and self._is_finite():
                memcpy(&self.state[0], self.result.state, self.state.shape[0] * sizeof(double))
                self._put_inputs_to_the_end()
                self.taken += 1
                return True
        return False

    cdef bint _is_finite(self) noexcept nogil:
        cdef int i
        for i in range(self.problem.state_count):
            if not isfinite(self.result.state[i]):
                return False
        return True
