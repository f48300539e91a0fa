"""Ctrl-C: none is lost, and what must not be left half done is done first.

Python raises KeyboardInterrupt wherever a program happens to be. In a callback that cannot raise
(of a weak reference, which imports have; ``__del__``; one from C) Python prints a traceback and
goes on, and so does a clause of a library that catches everything.
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

# How long a program may tidy up after an interrupt before it is raised again [s].
_PATIENCE = 1.0
# Until a callback in which one was lost has ended [s].
_MOMENT = 0.005


class _Heard:
    """The interrupts of a program."""

    def __init__(self) -> None:
        self.any = False
        # the one queue that may be written to where a signal is handled
        self.events: SimpleQueue[str] = SimpleQueue()

    def handle(self, _number: int, _frame: FrameType | None) -> None:
        """Raise an interrupt."""
        self.any = True
        self.events.put("raised")
        raise KeyboardInterrupt

    def lost(self, unraisable: Any) -> None:
        """Note an interrupt that could not be raised; Python prints what else could not."""
        if issubclass(unraisable.exc_type, KeyboardInterrupt):
            self.events.put("lost")
        else:
            sys.__unraisablehook__(unraisable)

    def raise_again(self) -> None:
        """Raise an interrupt that was lost again; in a thread of its own, until the end."""
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
    """From here on see that the first Ctrl-C ends this program; for its main thread.

    The process that started it may have asked that Ctrl-C be ignored, as shells do in the
    background.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        threading.Thread(target=_heard.raise_again, daemon=True).start()
        sys.unraisablehook = _heard.lost
        signal.signal(signal.SIGINT, _heard.handle)


def end() -> None:
    """Ignore Ctrl-C from here on, as the program has ended; raise one that did not end it."""
    if signal.getsignal(signal.SIGINT) == _heard.handle:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        sys.unraisablehook = sys.__unraisablehook__
        _heard.events.put("end")
        check()


def check() -> None:
    """Raise KeyboardInterrupt if there was one: nothing is written after it."""
    if _heard.any:
        raise KeyboardInterrupt


@contextmanager
def held() -> Iterator[None]:
    """Let Ctrl-C wait until this is done: a file put in its place, a process that is noted."""
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
