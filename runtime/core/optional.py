"""Packages that only some results need, and the message where they are not installed."""

from importlib import import_module
from types import ModuleType

from .errors import KintrafoError


class MissingPackageError(KintrafoError, ImportError):
    """A result needs a package that is not installed."""


def require(module: str, *, purpose: str, extra: str) -> ModuleType:
    """Return a module of an optional package.

    `purpose` is the beginning of a sentence; `extra` is the extra of this project that installs it.
    Raises `MissingPackageError` with the command that installs it.

    Examples
    --------
    >>> require("no_such_package", purpose="Writing Parquet", extra="parquet")
    Traceback (most recent call last):
    ...
    kintrafo.core.optional.MissingPackageError: Writing Parquet needs no_such_package, which is \
not installed. Install it with: pip install "kintrafo[parquet]"
    """
    try:
        return import_module(module)
    except ImportError as error:
        name = module.partition(".")[0]
        message = (
            f"{purpose} needs {name}, which is not installed. Install it with: "
            f'pip install "kintrafo[{extra}]"'
        )
        raise MissingPackageError(message) from error
