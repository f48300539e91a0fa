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
    (`Ground`); where all bodies move, one hangs on the world itself, by a joint `Free`.

    `coordinates` are the relative coordinates of the report, in the numbering of the figure,
    `outputs` further signals. All parts that these refer to are found automatically: `bodies`,
    `inputs`, `parameters`, and in copies `derived`, the expressions of the names of a copy.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        check_mechanism(self)
