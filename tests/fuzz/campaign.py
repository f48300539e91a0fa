"""Many attempts at a door, in a process of its own that may crash or hang."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from .attempts import DEFECTS, OUTCOMES, Tried, door

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_TESTS = Path(__file__).parents[1]


@dataclass
class Campaign:
    """What came of many attempts at a door.

    Attributes
    ----------
    name : str
        Of the door.
    what : str
        What is tried.
    counts : Counter
        How many attempts had each outcome.
    defects : list of Tried
        Those that are wrong, raw or hung.
    """

    name: str
    what: str
    counts: Counter[str] = field(default_factory=Counter)
    defects: list[Tried] = field(default_factory=list)

    def note(self, found: Tried) -> None:
        """Count an attempt."""
        self.counts[found.outcome] += 1
        if found.outcome in DEFECTS:
            self.defects.append(found)


def campaign(
    name: str, count: int, *, first: int = 0, told: Callable[[Campaign], None] | None = None
) -> Campaign:
    """Try a door with so many seeds.

    Parameters
    ----------
    name
        Of the door.
    count
        Number of attempts.
    first
        The first seed.
    told
        Called after every attempt with what there is so far.
    """
    found = Campaign(name, (door(name).__doc__ or "").splitlines()[0].rstrip("."))
    seed, end = first, first + count
    while seed < end:
        for one in _worked(name, seed, end - seed):
            found.note(one)
            seed = one.seed + 1
            if told:
                told(found)
    return found


def _worked(name: str, first: int, count: int) -> Iterator[Tried]:
    """Yield what one process tells, and at the end what the seed that ended it came to."""
    command = [sys.executable, "-m", "fuzz.worker", name, str(first), str(count)]
    with subprocess.Popen(
        command, cwd=_TESTS, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        seed = first
        assert process.stdout is not None
        assert process.stderr is not None
        for line in process.stdout:
            one = Tried(**json.loads(line))
            seed = one.seed + 1
            yield one
        last_words = process.stderr.read().strip()
    if seed < first + count:
        hung = last_words.startswith("Timeout")
        yield Tried(
            seed, "hung" if hung else "raw", f"exit code {process.returncode}: {last_words[-2000:]}"
        )


def table(campaigns: list[Campaign]) -> str:
    """Return a table in Markdown: a row for each door."""
    head = ["door", "what is tried", "attempts", *OUTCOMES]
    rows = [
        [c.name, c.what, f"{c.counts.total():,}", *(f"{c.counts[o]:,}" for o in OUTCOMES)]
        for c in campaigns
    ]
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    right = range(2, len(head))

    def line(cells: list[str]) -> str:
        padded = [
            cell.rjust(width) if i in right else cell.ljust(width)
            for i, (cell, width) in enumerate(zip(cells, widths, strict=True))
        ]
        return f"| {' | '.join(padded)} |"

    rule = [("-" * (w - 1) + ":") if i in right else "-" * w for i, w in enumerate(widths)]
    return "\n".join([line(head), line(rule), *map(line, rows)])
