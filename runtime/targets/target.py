"""The record of a kind of export."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Target:
    """A kind of files for other programs.

    Attributes
    ----------
    name : str
        Name in arguments and commands.
    ending : str
        Ending of the name of the file or folder, if no path is given.
    write : callable
        Writes an `Emitted` to a path, with the keywords ``force`` and ``read``, and with options of
        its own, which have defaults.
    check : callable
        Refuses a path, and options of its own, before a model exists.
    folder : bool
        Whether it is a folder, whose files have names of their own.
    derives : bool
        Whether the equations are derived again.
    """

    name: str
    ending: str
    write: Callable[..., Path]
    check: Callable[..., None]
    folder: bool = False
    derives: bool = False

    @property
    def options(self) -> tuple[str, ...]:
        """The names of its own options."""
        return tuple(getattr(self.write, "__kwdefaults__", None) or ())
