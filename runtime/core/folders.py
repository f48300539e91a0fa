"""The folder of compiled mechanisms, and checks that no other user could have written to it.

Its files are run again, so they must come from the user who runs them: folders and files that
others own, or can write to, are refused.
"""

import os
import stat
import sys
from pathlib import Path

from platformdirs import user_cache_path

from .errors import InputError

VARIABLE = "KINTRAFO_CACHE"
"""Environment variable with the name of another folder."""

_OF_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def cache_folder() -> Path:
    """Return the folder of compiled mechanisms and of the register of written files."""
    named = os.environ.get(VARIABLE)
    return Path(named) if named else user_cache_path("kintrafo")


def make_folder(folder: Path) -> None:
    """Create a folder, and those above it, with write permission for its owner alone."""
    if not folder.is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        keep_to_owner(folder)


def keep_to_owner(path: Path) -> None:
    """Remove the write permission of others from a file or a folder."""
    path.chmod(stat.S_IMODE(path.stat().st_mode) & ~_OF_OTHERS)


def shared(*paths: Path) -> str:
    """Return which of some files and folders another user may have written to, and who.

    The text is empty if only the user or the administrator can have done so. A path that does not
    exist is not shared; of a link, both ends count.
    """
    return next((text for path in paths if (text := _shared(path))), "")


def refuse_shared(*paths: Path) -> None:
    """Raise an InputError for files and folders that another user may have written to."""
    problem = shared(*paths)
    if problem:
        text = (
            f"{problem}, and what is kept there is run. Name a folder of your own in {VARIABLE}, "
            "or in compile(folder=...)."
        )
        raise InputError([text], str(paths[0]))


def _shared(path: Path) -> str:
    if sys.platform == "win32":
        return ""
    for look in (os.lstat, os.stat):
        try:
            found = look(path)
        except OSError:  # it does not exist, or cannot be read
            return ""
        if found.st_uid not in (os.geteuid(), 0):
            return f"{path} belongs to {_user(found.st_uid)}"
        writable = found.st_mode & _OF_OTHERS and not stat.S_ISLNK(found.st_mode)
        if writable and not _by_owner_alone(found):
            return (
                f"{path} can be written to by others ({stat.filemode(found.st_mode)}; "
                "chmod go-w takes that from them)"
            )
    return ""


def _by_owner_alone(found: os.stat_result) -> bool:
    """Return whether the group that may write to a file has its owner as the only member.

    Many systems create such a group for every user, and let it write by default.
    """
    import grp  # noqa: PLC0415 (Windows has none)
    import pwd  # noqa: PLC0415 (Windows has none)

    if found.st_mode & stat.S_IWOTH:
        return False
    try:
        group, user = grp.getgrgid(found.st_gid), pwd.getpwuid(found.st_uid).pw_name
    except KeyError:  # the group or the user has no entry
        return False
    return group.gr_name == user and set(group.gr_mem) <= {user}


def _user(number: int) -> str:
    import pwd  # noqa: PLC0415 (Windows has none)

    try:
        return f"user {pwd.getpwuid(number).pw_name!r}"
    except KeyError:
        return f"user {number}"
