"""Multi-link continuation: random hardpoints and racks, and rods of rigid axles, branch by branch.

What is answered over the range of each is compared with paths that are followed from the design
position in maximal coordinates (`swinging`, `rigid_ways`), one by one and in batches.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import rigid_ways
import swinging

from ..attempts import WrongError

if TYPE_CHECKING:
    import numpy as np

SECONDS = 300.0
SHORT = 2
CARS = 16  # in an attempt
RACK = 0.06  # m


class RefusedError(Exception):
    """Positions on a path are refused."""


CLEAR = (RefusedError,)


def attempt(random: np.random.Generator) -> None:
    """Draw suspensions, or axles, and compare where they are."""
    found: swinging.Judged | rigid_ways.Judged
    if random.random() < 0.8:
        cars = swinging.some_cars(random, CARS)
        found = swinging.judged(cars, random.uniform(-RACK, RACK), random)
    else:
        found = rigid_ways.judged(rigid_ways.some_axles(random, CARS), random)
    if found.wrong:
        raise WrongError("; ".join(found.wrong))
    if found.short:
        raise RefusedError("; ".join(found.short))
