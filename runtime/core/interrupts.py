"""Ctrl-C: no interrupt is lost, and operations that must not be half done are completed first.

Python raises KeyboardInterrupt at any place of a program. In a callback that cannot raise (of a
weak reference, which imports have; ``__del__``; one from C) Python prints a traceback and goes on,
and so does a clause of a library that catches everything.
"""

import signal
import sys
import threading
import time
from _thread import interrupt_main
from collections.abc import Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from types import FrameType
from typing import Any

# Time in which a program may clean up before an interrupt is raised again [s].
_PATIENCE = 1.0
# Time in which a callback that lost an interrupt has ended [s].
_MOMENT = 0.005


class _Heard:
    """The interrupts of a program that have occurred."""

    def __init__(self) -> None:
        self.any = False
        # the only queue that a signal handler may write to
        self.events: SimpleQueue[str] = SimpleQueue()

    def handle(self, _number: int, _frame: FrameType | None) -> None:
        """Raise an interrupt."""
        self.any = True
        self.events.put("raised")
        raise KeyboardInterrupt

    def lost(self, unraisable: Any) -> None:
        """Note an interrupt that could not be raised; Python prints any other exception."""
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            self.events.put("lost")
        else:
            sys.__unraisablehook__(unraisable)

    def raise_again(self) -> None:
        """Raise lost interrupts again; runs in a thread of its own until the end."""
        patience = None  # forever, for the first
        while True:
            try:
                word = self.events.get(timeout=patience)
            except Empty:
                word = "lost"
            if word == "end":
                return
            if word == "lost":
                time.sleep(_MOMENT)
                interrupt_main()
            patience = _PATIENCE


_heard = _Heard()


def heed() -> None:
    """Ensure from now on that the first Ctrl-C ends this program; called in its main thread.

    If the parent process asked that Ctrl-C be ignored, as shells do in the background, it stays so.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        threading.Thread(target=_heard.raise_again, daemon=True).start()
        sys.unraisablehook = _heard.lost
        signal.signal(signal.SIGINT, _heard.handle)


def end() -> None:
    """Ignore Ctrl-C from now on, as the program has ended; raise one that did not end it."""
    if signal.getsignal(signal.SIGINT) == _heard.handle:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        sys.unraisablehook = sys.__unraisablehook__
        _heard.events.put("end")
        check()


def check() -> None:
    """Raise KeyboardInterrupt if one has occurred: nothing is written after it."""
    if _heard.any:
        raise KeyboardInterrupt


@contextmanager
def held() -> Iterator[None]:
    """Delay Ctrl-C until the block ends: a file put in its place, a process that is noted."""
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield  # signals are handled by the main thread
        return
    came: list[Any] = []

    def wait(*given: Any) -> None:
        came.append(given)

    signal.signal(signal.SIGINT, wait)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if came:
            handler(*came[0])
