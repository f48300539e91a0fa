"""Where compiled mechanisms are kept, and under which name."""

import hashlib
import os
import platform
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from platformdirs import user_cache_path

from ..errors import InputError

VARIABLE = "KINTRAFO_CACHE"
"""Environment variable that names another folder."""

_LONG_AGO_S = 24 * 3600.0  # nothing takes that long to be derived and compiled


def cache_folder() -> Path:
    """Return the folder of all compiled mechanisms, which need not exist."""
    named = os.environ.get(VARIABLE)
    return Path(named) if named else user_cache_path("kintrafo")


def fingerprint(declared: str, *, built_by: str) -> str:
    """Return a name for what comes out of a declaration, here and now.

    Parameters
    ----------
    declared : str
        Everything that a person declared, as text.
    built_by : str
        Compiler with its options and version, or what stands in for it.

    Returns
    -------
    str
        16 hexadecimal digits of a hash of both, of the generator and of the machine.
    """
    parts = (declared, built_by, _generator_hash(), platform.machine(), sys.platform)
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


@cache
def _generator_hash() -> str:
    """Return a hash of everything that derives and emits."""
    import sympy

    from .. import generator

    digest = hashlib.sha256(sympy.__version__.encode())
    for name, content in sorted(_contents(files(generator), "")):
        digest.update(name.encode() + b"\0" + content)
    return digest.hexdigest()


def _contents(folder: Traversable, path: str) -> Iterator[tuple[str, bytes]]:
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _contents(entry, f"{path}{entry.name}/")
        elif entry.name.endswith((".py", ".in")):
            yield f"{path}{entry.name}", entry.read_bytes()


@contextmanager
def appearing(target: Path) -> Iterator[Path]:
    """Let a caller fill a folder that appears only when it is complete.

    Where two processes make the same one at a time, the first wins, and the second takes its work.

    Parameters
    ----------
    target : Path
        The folder; there must not be one yet.

    Yields
    ------
    Path
        A temporary folder beside it, to be filled.

    Raises
    ------
    InputError
        If nothing can be written there.
    """
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        _remove_leftovers(target.parent)
        temporary = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    except OSError as error:
        problem = f"cannot be written ({error.strerror}). Name another folder in {VARIABLE}."
        raise InputError([problem], str(target.parent)) from error
    try:
        yield temporary
        temporary.chmod(0o755)  # mkdtemp lets only its owner in, the cache may be shared
        try:
            temporary.rename(target)
        except OSError:
            if not target.is_dir():
                raise
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _remove_leftovers(folder: Path) -> None:
    """Remove the temporary folders of processes that were killed long ago."""
    for entry in folder.glob(".*-????????????????-*"):
        if time.time() - entry.stat().st_mtime > _LONG_AGO_S:
            shutil.rmtree(entry, ignore_errors=True)
