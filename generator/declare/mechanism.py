"""Mechanisms, checked as a whole."""

from __future__ import annotations

from dataclasses import dataclass

from .assembly import Parts
from .checks import check_mechanism
from .declared import declared


@declared
@dataclass(frozen=True)
class Mechanism(Parts):
    """A mechanism: joints between bodies, with the forces that act on them.

    One of the bodies is the ground (`Ground`), which is fixed in the world. If all bodies move, one
    of them has a joint `Free` with the world.

    Parameters
    ----------
    name
        Name of the mechanism in the generated code.
    title
        Title in reports.
    joints
        The joints, which contain the bodies.
    forces
        Forces, force elements and weight; by default none.
    coordinates
        Coordinates of joints that reports show, in the order of their numbers.
    outputs
        Further signals.
    constraints
        Constraints of velocities, such as `NoSlip` and `Rolling`.

    Attributes
    ----------
    bodies, inputs, parameters
        Those of all parts, in the order in which they were declared; the ground is the first body.
    derived
        In copies: the expressions in parameters for names of the copy.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        check_mechanism(self)
