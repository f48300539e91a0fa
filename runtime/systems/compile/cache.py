"""The cache of compiled mechanisms: names of its folders, and checks that these are unchanged.

The folder of a mechanism has a manifest with size and digest of each of its files. Files are
checked against it before they are loaded: a file that was cut off, changed or lost is found before
any of its code runs.
"""

import errno
import hashlib
import json
import platform
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from importlib.util import find_spec
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
    "alone",
    "appearing",
    "cache_folder",
    "damage",
    "fingerprint",
    "foreign",
    "refuse_foreign",
    "seal",
    "sources_hash",
]

MANIFEST = "manifest.json"
# A file in every unfinished folder: only folders with it may be removed.
_MARK = ".kintrafo-unfinished"
_MARKED = b"kintrafo fills this folder, or was stopped doing so.\n"
_LONG_AGO_S = 24 * 3600.0  # longer than deriving and compiling any mechanism takes


def fingerprint(declared: str, *, built_by: str) -> str:
    """Return a name for the compiled result of a declaration: 16 hexadecimal digits.

    It is a hash of the whole declaration as text, of the compiler with its options and version (or
    'numpy'), of the generator and of the machine.
    """
    parts = (declared, built_by, _generator_hash(), platform.machine(), sys.platform)
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]


def _generator_hash() -> str:
    """Return the version of SymPy, and a hash of the sources."""
    import sympy

    version: str = sympy.__version__
    return version + sources_hash()


@cache
def sources_hash() -> str:
    """Return a hash of the sources that derive and emit equations, and that read the result.

    Formulas of tyres are part of their contact laws.
    """
    digest = hashlib.sha256()
    for package in ("kintrafo.generator", "kintrafo.formulas", "kintrafo.equations"):
        spec = find_spec(package)  # does not import SymPy
        assert spec is not None
        for folder in spec.submodule_search_locations or ():
            for name, content in sorted(_contents(Path(folder), "")):
                digest.update(name.encode() + b"\0" + content)
    return digest.hexdigest()


def _contents(folder: Path, path: str) -> Iterator[tuple[str, bytes]]:
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _contents(entry, f"{path}{entry.name}/")
        elif entry.name.endswith((".py", ".in")):
            yield f"{path}{entry.name}", entry.read_bytes()


def seal(folder: Path, name: str) -> None:
    """Write the manifest of a folder with the final name `name`, whose files are complete."""
    listed = {p.name: _described(p) for p in sorted(folder.iterdir()) if p.name != _MARK}
    text = json.dumps({"folder": name, "files": listed}, indent=1)
    (folder / MANIFEST).write_text(text, encoding="utf-8", newline="\n")


def _described(path: Path) -> list[Any]:
    content = _content(path)
    return [len(content), hashlib.sha256(content).hexdigest()]


def _content(path: Path) -> bytes:
    """Return the bytes of a file; refuse a pipe, whose reader would wait."""
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "no ordinary file")
    return path.read_bytes()


def damage(folder: Path) -> str:
    """Return how the folder of a compiled mechanism differs from its manifest; or "".

    The folder need not exist; further files in it are ignored.
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
    """Return who else may have written to the files of a compiled mechanism; see `shared`."""
    return shared(*_places(folder))


def refuse_foreign(folder: Path) -> None:
    """Refuse a compiled mechanism that another user may have written to."""
    refuse_shared(*_places(folder))


def _places(folder: Path) -> list[Path]:
    files = sorted(folder.iterdir()) if folder.is_dir() else []
    return [folder.parent, folder, *(path for path in files if not path.is_dir())]


def _changed(folder: Path, name: str, size: int, digest: str) -> str:
    """Return how a file differs from its entry in the manifest; empty if it does not."""
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
def alone(target: Path, report: Callable[[str], object]) -> Iterator[None]:
    """Have other threads and processes wait, if they are to create the same folder, the target.

    Where the system has no such locks, they create it, too. `report` is called with a description
    of the present step before this process waits for another.
    """
    with ExitStack() as opened:
        with suppress(OSError):  # no locks; or `appearing` raises it again
            make_folder(target.parent)
            _lock(opened, target.parent / f".{target.name}.lock", report)
        yield


def _lock(opened: ExitStack, path: Path, report: Callable[[str], object]) -> None:
    """Lock a file, which is removed at the end; the lock ends with its process."""
    if sys.platform == "win32":
        return
    import fcntl

    file = opened.enter_context(path.open("ab"))
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        report("waiting for another process that compiles it")
        fcntl.flock(file, fcntl.LOCK_EX)
    # a process that has been forked meanwhile has the file open, too
    opened.callback(fcntl.flock, file, fcntl.LOCK_UN)
    opened.callback(_remove_file, path)


def _remove_file(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


@contextmanager
def appearing(target: Path) -> Iterator[Path]:
    """Yield a temporary folder, to be filled and sealed, that replaces the target once complete.

    If two processes create the same folder, the first one is kept, and both use it. Files of a
    damaged folder are replaced one by one: a process that has an old file open keeps it. Raises
    `InputError` if the folder cannot be written, or others can write there, too.
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
                temporary.chmod(0o755)  # mkdtemp permits access to its owner only
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
    """Rename a complete folder to its target, or replace the files of a damaged one."""
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
        # the manifest last: until then the folder counts as damaged
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
    """Remove a temporary folder, its mark last, so that a remainder is still recognised."""
    with suppress(OSError):
        for path in folder.iterdir():
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            elif path.name != _MARK:
                path.unlink(missing_ok=True)
        (folder / _MARK).unlink(missing_ok=True)
        folder.rmdir()
