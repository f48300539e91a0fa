"""The C sources of an FMU."""

from collections.abc import Iterable, Mapping
from importlib.resources import files
from typing import Any

from ...simulation import native
from ..emitted import Emitted
from .files import EQUATIONS, HEADERS, common_files
from .tables import any_tables


def source_files(
    emitted: Mapping[str, str], tables: Mapping[str, str], fronts: Iterable[str]
) -> dict[str, str]:
    """Return all files by path below ``sources``.

    `emitted` is the C of the equations by name, `tables` the result of
    `kintrafo.targets.fmi.tables.tables`; `fronts` are keys of `kintrafo.targets.fmi.files.HEADERS`.
    """
    common = common_files(files(__package__), files(native), fronts)
    return {
        **{name: _text(file) for name, file in common.items()},
        **{f"{EQUATIONS}/{name}": text for name, text in emitted.items()},
        **tables,
    }


def library_files(emitted: Emitted) -> dict[str, str]:
    """Return the files of a library for all versions of FMI, without token and numbers."""
    return source_files(emitted.sources, any_tables(emitted.manifest), HEADERS)


def _text(file: Any) -> str:
    return file.read_text(encoding="utf-8")
