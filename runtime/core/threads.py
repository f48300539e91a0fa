"""Parts of a task in several threads, and linear algebra in one thread.

Libraries of linear algebra distribute the work on a matrix over threads. For a matrix of some tens
of rows these only wait for each other, on a busy machine a hundred times as long as one needs.
"""

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import cache, wraps
from importlib import import_module
from typing import ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

Given = ParamSpec("Given")
Found = TypeVar("Found")
Part = TypeVar("Part")


def shared_out(
    do: Callable[[Part, Callable[[], bool]], Found],
    parts: Iterable[Part],
    take: Callable[[Found], None],
    threads: int | None = None,
) -> None:
    """Process parts in threads; an interruption, or an error of one of them, ends all.

    `do` is called with a part, and a function that returns whether its result is no longer needed;
    `take` with each result as it comes, in the thread of the caller. By default there are some more
    threads than cores.
    """
    unwanted = False
    with ThreadPoolExecutor(threads) as pool:
        try:
            for done in as_completed([pool.submit(do, part, lambda: unwanted) for part in parts]):
                take(done.result())
        except BaseException:
            unwanted = True
            pool.shutdown(cancel_futures=True)
            raise


def in_one_thread(function: Callable[Given, Found]) -> Callable[Given, Found]:
    """Return a function during which libraries of linear algebra start no threads.

    Of overlapping calls in threads, the first sets the limit for all.
    """

    @wraps(function)
    def alone(*args: Given.args, **kwargs: Given.kwargs) -> Found:
        with _libraries().limit(limits=1, user_api="blas"):
            return function(*args, **kwargs)

    return alone


@cache
def _libraries() -> ThreadpoolController:
    """Return the loaded libraries of linear algebra, with that of SciPy."""
    import_module("scipy.linalg")
    return ThreadpoolController()
