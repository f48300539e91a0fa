"""Many calls of one function: growth of memory, here, in a fork and in a spawned process.

A compiled function, a simulation, a stepper, an ensemble or a linearisation is called hundreds or
10,000 times with the same arguments, good ones or such as are refused. Behind a warm-up, what is
taken from the allocators of Python and of C, and what is resident, may not grow from one batch of
calls to each next one; and every call, in a process that was forked or spawned as well, returns the
same bits.
"""

import ctypes
import gc
import hashlib
import multiprocessing
import resource
import sys
from functools import cache
from pathlib import Path

import numpy as np
from kintrafo import Model, Stepper, System, ensemble, linearise, simulate
from kintrafo.core.errors import KintrafoError
from kintrafo.generated import four_bar, front_axle, rigid_axle, slider_crank
from kintrafo.simulation.lanes import library
from kintrafo.simulation.solvers import native_methods

from ..attempts import WrongError

SHORT = 4
SECONDS = 120.0
_MANY, _SOME, _FEW = 10_000, 400, 100
_BATCHES = 4
_MODULES = (four_bar, slider_crank, front_axle, rigid_axle)
_CARS = ("reference_car", "offset_strut_car", "push_rod_car", "multi_link_car", "trailing_arm_car")
_COUNTED = ("objects", "bytes of malloc", "resident bytes")
# What a leak takes of each call at least: an object of Python, a chunk of malloc, and of pages more
# than what varies from batch to batch. What caches and tables that double take, they take in some
# batches only.
_LEAST = (0.9, 16.0, 1e3)
# In all batches together, however many calls.
_RESIDENT = 1e7


def attempt(random):
    """Call something many times, and in other processes a few times."""
    seed, many = int(random.integers(2**31)), random.random() < 0.15
    here = measured(seed, _MANY if many else _SOME)
    ways = ["fork", "spawn"] if random.random() < 0.1 else ["fork"]
    for way in ways:
        there = _elsewhere(way, seed)
        if there != here:
            raise WrongError(f"other bits in a process by {way} than here")


def measured(seed, calls):
    """Call something so often; return a digest of what each call returns.

    What seems to grow is called four times as often, and again: what fills caches comes to an end.
    """
    call = _drawn(np.random.default_rng(seed))
    first, size = call(), calls // (_BATCHES + 1)
    gc.freeze()  # what is there already need not be searched
    while over := _growing(call, first, size):
        size *= 4
        if size > _MANY:
            raise WrongError(over)
    return hashlib.sha256(first).hexdigest()


def _growing(call, first, size):
    """Call in batches; return what grows in each of them, if anything does."""
    taken = np.zeros((_BATCHES + 1, 3))
    for batch in range(_BATCHES + 1):  # of which the first warms up
        for _ in range(size):
            if call() != first:
                raise WrongError("a later call returns other bits than the first")
        gc.collect()
        taken[batch] = _taken()
    growth = np.diff(taken, axis=0)
    for what, least, values in zip(_COUNTED, _LEAST, growth.T, strict=True):
        if values.min() > least * size:
            return f"{what}: {values} more after each {size} calls"
    if growth[:, -1].sum() > _RESIDENT:
        return f"{growth[:, -1]} bytes more are resident after each {size} calls"
    return ""


# -- memory and open files ------------------------------------------------------------------------


