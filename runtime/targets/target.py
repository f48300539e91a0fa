"""The record of a kind of export."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Target:
    """A kind of files for other programs."""

    name: str  # name in arguments and commands
    ending: str  # ending of the name of the file or folder, if no path is given
    # writes an `Emitted` to a path, with the keywords `force` and `read`, and with options of its
    # own, which have defaults
    write: Callable[..., Path]
    check: Callable[..., None]  # refuses a path, and options of its own, before a model exists
    folder: bool = False  # whether it is a folder, whose files have names of their own
    derives: bool = False  # whether the equations are derived again

    @property
    def options(self) -> tuple[str, ...]:
        """The names of its own options."""
        return tuple(getattr(self.write, "__kwdefaults__", None) or ())
