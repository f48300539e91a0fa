"""The equations of a suspension: those of its kind, or of this kind with a Pitman arm."""

from types import ModuleType

from ...core.errors import InputError
from ..kinds import Suspension
from .packaged import equations_named


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
