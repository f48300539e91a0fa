"""The bits of a status word, which every function of every model returns.

Bits 0 to 29 are for guards, bit 30 for results that are not finite. All guards from the thirtieth
on share bit 29; the margins show which of them acts.
"""

from collections.abc import Iterable

LAST_GUARD_BIT = 29
NOT_FINITE_BIT = 30

NOT_FINITE = 1 << NOT_FINITE_BIT


def bit_of(guard: int) -> int:
    """Return the bit of a guard, by its index among those of a model."""
    return min(guard, LAST_GUARD_BIT)


def mask_of(guards: Iterable[int]) -> int:
    """Return a status word with the bits of some guards, by index, and of non-finite results."""
    mask = NOT_FINITE
    for guard in guards:
        mask |= 1 << bit_of(guard)
    return mask
