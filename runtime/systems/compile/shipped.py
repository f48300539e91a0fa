"""Equations that are sent to another process, maybe on another machine."""

import json
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from ...core.errors import InputError
from .cache import MANIFEST, appearing, cache_folder, damage, foreign, seal
from .loader import load, refuse_damaged

_OF_PROJECT = "kintrafo."


@dataclass(frozen=True)
class SerializedModel:
    """Equations in a form that another process can load."""

    # `__name__` and `__file__` of the module in this process
    name: str
    file: str
    # names and contents of the compiled files; empty for equations that come with the project
    files: tuple[tuple[str, bytes], ...] = ()

    def module(self) -> ModuleType:
        """Return the module: from its folder, from the cache of this machine, or unpacked.

        Raises `InputError` if it cannot be written or loaded.
        """
        if self.name.startswith(_OF_PROJECT):
            return import_module(self.name)
        home = Path(self.file).parent
        if self.name in sys.modules or not (damage(home) or foreign(home)):
            return load(home)
        return from_cache(home.name, lambda: self.files)


def from_cache(folder: str, content: Callable[[], Iterable[tuple[str, bytes]]]) -> ModuleType:
    """Return a compiled module from its folder in the cache, which is filled at first use.

    `content` returns names and contents of the files, if they are not in the cache. Raises
    `InputError` if the folder cannot be written or loaded, or others can write there; if a file
    would be in another folder.
    """
    kept = cache_folder() / folder
    if damage(kept) or foreign(kept):
        with appearing(kept) as temporary:
            for name, text in content():
                if Path(name).name != name:
                    problem = f"{name!r} is the name of a file in another folder."
                    raise InputError([problem], folder)
                (temporary / name).write_bytes(text)
            seal(temporary, kept.name)
        refuse_damaged(kept)
    return load(kept)


def shipped(equations: ModuleType) -> SerializedModel:
    """Return equations in a form that another process can load."""
    name, file = equations.__name__, str(equations.__file__)
    if name.startswith(_OF_PROJECT):
        return SerializedModel(name, file)
    folder = Path(file).parent
    refuse_damaged(folder)
    listed = json.loads((folder / MANIFEST).read_bytes())["files"]
    return SerializedModel(
        name, file, tuple((entry, (folder / entry).read_bytes()) for entry in listed)
    )


def sources_of(equations: ModuleType) -> dict[str, Path]:
    """Return the paths of the emitted C files of equations by name, included ones first."""
    folder = Path(str(equations.__file__)).parent
    code = folder / "c" if equations.__name__.startswith(_OF_PROJECT) else folder
    return {source: code / source for source in equations.equations.manifest["sources"]}


def words_of(equations: ModuleType) -> bytes:
    """Return the emitted text of equations: the same bytes on every machine."""
    manifest = Path(str(equations.__file__)).parent / f"{equations.NAME}.json"
    texts = [manifest, *sources_of(equations).values()]
    return b"\0".join(text.name.encode() + b"\0" + text.read_bytes() for text in texts)
