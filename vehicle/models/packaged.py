"""Equations that are part of kintrafo, and those that are derived at first use."""

from functools import lru_cache
from importlib import import_module
from types import ModuleType

from ...core.errors import InputError
from ...systems.compile.build import compile_mechanism, require_generator
from ..kinds import Suspension


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


def equations_of(suspension: Suspension, *, free_rack: bool) -> ModuleType:
    """Return the equations of a suspension, with the rack as a degree of freedom if `free_rack`.

    Those of a suspension with a Pitman arm are packaged for some, otherwise derived and compiled at
    first use. Raises `InputError` if there are none.
    """
    found = suspension.equations(free_rack=free_rack)
    if suspension.pitman_arm is None:
        return found
    if free_rack:
        problem = "free_rack=True: a Pitman arm is prescribed. Leave it out."
        raise InputError([problem], "Model")
    return equations_named(f"{found.NAME}_pitman_arm")
