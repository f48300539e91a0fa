"""Packaged data sets."""

from collections.abc import Mapping
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from ...core.errors import InputError
from ...core.files import as_input_errors
from ...core.suggestions import suggestion

_ENDING = ".toml"


def data_sets(package: str = __package__, ending: str = _ENDING) -> dict[str, Traversable]:
    """Return the files of the data sets of a package, sorted by name."""
    files = sorted(resources.files(package).iterdir(), key=lambda file: file.name)
    return {f.name.removesuffix(ending): f for f in files if f.name.endswith(ending)}


def find(
    path_or_name: str | Path, packaged: Mapping[str, Traversable] | None = None
) -> Path | Traversable:
    """Return the packaged file with this name, or the file at this path."""
    packaged = data_sets() if packaged is None else packaged
    if isinstance(path_or_name, str) and path_or_name in packaged:
        return packaged[path_or_name]
    path = Path(path_or_name)
    with as_input_errors(path, "cannot be read"):
        found = path.exists()
    if not found:
        hint = suggestion(path.name, packaged)
        problem = f"There is no such file. Give the path of a TOML file, or a packaged name. {hint}"
        raise InputError([problem], str(path_or_name))
    return path
