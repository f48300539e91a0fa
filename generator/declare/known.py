"""Names that are declared, and those that are not."""

from __future__ import annotations

import difflib
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def repeated(what: str, names: Iterable[str]) -> list[str]:
    """Find what is named more than once."""
    counts = Counter(names).items()
    return [f"{what} {n!r} is declared {c} times; once is enough" for n, c in counts if c > 1]


def unknown(
    what: str, names: Iterable[str], known: Iterable[str] | Mapping[str, object]
) -> list[str]:
    """Find names that are not among the known ones, each with the one that was probably meant."""
    known = list(known)
    problems = []
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            hint = (
                f"did you mean {near[0]!r}?" if near else f"there are {', '.join(known) or 'none'}"
            )
            problems.append(f"{what} {name!r} is not declared; {hint}")
    return problems
