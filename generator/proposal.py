"""Models of a mechanism for which nobody has said which coordinates are independent.

The mobility says how many there are. Of all sets of so many reported coordinates the first is taken
from which every loop closes in closed form, joints on the ground before others: their coordinates
are what drives, and what a person sees.
"""

from __future__ import annotations

from itertools import combinations, islice
from typing import TYPE_CHECKING

from .joints import Prismatic, Revolute
from .mechanism import Model
from .topology import Topology
from .transformer import NoClosedFormError, Plan

if TYPE_CHECKING:
    from collections.abc import Iterator

    from .mechanism import Mechanism

# More are not tried: a mechanism with so many coordinates has one that its author would name.
_MOST_TRIALS = 2000


def model_of(mechanism: Mechanism) -> Model:
    """Return a model of a mechanism with the first proposed coordinates, all bodies massive.

    Parameters
    ----------
    mechanism
        A mechanism without a prescribed motion.

    Raises
    ------
    NoClosedFormError
        If there is no such set of coordinates.
    """
    independent = next(proposals(mechanism), None)
    if independent is None:
        count = Topology(mechanism).mobility
        message = (
            f"mechanism {mechanism.name!r} with mobility {count}: from no {count} of its reported "
            f"angles and slides ({', '.join(_candidates(mechanism)) or 'none'}) does every loop "
            "close in closed form. Report more coordinates, or declare a Model with the "
            "independent and the prescribed joints that you mean"
        )
        raise NoClosedFormError(message)
    return _model(mechanism, independent)


def proposals(mechanism: Mechanism) -> Iterator[tuple[str, ...]]:
    """Yield sets of joints whose coordinates can be independent, in the order of preference."""
    candidates = _candidates(mechanism)
    sets = combinations(candidates, Topology(mechanism).mobility)
    for independent in islice(sets, _MOST_TRIALS):
        try:
            Plan.of(_model(mechanism, independent))
        except NoClosedFormError:
            continue
        yield independent


def _candidates(mechanism: Mechanism) -> list[str]:
    """Return the joints with one reported coordinate, those on the ground first."""
    reported = {c.joint for c in mechanism.coordinates}
    joints = [
        j for j in mechanism.joints if isinstance(j, Revolute | Prismatic) and j.name in reported
    ]
    joints.sort(key=lambda joint: mechanism.ground not in joint.bodies)  # stable
    return [joint.name for joint in joints]


def _model(mechanism: Mechanism, independent: tuple[str, ...]) -> Model:
    return Model(
        name=mechanism.name,
        title=mechanism.title,
        mechanism=mechanism,
        independent=independent,
        massive=tuple(body.name for body in mechanism.bodies[1:]),
    )
