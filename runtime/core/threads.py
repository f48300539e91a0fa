"""Work in several threads, and matrices in one.

Libraries of linear algebra share the work on a matrix out to threads. Where it has some tens of
rows these only wait for each other, on a busy machine a hundred times as long as one of them needs.
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
    """Work on parts in threads; an interruption, or an error of one of them, ends all.

    Parameters
    ----------
    do : callable
        Called with a part, and a function that returns whether its result is not needed any more.
    parts : iterable
    take : callable
        Called with each result as it comes, in the thread of the caller.
    threads : int, optional
        By default some more than there are cores.
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
    """Return a function while which libraries of linear algebra start no threads.

    Of calls that overlap in threads, the first limits them for all.
    """

    @wraps(function)
    def alone(*args: Given.args, **kwargs: Given.kwargs) -> Found:
        with _libraries().limit(limits=1, user_api="blas"):
            return function(*args, **kwargs)

    return alone


@cache
def _libraries() -> ThreadpoolController:
    """Return those that are loaded; SciPy brings one of its own."""
    import_module("scipy.linalg")
    return ThreadpoolController()
