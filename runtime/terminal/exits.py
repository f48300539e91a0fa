"""Messages and exit codes at the end of the command line."""

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from enum import IntEnum
from typing import Any, TextIO

from ..core import interrupts
from .console import problems


class Exit(IntEnum):
    """The exit code, for scripts."""

    DONE = 0
    REFUSED = 1  # an operation is not possible, or a check found a problem
    MISTAKE = 2  # in the arguments or in a file; or a file cannot be written
    MISSING = 3  # a required package is not installed


@contextmanager
def standing_streams() -> Iterator[None]:
    """Ensure that output is written, or that a message reports that it is not.

    A stream that was closed is replaced by one without effect, so that no file gets its number.
    Characters that an encoding does not have are written as escapes of Python. A full disk ends the
    program with a message and exit code 2, a closed pipe with exit code 1.
    """
    _replace_closed()
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    code = 0
    try:
        yield
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    try:
        sys.stdout.flush()
    except OSError as error:
        code = _lost_output(error)
    if code:
        raise SystemExit(code)


def _replace_closed() -> None:
    for number, name, mode in ((0, "stdin", "r"), (1, "stdout", "w"), (2, "stderr", "w")):
        if getattr(sys, name) is None:
            # the lowest free number, which is that of the stream
            os.open(os.devnull, os.O_RDWR)
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115 (open as long as the program runs)


def _lost_output(error: OSError) -> int:
    """Report that results could not be printed, drop the rest of them, and return the exit code."""
    with suppress(OSError):
        # so that the rest of the output does not fail again when the interpreter ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError):
        return Exit.REFUSED  # without a message: a reader may close the pipe
    _print(f"error: standard output cannot be written: {error.strerror}.", "red")
    return Exit.MISTAKE


@contextmanager
def guarded() -> Iterator[None]:
    """Turn errors that a user can correct into a message on stderr and an exit code."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _show_warning
            yield
    except BrokenPipeError as error:
        raise SystemExit(_lost_output(error)) from None
    except Exception as error:
        found = _explained(error)
        if found is None:
            raise
        message, code = found
        _print(f"error: {message}", "red")
        raise SystemExit(code) from None


def show_usage_error(error: Any) -> None:
    """Show a mistake in the arguments in the form of other errors.

    It is an exception of Click, whose context, if it has one, names the command.
    """
    from ..core.errors import InputError
    from .usage import OptionError, usage_problem

    problem = usage_problem(error)
    if not problem:
        return
    context = getattr(error, "ctx", None)
    command = "kintrafo" if context is None else context.command_path
    listed = "commands" if hasattr(getattr(context, "command", None), "commands") else "options"
    message = OptionError([problem], command, listed) if context else InputError([problem], command)
    _print(f"error: {message}", "red")


def _explained(error: Exception) -> tuple[str, Exit] | None:
    """Return message and exit code; None for a defect of the program."""
    # imported here, since only a run that fails needs them
    from ..core.errors import InputError, KintrafoError
    from ..core.files import reason
    from ..core.optional import MissingPackageError
    from ..equations.errors import ParameterError

    if isinstance(error, MissingPackageError):
        return str(error), Exit.MISSING
    if isinstance(error, InputError | ParameterError):
        return str(error), Exit.MISTAKE
    if isinstance(error, KintrafoError):
        return str(error), Exit.REFUSED
    if isinstance(error, OSError):
        where = "" if error.filename is None else f"{os.fsdecode(error.filename)}: "
        return f"{where}{reason(error)}", Exit.MISTAKE
    return None


def _show_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Show a warning as a note, without its place in the program.

    A library that takes an interrupt for an error of its own warns: the interrupt is raised then.
    """
    del category, filename, lineno, file, line
    interrupts.check()
    _print(f"note: {message}", "yellow")


def _print(text: str, style: str) -> None:
    """Print on stderr; if that fails, only the exit code reports the error."""
    with suppress(OSError):
        # no markup: names of sections are in brackets
        problems.print(text, style=style, highlight=False, markup=False)
