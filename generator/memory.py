"""SymPy's memory of its own results, and pauses of the garbage collector.

By default SymPy remembers the last thousand. A derivation comes back to far more of them, and takes
half as long again without; all of them take some 100 MB. SymPy reads the number when it is
imported, so that this comes first; where a program has imported SymPy before, its own choice stays.
"""

import atexit
import gc
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

os.environ.setdefault("SYMPY_CACHE_SIZE", "None")


@atexit.register
def forget() -> None:
    """Free what SymPy remembers.

    At the end of a program this takes 0.2 s after the derivation of a car. Otherwise Python frees
    it after its modules, with several searches for cycles: in 5 s.
    """
    if "sympy.core.cache" in sys.modules:
        sys.modules["sympy.core.cache"].clear_cache()


@contextmanager
def uncollected() -> Iterator[None]:
    """Suspend Python's search for cycles of objects.

    It traverses all results that SymPy remembers, over and over, and finds nothing to free: a sixth
    of the time of a derivation, and of printing its results.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
