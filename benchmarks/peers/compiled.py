"""Peers as C: one file with the peer's code, an adapter and the timing loops, compiled and loaded.

The adapter ``rhs(parameters, state, out)`` is the same for all peers and is never inlined into the
loops, so that nothing that depends on parameters alone is moved out of them. The loops go through
a table of states and read the clock themselves.
"""

import ctypes
import hashlib
import subprocess
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .case import REPOSITORY, Array

BUILD = REPOSITORY / "build" / "peers"

FLAGS = {
    "ours": ("-O2", "-fno-math-errno", "-ffp-contract=off"),
    "native": ("-O3", "-march=native", "-fno-math-errno"),
}
"""Compiler flags: those of this project's extension modules, and those that are fastest here."""

_LOOPS = """
#include <time.h>

static double kt_now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#ifdef __cplusplus
extern "C" {
#endif
void kt_rhs(const double *parameters, const double *state, double *out) {
    rhs(parameters, state, out);
}

/* Seconds of `count` calls, each of which needs the result of the one before. */
double kt_dependent(long count, const double *parameters, const double *table, long rows) {
    double state[NX], out[NO] = {0.0};
    const double begin = kt_now();
    for (long k = 0, row = 0; k < count; ++k) {
        double sum = 0.0;
        for (int i = 0; i < NFED; ++i) sum += out[FED + i];
        for (int i = 0; i < NX; ++i) state[i] = table[row * NX + i] + 1e-30 * sum;
        rhs(parameters, state, out);
        if (++row == rows) row = 0;
    }
    const double end = kt_now();
    volatile double sink = out[0];
    (void)sink;
    return end - begin;
}

/* Seconds of `count` calls that may overlap. */
double kt_independent(long count, const double *parameters, const double *table, long rows) {
    double out[NO] = {0.0};
    const double begin = kt_now();
    for (long k = 0, row = 0; k < count; ++k) {
        rhs(parameters, table + row * NX, out);
        if (++row == rows) row = 0;
    }
    const double end = kt_now();
    volatile double sink = out[0];
    (void)sink;
    return end - begin;
}
#ifdef __cplusplus
}
#endif
"""

_RUNGE_KUTTA = """
/* Classical Runge-Kutta of order 4; the first element of the state is stored at each sample. */
void kt_rk4(const double *parameters, const double *start, long samples, long steps, double h,
            double *angles) {
    double x[NX], y[NX], k1[NO], k2[NO], k3[NO], k4[NO];
    for (int i = 0; i < NX; ++i) x[i] = start[i];
    angles[0] = x[0];
    for (long s = 1; s < samples; ++s) {
        for (long n = 0; n < steps; ++n) {
            rhs(parameters, x, k1);
            for (int i = 0; i < NX; ++i) y[i] = x[i] + 0.5 * h * k1[i];
            rhs(parameters, y, k2);
            for (int i = 0; i < NX; ++i) y[i] = x[i] + 0.5 * h * k2[i];
            rhs(parameters, y, k3);
            for (int i = 0; i < NX; ++i) y[i] = x[i] + h * k3[i];
            rhs(parameters, y, k4);
            for (int i = 0; i < NX; ++i)
                x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        angles[s] = x[0];
    }
}
"""

_POINTER = ctypes.POINTER(ctypes.c_double)


@dataclass(frozen=True)
class Source:
    """C (or C++) of one peer's right-hand side."""

    name: str  # of the file
    # defines `static void rhs(const double *p, const double *x, double *out)` after `HEAD`
    code: str
    # lengths of `x` and `out`
    states: int
    outputs: int
    fed_back: slice  # outputs whose sum is added, times 1e-30, to each state of the dependent loop
    # whether `out` is the derivative of `x` and beta1 comes first, so that it can be integrated as
    # it is
    is_derivative: bool = False
    # what compiles it, and its further options
    compiler: str = "gcc"
    options: tuple[str, ...] = ()

    def text(self) -> str:
        """Return the whole file."""
        fed = range(*self.fed_back.indices(self.outputs))
        sizes = {"NX": self.states, "NO": self.outputs, "FED": fed[0], "NFED": len(fed)}
        lines = [f"#define {name} {value}" for name, value in sizes.items()]
        extra = _RUNGE_KUTTA if self.is_derivative and self.compiler == "gcc" else ""
        return "\n".join([*lines, HEAD, self.code, _LOOPS, extra])


