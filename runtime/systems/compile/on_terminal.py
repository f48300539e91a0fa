"""Progress of a task on the terminal."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def on_terminal(text: str) -> Iterator[Callable[[str], None]]:
    """Show a line on standard error inside a block: a text and the elapsed time.

    It is removed afterwards. Nothing is shown without a terminal. The yielded function takes the
    next text, a few words.
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
