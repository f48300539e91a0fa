"""Mechanisms, checked as a whole."""

from __future__ import annotations

from dataclasses import dataclass

from .assembly import Assembly
from .checks import check_mechanism
from .declared import declared


@declared
@dataclass(frozen=True)
class Mechanism(Assembly):
    """Bodies and joints with everything that acts on them.

    `fixed` is the body that rests in the world, with its axes along those of the world at design;
    None: all move, and a joint `Free` says which body they hang on. `coordinates` are the relative
    coordinates of the report, in the numbering of the figure; `inputs` are the time-varying inputs;
    `derived` gives, by name, what the declaration reads like a parameter but is an expression in
    parameters.
    """

    def __post_init__(self) -> None:
        check_mechanism(self)
