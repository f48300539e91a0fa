"""Reading TOML files, with errors that name the line and the remedy."""

import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.legible import short, strange
from ...core.reading import is_path, text_of
from ...core.suggestions import suggestion
from ...core.validator import Validator

_PYTHON = (
    "This is a Python file, and a hardpoint file (TOML) of a suspension is needed. A mechanism of "
    "your own has: kintrafo mechanism, report and export; and in Python "
    "kintrafo.compile, System, rest, linearise, simulate, ensemble."
)
_DEEP = "Tables or lists are nested too deeply. No key of a suspension does."
# A key of a hundred parts, found in linear time; tomllib's time grows with their square.
_TOO_DEEP = re.compile(r"""(?<![\w"'.-])(?:[\w"'-]++\s*+\.\s*+){100}""")


def read_toml(file: Path | Traversable) -> dict[str, Any]:
    """Return the content of a TOML file on disk or in a package.

    Raises `InputError` if the file cannot be read, is not UTF-8 or is not valid TOML.
    """
    if file.name.endswith(".py"):
        raise InputError([_PYTHON], str(file))
    text = text_of(file)
    if _TOO_DEEP.search(text):
        raise InputError([_DEEP], str(file))
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError([_syntax_problem(str(error), text)], str(file)) from None
    except RecursionError:
        raise InputError([_DEEP], str(file)) from None
    except ValueError:  # Python's limit of 4300 digits, which tomllib lets pass
        problem = "A number has thousands of digits. Write it with an exponent, as 1.5e6."
        raise InputError([problem], str(file)) from None
    if problem := strange(data):
        raise InputError([problem], str(file))
    return data


def read_sections(path: str | Path, known: Sequence[str], needed: str = "") -> dict[str, Any]:
    """Return the content of a TOML file that has only the sections and keys in `known`.

    `needed` is a required section: ``cases.NAME`` is one of several in ``cases``. Raises
    `InputError` if it is missing, there are others, or the file cannot be read.
    """
    with Validator("file") as given:
        given.path("path", path)
    data = read_toml(Path(path))
    problems = [f"{key} is not known. {suggestion(key, known)}" for key in data if key not in known]
    if needed and not isinstance(data.get(needed.partition(".")[0]), dict):
        problems.append(f"there is no section [{needed}]: write one or more.")
    with problems_in(Path(path)):
        if problems:
            raise InputError(problems, str(path))
    return data


def _syntax_problem(message: str, text: str) -> str:
    """Return the message of a syntax error, with the number and the text of the line."""
    last = len(text.rstrip().split("\n"))
    found = re.fullmatch(
        r"(.*) \(at (?:line (\d+), column \d+|end of document)\)", message, re.DOTALL
    )
    reason = found[1] if found else message
    number = int(found[2]) if found and found[2] else last
    line = short(text.split("\n")[number - 1].strip())
    return (
        f"Line {number} `{line}` is not valid TOML: {reason}. "
        "Write `key = value`, text in quotes, points as [x, y, z], decimals with a point."
    )


@contextmanager
def problems_in(
    file: Path | Traversable | None, source: str = "", sections: Collection[str] | None = None
) -> Iterator[None]:
    """Add the name of a TOML file, and the lines of their keys, to problems of its content.

    `source` is the printed name of the file, its path by default. Errors of other files are
    unchanged; and with the `sections` that the file may have, those in which no problem begins with
    a section or a key of the file, since they are errors of other arguments. All are unchanged
    without a file.
    """
    try:
        yield
    except InputError as error:
        source = source or str(file)
        named = error.source == source
        if file is None or (not named and is_path(error.source)):
            raise
        lines = lines_of_keys(text_of(file))
        numbers = [_line_of(problem, lines) for problem in error.problems]
        words = {re.split(r"[ :]", problem, maxsplit=1)[0] for problem in error.problems}
        if not (named or sections is None or any(numbers) or words & {*sections}):
            raise
        located = (
            f"line {number}: {problem}" if number else problem
            for number, problem in zip(numbers, error.problems, strict=True)
        )
        raise InputError(located, source) from None


# Texts and comments, which may have brackets in them; brackets; ends of lines.
_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}|"(?:\\.|[^"\\\n])*"'
    r"|'''.*?'{3,5}|'[^'\n]*'|#[^\n]*|[\[\]{}\n]",
    re.DOTALL,
)


def lines_of_keys(text: str) -> dict[str, int]:
    """Return the line of each key and table of a valid TOML text, by names with dots between them.

    Keys that several tables of an array have are left out.
    """
    found: dict[str, int] = {}
    repeated = set[str]()
    table, start, line, depth = "", 0, 1, 0
    for token in _TOKEN.finditer(f"{text}\n"):
        depth += (token[0] in "[{") - (token[0] in "]}")
        if token[0] != "\n" or depth:
            continue
        statement = text[start : token.end()]
        try:
            keys = dict(_paths(tomllib.loads(statement)))
        except ValueError:
            keys = {}
        header = statement.lstrip().startswith("[")
        if header:
            table = max(keys, key=len)
            keys = {table: statement.lstrip().startswith("[[")}
        for key, leaf in keys.items():
            name = key if header or not table else f"{table}.{key}"
            if leaf and name in found:
                repeated.add(name)
            if header or name not in found:
                found[name] = line
        start, line = token.end(), line + statement.count("\n")
    return {name: at for name, at in found.items() if name not in repeated}


def _paths(tables: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, bool]]:
    """Yield the names of all keys in tables, and whether each is a value."""
    for key, value in tables.items():
        yield before + key, not isinstance(value, dict)
        if isinstance(value, dict):
            yield from _paths(value, f"{before}{key}.")


def _line_of(problem: str, lines: Mapping[str, int]) -> int:
    """Return the line of the table and key that a problem begins with; 0 if it is not known."""
    titled = re.match(r"\[([^\]\n]+)\]", problem)
    first, *rest = re.findall(r"[^\s,:=]+", problem[titled.end() :] if titled else problem) or [""]
    if titled:
        path, rest = titled[1], [first, *rest]
    elif first in lines:
        path = first
    else:
        inner = [name for name in lines if name.endswith(f".{first}")]
        path = inner[0] if len(inner) == 1 else ""
    for word in rest:
        if f"{path}.{word}" not in lines:
            break
        path = f"{path}.{word}"
    return lines.get(path, 0)
