"""What is being done, on the screen of who waits for it."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def on_terminal(text: str) -> Iterator[Callable[[str], None]]:
    """Show a line while something lasts: what is being done, and for how long.

    It is on standard error, and gone afterwards. Where that is no terminal, nothing is shown.

    Parameters
    ----------
    text : str
        What is shown at first.

    Yields
    ------
    callable
        To be called with what is being done, in a few words.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.console import Console  # slow to import
    from rich.markup import escape
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as shown:
        task = shown.add_task(escape(text), total=None)
        yield lambda now: shown.update(task, description=escape(now))
