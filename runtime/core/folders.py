"""Where this program keeps things between two runs, and who else could have written there.

What is kept is run again, so that it must come from the user who runs it: folders and files that
others own, or can write to, are refused.
"""

import os
import stat
import sys
from pathlib import Path

from platformdirs import user_cache_path

from .errors import InputError

VARIABLE = "KINTRAFO_CACHE"
"""Environment variable that names another folder."""

_OF_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def cache_folder() -> Path:
    """Return the folder of what is kept, which need not exist.

    Compiled mechanisms are in it, and `kintrafo.core.written` notes there which files were written.
    """
    named = os.environ.get(VARIABLE)
    return Path(named) if named else user_cache_path("kintrafo")


def make_folder(folder: Path) -> None:
    """Make a folder that its owner alone can write to, with any umask; one that is there stays.

    Parameters
    ----------
    folder : Path
        Those above it are made, too.

    Raises
    ------
    OSError
        If the system does not let it be made.
    """
    if not folder.is_dir():
        folder.mkdir(parents=True, exist_ok=True)
        keep_to_owner(folder)


def keep_to_owner(path: Path) -> None:
    """Let only the owner write to a file or a folder.

    Parameters
    ----------
    path : Path
        It exists.
    """
    path.chmod(stat.S_IMODE(path.stat().st_mode) & ~_OF_OTHERS)


def shared(*paths: Path) -> str:
    """Return which of some files and folders another user may have written to.

    Parameters
    ----------
    *paths : Path
        One that does not exist has no owner. Of a link, both ends count.

    Returns
    -------
    str
        Which, and who; empty if the user alone, or the system's administrator, can have done so.
    """
    return next((text for path in paths if (text := _shared(path))), "")


def refuse_shared(*paths: Path) -> None:
    """Refuse files and folders that another user may have written to.

    Parameters
    ----------
    *paths : Path
        As of `shared`.

    Raises
    ------
    InputError
    """
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
        except OSError:  # it is not there, or cannot be read either
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
    """Return whether what a group may write to is of a group in which its owner is alone.

    Many systems give every user a group of the same name, and let it write by default.
    """
    import grp  # noqa: PLC0415 (Windows has none)
    import pwd  # noqa: PLC0415 (Windows has none)

    if found.st_mode & stat.S_IWOTH:
        return False
    try:
        group, user = grp.getgrgid(found.st_gid), pwd.getpwuid(found.st_uid).pw_name
    except KeyError:  # neither has an entry
        return False
    return group.gr_name == user and set(group.gr_mem) <= {user}


def _user(number: int) -> str:
    import pwd  # noqa: PLC0415 (Windows has none)

    try:
        return f"user {pwd.getpwuid(number).pw_name!r}"
    except KeyError:
        return f"user {number}"
