"""Progress of long work, and the time that remains."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from typing import TypeVar

    T = TypeVar("T")
    Notify = Callable[[str], None]

WORTH_REPORTING_S = 10.0
"""Least duration of work whose remaining time is reported [s]."""


def silent(text: str) -> None:
    """Report nothing."""
    del text


def counted(notify: Notify, what: str, items: Iterable[T]) -> Iterator[T]:
    """Yield items one by one and report their number.

    The remaining time is reported too, if all items are expected to take more than
    `WORTH_REPORTING_S`. `notify` is called with each report; `what` is the work on each item, in a
    few words.
    """
    items, started = list(items), time.monotonic()
    for done, item in enumerate(items):
        passed = time.monotonic() - started
        left = passed / done * (len(items) - done) if done else 0.0
        rest = f", {left:.0f} s to go" if passed + left > WORTH_REPORTING_S else ""
        notify(f"{what}: {done + 1} of {len(items)}{rest}")
        yield item
