"""Multi-link continuation: random hardpoints, racks, rods of rigid axles, branch by branch.

What is answered over the range of each is compared with paths that are followed from the design
position in maximal coordinates (`swinging`, `rigid_ways`), one by one and in batches.
"""

from mechanisms import random_multi_links, random_rigid_axles

from ..attempts import WrongError

SECONDS = 300.0
SHORT = 1
CARS = 12  # in an attempt, and a third as many axles
RACK = 0.06  # m


class RefusedError(Exception):
    """Positions on a path are refused."""


CLEAR = (RefusedError,)


def attempt(random):
    """Draw suspensions and axles, and compare where they are."""
    cars = random_multi_links.some_cars(random, CARS)
    of_cars = random_multi_links.judged(cars, random.uniform(-RACK, RACK), random)
    of_axles = random_rigid_axles.judged(random_rigid_axles.some_axles(random, CARS // 3), random)
    if wrong := [*of_cars.wrong, *of_axles.wrong]:
        raise WrongError("; ".join(wrong))
    if short := [*of_cars.short, *of_axles.short]:
        raise RefusedError("; ".join(short))
