"""Messages as they were stored: one file has all, and no test repeats their sentences.

A test says by its name what it gives; what it is told is in `golden/messages.json` under that name.
``pytest --update-messages`` stores what is said now: the difference is what a person reads.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

FILE = Path(__file__).parent / "golden/messages.json"


@cache
def stored() -> dict[str, str | list[str]]:
    """Return all messages by test."""
    found: dict[str, str | list[str]] = json.loads(FILE.read_text(encoding="utf-8"))
    return found


def key_of(item: pytest.Item) -> str:
    """Return the name that a test has there: its file's, and its own."""
    return f"{item.path.stem}{item.nodeid.partition('.py')[2]}"


def check(item: pytest.Item, *texts: str, update: bool) -> None:
    """Compare what a test is told with what is stored, or store it.

    Parameters
    ----------
    texts
        All that the test is told, in order.
    update
        Whether it is stored.
    """
    told = texts[0] if len(texts) == 1 else [*texts]
    if update:
        stored()[key_of(item)] = told
        text = json.dumps(stored(), indent=1, sort_keys=True, ensure_ascii=False)
        FILE.write_text(f"{text}\n", encoding="utf-8")
    assert told == stored().get(key_of(item)), "if on purpose: pytest --update-messages"
