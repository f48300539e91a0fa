"""The catalogue of all classes in this folder that place bodies."""

from __future__ import annotations

from inspect import isabstract

from ..declare.kinds import defined_in
from ..loops.forms import Catalogue, ClosedForm, Follower, Iteration, Leftover, PlannedStep

STEPS: frozenset[type[PlannedStep]] = frozenset(
    c for c in defined_in(__package__) if issubclass(c, PlannedStep) and not isabstract(c)
)
"""Every kind of step."""


_RANKED = sorted(STEPS, key=lambda step: (getattr(step, "rank", 0), step.__name__))

CATALOGUE = Catalogue(
    closed=tuple(step for step in _RANKED if issubclass(step, ClosedForm)),
    followers=tuple(step for step in _RANKED if issubclass(step, Follower)),
    leftovers=tuple(step for step in _RANKED if issubclass(step, Leftover)),
    iterations=tuple(step for step in _RANKED if issubclass(step, Iteration)),
)
