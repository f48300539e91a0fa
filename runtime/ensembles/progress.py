"""A progress bar of simulations on the terminal."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


@contextmanager
def bar(count: int) -> Iterator[Callable[[int], None]]:
    """Show a bar inside a block; the yielded function takes the number of finished systems."""
    columns = (TextColumn("simulating"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, transient=True) as shown:
        task = shown.add_task("", total=count)
        yield lambda done: shown.update(task, completed=done)
