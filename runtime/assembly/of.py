"""The assembly of what a file describes."""

from collections.abc import Callable
from typing import Any

from ..core.arguments import Arguments
from ..suspension.axle import Axle
from ..suspension.axle.equations import AxleModel
from ..suspension.kinds import Suspension
from ..suspension.model import Model
from ..suspension.rigid.axle import RigidAxle
from ..suspension.rigid.model import RigidAxleModel
from .assembly import Assembly
from .axle import AxleAssembly
from .corner import CornerAssembly
from .rigid_axle import RigidAxleAssembly


def assembly_of(subject: Any) -> Assembly | None:
    """Return what a suspension, an axle or their equations are as an assembly; None of others."""
    for kind, make in _ASSEMBLIES.items():
        if isinstance(subject, kind):
            return make(subject)
    return None


def _of_suspension(suspension: Suspension) -> Assembly:
    """Return a corner by the equations in which every body with mass counts."""
    return CornerAssembly(Model(suspension, free_rack=bool(suspension.neglected_masses())))


_ASSEMBLIES: dict[type, Callable[[Any], Assembly]] = {
    Assembly: lambda assembly: assembly,
    Model: CornerAssembly,
    Suspension: _of_suspension,
    Axle: AxleAssembly,
    AxleModel: lambda model: AxleAssembly(model.axle),
    RigidAxle: RigidAxleAssembly,
    RigidAxleModel: lambda model: RigidAxleAssembly(model.axle, model),
}


def given_assembly(given: Arguments, subject: Any, name: str = "subject") -> Assembly:
    """Return the assembly of an argument, or refuse it; nothing is to be asked of what is refused.

    Parameters
    ----------
    given : Arguments
    subject : Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel
    name : str, optional
        Of the argument.
    """
    found = assembly_of(subject)
    if found is None:
        given.kind(name, subject, Assembly, Assembly.NEEDED)
    return found  # type: ignore[return-value]  # what is refused is never seen, see `Arguments`
