"""Compiled mechanisms that come with the package, in archives.

`.ci/fill.py` adds them to a wheel; a checkout has none. The name of an archive has a hash of
everything on which its files depend: the structure from which the mechanism was declared, the
sources that derive and emit equations, and the machine. A changed structure or source has no
archive, and is derived. SymPy is not needed: its release was the one that `pyproject.toml` pins.

The folder in the cache has a hash of the archive itself, so that the wheels of several versions or
systems that share a cache never use the files of each other.
"""

import hashlib
import platform
import sys
import zipfile
from importlib.resources import files
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from types import ModuleType

from ...core.archives import undated
from ...core.errors import InputError
from .cache import sources_hash
from .shipped import from_cache, shipped


def packed(name: str, structure: str) -> ModuleType | None:
    """Return compiled equations by name from their archive, which is unpacked into the cache once.

    `structure` is everything that determines their declaration. None is returned if there is no
    archive of this structure and these sources. Raises `InputError` if the archive is damaged; if
    the cache cannot be written, or others can write there.
    """
    archive = files("kintrafo.generated") / _archive_name(name, structure)
    # some builds of Python have no LZMA
    if not archive.is_file() or find_spec("_lzma") is None:
        return None
    content = archive.read_bytes()
    digest = hashlib.sha256(content).hexdigest()[:16]
    return from_cache(f"{name}-{digest}", lambda: _unpacked(content, str(archive)))


def _unpacked(content: bytes, archive: str) -> list[tuple[str, bytes]]:
    """Return names and contents of the files of an archive."""
    try:
        with zipfile.ZipFile(BytesIO(content)) as opened:
            return [(entry, opened.read(entry)) for entry in opened.namelist()]
    # zipfile lets errors of the reading of cut or changed bytes through, of many types
    except Exception as error:
        problem = f"the archive is damaged ({error}). Install kintrafo again."
        raise InputError([problem], archive) from error


def pack(equations: ModuleType, structure: str, into: Path) -> Path:
    """Write the archive of equations that a C compiler compiled into a folder, and return it.

    `structure` is everything that determines their declaration.
    """
    path = into / _archive_name(equations.NAME, structure)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_LZMA) as archive:
        for name, content in sorted(shipped(equations).files):
            archive.writestr(undated(name, zipfile.ZIP_LZMA), content)
    return path


def _archive_name(name: str, structure: str) -> str:
    parts = ("packed", name, structure, sources_hash(), platform.machine(), sys.platform)
    key = hashlib.sha256("\0".join(parts).encode()).hexdigest()[:16]
    return f"{name}-{key}.zip"
