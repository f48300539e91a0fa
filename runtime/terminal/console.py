"""What the commands print: results on stdout, everything else on stderr."""

import json
import math
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from ..core.tabulated import number

if TYPE_CHECKING:
    from xarray import Dataset

    from ..core.tabulated import Tabulated

# Where the output goes into a file, it is wide enough for the tables.
_WIDTH_OF_FILES = 110
# Every so many positions are in a table, so that round distances stay round.
_STRIDES = [factor * 10**power for power in range(9) for factor in (1, 2, 5)]

console = Console(width=None if sys.stdout and sys.stdout.isatty() else _WIDTH_OF_FILES)
problems = Console(stderr=True, soft_wrap=True)


def print_json(result: Any) -> None:
    """Print a result for scripts: JSON and nothing else; what is not defined is null."""
    sys.stdout.write(json.dumps(_plain(result), indent=2, allow_nan=False) + "\n")


def _plain(value: Any) -> Any:
    """Return a value as JSON has it."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def say(text: str) -> None:
    """Print a line in which brackets mean nothing."""
    console.print(text, markup=False, highlight=False, soft_wrap=True)


def note(text: str) -> None:
    """Print a line on stderr, beside the results, in which brackets mean nothing."""
    problems.print(text, markup=False, highlight=False)


@contextmanager
def progress_bar(text: str) -> Iterator[Callable[[float], None]]:
    """Show on stderr how much is done of something that may take long."""
    columns = TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn()
    with Progress(*columns, console=problems, transient=True) as progress:
        task = progress.add_task(text, total=1.0)
        yield lambda done: progress.update(task, completed=done)


def curve_table(dataset: "Dataset", names: Sequence[str], title: str) -> Table:
    """Return a table of some variables at some of the positions of a dataset.

    Parameters
    ----------
    dataset : xarray.Dataset
        Over one dimension.
    names : sequence of str
        Variables, one column each.
    title : str

    Returns
    -------
    rich.table.Table
        With 17 rows at most, zero among them where it is a position.
    """
    from ..core.quantities import bracketed, displayed

    (along,) = dataset.sizes
    columns = [dataset[str(along)], *(dataset[name] for name in names)]
    headings = [bracketed(str(c.name).replace("_", " "), c.attrs) for c in columns]
    values = [displayed(column) for column in columns]
    rows = ([number(float(column[row])) for column in values] for row in _rows(values[0]))
    return table(title, headings, rows, words=())


def _rows(positions: Any) -> list[int]:
    """Return the indices of at most 17 positions, equally spaced about zero."""
    count = len(positions)
    stride = next(n for n in _STRIDES if count <= 17 * n)
    zero = int(abs(positions).argmin())
    return list(range(zero % stride, count, stride))


def table(
    title: str,
    columns: Iterable[str],
    rows: Iterable[Iterable[str]],
    words: Collection[int] = (0,),
    caption: str | None = None,
) -> Table:
    """Return a table of texts: words to the left, numbers to the right.

    Parameters
    ----------
    title : str
    columns : iterable of str
        Headings.
    rows : iterable of iterable of str
        A cell for each column.
    words : collection of int, optional
        The columns that are words; the others are numbers.
    caption : str, optional
        Below the table.
    """
    made = Table(title=escape(title), caption=caption)
    for index, heading in enumerate(columns):
        made.add_column(escape(heading), justify="left" if index in words else "right")
    for row in rows:
        made.add_row(*map(escape, row))
    return made


def print_table(tabulated: "Tabulated", *, ruled: bool = True) -> None:
    """Print a table that is made for the terminal and a page alike, narrower if it is not ruled."""
    shown = table(tabulated.title, tabulated.columns, tabulated.rows, tabulated.words)
    if not ruled:
        shown.box, shown.show_edge, shown.padding = SIMPLE_HEAD, False, (0, 1, 0, 0)
    console.print(shown)
