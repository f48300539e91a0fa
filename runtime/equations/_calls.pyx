# cython: language_level=3, boundscheck=False, cdivision=True
"""Calls of the compiled functions of a model for one state or for arrays of states."""

import numpy as np

from libc.math cimport isfinite
from libc.stdint cimport uintptr_t
from libc.stdlib cimport free, malloc
from libc.string cimport memcpy

from kintrafo.equations.status import NOT_FINITE

ctypedef int (*function_pointer)(
    const double *constants, const double *state, const double *inputs, double *out
) noexcept nogil
ctypedef int (*residual_pointer)(
    const double *constants, const double *state, const double *inputs, const double *given,
    double *out
) noexcept nogil
ctypedef int (*prepare_pointer)(const double *parameters, double *constants) noexcept nogil


cdef class ModelFunction:
    """One result of a compiled function of a model: all elements that it computes, or some of them.

    Attributes
    ----------
    name : str
    shape : tuple of int
        Shape of the result for one state.
    labels : tuple of str
        One label for each element of the result, row-major.
    operations : dict
        Arithmetic operations of one call of the compiled function.
    address : int
        Address of the C function, for native callers.
    stage : str
        Name of the compiled function.
    """

    cdef readonly str name
    cdef readonly tuple shape
    cdef readonly tuple labels
    cdef readonly dict operations
    cdef readonly object address
    cdef readonly str __doc__
    cdef readonly str stage
    cdef object _model
    cdef Py_ssize_t _out, _start, _whole
    cdef Py_ssize_t _widths[3]
    cdef int _mask, _not_finite
    cdef uintptr_t _pointer

    def __init__(self, model, str name, address, tuple shape, tuple labels, dict operations,
                 str doc, str stage, Py_ssize_t start, Py_ssize_t whole, int mask):
        self._model = model
        self.name = name
        self.address = address
        self._pointer = address
        self.shape = shape
        self.labels = labels
        self.operations = operations
        self.__doc__ = doc
        self.stage = stage
        self._out, self._start, self._whole = len(labels), start, whole
        self._mask, self._not_finite = mask, NOT_FINITE
        for i in range(3):
            self._widths[i] = model.widths[i]

    def __repr__(self):
        return f"<compiled function {self._model.name}.{self.name}, result (..., {self.shape})>"

    def __call__(self, state, inputs=None, constants=None):
        """Evaluate the function; see the documentation of the model's module."""
        arrays = [
            self._model.default_constants if constants is None else constants,
            state,
            self._model.no_inputs if inputs is None else inputs,
        ]
        arrays = [np.asarray(a, dtype=np.float64) for a in arrays]
        for i, what in enumerate(("constants", "state", "inputs")):
            if arrays[i].shape[-1:] != (self._widths[i],):
                raise ValueError(
                    f"{self._model.name}.{self.name}: the last dimension of {what} must be "
                    f"{self._widths[i]}, its shape is {arrays[i].shape}"
                )
        lead = np.broadcast_shapes(*(a.shape[:-1] for a in arrays))
        result = np.empty(lead + self.shape)
        if result.size:
            self._fill(arrays, lead, result)
        return result

    cdef _fill(self, list arrays, tuple lead, result):
        cdef Py_ssize_t steps[3]
        cdef Py_ssize_t runs[3]  # consecutive calls with the same values
        flat = []
        for i, array in enumerate(arrays):
            steps[i] = self._widths[i] if array.ndim > 1 else 0
            runs[i] = 1
            if array.shape[:-1] == lead[:-1] + (1,):
                runs[i] = lead[-1]
            elif array.ndim > 1:
                array = np.broadcast_to(array, lead + (self._widths[i],))
            flat.append(np.ascontiguousarray(array).reshape(-1))
        cdef const double[::1] c = flat[0]
        cdef const double[::1] y = flat[1]
        cdef const double[::1] u = flat[2] if self._widths[2] else np.zeros(1)
        cdef double[::1] out = result.reshape(-1)
        cdef Py_ssize_t size = out.shape[0] // self._out, k = 0
        cdef int status = 0
        cdef double *whole = NULL
        if self._whole != self._out:
            whole = <double *> malloc(self._whole * sizeof(double))
            if whole == NULL:
                raise MemoryError
        try:
            while k < size:
                with nogil:
                    while k < size and status == 0:
                        status = self._one(&c[k // runs[0] * steps[0]],
                                           &y[k // runs[1] * steps[1]],
                                           &u[k // runs[2] * steps[2]],
                                           whole, &out[k * self._out])
                        k += 1
                if status != 0:
                    self._refuse(flat, steps, runs, k - 1, status, lead)
                    status = 0
        finally:
            free(whole)

    cdef int _one(self, const double *constants, const double *state, const double *inputs,
                  double *whole, double *out) noexcept nogil:
        """Fill the result for one state; return the status bits that concern it."""
        cdef function_pointer function = <function_pointer> self._pointer
        cdef Py_ssize_t i
        if whole == NULL:
            return function(constants, state, inputs, out) & self._mask
        cdef int status = function(constants, state, inputs, whole) & self._mask
        memcpy(out, whole + self._start, self._out * sizeof(double))
        if status & self._not_finite:  # another part may not be finite
            for i in range(self._out):
                if not isfinite(out[i]):
                    return status
            status &= ~self._not_finite
        return status

    cdef _refuse(self, list flat, Py_ssize_t *steps, Py_ssize_t *runs, Py_ssize_t k, int status,
                 tuple lead):
        starts = [k // runs[i] * steps[i] for i in range(3)]
        one = [flat[i][starts[i]:starts[i] + self._widths[i]] for i in range(3)]
        index = tuple(int(v) for v in np.unravel_index(k, lead)) if lead else ()
        self._model.refuse(self.name, status, one[0], one[1], one[2], index)


def call_prepare(address, const double[::1] parameters, double[::1] constants):
    """Fill the constants; return 0 or the number of an error (see the header of the model)."""
    return (<prepare_pointer><uintptr_t> address)(&parameters[0], &constants[0])


def call_margins(address, const double[::1] constants, const double[::1] state,
                 const double[::1] inputs, double[::1] out):
    """Fill the margins and return the status word."""
    return (<function_pointer><uintptr_t> address)(
        &constants[0], &state[0], &inputs[0], &out[0])


def call_residuals(address, const double[::1] constants, const double[::1] state,
                   const double[::1] inputs, const double[::1] given, double[::1] out):
    """Fill the closure residuals and return the status word."""
    return (<residual_pointer><uintptr_t> address)(
        &constants[0], &state[0], &inputs[0], &given[0], &out[0])
