"""Register of the files that kintrafo wrote, so that it replaces no other.

Every written file is noted by a hash of its path and its contents: an existing file is kintrafo's
own if it is unchanged where it was written. No name and no contents are kept, and nothing is added
to the files themselves. Where a note cannot be made, is lost, or could be another user's, a file
counts as foreign and is kept.
"""

import hashlib
import os
from contextlib import suppress
from pathlib import Path

from .folders import cache_folder, make_folder, shared

_NAME = "written"
# 64 digits and an end of line for each file: at least the last 30,000 files are known
_MOST_BYTES = 4_000_000


def note(target: Path, content: Path) -> None:
    """Note a file that is being written to `target`; its contents are now in `content`."""
    register = cache_folder() / _NAME
    entry = _entry(target, content)
    with suppress(OSError):
        make_folder(register.parent)
        if shared(register.parent, register):
            return
        _shorten(register)
        # one write appends as a whole, also if other processes append
        flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT
        descriptor = os.open(register, flags, 0o644)
        try:
            os.write(descriptor, entry)
        finally:
            os.close(descriptor)


def known(target: Path) -> bool:
    """Return whether an existing file, a path without links, is as kintrafo wrote it."""
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
    """Delete the older half of a register that is too long."""
    if register.exists() and register.stat().st_size > _MOST_BYTES:
        lines = register.read_bytes().splitlines(keepends=True)
        register.write_bytes(b"".join(lines[len(lines) // 2 :]))
