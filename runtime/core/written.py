"""Which files this program wrote, so that it replaces no other.

Every file that is written is noted by a hash of its place and its content: a file that is there is
this program's own as long as it lies where it was written, unchanged. No name and no
content is kept, and nothing is added to the files themselves, of which some have no room for a
mark. Where nothing can be noted, or the note is lost, or others could have written it, a file
counts as foreign: it is kept.
"""

import hashlib
import os
from contextlib import suppress
from pathlib import Path

from .folders import cache_folder, make_folder, shared

_NAME = "written"
# 64 digits and the end of a line for each file: the last 30,000 files or more are known.
_MOST_BYTES = 4_000_000


def note(target: Path, content: Path) -> None:
    """Remember that a file is being written.

    Parameters
    ----------
    target : Path
        Where it will be, without links.
    content : Path
        Where its content is now.
    """
    register = cache_folder() / _NAME
    entry = _entry(target, content)
    with suppress(OSError):
        make_folder(register.parent)
        if shared(register.parent, register):
            return
        _shorten(register)
        # appended in one piece, also if other processes do so
        flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT
        descriptor = os.open(register, flags, 0o644)
        try:
            os.write(descriptor, entry)
        finally:
            os.close(descriptor)


def known(target: Path) -> bool:
    """Return whether a file is as this program wrote it.

    Parameters
    ----------
    target : Path
        A file that is there, without links.
    """
    register = cache_folder() / _NAME
    try:
        ours = register.is_file() and not shared(register.parent, register)
        return ours and _entry(target, target) in register.read_bytes()
    except OSError:
        return False


def _entry(target: Path, content: Path) -> bytes:
    with content.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").digest()
    return hashlib.sha256(os.fsencode(target) + b"\0" + digest).hexdigest().encode() + b"\n"


def _shorten(register: Path) -> None:
    """Forget the older half where there is too much."""
    if register.exists() and register.stat().st_size > _MOST_BYTES:
        lines = register.read_bytes().splitlines(keepends=True)
        register.write_bytes(b"".join(lines[len(lines) // 2 :]))
