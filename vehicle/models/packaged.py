"""Equations that are part of kintrafo."""

from importlib import import_module
from types import ModuleType


def packaged_equations(name: str) -> ModuleType | None:
    """Return the packaged equations of this name; None if there are none."""
    module = f"kintrafo.generated.{name}"
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        return None
