"""The bits of a status word.

There are 30 for guards, under that for results that are not finite. The last one is for all guards
that are left: which of those it is follows from the margins.
"""

LAST_GUARD_BIT = 29
NOT_FINITE_BIT = 30
