"""Reading TOML files, with errors that name the line and the remedy."""

import re
import tomllib
from collections.abc import Sequence
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.legible import short, strange
from ...core.reading import text_of
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
