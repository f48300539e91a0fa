"""All that places bodies: whatever is defined in this folder is found here."""

from __future__ import annotations

import pkgutil
from importlib import import_module
from inspect import isabstract, isclass

from ..loops.forms import Catalogue, ClosedForm, Follower, Iteration, Leftover, PlannedStep


def _defined() -> list[type]:
    """Return the classes that the files of this folder define."""
    package = __name__.rpartition(".")[0]
    here = __name__.rpartition(".")[2]
    files = (m.name for m in pkgutil.iter_modules(import_module(package).__path__))
    modules = [import_module(f"{package}.{name}") for name in files if name != here]
    return [
        c for m in modules for c in vars(m).values() if isclass(c) and c.__module__ == m.__name__
    ]


STEPS: frozenset[type[PlannedStep]] = frozenset(
    c for c in _defined() if issubclass(c, PlannedStep) and not isabstract(c)
)
"""Every kind of step."""


_RANKED = sorted(STEPS, key=lambda step: (getattr(step, "rank", 0), step.__name__))

CATALOGUE = Catalogue(
    closed=tuple(step for step in _RANKED if issubclass(step, ClosedForm)),
    followers=tuple(step for step in _RANKED if issubclass(step, Follower)),
    leftovers=tuple(step for step in _RANKED if issubclass(step, Leftover)),
    iterations=tuple(step for step in _RANKED if issubclass(step, Iteration)),
)
