"""Free memory, so that results which do not fit are refused before they are computed."""

import os
from collections.abc import Iterator, Sequence, Sized
from contextlib import suppress
from pathlib import Path

import numpy as np

from .named_types import Array, ArrayLike
from .validator import Validator

_EACH = 4096
"""Memory of all curves of a position, rounded up: there are 800 to 5500 curves [bytes]."""
_LITTLE = 2.0**20
"""Memory for which the system is not asked: it reports in files, which take longer to read than a
short simulation [bytes]."""
_UNITS = (("TB", 1e12), ("GB", 1e9), ("MB", 1e6))


def refuse_beyond(given: Validator, needed: float, what: str, instead: str) -> bool:
    """Refuse a computation that needs more memory than is free, and return whether it does.

    `needed` is in bytes; `what` names the data, with sizes, in the plural; `instead` is advice.
    """
    if needed <= _LITTLE:
        return False
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

    `dimensions` are the allowed numbers of dimensions; there are `times` positions for each value.
    """
    size = getattr(values, "size", None)
    count = size if isinstance(size, int) else len(values) if isinstance(values, Sized) else 1
    what = f"{name}: curves of {count * times:,} positions"
    if refuse_beyond(given, float(_EACH) * count * times, what, "Ask for fewer."):
        return np.ones(1)
    return given.array(name, values, unit, dimensions=dimensions)


def free() -> float:
    """Return the memory that this process can still allocate, as the system reports it [bytes]."""
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
    with suppress(OSError, ValueError, AttributeError):  # all memory of the machine
        yield float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))


def _table(path: str) -> dict[str, float]:
    """Return the numbers of a file with a name and a number in each row."""
    rows = (
        line.replace(":", " ").split()
        for line in Path(path).read_text(encoding="ascii").splitlines()
    )
    return {row[0]: float(row[1]) for row in rows}


def _size(count: float) -> str:
    """Return a number of bytes with a unit, as a text."""
    unit, scale = next((one for one in _UNITS if count >= one[1]), _UNITS[-1])
    return f"{count / scale:.3g} {unit}"