HEAD = """
#if defined(__GNUC__) && !defined(__clang__)
#define KT_RHS static __attribute__((noipa)) void rhs
#else
#define KT_RHS static __attribute__((noinline)) void rhs
#endif
"""
"""Defines ``KT_RHS``, which begins the definition of a peer's ``rhs``."""


@dataclass
class Library:
    """A compiled peer."""

    source: Source  # what it was made of
    parameters: Array  # passed to every call
    compile_seconds: float  # time that the compiler took
    _library: ctypes.CDLL = field(repr=False)

    def __call__(self, state: Array) -> Array:
        """Return the peer's outputs at one state."""
        out = np.zeros(self.source.outputs)
        self._library.kt_rhs(*map(_pointer, (self.parameters, state, out)))
        return out

    def seconds(self, kind: str, count: int, table: Array) -> float:
        """Return the time of `count` calls, s.

        Parameters
        ----------
        kind : {"dependent", "independent"}
            Whether a call waits for the one before.
        count : int
            Number of calls.
        table : ndarray, shape (n, states)
            States to go through.
        """
        loop = getattr(self._library, f"kt_{kind}")
        loop.restype = ctypes.c_double
        given = np.ascontiguousarray(table)
        return float(
            loop(
                ctypes.c_long(count),
                _pointer(self.parameters),
                _pointer(given),
                ctypes.c_long(len(given)),
            )
        )

    def runge_kutta(self, start: Array, samples: int, steps: int, step: float) -> Array:
        """Return the first element of the state at each sample, by classical Runge-Kutta."""
        angles = np.empty(samples)
        self._library.kt_rk4(
            _pointer(self.parameters),
            _pointer(np.ascontiguousarray(start)),
            ctypes.c_long(samples),
            ctypes.c_long(steps),
            ctypes.c_double(step),
            _pointer(angles),
        )
        return angles


def compile_source(source: Source, parameters: Array, flags: Sequence[str]) -> Library:
    """Compile and load a peer.

    Parameters
    ----------
    source : Source
        Its code.
    parameters : ndarray
        Passed to every call.
    flags : sequence of str
        Of the compiler.

    Returns
    -------
    Library
        Ready to be called.
    """
    BUILD.mkdir(parents=True, exist_ok=True)
    text = source.text()
    key = hashlib.sha256(" ".join([text, *flags, *source.options]).encode()).hexdigest()[:12]
    ending = "cpp" if source.compiler == "g++" else "c"
    path = BUILD / f"{source.name}_{key}.{ending}"
    library, clock = path.with_suffix(".so"), path.with_suffix(".seconds")
    # What was compiled before is used again, with the time that it took then.
    if not (clock.exists() and library.exists()):
        path.write_text(text)
        command = [source.compiler, *flags, "-shared", "-fPIC", "-o", str(library), str(path)]
        if source.compiler == "g++":
            command.append("-w")  # the peer's own headers are not ours to warn about
        begin = time.perf_counter()
        subprocess.run([*command, *source.options, "-lm"], check=True)
        clock.write_text(f"{time.perf_counter() - begin:.3f}\n")
    given = np.ascontiguousarray(parameters, dtype=float)
    return Library(source, given, float(clock.read_text()), ctypes.CDLL(str(library)))


def _pointer(array: Array) -> "ctypes._Pointer[ctypes.c_double]":
    return array.ctypes.data_as(_POINTER)
