"""Checks for parts that are declared twice, and for undeclared parts."""

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
    """Return problems of names that occur more than once, for a kind of things."""
    counts = Counter(names).items()
    return [f"{what} {n!r} is declared {c} times; once is enough" for n, c in counts if c > 1]


def strangers(what: str, used: Iterable[Named], known: Collection[Named]) -> list[str]:
    """Return problems of parts that a model refers to and its mechanism does not have."""
    names = ", ".join(thing.name for thing in known) or "none"
    return [
        f"{what} {thing.name!r} is not in its mechanism; there are {names}"
        for thing in used
        if thing not in known
    ]
