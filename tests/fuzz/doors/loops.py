"""Dimensions of loops without a closed form, and positions on their paths.

What is answered is compared with a path followed in maximal coordinates (`following`).
"""

from mechanisms.random_loops import FAMILIES, judged

from ..attempts import WrongError

SECONDS = 120.0  # deriving is a part of the first attempt at each family
SHORT = 2

_QUICK = [family for family in FAMILIES if family.quick]


class RefusedError(Exception):
    """Positions on a path are refused."""


CLEAR = (RefusedError,)


def attempt(random):
    """Draw a mechanism and a path, and compare where it leads."""
    family = _QUICK[random.integers(len(_QUICK))]
    found = judged(family, random)
    if found.wrong:
        message = f"{family.title}: {found.wrong} of {found.reached} positions are elsewhere"
        raise WrongError(message)
    if found.answered < found.regular:
        message = f"{family.title}: {found.answered} of {found.regular} positions are answered"
        raise RefusedError(message)
