# cython: language_level=3, boundscheck=False, wraparound=False
"""Evaluation of the steps of a motion, and of their adjoint, with compiled functions of a model."""

import numpy as np

from libc.stdint cimport uintptr_t

cdef extern from "Python.h":
    int PyErr_CheckSignals() except -1

# Steps after which interrupts are checked: some milliseconds.
cdef enum:
    LOOKS = 1024

ctypedef int (*function_pointer)(
    const double *constants, const double *state, const double *inputs, double *out
) noexcept nogil


def go_through(
    rhs, const double[::1] constants, const double[:, ::1] table, const double[::1] lengths,
    const unsigned char[::1] restarts, const double[:, :, ::1] inputs, double[:, :, ::1] states,
    double[:, :, ::1] rates,
):
    """Fill states and rates of all stages from the states at the first ones.

    The first stage of a step that does not restart is the last one of the step before; the first
    step restarts. Return whether no state is refused.
    """
    cdef function_pointer function = <function_pointer><uintptr_t> rhs
    cdef Py_ssize_t last = states.shape[1] - 1, n = states.shape[2], step, stage, earlier, i
    cdef double moved
    cdef int status = 0
    with nogil:
        for step in range(states.shape[0]):
            if step % LOOKS == 0:
                with gil:
                    PyErr_CheckSignals()
            if not restarts[step]:
                for i in range(n):
                    rates[step, 0, i] = rates[step - 1, last, i]
            for stage in range(0 if restarts[step] else 1, last + 1):
                for i in range(n):
                    moved = 0.0
                    for earlier in range(stage):
                        moved += table[stage, earlier] * rates[step, earlier, i]
                    states[step, stage, i] = states[step, 0, i] + lengths[step] * moved
                status |= function(&constants[0], &states[step, stage, 0],
                                   &inputs[step, stage, 0], &rates[step, stage, 0])
    return status == 0


def go_back(
    adjoint, const double[::1] constants, const double[:, ::1] table, const double[::1] lengths,
    const unsigned char[::1] restarts, const double[:, :, ::1] inputs, const double[:, :, ::1] states,
    const double[:, ::1] at_begin, const double[:, :, ::1] at_stages, double[::1] by_constants,
    double[::1] by_start, double[::1] by_inputs,
):
    """Add the derivatives with respect to constants, the start and inputs, see `sweep`.

    If the next step does not restart, its first stage is the last one of this step, whose
    contributions must be zero here. Return whether no state is refused.
    """
    cdef function_pointer function = <function_pointer><uintptr_t> adjoint
    cdef Py_ssize_t count = states.shape[0], last = states.shape[1] - 1, step, stage, later, i
    cdef Py_ssize_t c = constants.shape[0], n = states.shape[2], m = inputs.shape[2]
    cdef double[::1] given = np.empty(m + n), found = np.empty(c + n + m)
    cdef double[:, ::1] back = np.zeros((last + 1, n))
    cdef double counts
    cdef int status = 0
    with nogil:
        for step in range(count - 1, -1, -1):
            if step % LOOKS == 0:
                with gil:
                    PyErr_CheckSignals()
            for i in range(n):
                back[last, i] = 0.0
            for stage in range(last - (step + 1 < count and not restarts[step + 1]), -1, -1):
                for i in range(m):
                    given[i] = inputs[step, stage, i]
                for i in range(n):
                    counts = table[last, stage] * by_start[i]
                    for later in range(stage + 1, last + 1):
                        counts += table[later, stage] * back[later, i]
                    given[m + i] = at_stages[step, stage, i] + lengths[step] * counts
                status |= function(&constants[0], &states[step, stage, 0], &given[0], &found[0])
                for i in range(c):
                    by_constants[i] += found[i]
                for i in range(n):
                    back[stage, i] = found[c + i]
                for i in range(m):
                    by_inputs[i] += found[c + n + i]
            for i in range(n):
                by_start[i] += at_begin[step, i]
                for stage in range(last + 1):
                    by_start[i] += back[stage, i]
    return status == 0
