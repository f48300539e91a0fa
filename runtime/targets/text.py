"""Numbers and texts in C, and the templates of this package."""

import re
from collections.abc import Iterable

from jinja2 import Environment, PackageLoader, StrictUndefined

# Characters of a C string that need no escape; a question mark may begin a trigraph.
_PLAIN = re.compile(r"[ -~]")
_ESCAPED = frozenset('"\\?')


def number(value: float) -> str:
    """Return a finite number of C99 with all its bits.

    Examples
    --------
    >>> number(0.1)
    '0x1.999999999999ap-4'
    """
    return float(value).hex()


def quoted(text: str) -> str:
    r"""Return a text as a C string in UTF-8.

    Examples
    --------
    >>> quoted('a "b"')
    '"a \\"b\\""'
    """
    return f'"{"".join(map(_character, text.encode()))}"'


def _character(byte: int) -> str:
    letter = chr(byte)
    if not _PLAIN.fullmatch(letter):
        return f"\\{byte:03o}"  # three digits, so that no further digit belongs to it
    return f"\\{letter}" if letter in _ESCAPED else letter


def comment(text: str) -> str:
    """Return a text without the marks of comments in C."""
    return " ".join(text.split()).replace("*/", "* /").replace("/*", "/ *")


def operations(counts: dict[str, int]) -> str:
    """Return counts of operations in words, as in headers."""
    kinds = ", ".join(f"{n} {kind}" for kind, n in counts.items() if n and kind != "total")
    return f"{counts['total']} operations ({kinds or 'none'})"


def wrapped(parts: Iterable[str], indent: str = "    ", width: int = 100) -> str:
    """Return parts, separated by commas, in lines of some width."""
    lines, line = [], indent
    for part in parts:
        if line.strip() and len(line) + len(part) > width:
            lines.append(line.rstrip())
            line = indent
        line += f"{part}, "
    return "\n".join([*lines, line.rstrip()])


def environment(folder: str) -> Environment:
    """Return the environment for the templates in a folder of this package."""
    made = Environment(
        loader=PackageLoader(__package__, folder),
        autoescape=False,  # noqa: S701 (C and plain text; XML is built as a tree)
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters |= {
        "number": number,
        "quoted": quoted,
        "comment": comment,
        "operations": operations,
        "wrapped": wrapped,
        "repr": repr,
    }
    return made
