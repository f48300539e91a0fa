"""Reading a tyre from any file."""

from importlib.resources.abc import Traversable
from pathlib import Path

from ...core.errors import InputError
from ...core.validator import Validator
from ..data import data_sets
from .magic_formula import MagicFormula
from .tmeasy import TMeasy
from .tyre import Tyre

_PACKAGED = f"{__package__.rpartition('.')[0]}.data.tyres"


def packaged_tyres() -> dict[str, Traversable]:
    """Return the files of the packaged tyres by name."""
    return data_sets(_PACKAGED, ".tir") | data_sets(_PACKAGED, ".json")


def load(path_or_name: str | Path) -> Tyre:
    """Return the tyre that a file describes.

    Parameters
    ----------
    path_or_name : str or pathlib.Path
        A property file (.tir), a TMeasy tyre of Project Chrono (.json), or the name of a packaged
        tyre, such as ``"passenger_205_55"``.

    Returns
    -------
    Tyre

    Raises
    ------
    InputError
        If the file cannot be read, or values are impossible; the message lists all problems.
    """
    with Validator("load") as given:
        given.path("path_or_name", path_or_name)
    packaged = packaged_tyres()
    path = Path(str(packaged.get(str(path_or_name), path_or_name)))
    if path.suffix.lower() == ".tir":
        return MagicFormula.load(path)
    if path.suffix.lower() == ".json":
        return TMeasy.load(path)
    names = ", ".join(packaged)
    problem = f"a file that ends in .tir or .json is needed, or a packaged name: {names}."
    raise InputError([problem], str(path_or_name))
