"""Many attempts at a door, in a process of its own that may crash or hang."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING

from benchmarks.report import count as count_of
from benchmarks.report import markdown_table

from .attempts import DEFECTS, OUTCOMES, Tried, door

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_TESTS = Path(__file__).parents[1]
_PATH = os.pathsep.join([str(_TESTS), str(_TESTS.parent)])


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
    environment = os.environ | {"PYTHONPATH": _PATH}
    seed, plain = first, {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "text": True}
    # a file, since a pipe that nobody reads from would fill up
    with (
        TemporaryFile("w+", encoding="utf-8", errors="replace") as complaints,
        subprocess.Popen(command, env=environment, stderr=complaints, **plain) as process,
    ):
        for line in process.stdout or ():
            one = Tried(**json.loads(line))
            seed = one.seed + 1
            yield one
        process.wait()
        complaints.seek(0)
        last_words = complaints.read().strip()
    if seed < first + count:
        hung = process.returncode == -signal.SIGPROF or "Timeout (" in last_words
        yield Tried(
            seed, "hung" if hung else "raw", f"exit code {process.returncode}: {last_words[-2000:]}"
        )


def table(campaigns: list[Campaign]) -> str:
    """Return a table in Markdown: a row for each door."""
    rows = [
        [
            f"`{c.name}`: {c.what}",
            count_of(c.counts.total()),
            *(count_of(c.counts[outcome]) for outcome in OUTCOMES),
        ]
        for c in campaigns
    ]
    return markdown_table(["door, and what is tried", "attempts", *OUTCOMES], rows)
