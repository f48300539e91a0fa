"""Loading a folder of the cache as a Python module."""

import sys
from collections.abc import Iterable
from importlib import import_module
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any

from ...core.errors import InputError
from ...core.folders import VARIABLE
from .cache import damage, refuse_foreign

_lock = RLock()


class AsItIs(SourceFileLoader):
    """Runs a source file; compiled bytes are neither read nor written."""

    def path_stats(self, path: Any) -> Any:
        """Raise: without a date there are no compiled bytes."""
        raise OSError(path)


def load(folder: Path) -> ModuleType:
    """Return the module of a compiled mechanism.

    `folder` has the package of one model from `kintrafo.compile`, named by model and fingerprint.
    Raises `InputError` if the system does not load it, or another user may have written to it.
    """
    model, _, key = folder.name.rpartition("-")
    package = f"kintrafo_{model}_{key}"
    files = {
        package: folder / "__init__.py",
        f"{package}._{model}": folder / f"_{model}.py",
        f"{package}.{model}": folder / f"{model}.py",
    }
    with _lock:  # one module for all threads
        if any(name not in sys.modules for name in files):
            refuse_foreign(folder)
            _run(files, folder)
        return sys.modules[f"{package}.{model}"]


def _run(files: dict[str, Path], folder: Path) -> None:
    """Run the files of a package in their order; remove all from `sys.modules` if one fails."""
    try:
        for name, path in files.items():
            _run_file(name, path)
    except OSError as error:
        forget(files)
        problem = (
            f'cannot be loaded: {error}. Name another folder in {VARIABLE}, or use backend="numpy".'
        )
        raise InputError([problem], str(folder)) from error
    except BaseException:
        forget(files)
        raise


def _run_file(name: str, path: Path) -> None:
    package, _, short = name.partition(".")
    inside = None if short else [str(path.parent)]
    loader = AsItIs(name, str(path))
    spec = spec_from_file_location(name, path, loader=loader, submodule_search_locations=inside)
    assert spec is not None
    module = module_from_spec(spec)
    sys.modules[name] = module
    loader.exec_module(module)
    if short:
        setattr(sys.modules[package], short, module)


def forget(names: Iterable[str]) -> None:
    """Remove modules, which need not be loaded, so that they are imported again."""
    for name in names:
        sys.modules.pop(name, None)


def refuse_damaged(folder: Path) -> None:
    """Raise an InputError for a compiled mechanism whose files have changed."""
    problem = damage(folder)
    if problem:
        text = f"{problem}: the compiled files are damaged. Compile the mechanism again."
        raise InputError([text], str(folder))


def find(name: str, file: str) -> ModuleType:
    """Return a module of equations by its ``__name__`` and ``__file__``, for unpickling.

    Raises `InputError` if the compiled files are damaged.
    """
    if name.startswith("kintrafo."):
        return import_module(name)
    if name not in sys.modules:
        refuse_damaged(Path(file).parent)
    return load(Path(file).parent)
