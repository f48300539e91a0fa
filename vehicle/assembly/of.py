"""The assembly of what a file describes."""

from collections.abc import Callable
from typing import Any

from ...core.arguments import Arguments
from ..kinds import Suspension
from ..models.axle import Axle
from ..models.axle.equations import AxleModel
from ..models.model import Model
from ..models.rigid.axle import RigidAxle
from ..models.rigid.model import RigidAxleModel
from .assembly import Assembly
from .axle import AxleAssembly
from .corner import CornerAssembly
from .rigid_axle import RigidAxleAssembly


def assembly_of(subject: Any) -> Assembly:
    """Return a suspension, an axle or their equations as an assembly.

    Raises
    ------
    InputError
        If it is something else.
    """
    with Arguments("assembly") as given:
        return given_assembly(given, subject)


def _found(subject: Any) -> Assembly | None:
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
    AxleModel: lambda model: AxleAssembly(model.axle, model),
    RigidAxle: RigidAxleAssembly,
    RigidAxleModel: lambda model: RigidAxleAssembly(model.axle, model),
}


def model_of(
    subject: Suspension | Axle | RigidAxle,
    *,
    wheel_loads: bool = False,
    progress: Callable[[str], None] | None = None,
) -> Model | AxleModel | RigidAxleModel:
    """Return the equations of motion of what a file describes, in which all mass counts.

    Parameters
    ----------
    subject : Suspension, Axle or RigidAxle
    wheel_loads : bool, optional
        Whether what acts on the wheels are inputs.
    progress : callable, optional
        Called with what is being done, in a few words, where equations are derived.
    """
    if isinstance(subject, Axle):
        return AxleModel(subject, progress=progress, wheel_loads=wheel_loads)
    if isinstance(subject, RigidAxle):
        return RigidAxleModel(subject, wheel_loads=wheel_loads)
    free_rack = bool(subject.neglected_masses())
    return Model(subject, free_rack=free_rack, wheel_loads=wheel_loads)


MODELS = (Model, AxleModel, RigidAxleModel)
"""The equations of motion of the assemblies."""

_MODEL_NEEDED = (
    'a kintrafo.Model of a suspension, such as Model("reference_car"), an AxleModel or a '
    "RigidAxleModel is needed; where another mechanism is at rest, kintrafo.rest says"
)


def given_model(given: Arguments, model: Any) -> Assembly:
    """Return the assembly of equations of motion, or refuse what is not one's.

    Parameters
    ----------
    given : Arguments
    model : Model, AxleModel or RigidAxleModel
    """
    given.kind("model", model, MODELS, _MODEL_NEEDED)
    # what is refused is never seen, see `Arguments`
    return assembly_of(model) if isinstance(model, MODELS) else None  # type: ignore[return-value]


def given_assemblies(given: Arguments, name: str, subjects: Any) -> dict[str, Assembly]:
    """Return the assemblies of an argument by their names, or refuse what is none.

    Parameters
    ----------
    given : Arguments
    name : str
        Of the argument.
    subjects : mapping of str to Suspension, Model, Axle, AxleModel, RigidAxle or RigidAxleModel
    """
    by_name = given.mapping(name, subjects, "names and suspensions or axles")
    for known in by_name:
        given.text(f"name in {name}", known)
    given.labels(name, by_name)
    return {
        known: given_assembly(given, one, f"{name}[{known!r}]") for known, one in by_name.items()
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
    found = _found(subject)
    if found is None:
        given.kind(name, subject, Assembly, Assembly.NEEDED)
    return found  # type: ignore[return-value]  # what is refused is never seen, see `Arguments`
