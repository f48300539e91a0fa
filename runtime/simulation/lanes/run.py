"""Integration of many systems on all cores, without the interpreter's lock."""

import ctypes
import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

import numpy as np
from numpy.typing import NDArray

from .problem import Problem

Report = Callable[[int], None]
Finish = Callable[[int, int, NDArray[np.float64], Callable[[], bool]], None]

# Systems of one call in a thread: enough that idle lanes at the end matter little, few enough that
# all threads end at about the same time.
_FEWEST, _MOST, _PARTS = 64, 2048, 8
# Samples of one call in a thread, which limits the memory [bytes].
SAMPLES = 2**23
# Time after which the main thread handles signals and reports progress [s].
_PATIENCE = 0.1


def usual_threads() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def run(problem: Problem, threads: int, finish: Finish, report: Report | None = None) -> None:
    """Integrate all systems of a problem into its outcome; an interruption ends all threads.

    `finish` is called in several threads with the first of some systems and the one after the last,
    their samples, and a function that returns whether the caller wants to stop. `report` is called
    now and then with the number of integrated systems.
    """
    stop = ctypes.c_int(0)

    def part(first: int, last: int) -> None:
        samples = problem.integrate(first, last, stop)
        if not stop.value:
            finish(first, last, samples, lambda: bool(stop.value))

    with ThreadPoolExecutor(threads) as pool:
        try:
            waiting = {
                pool.submit(part, first, last): last - first
                for first, last in _chunks(problem, threads)
            }
            _wait_for(waiting, report)
        except BaseException:
            stop.value = 1
            pool.shutdown(cancel_futures=True)
            raise


def _wait_for(waiting: dict[Future[None], int], report: Report | None) -> None:
    done = 0
    while waiting:
        for future in wait(waiting, _PATIENCE, FIRST_COMPLETED).done:
            future.result()
            done += waiting.pop(future)
        if report:
            report(done)


def _chunks(problem: Problem, threads: int) -> Iterator[tuple[int, int]]:
    count, wanted = problem.systems.count, problem.wanted
    size = min(max(count // (threads * _PARTS), _FEWEST), _MOST)
    of_one = 8 * wanted.sample_count * wanted.times.size
    size = min(size, max(SAMPLES // max(of_one, 1), problem.width))
    for first in range(0, count, size):
        yield first, min(first + size, count)
