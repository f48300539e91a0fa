"""The output of each command, as a page of the documentation shows it and a test compares it."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
_PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)]+)\)")
# A picture that is so many characters behind an output belongs to it.
_NEAR = 700


@dataclass(frozen=True)
class Shown:
    """A command line with what it prints.

    Attributes
    ----------
    page : str
        Where it is from, relative to the documentation, without an ending.
    line, text : str
        The command, and its output or a part of it.
    picture : tuple of str, optional
        Words and path of the picture below it, from the folder of the page.
    """

    page: str
    line: str
    text: str
    picture: tuple[str, str] | None


def outputs(folder: Path, names: list[str]) -> dict[str, Shown]:
    """Return an output for each command that a page shows one of: with a picture, the longest.

    Parameters
    ----------
    folder : pathlib.Path
        Of the documentation.
    names : list of str
        Commands, without ``kintrafo``.
    """
    found: dict[str, Shown] = {}
    for path in sorted(folder.rglob("*.md")):
        page = path.relative_to(folder).with_suffix("").as_posix()
        for shown in _of_page(page, path.read_text(encoding="utf-8")):
            name = next((n for n in names if shown.line.startswith(f"kintrafo {n} ")), "")
            name = name or shown.line.removeprefix("kintrafo ")
            if name in names and _rank(shown) > _rank(found.get(name)):
                found[name] = shown
    return found


def _rank(shown: Shown | None) -> tuple[int, ...]:
    if shown is None:
        return (-1,)
    return (int(shown.picture is not None), len(shown.text))


def _of_page(page: str, text: str) -> Iterator[Shown]:
    """Yield the last command of each block that is followed by what it prints."""
    for block in _BLOCK.finditer(text):
        lines = [line.partition("  #")[0].strip() for line in block[2].splitlines()]
        lines = [line for line in lines if line.startswith("kintrafo ")]
        begin = block.end() + len(text[block.end() :]) - len(text[block.end() :].lstrip())
        output = _BLOCK.match(text, begin)
        if block[1] == "sh" and lines and output and output[1] == "text":
            behind = text[output.end() : output.end() + _NEAR].partition("\n## ")[0]
            picture = _PICTURE.search(behind)
            drawn = (picture[1], picture[2]) if picture else None
            yield Shown(page, lines[-1], output[2].rstrip(), drawn)
