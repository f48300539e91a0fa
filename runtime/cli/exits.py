"""How the command line ends: messages and exit codes."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from enum import IntEnum
from typing import TextIO

from .console import problems


class Exit(IntEnum):
    """What the exit code tells a script."""

    DONE = 0
    REFUSED = 1  # the suspension cannot do what was asked, or a check found a problem
    MISTAKE = 2  # in the arguments or in a file
    MISSING = 3  # a package that is needed is not installed


@contextmanager
def guarded() -> Iterator[None]:
    """Turn what the user can do something about into a message on stderr and an exit code."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _show_warning
            yield
    except Exception as error:
        found = _explained(error)
        if found is None:
            raise
        message, code = found
        # no markup: the names of sections stand in brackets
        problems.print(f"error: {message}", style="red", highlight=False, markup=False)
        raise SystemExit(code) from None


def _explained(error: Exception) -> tuple[str, Exit] | None:
    """Return message and exit code; None for a defect of the program."""
    # imported here, because only a run that fails needs them
    from ..errors import InputError, KintrafoError
    from ..generated._support import ParameterError
    from ..optional import MissingPackageError

    if isinstance(error, MissingPackageError):
        return str(error), Exit.MISSING
    if isinstance(error, InputError | ParameterError):
        return str(error), Exit.MISTAKE
    if isinstance(error, KintrafoError):
        return str(error), Exit.REFUSED
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}", Exit.MISTAKE
    return None


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Show a warning as a note, without the place in the program that raised it."""
    del category, filename, lineno, file, line
    problems.print(f"note: {message}", style="yellow", highlight=False, markup=False)
