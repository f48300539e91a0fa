"""Files of Project Chrono: JSON with comments."""

import json
import re
from collections import Counter
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.legible import legible, short, strange
from ...core.reading import text_of
from ...core.validator import Validator

# A text, a comment to the end of the line, a comment between marks. Each of them matches up to the
# end of the file if it is not closed, without backtracking: the time is linear in the length.
_COMMENT = re.compile(r'("(?:[^"\\]|\\.)*+"?)|//[^\n]*+|/\*.*?(\*/|\Z)', re.DOTALL)


def content(path: str | Path) -> dict[str, Any]:
    """Return the content of a JSON file that may have comments, as Chrono allows."""
    with Validator("chrono") as given:
        given.path("path", path)
    text = text_of(Path(path))
    try:
        data = json.loads(_COMMENT.sub(_without_comment, text), object_pairs_hook=_keys)
    except json.JSONDecodeError as error:
        problem = f"Line {error.lineno} is not valid JSON: {error.msg}."
        raise InputError([problem], str(path)) from error
    except RecursionError as error:
        problem = "lists or keys are nested too deeply. Give a file of Project Chrono."
        raise InputError([problem], str(path)) from error
    except _TwiceError as error:
        raise InputError([str(error)], str(path)) from None
    except ValueError as error:  # Python's limit of 4300 digits
        problem = "has a number of thousands of digits. Write it with an exponent, as 1.5e6."
        raise InputError([problem], str(path)) from error
    if not isinstance(data, dict):
        raise InputError(["has no keys. Give a file of Project Chrono's templates."], str(path))
    if problem := strange(data):
        raise InputError([problem], str(path))
    return data


def entry(data: Any, place: tuple[str, ...]) -> Any:
    """Return the value at a place in nested objects, or None."""
    for key in place:
        data = data.get(key) if isinstance(data, dict) else None
    return data


class _TwiceError(ValueError):
    """An object with the same key twice."""


def _keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object as a dictionary; refuse two equal keys."""
    ((most, times),) = Counter(key for key, _ in pairs).most_common(1) or [("", 0)]
    if times > 1:
        raise _TwiceError(f'"{legible(short(most))}" is given {times} times. Keep one of them.')
    return dict(pairs)


def _without_comment(found: re.Match[str]) -> str:
    """Return a text unchanged, and line ends or a blank for a comment."""
    is_text, is_open = found[1] is not None, found[2] == ""
    return found[0] if is_text or is_open else "\n" * found[0].count("\n") or " "
