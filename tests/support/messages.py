"""Messages as they were stored: one file has all, and no test repeats their sentences.

A test's name describes the mistake; its messages are in `golden/messages.json` under that name.
``pytest --update-messages`` stores the present messages: a person reads the difference. Numbers
with a fraction or an exponent are computed, and differ by rounding on other processors.
"""

import json
import re
from functools import cache
from math import isclose
from pathlib import Path

FILE = Path(__file__).parents[1] / "golden/messages.json"


COMPUTED = re.compile(r"-?\d+(?:\.\d+(?:e[-+]?\d+)?|e[-+]?\d+)")
"""A number that may be rounded differently."""


@cache
def stored():
    """Return all messages by test."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def write():
    """Write all messages."""
    text = json.dumps(stored(), indent=1, sort_keys=True, ensure_ascii=False)
    FILE.write_text(f"{text}\n", encoding="utf-8")


def key_of(item):
    """Return the key of a test among the stored messages: its file and its name."""
    return f"{item.path.stem}{item.nodeid.partition('.py')[2]}"


def alike(text, other):
    """Return whether two messages differ only by rounding of the numbers in them.

    Numbers may differ by one unit of the last digit shown, by a thousandth, or by 1e-9: what is
    singular is zero but for rounding.
    """
    if COMPUTED.sub("#", text) != COMPUTED.sub("#", other):
        return False
    pairs = zip(COMPUTED.findall(text), COMPUTED.findall(other), strict=True)
    return all(
        isclose(float(one), float(two), rel_tol=1e-3, abs_tol=max(1e-9, 1.01 * _last_digit(one)))
        for one, two in pairs
    )


def _last_digit(number):
    digits, _, exponent = number.partition("e")
    return float(f"1e{int(exponent or 0) - len(digits.partition('.')[2])}")


class StoredMessages:
    """Messages of one test, compared one by one with those that are stored.

    Parameters
    ----------
    item
        The test.
    update
        Whether its messages are stored instead.
    """

    def __init__(self, item, *, update):
        self.key, self.update = key_of(item), update
        known = stored().get(self.key, [])
        self.known = [known] if isinstance(known, str) else known
        self.shown = []

    def hear(self, text):
        """Compare one more message."""
        known = self.known[len(self.shown) : len(self.shown) + 1]
        self.shown.append(known[0] if known and alike(text, known[0]) else text)
        if not self.update:
            so_far = self.known[: len(self.shown)]
            assert self.shown == so_far, "if on purpose: pytest --update-messages"

    def end(self):
        """Store the messages with ``--update-messages``."""
        if self.update and self.shown:
            stored()[self.key] = self.shown[0] if len(self.shown) == 1 else self.shown
            write()
