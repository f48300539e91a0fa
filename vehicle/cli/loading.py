"""The suspension, axle or car in a file, and its equations."""

from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from ...terminal.console import note, problems

if TYPE_CHECKING:
    from ...systems.system import System
    from ..assembly.assembly import Assembly
    from ..assembly.car import CarAssembly
    from ..assembly.of import AnyModel
    from ..models.car import Car
    from ..studies.evaluation import Subject


_Kind = TypeVar("_Kind")


def assembly_of_file(file: str, held: str | None = None) -> "Assembly":
    """Return the assembly of a file or of a packaged data set.

    `held` is the name of a command that needs a held body: cars are refused.
    """
    from ..assembly.of import assembly_of

    subject = variable_subject(file, held)
    with problems.status("preparing the equations"):
        return assembly_of(subject)


def _refuse_car(car: "Subject", file: str, command: str) -> NoReturn:
    """Refuse a car, and name the files of its suspensions and axles."""
    from ...core.errors import InputError

    folder = Path(file).parent
    beside = [folder / name if (folder / name).is_file() else name for name in car.parts_named]
    wanted = " or ".join(f"kintrafo {command} {part}" for part in beside)
    problem = (
        f"this is the file of a whole car, and {command} is about a suspension or an axle. Give "
        f"the file of one of its parts: {wanted or f'kintrafo {command} FILE'}."
    )
    raise InputError([problem], file)


def model_of(file: str, *, wheel_loads: bool = False) -> "AnyModel":
    """Return the equations of motion of the suspension, axle or car in a file.

    Loads on the wheels are inputs if `wheel_loads`.
    """
    from ..assembly.of import model_of as of_subject
    from ..files.loading import load

    subject = load(file)
    with problems.status("preparing the equations") as status:
        return of_subject(
            subject,
            wheel_loads=wheel_loads,
            progress=lambda text: status.update(f"the equations: {text}"),
        )


def note_unused(car: "Car", file: str) -> None:
    """Print the number of unused entries in the files of a car."""
    if car.unused:
        many = f"{len(car.unused)} entries" if len(car.unused) > 1 else "1 entry"
        note(f"not used: {many} of the files of this car, listed by kintrafo check {file}")


def variable_subject(file: str, held: str | None = None) -> "Subject":
    """Return the suspension, axle or car in a file; `held` as in `assembly_of_file`."""
    from ..files.loading import load

    subject = load(file)
    if held is not None and subject.whole_car:
        _refuse_car(subject, file, held)
    return subject


def subject_of(file: str, kind: type[_Kind], needed: str) -> _Kind:
    """Return the subject of a file that must be of a class, such as `Suspension` or `Car`.

    Raises `InputError` for other classes; `needed` ends its message with the reason and a way out.
    """
    from ...core.errors import InputError
    from ..files.loading import load

    subject = load(file)
    if not isinstance(subject, kind):
        raise InputError([f"this is the file of a {subject.heading()}, {needed}"], file)
    return subject


def car_of(file: str) -> "CarAssembly":
    """Return the car in a file, its equations not yet derived.

    Raises `InputError` if it is the file of a suspension or an axle.
    """
    from ..assembly.car import CarAssembly
    from ..data import data_sets, find
    from ..data.starter import CARS, all_packaged
    from ..models.car import Car

    if file not in all_packaged():
        find(file, data_sets(CARS))  # raises for a missing file, and lists the packaged cars
    needed = (
        "whose body is held. A car's file is needed: quarter_car, or what kintrafo new FILE --car "
        "writes."
    )
    return CarAssembly(subject_of(file, Car, needed))


def naming(file: str) -> AbstractContextManager[None]:
    """Add the file of a car, and the lines of keys, to problems of the car."""
    from ..data import find
    from ..data.starter import all_packaged
    from ..input.toml_file import problems_in

    return problems_in(find(file, all_packaged()), file)


def of_study(file: Path | None) -> AbstractContextManager[None]:
    """Add the file of a study, and the lines of keys, to problems of its targets and values."""
    from ..input.toml_file import problems_in
    from ..studies.goals import SECTIONS

    return problems_in(file, sections=SECTIONS)


def of_cases(file: Path | None) -> AbstractContextManager[None]:
    """Add the file of load cases, and the lines of keys, to problems of the cases."""
    from ..input.toml_file import problems_in

    return problems_in(file, sections=("cases", "static_load"))


def derived(assembly: "CarAssembly") -> "CarAssembly":
    """Return a car with its equations, derived at first use."""
    from ..models.car.equations import CarModel

    with problems.status("preparing the equations") as status:
        car = assembly.car
        model = CarModel(car, progress=lambda text: status.update(f"the equations: {text}"))
    return type(assembly)(car, model)


def system_of(file: str, name: str | None = None) -> "System":
    """Return the equations of the mechanism in a Python file, derived at first use."""
    from ...systems.compile import compile_mechanism
    from ...systems.system import System

    return System(compile_mechanism(file, name=name))


def bushes_of(assembly: "Assembly", bushes: Path | None, file: str = "") -> dict[str, Any] | None:
    """Return the bushes of a separate file for an assembly, or None; print a note with `file`."""
    from ...core.validator import Validator
    from ..analysis.compliance import read_bushes
    from ..assembly.assembly import HeldAssembly
    from ..input.toml_file import problems_in

    if bushes is None:
        return None
    if file:
        note(f"bushes: those of {bushes}, in place of any that {file} has.")
    found = read_bushes(bushes)
    with problems_in(bushes), Validator("compliance") as given:
        if isinstance(assembly, HeldAssembly):
            assembly.bushes(given, found)
    return found
