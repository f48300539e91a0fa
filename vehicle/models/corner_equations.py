"""The equations of a suspension: those of its kind, or of this kind with a Pitman arm."""

from functools import lru_cache
from types import ModuleType

from ...core.errors import InputError
from ...systems.compile.build import compile_mechanism, require_generator
from ..kinds import Suspension
from .packaged import packaged_equations


def equations_of(suspension: Suspension, *, free_rack: bool) -> ModuleType:
    """Return the equations of a suspension.

    Those of a suspension with a Pitman arm are packaged for some, otherwise derived and compiled at
    first use.

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
    return _with_pitman_arm(str(found.NAME))


@lru_cache
def _with_pitman_arm(name: str) -> ModuleType:
    """Return the equations of this name with a Pitman arm instead of the rack."""
    full_name = f"{name}_pitman_arm"
    packaged = packaged_equations(full_name)
    if packaged is not None:
        return packaged
    require_generator()
    from ...generator.mechanisms import model_named  # noqa: PLC0415 (an extra)

    return compile_mechanism(model_named(full_name))
