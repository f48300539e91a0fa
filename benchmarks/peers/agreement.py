"""Whether a peer is the same model: accelerations at random states against the reference."""

import numpy as np

from .case import random_instants
from .compiled import Library
from .models import Built

LIMIT = 1e-9
"""Largest error of an acceleration, relative to one plus its size, at which a peer is timed."""


class DisagreementError(RuntimeError):
    """A peer that does not model the same suspension."""


def acceleration_error(built: Built, library: Library) -> float:
    """Return the largest error of both accelerations at random states.

    Parameters
    ----------
    built : Built
        The right-hand side.
    library : Library
        What the compiler made of it.

    Returns
    -------
    float
        Relative to one plus the acceleration.

    Raises
    ------
    DisagreementError
        If it is not small.
    """
    worst = 0.0
    for instant in random_instants():
        got = built.accelerations(instant, library(built.state(instant)))
        error = np.abs(got - instant.acceleration) / (1.0 + np.abs(instant.acceleration))
        worst = max(worst, float(error.max()))
    if not worst < LIMIT:
        message = f"accelerations differ from the reference by {worst:.1e}"
        raise DisagreementError(message)
    return worst
