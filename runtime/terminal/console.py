"""Output of commands: results on stdout, everything else on stderr."""

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

_WIDTH_OF_FILES = 110  # for output that is not on a terminal
_EDGE = 3  # a line and a blank on either side of a cell
# Strides of the positions in a table, so that round distances stay round.
_STRIDES = [factor * 10**power for power in range(9) for factor in (1, 2, 5)]

console = Console(width=None if sys.stdout and sys.stdout.isatty() else _WIDTH_OF_FILES)
problems = Console(stderr=True, soft_wrap=True)


def print_json(result: Any) -> None:
    """Print a result for scripts: JSON only; undefined numbers are null."""
    sys.stdout.write(json.dumps(_plain(result), indent=2, allow_nan=False) + "\n")


def _plain(value: Any) -> Any:
    """Return a value that JSON can represent."""
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def say(text: str) -> None:
    """Print a line without markup in brackets."""
    console.print(text, markup=False, highlight=False, soft_wrap=True)


def note(text: str) -> None:
    """Print a line on stderr, without markup in brackets."""
    problems.print(text, markup=False, highlight=False)


@contextmanager
def progress_bar(text: str) -> Iterator[Callable[[float], None]]:
    """Show on stderr the completed fraction of a task, from 0 to 1."""
    columns = TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn()
    # without a terminal, its end would be an empty line
    disable = not problems.is_terminal
    with Progress(*columns, console=problems, transient=True, disable=disable) as progress:
        task = progress.add_task(text, total=1.0)
        yield lambda done: progress.update(task, completed=done)


def print_curves(dataset: "Dataset", names: Sequence[str], title: str) -> None:
    """Print some variables of a dataset over one dimension.

    A table has at most 17 rows, among them zero if that is a position. Columns that do not fit into
    the width of the terminal are in further tables.
    """
    from ..core.quantities import bracketed, displayed

    (along,) = dataset.sizes
    columns = [dataset[str(along)], *(dataset[name] for name in names)]
    headings = [bracketed(str(c.name).replace("_", " "), c.attrs) for c in columns]
    values = [displayed(column) for column in columns]
    rows = [[number(float(column[row])) for column in values] for row in _rows(values[0])]
    for chosen in _fitting(headings, rows, console.width):
        cells = ([row[i] for i in chosen] for row in rows)
        console.print(table(title, [headings[i] for i in chosen], cells, words=()))


def _fitting(
    headings: Sequence[str], rows: Sequence[Sequence[str]], width: int
) -> Iterator[list[int]]:
    """Yield the columns of each table that is no wider than `width`; the first is in all."""
    widths = [
        _EDGE + max(len(text) for text in (*heading.split(), *(row[i] for row in rows)))
        for i, heading in enumerate(headings)
    ]
    chosen, used = [0], widths[0] + 1
    for i, needed in enumerate(widths[1:], 1):
        if used + needed > width and len(chosen) > 1:
            yield chosen
            chosen, used = [0], widths[0] + 1
        chosen, used = [*chosen, i], used + needed
    yield chosen


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

    Each row has a cell for each column; `words` are the indices of the columns of words.
    """
    made = Table(title=escape(title), caption=caption)
    for index, heading in enumerate(columns):
        made.add_column(escape(heading), justify="left" if index in words else "right")
    for row in rows:
        made.add_row(*map(escape, row))
    return made


def print_table(tabulated: "Tabulated", *, ruled: bool = True) -> None:
    """Print a table of texts, with narrower columns if not `ruled`."""
    shown = table(tabulated.title, tabulated.columns, tabulated.rows, tabulated.words)
    if not ruled:
        shown.box, shown.show_edge, shown.padding = SIMPLE_HEAD, False, (0, 1, 0, 0)
    console.print(shown)
