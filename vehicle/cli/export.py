"""``kintrafo export``: a model for other programs."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from ...terminal.console import print_json, problems, say
from .loading import model_of, subject_of, system_of
from .options import Force, Json, Which, argument, option, refuse_options, refuse_which

if TYPE_CHECKING:
    from ...systems.system import System

EXAMPLES = (
    "kintrafo export my_car.toml --to c -o my_car_c",
    "kintrafo export my_axle.toml --to fmu",
    "kintrafo export my_car.toml --to fmu --fmi 3 -o my_car_3.fmu",
    "kintrafo export slider_crank --to casadi",
    "kintrafo export four_bar --to jax",
    "kintrafo export my_mechanism.py --model crane --to c",
    "kintrafo export my_car.toml --to points -o points.csv",
)

_NOT_A_TABLE = (
    "and a table of hardpoints is that of a suspension. Give the file of a suspension, such as one "
    "that the file of an axle names; rigid and twist-beam axles have no table."
)


def command(
    file: Annotated[
        str,
        argument(
            "File of a suspension, an axle or a car, Python file with a mechanism of your own, or "
            "the name of a packaged file or model: reference_car, rigid_axle, driving_car, "
            "four_bar.",
            "FILE",
        ),
    ],
    *,
    to: Annotated[
        str,
        option(
            "c: a folder with plain C. fmu: a functional mock-up unit. casadi, jax: a module of "
            "Python for these. points: a table of the hardpoints (.csv), which kintrafo import "
            "reads again.",
            "KIND",
        ),
    ],
    out: Annotated[
        Path | None,
        option("File or folder to write. Default: named after FILE.", "PATH", "--out", "-o"),
    ] = None,
    fmi: Annotated[int | None, option("Version of FMI: 2 or 3. Default: 2.", "VERSION")] = None,
    platform: Annotated[
        list[str] | None,
        option(
            "Systems of the library: linux, windows, or none for sources only. Default: linux on "
            "Linux for x86-64, elsewhere none.",
            "NAME,...",
        ),
    ] = None,
    model: Which = None,
    force: Force = False,
    json: Json = False,
) -> None:
    """Write a model, or its hardpoints, for other programs, with the values of FILE.

    The initial state is the design position at rest. c: the emitted C99, which needs nothing else,
    with constants, a CMake file and an example. fmu: Model Exchange and Co-Simulation of FMI 2.0 or
    3.0 in one file. casadi, jax: functions that these libraries differentiate. points: the
    hardpoints of a suspension as a table. In Python any state can be the initial one:
    kintrafo.export_model(model, "car.fmu", "fmu", state=rest).
    """
    from ...core.errors import InputError
    from ...core.validator import Validator
    from ...targets.export import TARGETS, check_export, export_model
    from ..files.point_table import write_points
    from ..kinds import Suspension

    endings = {name: target.ending for name, target in TARGETS.items()}
    endings["points"] = "_points.csv"
    with Validator("export") as given:
        given.among("--to", to, endings)
    refuse_which(file, model)
    if to != "fmu":
        refuse_options("--to fmu", {"--fmi": fmi, "--platform": platform or None})
    options = {"fmi": fmi, "platforms": () if platform == ["none"] else platform or None}
    stem = Path(file).stem if Path(file).suffix else file
    path = Path(f"{stem}{endings[to]}") if out is None else out
    if to == "points":
        if file.endswith(".py") or _is_equations(file):
            raise InputError([f"this is a mechanism, {_NOT_A_TABLE}"], file)
        kind: type[Any] = Suspension  # an abstract class, of which one is loaded
        suspension = subject_of(file, kind, _NOT_A_TABLE)
        facts = {"path": str(write_points(suspension, path, force=force, inputs=[file])), "to": to}
    else:
        # deriving takes minutes for a car
        text = "deriving the equations, and writing them" if TARGETS[to].derives else "export"
        chosen: Any = {name: value for name, value in options.items() if value is not None}
        chosen |= {"force": force, "read": [file]}
        check_export(path, to, **chosen)  # before anything is derived
        with problems.status(text):
            written = export_model(system := _described_by(file, model), path, to, **chosen)
        facts = {"path": str(written), "to": to, "equations": system.equations.NAME}
    if json:
        print_json(facts)
    else:
        say(f"  {facts['path']}")


def _described_by(file: str, model: str | None) -> "System":
    """Return the equations of a file or of a packaged model."""
    from importlib import import_module

    from ...core.validator import Validator
    from ...systems.system import System
    from ..data.starter import all_packaged

    if file.endswith(".py"):
        return system_of(file, model)
    if _is_equations(file):
        return System(import_module(f"kintrafo.generated.{file}"))
    if not (Path(file).suffix or Path(file).exists()):
        with Validator("export") as given:
            given.among("FILE", file, [*all_packaged(), *_shipped()])
    return model_of(file)


def _is_equations(file: str) -> bool:
    """Return whether a name is that of equations, and of no packaged file."""
    from ..data.starter import all_packaged

    return file in _shipped() and file not in all_packaged()


def _shipped() -> list[str]:
    """Return the names of the packaged equations."""
    from importlib.resources import files

    entries = files("kintrafo.generated").iterdir()
    return sorted(e.name.removesuffix(".json") for e in entries if e.name.endswith(".json"))
