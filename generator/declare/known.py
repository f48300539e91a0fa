"""Parts that are declared twice, and parts that are not declared."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable


class Named(Protocol):
    """Something with a name."""

    @property
    def name(self) -> str:
        """The name."""


def repeated(what: str, names: Iterable[str]) -> list[str]:
    """Find what is named more than once.

    Parameters
    ----------
    what, names
        What the names are of, for the message, and the names.
    """
    counts = Counter(names).items()
    return [f"{what} {n!r} is declared {c} times; once is enough" for n, c in counts if c > 1]


def strangers(what: str, used: Iterable[Named], known: Collection[Named]) -> list[str]:
    """Find what a model refers to and its mechanism does not have.

    Parameters
    ----------
    what
        What refers to them, for the message.
    used, known
        What is referred to, and what there is.
    """
    names = ", ".join(thing.name for thing in known) or "none"
    return [
        f"{what} {thing.name!r} is not in its mechanism; there are {names}"
        for thing in used
        if thing not in known
    ]
