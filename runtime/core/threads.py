"""One thread for matrices that are small.

Libraries of linear algebra share the work on a matrix out to threads. Where it has some tens of
rows these only wait for each other, on a busy machine a hundred times as long as one of them needs.
"""

from collections.abc import Callable
from functools import cache, wraps
from importlib import import_module
from typing import ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

Given = ParamSpec("Given")
Found = TypeVar("Found")


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
