"""Text files in the TeimOrbit format, which Adams/Car writes.

Blocks begin with a name in brackets, parts of them with a name in parentheses. They have keys with
values, and tables, whose columns are named in braces. Comments begin with ``$`` or ``!``, or are
texts in quotes below ``(COMMENTS)`` or ``{comment_string}``.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import InputError
from ...core.reading import bytes_of
from ...core.validator import Validator

_LINE_END = re.compile(r"\r\n|\r|\n")  # not the further ones of Latin-1
_BLOCK = re.compile(r"\s*+\[([^\[\]]*+)\]\s*+([$!].*+)?")
_PART = re.compile(r"\s*+\(([^()]*+)\)\s*+([$!].*+)?")
_COLUMNS = re.compile(r"\s*+\{([^{}]*+)\}?\s*+([$!].*+)?")
_KEY = re.compile(r"""\s*+([^\s='"$!]++)\s*+=(.*+)""")
# a text in quotes, a bare word, or a comment to the end of the line
_CELL = re.compile(r"""'([^']*+)'|"([^"]*+)"|([^\s'"$!,]++)|([$!].*+)|[\s,]++""")


_OF_COMMENTS = ("comments", "comment_string")


@dataclass(frozen=True)
class FileBlock:
    """A block of a file with its parts."""

    name: str  # in lower case
    number: int  # number of its first line
    lines: tuple[tuple[int, str], ...]  # following lines up to the next block, with their numbers

    def values(self) -> Iterator[tuple[str, str]]:
        """Yield keys, in lower case, and values, without quotes."""
        for _, line in self._uncommented():
            found = _KEY.fullmatch(line)
            if found:
                yield found[1].lower(), " ".join(cells_of(found[2]) or [found[2].strip()])

    def columns(self) -> list[str]:
        """Return the names of the columns of its first table, in lower case."""
        for _, line in self._uncommented():
            found = _COLUMNS.fullmatch(line)
            if found:
                return [cell.lower() for cell in cells_of(found[1]) or []]
        return []

    def rows(self) -> Iterator[tuple[int, str, list[str] | None]]:
        """Yield number, text and cells of the rows of its tables; no cells of a broken row."""
        for number, line in self._uncommented():
            if not any(kind.fullmatch(line) for kind in (_PART, _COLUMNS, _KEY)):
                cells = cells_of(line)
                if cells != []:
                    yield number, line.strip(), cells

    def _uncommented(self) -> Iterator[tuple[int, str]]:
        """Yield its lines without texts in quotes that are comments."""
        of_comments = False
        for number, line in self.lines:
            begin = _PART.fullmatch(line) or _COLUMNS.fullmatch(line)
            if begin:
                of_comments = begin[1].strip().lower() in _OF_COMMENTS
            text = begin or (not _KEY.fullmatch(line) and len(cells_of(line) or ()) == 1)
            if not (of_comments and text):
                yield number, line


def cells_of(line: str) -> list[str] | None:
    """Return the cells of a line, without quotes and comment; None if a quote is not closed.

    Examples
    --------
    >>> cells_of("'lca_front  '  'single' 1.0  $ a comment")
    ['lca_front', 'single', '1.0']
    """
    cells, at = [], 0
    while at < len(line):
        found = _CELL.match(line, at)
        if found is None:
            return None
        cells += [cell.strip() for cell in found.groups()[:3] if cell is not None]
        at = found.end()
    return cells


def read_blocks(path: str | Path) -> list[FileBlock]:
    """Return the blocks of a file in its order; several may have the same name.

    The text is UTF-8 or Latin-1, with line ends of any system. Raises `InputError` if it cannot be
    read, is not a text or has no blocks.
    """
    with Validator("teim_orbit") as given:
        given.path("path", path)
    blocks: list[FileBlock] = []
    name, start = "", 0
    lines: list[tuple[int, str]] = []
    for number, line in enumerate(_LINE_END.split(_text_of(Path(path))), start=1):
        found = _BLOCK.fullmatch(line)
        if found:
            blocks.append(FileBlock(name, start, tuple(lines)))
            name, start, lines = found[1].strip().lower(), number, []
        else:
            lines.append((number, line))
    blocks.append(FileBlock(name, start, tuple(lines)))
    if len(blocks) == 1:
        problem = (
            "there is no [BLOCK] in it, so it is not a file in the TeimOrbit format. Give it "
            "as text (TeimOrbit), not as XML."
        )
        raise InputError([problem], str(path))
    return blocks[1:]


def _text_of(file: Path) -> str:
    """Return the file's text; every byte is a character of Latin-1."""
    content = bytes_of(file)
    if b"\0" in content:
        raise InputError(["the file is not a text. Save it as plain text."], str(file))
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")
