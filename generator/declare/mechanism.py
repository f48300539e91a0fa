"""Mechanisms, checked as a whole."""

from __future__ import annotations

from dataclasses import dataclass

from .assembly import Parts
from .checks import check_mechanism
from .declared import declared


@declared
@dataclass(frozen=True)
class Mechanism(Parts):
    """Joints between bodies, with everything that acts on them.

    The ground is the body that rests in the world, with its axes along those of the world at design
    (`Ground`); where all move, a joint `Free` says which body they hang on, and the ground is the
    world itself.
    `coordinates` are the relative coordinates of the report, in the numbering of the figure,
    `outputs` what else is to be seen. What all these refer to is found by itself: `bodies`,
    `inputs`, `parameters`, and in copies `derived`, what the names of a copy represent.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        check_mechanism(self)
