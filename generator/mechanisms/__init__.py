"""The mechanisms that come with the project, one file each.

`MODELS` of a file are emitted with the project, unless it has ``EMITTED = False``; `SELDOM` are
equations that are derived on demand.
"""

from importlib import import_module
from pkgutil import iter_modules
from typing import Any

from ..declare import Formulation

_FIRST = "macpherson"  # the suspension of the paper


_FILES = sorted((m.name for m in iter_modules(__path__)), key=lambda n: (n != _FIRST, n))
_FOUND: list[Any] = [import_module(f"{__name__}.{name}") for name in _FILES]

MODELS: tuple[Formulation, ...] = tuple(
    model
    for found in _FOUND
    if getattr(found, "EMITTED", True)
    for model in getattr(found, "MODELS", ())
)
"""The equations that are emitted with the project."""

_SELDOM: tuple[Formulation, ...] = tuple(
    model for found in _FOUND for model in getattr(found, "SELDOM", ())
)


def model_named(name: str) -> Formulation:
    """Return the equations of a name, among those that are emitted or derived on demand."""
    return next(model for model in (*MODELS, *_SELDOM) if model.name == name)
