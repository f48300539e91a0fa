"""How compiled mechanisms are kept: under which name, complete and unchanged.

The folder of one has a manifest with size and digest of each of its files. What is read is compared
with it, so that a file that was cut off, changed or lost is found before any of it runs.
"""

import errno
import hashlib
import json
import platform
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.files import reason
from ...core.folders import (
    VARIABLE,
    cache_folder,
    keep_to_owner,
    make_folder,
    refuse_shared,
    shared,
)
from ...core.interrupts import held

__all__ = [
    "MANIFEST",
    "appearing",
    "cache_folder",
    "damage",
    "fingerprint",
    "foreign",
    "refuse_foreign",
    "seal",
]

MANIFEST = "manifest.json"
# In every folder that is being filled: what has it may be removed, and nothing else.
_MARK = ".kintrafo-unfinished"
_MARKED = b"kintrafo fills this folder, or was stopped doing so.\n"
_LONG_AGO_S = 24 * 3600.0  # nothing takes that long to be derived and compiled


def fingerprint(declared: str, *, built_by: str) -> str:
    """Return a name for what comes out of a declaration, here and now.

    Parameters
    ----------
    declared : str
        Everything that a person declared, as text.
    built_by : str
        Compiler with its options and version, or what replaces it.

    Returns
    -------
    str
        16 hexadecimal digits of a hash of both, of the generator and of the machine.
    """
    parts = (declared, built_by, _generator_hash(), platform.machine(), sys.platform)
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


@cache
def _generator_hash() -> str:
    """Return a hash of everything that derives, emits, and reads what was emitted."""
    import sympy

    digest = hashlib.sha256(sympy.__version__.encode())
    for package in ("kintrafo.generator", "kintrafo.equations"):  # what emits, and what reads it
        for name, content in sorted(_contents(files(package), "")):
            digest.update(name.encode() + b"\0" + content)
    return digest.hexdigest()


def _contents(folder: Traversable, path: str) -> Iterator[tuple[str, bytes]]:
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _contents(entry, f"{path}{entry.name}/")
        elif entry.name.endswith((".py", ".in")):
            yield f"{path}{entry.name}", entry.read_bytes()


def seal(folder: Path, name: str) -> None:
    """Write down what is in a folder, so that `damage` finds what is not so any more.

    Parameters
    ----------
    folder : Path
        With the files of a compiled mechanism, all of them complete.
    name : str
        What the folder will be called.
    """
    listed = {p.name: _described(p) for p in sorted(folder.iterdir()) if p.name != _MARK}
    text = json.dumps({"folder": name, "files": listed}, indent=1)
    (folder / MANIFEST).write_text(text, encoding="utf-8", newline="\n")


def _described(path: Path) -> list[Any]:
    content = _content(path)
    return [len(content), hashlib.sha256(content).hexdigest()]


def _content(path: Path) -> bytes:
    """Return the bytes of a file; a pipe would keep its reader waiting."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "no ordinary file")
    return path.read_bytes()


def damage(folder: Path) -> str:
    """Say what is wrong with the folder of a compiled mechanism.

    Parameters
    ----------
    folder : Path
        It need not exist.

    Returns
    -------
    str
        Empty if all files are as they were when it was sealed; other files do not matter.
    """
    try:
        manifest = json.loads(_content(folder / MANIFEST))
        listed = [(str(n), int(size), digest) for n, (size, digest) in manifest["files"].items()]
        sealed = manifest["folder"]
        if any("\0" in name or Path(name).name != name for name, *_ in listed):
            return f"{MANIFEST} names other folders"
    except FileNotFoundError:
        return f"{MANIFEST} is missing"
    except (OSError, ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return f"{MANIFEST} cannot be read"
    if sealed != folder.name:
        return f"it is that of {sealed}"
    return next((text for entry in listed if (text := _changed(folder, *entry))), "")


def foreign(folder: Path) -> str:
    """Say who else may have written to what a compiled mechanism is loaded from.

    Parameters
    ----------
    folder : Path
        As of `damage`. The folder that it is in counts, too, and all files.

    Returns
    -------
    str
        As of `kintrafo.core.folders.shared`.
    """
    return shared(*_places(folder))


def refuse_foreign(folder: Path) -> None:
    """Refuse a compiled mechanism that another user may have written to.

    Parameters
    ----------
    folder : Path
        As of `foreign`.

    Raises
    ------
    InputError
    """
    refuse_shared(*_places(folder))


def _places(folder: Path) -> list[Path]:
    files = sorted(folder.iterdir()) if folder.is_dir() else []
    return [folder.parent, folder, *(path for path in files if not path.is_dir())]


def _changed(folder: Path, name: str, size: int, digest: str) -> str:
    """Say how a file differs from what it was; empty if it does not."""
    try:
        found = _described(folder / name)
    except FileNotFoundError:
        return f"{name} is missing"
    except OSError as error:
        return f"{name} cannot be read ({error.strerror})"
    if found[0] != size:
        return f"{name} has {found[0]:,} bytes instead of {size:,}"
    return "" if found[1] == digest else f"{name} was changed"


@contextmanager
def appearing(target: Path) -> Iterator[Path]:
    """Let a caller fill a folder that appears only when it is complete.

    Where two processes make the same one at a time, the first wins, and the second takes its work.
    Where there is one that is damaged, its files are replaced, each of them at once: who has an old
    one open keeps it.

    Parameters
    ----------
    target : Path
        The folder.

    Yields
    ------
    Path
        A temporary folder beside it, to be filled and sealed.

    Raises
    ------
    InputError
        If nothing can be written there, or others can write there, too.
    """
    try:
        make_folder(target.parent)
        refuse_shared(target.parent)
        _remove_leftovers(target.parent)
        temporary = None
        try:
            with held():
                temporary = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
                (temporary / _MARK).write_bytes(_MARKED)
            yield temporary
            with held():
                temporary.chmod(0o755)  # mkdtemp lets only its owner in
                for path in temporary.iterdir():
                    keep_to_owner(path)
                _move(temporary, target)
        finally:
            with held():
                if temporary:
                    _remove(temporary)
    except OSError as error:
        problem = f"cannot be written: {reason(error)} Or name another folder in {VARIABLE}."
        raise InputError([problem], str(error.filename or target.parent)) from error


def _move(temporary: Path, target: Path) -> None:
    """Put a complete folder in its place, or its files into what is left of an older one."""
    try:
        temporary.rename(target)
    except OSError:
        if not target.is_dir():
            raise
    else:
        (target / _MARK).unlink(missing_ok=True)
        return
    if damage(target):
        made = [path for path in temporary.iterdir() if path.name != _MARK]
        # the manifest last: until it is there, the folder counts as damaged
        for path in sorted(made, key=lambda path: path.name == MANIFEST):
            path.replace(target / path.name)


def _remove_leftovers(folder: Path) -> None:
    """Remove the temporary folders of processes that were killed long ago."""
    for entry in folder.glob(".*-????????????????-*"):
        # another process may be removing the same one
        with suppress(OSError):
            mark = entry / _MARK
            ours = not entry.is_symlink() and mark.is_file() and mark.read_bytes() == _MARKED
            if ours and time.time() - mark.stat().st_mtime > _LONG_AGO_S:
                _remove(entry)


def _remove(folder: Path) -> None:
    """Remove a temporary folder, its mark last: what is left of it is still known."""
    with suppress(OSError):
        for path in folder.iterdir():
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            elif path.name != _MARK:
                path.unlink(missing_ok=True)
        (folder / _MARK).unlink(missing_ok=True)
        folder.rmdir()
