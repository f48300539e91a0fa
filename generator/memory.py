"""How much SymPy remembers of its own results, which the garbage collector skips meanwhile.

By default SymPy remembers the last thousand. A derivation comes back to far more of them, and takes
half as long again without; what it keeps in all is some 100 MB. SymPy reads the number when it is
imported, so that this comes first; where a program has imported SymPy before, its own choice stays.
"""

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager

os.environ.setdefault("SYMPY_CACHE_SIZE", "None")


@contextmanager
def uncollected() -> Iterator[None]:
    """Let Python's search for circles of objects rest.

    It goes through all that SymPy remembers, over and over, and finds nothing to be freed: a sixth
    of the time of a derivation, and of printing what came of it.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
