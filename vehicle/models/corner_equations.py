"""The equations of a suspension: those of its kind, or of the same behind a Pitman arm."""

import importlib
from functools import lru_cache
from types import ModuleType

from ...core.errors import InputError
from ...systems.compile.build import compile_mechanism, require_generator
from ..kinds import Suspension


def equations_of(suspension: Suspension, *, free_rack: bool) -> ModuleType:
    """Return the equations of a suspension.

    Those behind a Pitman arm that do not come with kintrafo are derived and compiled when they are
    first needed.

    Parameters
    ----------
    suspension : Suspension
    free_rack : bool
        Whether the rack is a degree of freedom.

    Raises
    ------
    InputError
        If there are none.
    """
    found = suspension.equations(free_rack=free_rack)
    if suspension.pitman_arm is None:
        return found
    if free_rack:
        problem = "free_rack=True: a Pitman arm is prescribed. Leave that out."
        raise InputError([problem], "Model")
    return _behind_a_pitman_arm(str(found.NAME))


@lru_cache
def _behind_a_pitman_arm(name: str) -> ModuleType:
    """Return the equations of a suspension that a rack steers, with a Pitman arm instead."""
    behind = f"{name}_pitman_arm"
    try:
        return importlib.import_module(f"kintrafo.generated.{behind}")
    except ModuleNotFoundError as error:
        if error.name != f"kintrafo.generated.{behind}":
            raise
    require_generator()
    from ...generator.mechanisms import model_named  # noqa: PLC0415 (an extra)

    return compile_mechanism(model_named(behind))
