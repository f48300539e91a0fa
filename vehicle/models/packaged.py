"""Equations that are part of kintrafo, and those that are derived at first use."""

from functools import lru_cache
from importlib import import_module
from types import ModuleType

from ...systems.compile.build import compile_mechanism, require_generator


def packaged_equations(name: str) -> ModuleType | None:
    """Return the packaged equations of this name; None if there are none."""
    module = f"kintrafo.generated.{name}"
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        return None


@lru_cache
def equations_named(name: str) -> ModuleType:
    """Return the equations of a mechanism: packaged, or derived and compiled at first use."""
    packaged = packaged_equations(name)
    if packaged is not None:
        return packaged
    require_generator()
    from ...generator.mechanisms import model_named  # noqa: PLC0415 (an extra)

    return compile_mechanism(model_named(name))
