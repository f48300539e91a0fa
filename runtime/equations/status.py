"""The bits of a status word, as all functions of all models return it.

There are 30 for guards, under that for results that are not finite. The last one is for all guards
that are left: which of those it is follows from the margins.
"""

from collections.abc import Iterable

LAST_GUARD_BIT = 29
NOT_FINITE_BIT = 30

NOT_FINITE = 1 << NOT_FINITE_BIT


def bit_of(guard: int) -> int:
    """Return the bit of a guard, by its place among those of a model."""
    return min(guard, LAST_GUARD_BIT)


def mask_of(guards: Iterable[int]) -> int:
    """Return a status word with the bits of some guards, and that of results that are not finite.

    Parameters
    ----------
    guards : iterable of int
        Their places among those of a model.
    """
    mask = NOT_FINITE
    for guard in guards:
        mask |= 1 << bit_of(guard)
    return mask