def _taken():
    """Return how much of the memory of this process is in use, as `_COUNTED` names it."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return sys.getallocatedblocks(), _by_malloc(), pages * resource.getpagesize()


class _Mallinfo(ctypes.Structure):
    """As glibc declares ``struct mallinfo2``."""

    _fields_ = [
        (name, ctypes.c_size_t)
        for name in (
            "arena", "ordblks", "smblks", "hblks", "hblkhd",
            "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost",
        )
    ]  # fmt: skip


@cache
def _mallinfo():
    """Return the function of glibc, or None where there is another library."""
    function = getattr(ctypes.CDLL(None), "mallinfo2", None)
    if function is not None:
        function.restype = _Mallinfo
    return function


def _by_malloc():
    function = _mallinfo()
    if function is None:
        return 0
    found = function()
    return int(found.uordblks + found.hblkhd)


# -- other processes ------------------------------------------------------------------------------


def _elsewhere(way, seed):
    """Return the digest of what another process computes."""
    context = multiprocessing.get_context(way)
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_send_digest, args=(seed, sender))
    process.start()
    sender.close()
    try:
        if not receiver.poll(0.5 * SECONDS):
            raise WrongError(f"a process by {way} does not end")
        fine, text = receiver.recv()
    except EOFError:
        process.join()
        raise WrongError(f"a process by {way} ends with {process.exitcode}") from None
    finally:
        process.kill()
        process.join()
    if not fine:
        raise WrongError(f"in a process by {way}: {text}")
    return str(text)


def _send_digest(seed, sender):
    try:
        sender.send((True, measured(seed, _FEW)))
    except Exception as error:  # noqa: BLE001 (any error goes to the parent, which fails the attempt)
        sender.send((False, f"{type(error).__name__}: {error}"))


# -- calls ----------------------------------------------------------------------------------------


@cache
def _system(place):
    count = len(_MODULES)
    return System(_MODULES[place]) if place < count else Model(_CARS[place - count])


def _drawn(random):
    """Return a function without arguments, which returns all that comes of a call as bytes."""
    system = _system(int(random.integers(len(_MODULES) + len(_CARS))))
    start = np.array(system.design_state)
    half = start.size // 2
    start[half:] += 0.1 * random.normal(size=half)
    if random.random() < 0.2:  # where no loop closes
        start[:half] += 1e3 * random.normal(size=half)
    kinds = [_function, _function, _preparation, _motion, _linearisation]
    if native_methods():
        kinds.append(_stepper)
    if library.widths():
        kinds.append(_ensemble)
    call = kinds[random.integers(len(kinds))](random, system, start)

    def guarded():
        try:
            return b"".join(np.asarray(part).tobytes() for part in call())
        except KintrafoError as error:
            return str(error).encode()

    return guarded


def _function(random, system, start):
    functions = system.equations.equations.functions
    function = functions[sorted(functions)[random.integers(len(functions))]]
    states = start if random.random() < 0.5 else np.tile(start, (20, 1))
    inputs = np.zeros(len(system.input_names))
    return lambda: [function(states, inputs, system.constants)]


def _preparation(random, system, _):
    values = dict(system.parameters)
    if random.random() < 0.3:
        values[sorted(values)[random.integers(len(values))]] = float(random.choice([np.nan, -1.0]))
    return lambda: [system.equations.prepare(values)]


def _motion(random, system, start):
    method = str(random.choice([*native_methods(), "RK45"]))
    name = next(iter([n for n in system.input_names if n.endswith("road_height")]), "")
    inputs = {name: lambda t: 0.01 * np.sin(20.0 * t)} if name and random.random() < 0.3 else {}

    def call():
        found = simulate(system, (0.0, 0.005), start, inputs=inputs, method=method)
        return [found.t, found.y, found.inputs, *found.signals.values()]

    return call


def _stepper(random, system, start):
    method = str(random.choice(["RK4", "DormandPrince"]))

    def call():
        stepper = Stepper(system, 1e-4, start, method=method)
        for _ in range(5):
            stepper.step()
        return [stepper.state, *stepper.signals().values()]

    return call


def _ensemble(random, system, start):
    names = [name for name in system.parameters if name.endswith(("_mass", "_rate"))]
    name = names[random.integers(len(names))]
    values = system.parameters[name] * np.linspace(1.0, 1.1, int(random.integers(1, 10)))
    threads = int(random.integers(1, 3))

    def call():
        found = ensemble(system, {name: values}, (0.0, 0.005), start, threads=threads)
        return [found["final_state"].values, found["success"].values]

    return call


def _linearisation(_, system, start):
    def call():
        found = linearise(system, start)
        return [found.A, found.B, found.C, found.D]

    return call
