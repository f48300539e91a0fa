"""Many attempts at a door, in a process of its own that may crash or hang."""

from __future__ import annotations

import multiprocessing
import signal
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from tempfile import NamedTemporaryFile

from benchmarks.report import count as count_of
from benchmarks.report import markdown_table

from . import worker
from .attempts import DEFECTS, OUTCOMES, Tried, what_is_tried

_PROCESSES = multiprocessing.get_context("forkserver")
# what doors have in common is imported once, for all processes
_PROCESSES.set_forkserver_preload(
    [
        "kintrafo.generator.backends.files",
        "kintrafo.generator.equations.outputs",
        "kintrafo.generator.mechanisms",
        "kintrafo.vehicle.cli",
        "kintrafo.vehicle.plots",
        "kintrafo.vehicle.studies",
        "scipy.optimize",
    ]
)


@dataclass
class Campaign:
    """Counts of outcomes for many attempts at a door.

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

    def note(self, found):
        """Count an attempt."""
        self.counts[found.outcome] += 1
        if found.outcome in DEFECTS:
            self.defects.append(found)


def campaign(name, count, *, first=0, progress=None):
    """Try a door with so many seeds.

    Parameters
    ----------
    name
        Of the door.
    count
        Number of attempts.
    first
        The first seed.
    progress
        Called after every attempt with the results so far.
    """
    found = Campaign(name, what_is_tried(name))
    seed, end = first, first + count
    while seed < end:
        for one in _worked(name, seed, end - seed):
            found.note(one)
            seed = one.seed + 1
            if progress:
                progress(found)
    return found


def _worked(name, first, count):
    """Yield the results of one process, and at its end that of the seed that ended it."""
    seed = first
    receiver, sender = _PROCESSES.Pipe(duplex=False)
    # a file, since a pipe that nobody reads from would fill up
    with NamedTemporaryFile("r", encoding="utf-8", errors="replace") as complaints:
        process = _PROCESSES.Process(
            target=worker.main, args=(name, first, count, sender, complaints.name)
        )
        process.start()
        sender.close()
        with suppress(EOFError):
            while True:
                one = receiver.recv()
                seed = one.seed + 1
                yield one
        process.join()
        last_words = complaints.read().strip()
    if seed < first + count:
        hung = process.exitcode == -signal.SIGPROF or "Timeout (" in last_words
        yield Tried(
            seed, "hung" if hung else "raw", f"exit code {process.exitcode}: {last_words[-2000:]}"
        )


def table(campaigns):
    """Return a table in Markdown: a row for each door."""
    rows = [
        [
            f"`{c.name}`: {c.what}",
            count_of(c.counts.total()),
            *(count_of(c.counts[outcome]) for outcome in OUTCOMES),
        ]
        for c in campaigns
    ]
    return markdown_table(["door and random input", "attempts", *OUTCOMES], rows)
