"""SymPy's cache of results, and pauses of the garbage collector.

By default SymPy keeps the last thousand results. A derivation needs far more of them again, and
takes half as long again without them; all of them take some 100 MB. SymPy reads the size of the
cache when it is imported, so that this module is imported first; if a program has imported SymPy
before, its own choice stays.
"""

import atexit
import gc
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any, TypeVar, cast

os.environ.setdefault("SYMPY_CACHE_SIZE", "None")


_Function = TypeVar("_Function", bound=Callable[..., Any])
_caches: list[Any] = []


def remembered(function: _Function) -> _Function:
    """Return a function of expressions that keeps its results until `forget`.

    SymPy's ``cacheit`` adds a call in Python to every look-up, of which a car takes a million.
    """
    kept = cache(function)
    _caches.append(kept)
    return cast("_Function", kept)


@atexit.register
def forget() -> None:
    """Empty the cache of SymPy, and those of `remembered` functions.

    At the end of a program this takes 0.2 s after the derivation of a car. Otherwise Python frees
    it after its modules, with several searches for cycles: in 5 s.
    """
    if "sympy.core.cache" in sys.modules:
        sys.modules["sympy.core.cache"].clear_cache()
    for kept in _caches:
        kept.cache_clear()


@contextmanager
def uncollected() -> Iterator[None]:
    """Suspend Python's search for cycles of objects.

    It traverses all results in the cache of SymPy again and again, and finds nothing to free: that
    takes a sixth of the time of a derivation, and of printing its results.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
