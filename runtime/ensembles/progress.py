"""How far many simulations are, on the screen."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn


@contextmanager
def bar(count: int) -> Iterator[Callable[[int], None]]:
    """Show a bar while something lasts; the function handed over takes how many are done."""
    columns = (TextColumn("simulating"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, transient=True) as shown:
        task = shown.add_task("", total=count)
        yield lambda done: shown.update(task, completed=done)
