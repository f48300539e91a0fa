"""The mechanisms that come with the project: a file each, which is all that there is to do.

`MODELS` of a file are emitted with the project, unless it says ``EMITTED = False``; `SELDOM` are
equations that are derived where they are needed.
"""

from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from ..declare import Formulation

_FIRST = "macpherson"  # the suspension of the paper


def _files() -> list[str]:
    names = [found.name for found in iter_modules(__path__)]
    return sorted(names, key=lambda name: (name != _FIRST, name))


_FOUND: list[Any] = [import_module(f"{__name__}.{name}") for name in _files()]

MODELS: tuple[Formulation, ...] = tuple(
    model
    for found in _FOUND
    if getattr(found, "EMITTED", True)
    for model in getattr(found, "MODELS", ())
)
"""Those that are emitted with the project."""

_SELDOM: tuple[Formulation, ...] = tuple(
    model for found in _FOUND for model in getattr(found, "SELDOM", ())
)


def model_named(name: str) -> Formulation:
    """Return the equations of a name, of those that are emitted or derived when they are needed."""
    return next(model for model in (*MODELS, *_SELDOM) if model.name == name)
