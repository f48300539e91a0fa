"""A user's declaration: a file, a mechanism, or a model of one."""

import sys
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.machinery import (
    EXTENSION_SUFFIXES,
    SOURCE_SUFFIXES,
    ExtensionFileLoader,
    FileFinder,
)
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError, KintrafoError
from ...core.files import as_input_errors
from ...core.suggestions import suggestion
from ...core.validator import Validator, shown
from .loader import AsItIs, forget

if TYPE_CHECKING:
    from ...generator import Formulation, Mechanism


class MechanismError(KintrafoError, ValueError):
    """A declaration that contradicts itself, or has a loop that cannot be solved."""


@contextmanager
def translated_errors(model: "Formulation | None" = None) -> Iterator[None]:
    """Raise the generator's errors as errors of this package.

    If a loop of the derived model, if given, does not close, the error names other choices of
    independent coordinates.
    """
    from ...generator import DeclarationError
    from ...generator.loops.errors import NoClosedFormError, TopologyError
    from ...generator.planning.proposal import advice

    try:
        yield
    except NoClosedFormError as error:
        more = advice(model) if model else ""
        message = f"{str(error).removesuffix('.')}. {more}" if more else str(error)
        raise MechanismError(message) from error
    except (DeclarationError, TopologyError) as error:
        raise MechanismError(str(error)) from error


def model_of(
    declared: "Formulation | Mechanism | str | Path", name: str | None = None
) -> "Formulation":
    """Return the model of a declaration, or of a Python file with one.

    For a mechanism it is one with proposed coordinates. `name` is that of the model or mechanism,
    if the file has several. Raises `InputError` if the file cannot be run, or has no or several
    declarations; `MechanismError` if the declaration contradicts itself.
    """
    from ...generator import Mechanism
    from ...generator.planning.proposal import model_of as proposed

    given = given_by(declared, name)
    if isinstance(given, Mechanism):
        with translated_errors():
            return proposed(given)
    return given


def given_by(
    declared: "Formulation | Mechanism | str | Path", name: str | None
) -> "Formulation | Mechanism":
    """Return a declaration; a file is run. The errors are those of `model_of`."""
    from ...generator import Formulation, Mechanism

    with Validator("compile") as checked:
        if name is not None:
            checked.instance("name", name, str, "the name of a model or a mechanism is needed")
    given: Any = declared
    if isinstance(declared, str | Path):
        if Path(declared).suffix.lower() == ".toml":
            problem = (
                "this is not a Python file with a declaration. Suspensions have their equations: a "
                "hardpoint file (TOML) is for kintrafo check, simulate and so on, in Python for "
                "kintrafo.Model."
            )
            raise InputError([problem], str(declared))
        with translated_errors():
            given = _chosen(_run(Path(declared)), str(declared), name)
    if isinstance(given, Formulation | Mechanism):
        return given
    problem = (
        "a Formulation, a Mechanism (kintrafo.generator) or the path of a Python file with one "
        f"is needed, not {shown(declared)}."
    )
    raise InputError([problem], "compile")


def _run(path: Path) -> ModuleType:
    """Run a file and return its module."""
    from ...generator import DeclarationError

    try:
        with as_input_errors(path, "cannot be read"):
            source = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        problem = f"is not a text in UTF-8 (byte {error.start}). Give a Python file."
        raise InputError([problem], str(path)) from error
    module = ModuleType(path.stem)
    module.__file__ = str(path)
    module.__package__ = _package_of(path)  # for its relative imports
    try:
        with _neighbours(path.parent.resolve()):
            exec(compile(source, str(path), "exec"), vars(module))
    except SyntaxError as error:
        line = f"Line {error.lineno}: " if error.lineno else ""
        problem = (
            f"{line}{error.msg}: {error.text.strip()}" if error.text else f"{line}{error.msg}."
        )
        raise InputError([problem], str(path)) from error
    except SystemExit as error:
        problem = (
            f"{_where(error, path)}: the file ends the program before its declaration is read. "
            'Put what only a script should do below if __name__ == "__main__":'
        )
        raise InputError([problem], str(path)) from error
    except DeclarationError as error:
        problems = [f"{_line(error, path)}{error.name}: {problem}" for problem in error.problems]
        raise InputError(problems, str(path)) from error
    except Exception as error:
        raise InputError([_where(error, path)], str(path)) from error
    return module


