"""Data sets that come with the project."""

from importlib import resources
from importlib.resources.abc import Traversable

_ENDING = ".toml"


def data_sets() -> dict[str, Traversable]:
    """Return the files of the data sets, by their names in order."""
    files = sorted(resources.files(__package__).iterdir(), key=lambda file: file.name)
    return {f.name.removesuffix(_ENDING): f for f in files if f.name.endswith(_ENDING)}
