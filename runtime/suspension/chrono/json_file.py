"""Files of Project Chrono: JSON that may have comments, and what is wrong in one."""

import json
import re
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.legible import short, strange
from ...core.reading import text_of

# A text, a comment to the end of the line, a comment between marks. Each of them matches up to the
# end of the file where it is not closed, and never goes back: the time is linear in the length.
_COMMENT = re.compile(r'("(?:[^"\\]|\\.)*+"?)|//[^\n]*+|/\*.*?(\*/|\Z)', re.DOTALL)

Kind = TypeVar("Kind", bound=BaseModel)


def checked(model: type[Kind], data: dict[str, Any], path: str | Path) -> Kind:
    """Return the content of a file as what it is of a kind; say what is wrong if it is not."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        details = error.errors()
        # of another kind of file, nothing else is worth telling
        other = [detail for detail in details if detail["type"] == "literal_error"]
        raise InputError([_problem(d) for d in other or details], str(path)) from None


def content(path: str | Path) -> dict[str, Any]:
    """Read JSON that may have comments, as Chrono allows."""
    with Arguments("chrono") as given:
        given.path("path", path)
    text = text_of(Path(path))
    try:
        data = json.loads(_COMMENT.sub(_without_comment, text))
    except json.JSONDecodeError as error:
        problem = f"Line {error.lineno} is not valid JSON: {error.msg}."
        raise InputError([problem], str(path)) from error
    except RecursionError as error:
        problem = "has lists or keys in each other too deeply. Give a file of Project Chrono."
        raise InputError([problem], str(path)) from error
    except ValueError as error:  # Python's limit of 4300 digits
        problem = "has a number of thousands of digits. Write it with an exponent, as 1.5e6."
        raise InputError([problem], str(path)) from error
    if not isinstance(data, dict):
        raise InputError(["has no keys. Give a file of Project Chrono's templates."], str(path))
    if problem := strange(data):
        raise InputError([problem], str(path))
    return data


def _without_comment(found: re.Match[str]) -> str:
    """Return what stands for a text or a comment; the lines keep their numbers."""
    is_text, is_open = found[1] is not None, found[2] == ""
    return found[0] if is_text or is_open else "\n" * found[0].count("\n") or " "


def _problem(detail: Any) -> str:
    place = " > ".join(str(part) for part in detail["loc"])
    given = short(json.dumps(detail["input"], default=str))
    if detail["type"] == "missing":
        return f'"{place}" is missing. Add it, in SI units.'
    if detail["type"] == "literal_error":
        return f'"{place}" is {given}; only {detail["ctx"]["expected"]} can be read.'
    return f'"{place}" = {given}: {detail["msg"].lower()}.'