def _package_of(path: Path) -> str:
    """Return the package of a file that is in the generator's own folder; else an empty text."""
    # `from ... import generator` would be a circular import
    from ...generator import __file__ as file
    from ...generator import __name__ as name

    home, folder = Path(file).resolve().parent, path.resolve().parent
    if not folder.is_relative_to(home):
        return ""
    return ".".join((name, *folder.relative_to(home).parts))


@contextmanager
def _neighbours(folder: Path) -> Iterator[None]:
    """Permit a file to import those beside it, as a script can.

    They are run in their present state: modules imported before are ignored, and compiled bytes,
    which Python trusts by date and size of the source, too. They are forgotten afterwards.
    """
    before = _modules_beside(folder)
    hook = FileFinder.path_hook(
        (ExtensionFileLoader, EXTENSION_SUFFIXES), (AsItIs, SOURCE_SUFFIXES)
    )

    def of_folder(path: str) -> Any:
        if not _is_inside(path, folder, _other_places(folder)):
            raise ImportError(path)
        return hook(path)

    forget(before)
    _forget_files(folder)
    sys.path.insert(0, str(folder))
    sys.path_hooks.insert(0, of_folder)
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        sys.path_hooks.remove(of_folder)
        _forget_files(folder)
        forget(_modules_beside(folder))
        sys.modules.update(before)


def _modules_beside(folder: Path) -> dict[str, Any]:
    """Return the modules of a folder, and those of packages in it, by name."""
    # thousands of modules belong to some hundred packages, whose paths take long to resolve
    tops = {n: getattr(m, "__name__", "").partition(".")[0] for n, m in sys.modules.items()}
    beside = {top for top in set(tops.values()) if _is_beside(top, folder)}
    return {name: sys.modules[name] for name, top in tops.items() if top in beside}


def _is_beside(name: str, folder: Path) -> bool:
    """Return whether a package or module of the top level is in a folder."""
    if name in ("__main__", __name__.partition(".")[0]):
        return False
    top = sys.modules.get(name)
    places = [getattr(top, "__file__", None), *(getattr(top, "__path__", None) or ())]
    return any(Path(place).parent.resolve() == folder for place in places if place)


def _other_places(folder: Path) -> set[Path]:
    """Return the folders of modules except one."""
    return {Path(entry).resolve() for entry in sys.path} - {folder}


def _is_inside(path: str, folder: Path, others: set[Path]) -> bool:
    """Return whether a path is in a folder, and not below another place for modules in it."""
    place = Path(path).resolve()
    between = [place, *place.parents]
    return folder in between and others.isdisjoint(between[: between.index(folder)])


def _forget_files(folder: Path) -> None:
    """Forget cached listings of the files of a folder."""
    others = _other_places(folder)
    for path in list(sys.path_importer_cache):
        if _is_inside(path, folder, others):
            sys.path_importer_cache.pop(path, None)


def _where(error: BaseException, path: Path) -> str:
    """Return the line and the text of an error in a file."""
    return f"{_line(error, path)}{type(error).__name__}: {error}"


def _line(error: BaseException, path: Path) -> str:
    """Return the last line of a file in the traceback of an error."""
    lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == str(path)]
    return f"Line {lines[-1]}: " if lines else ""


def _chosen(module: ModuleType, path: str, name: str | None) -> "Formulation | Mechanism":
    """Return the model of a file, or its mechanism if it has no model."""
    from ...generator import Formulation, Mechanism

    defined = [v for v in vars(module).values() if isinstance(v, Formulation | Mechanism)]
    listed = [m for v in vars(module).values() if isinstance(v, tuple | list) for m in v]
    defined += [m for m in listed if isinstance(m, Formulation | Mechanism)]
    models = [m for m in defined if isinstance(m, Formulation)]
    found: dict[str, Formulation | Mechanism] = {m.name: m for m in models or defined}
    if name is not None and name in found:
        return found[name]
    if name is not None:
        raise InputError([f"{name!r} is not defined. {suggestion(name, found)}"], path)
    if not found:
        problem = "defines no Formulation and no Mechanism. Assign one to a name at its top level."
        raise InputError([problem], path)
    if len(found) > 1:
        first = next(iter(found))
        problem = (
            f"defines {', '.join(found)}. Say which one is meant: --model {first}, in Python "
            f'name="{first}"'
        )
        raise InputError([problem], path)
    return next(iter(found.values()))
