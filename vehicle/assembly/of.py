"""The assembly of the suspension, axle or car in a file."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, overload

from ...core.errors import InputError
from ...core.validator import Validator
from ...systems.compile.build import require_generator
from ..kinds import Suspension
from ..models.axle import Axle
from ..models.axle.equations import AxleModel
from ..models.axle.equations import declared as axle_declared
from ..models.car import Car
from ..models.car.equations import CarModel
from ..models.car.equations import declared as car_declared
from ..models.model import Model
from ..models.whole_axle import WholeAxle
from ..models.whole_axle_model import WholeAxleModel
from .assembly import NOT_A_CAR, Assembly, HeldAssembly
from .axle import AxleAssembly
from .car import CarAssembly
from .corner import CornerAssembly
from .whole_axle import whole_axle_assembly

if TYPE_CHECKING:
    from ...generator import Formulation


def assembly_of(subject: Any) -> Assembly:
    """Return a suspension, an axle, a car or their equations as an assembly.

    Raises `InputError` if it is none of these.
    """
    with Validator("assembly") as given:
        return given_assembly(given, subject, cars=True)


def _found(subject: Any) -> Assembly | None:
    for kind, make in _ASSEMBLIES.items():
        if isinstance(subject, kind):
            return make(subject)
    return None


_ASSEMBLIES: dict[type, Callable[[Any], Assembly]] = {
    Assembly: lambda assembly: assembly,
    Model: CornerAssembly,
    # by the equations in which every body with mass counts
    Suspension: lambda one: CornerAssembly(Model(one, free_rack=bool(one.neglected_masses()))),
    Axle: AxleAssembly,
    AxleModel: lambda model: AxleAssembly(model.axle, model),
    WholeAxle: lambda axle: whole_axle_assembly(axle.KEY)(axle),
    WholeAxleModel: lambda model: whole_axle_assembly(model.axle.KEY)(model.axle, model),
    Car: CarAssembly,
    CarModel: lambda model: CarAssembly(model.car, model),
}


AnyModel = Model | AxleModel | WholeAxleModel | CarModel
"""The equations of motion of an assembly."""


def model_of(
    subject: Suspension | Axle | WholeAxle | Car,
    *,
    wheel_loads: bool = False,
    progress: Callable[[str], None] | None = None,
) -> AnyModel:
    """Return the complete equations of motion of a suspension, an axle or a car.

    Parameters
    ----------
    subject : Suspension, Axle, WholeAxle or Car
    wheel_loads : bool, optional
        Whether loads on the wheels are inputs, as of `Model`.
    progress : callable, optional
        Called with a short description of the present step, if equations are derived.

    Returns
    -------
    Model, AxleModel, CarModel or the equations of an axle without sides

    Raises
    ------
    InputError
        If the subject is none of these, or a car with `wheel_loads`.
    """
    with Validator("model_of") as given:
        kinds = (Suspension, Axle, WholeAxle, Car)
        given.instance("subject", subject, kinds, "a result of kintrafo.load is needed")
        given.flag("wheel_loads", wheel_loads)
        given.function("progress", progress)
    if isinstance(subject, Car):
        if wheel_loads:
            raise InputError([_NO_WHEEL_LOADS], "CarModel")
        return CarModel(subject, progress=progress)
    if isinstance(subject, Axle):
        return AxleModel(subject, progress=progress, wheel_loads=wheel_loads)
    if isinstance(subject, WholeAxle):
        return whole_axle_assembly(subject.KEY).MODEL(subject, wheel_loads=wheel_loads)
    free_rack = bool(subject.neglected_masses())
    return Model(subject, free_rack=free_rack, wheel_loads=wheel_loads)


def declaration_of(subject: Suspension | Axle | WholeAxle | Car) -> "Formulation":
    """Return the declaration from which the equations of motion of `model_of` were derived."""
    require_generator()
    from ...generator.mechanisms import model_named  # noqa: PLC0415 (an extra)

    if isinstance(subject, Car):
        return car_declared(subject)
    if isinstance(subject, Axle):
        return axle_declared(subject)
    return model_named(str(model_of(subject).equations.NAME))


_NO_WHEEL_LOADS = (
    "the equations of a car have no loads on the wheels as inputs besides those of its tyres. "
    "Leave them out."
)

MODELS = (Model, AxleModel, WholeAxleModel, CarModel)
"""The equations of motion of the assemblies."""

_MODEL_NEEDED = (
    'a kintrafo.Model of a suspension, such as Model("reference_car"), an AxleModel or a '
    "RigidAxleModel is needed; for another mechanism, use kintrafo.rest"
)


def given_model(given: Validator, model: Any) -> Assembly:
    """Return the assembly of equations of motion, or refuse any other object."""
    given.instance("model", model, MODELS, _MODEL_NEEDED)
    # a result of refused arguments is not used, see `Validator`
    return assembly_of(model) if isinstance(model, MODELS) else None  # type: ignore[return-value]


@overload
def given_assemblies(given: Validator, name: str, subjects: Any) -> dict[str, HeldAssembly]: ...
@overload
def given_assemblies(
    given: Validator, name: str, subjects: Any, *, cars: bool
) -> dict[str, Assembly]: ...
def given_assemblies(given: Validator, name: str, subjects: Any, *, cars: bool = False) -> Any:
    """Return the assemblies of an argument by their names, or refuse other objects.

    `name` is that of the argument; it may contain cars if `cars`.
    """
    by_name = given.mapping(name, subjects, "names and suspensions or axles")
    for known in by_name:
        given.text(f"name in {name}", known)
    given.labels(name, by_name)
    return {
        known: given_assembly(given, one, f"{name}[{known!r}]", cars=cars)
        for known, one in by_name.items()
    }


def car_assembly_of(source: str, subject: Any, needed: str) -> CarAssembly:
    """Return a car, or its equations, as an assembly.

    `source` is the function that a message names, `needed` the end of the message. Raises
    `InputError` for any other subject.
    """
    with Validator(source) as given:
        given.instance("subject", subject, (Car, CarModel, CarAssembly), needed)
    found = assembly_of(subject)
    assert isinstance(found, CarAssembly)
    return found


@overload
def given_assembly(given: Validator, subject: Any, name: str = "subject") -> HeldAssembly: ...
@overload
def given_assembly(
    given: Validator, subject: Any, name: str = "subject", *, cars: bool
) -> Assembly: ...
def given_assembly(
    given: Validator, subject: Any, name: str = "subject", *, cars: bool = False
) -> Any:
    """Return the assembly of an argument, or refuse it; `cars` is whether it may be a car."""
    found = _found(subject)
    if found is not None and found.body_moves and not cars:
        given.fail(f"{name}: {NOT_A_CAR}")
    if found is None:
        given.instance(name, subject, Assembly, Assembly.NEEDED)
    return found  # the result of a refused argument is not used, see `Validator`
