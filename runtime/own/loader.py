"""A folder of the cache as a Python module."""

import importlib.util
import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType


def load(folder: Path) -> ModuleType:
    """Return the module of a compiled mechanism.

    Parameters
    ----------
    folder : Path
        The package of one model, as `kintrafo.compile` leaves it: named by model and fingerprint.

    Returns
    -------
    module
        As those of `kintrafo.generated`.
    """
    model, _, key = folder.name.rpartition("-")
    package = f"kintrafo_{model}_{key}"
    if package not in sys.modules:
        spec = importlib.util.spec_from_file_location(
            package, folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[package] = module
        spec.loader.exec_module(module)
    return import_module(f"{package}.{model}")


def find(name: str, file: str) -> ModuleType:
    """Return a module of equations by what another process knows of it: for unpickling.

    Parameters
    ----------
    name : str
        ``__name__`` of the module.
    file : str
        ``__file__`` of the module.
    """
    if name.startswith("kintrafo."):
        return import_module(name)
    return load(Path(file).parent)
