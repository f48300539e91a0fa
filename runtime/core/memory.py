"""How much memory there is, so that what does not fit is refused before it is begun."""

import os
from collections.abc import Iterator, Sequence, Sized
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .named_types import ArrayLike
from .validator import Validator

Array = NDArray[np.float64]

_EACH = 4096
"""What curves take for each position, of the kinds that there are 800 to 5500 [bytes]."""
_UNITS = (("TB", 1e12), ("GB", 1e9), ("MB", 1e6))


def refuse_beyond(given: Validator, needed: float, what: str, instead: str) -> bool:
    """Refuse what needs more memory than there is, and return whether it does.

    Parameters
    ----------
    given : Validator
    needed : float
        [bytes]
    what : str
        What needs it, with its sizes; a plural.
    instead : str
        What to do: a sentence.
    """
    there = free()
    if needed > there:
        given.fail(f"{what} need {_size(needed)}, and {_size(there)} are free. {instead}")
    return needed > there


def positions_given(
    given: Validator,
    name: str,
    values: ArrayLike,
    unit: str,
    *,
    dimensions: Sequence[int] = (1,),
    times: int = 1,
) -> Array:
    """Return positions as an array, or refuse those whose curves do not fit into memory.

    Parameters
    ----------
    given : Validator
    name, values, unit
        The argument.
    dimensions : sequence of int, optional
        How many dimensions it may have.
    times : int, optional
        How many positions there are for each of the values.
    """
    size = getattr(values, "size", None)
    count = size if isinstance(size, int) else len(values) if isinstance(values, Sized) else 1
    what = f"{name}: curves of {count * times:,} positions"
    if refuse_beyond(given, float(_EACH) * count * times, what, "Ask for fewer."):
        return np.ones(1)
    return given.array(name, values, unit, dimensions=dimensions)


def free() -> float:
    """Return how much memory this process can still take, as far as the system shows [bytes]."""
    return min(_limits(), default=float("inf"))


def _limits() -> Iterator[float]:
    with suppress(OSError, KeyError, ValueError):
        there = _table("/proc/meminfo")
        yield 1024.0 * (there["MemAvailable"] + there.get("SwapFree", 0.0))
    with suppress(OSError, KeyError, ValueError):  # of a container
        limit = float(Path("/sys/fs/cgroup/memory.max").read_text(encoding="ascii"))
        yield limit - _table("/sys/fs/cgroup/memory.stat")["anon"]
    with suppress(OSError, ImportError, ValueError):
        import resource  # noqa: PLC0415 (not of every system)

        limit, _ = resource.getrlimit(resource.RLIMIT_AS)
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[0]
        if limit != resource.RLIM_INFINITY:
            yield float(limit - int(pages) * os.sysconf("SC_PAGE_SIZE"))
    with suppress(OSError, ValueError, AttributeError):  # what is there at all
        yield float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))


def _table(path: str) -> dict[str, float]:
    """Return the numbers of a file with a name and a number in each row."""
    rows = (
        line.replace(":", " ").split()
        for line in Path(path).read_text(encoding="ascii").splitlines()
    )
    return {row[0]: float(row[1]) for row in rows}


def _size(count: float) -> str:
    """Return a number of bytes, for people."""
    unit, scale = next((one for one in _UNITS if count >= one[1]), _UNITS[-1])
    return f"{count / scale:.3g} {unit}"
