"""Tables as files of MATLAB: a struct of columns, and structs that describe them.

`scipy.io.savemat` writes version 5 of the format. The same data give the same bytes: the header has
no time of writing.
"""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError

LONGEST = 63
"""Most characters of a name in MATLAB."""

_HEAD = b"MATLAB 5.0 MAT-file, by kintrafo".ljust(116)
_KEYWORD = re.compile(
    "break|case|catch|classdef|continue|else|elseif|end|for|function|global|if|otherwise|parfor|"
    "persistent|return|spmd|switch|try|while"
)


def write(frame: Any, described: Mapping[str, Mapping[str, Any]], about: Any, path: Path) -> None:
    """Write a data frame.

    ``data`` has the columns, ``units`` and ``meanings`` describe them, and ``names`` has their
    original names. Texts are rows of characters, for ``string(data.load)``. By column `described`
    has ``units``, ``long_name`` and ``sign``; `about` are attributes of the whole table. Raises
    `InputError` if a column is larger than the format allows.
    """
    from scipy.io import savemat  # noqa: PLC0415 (slow to import)
    from scipy.io.matlab import MatWriteError  # noqa: PLC0415 (as this)

    names = valid_names(map(str, frame.columns))
    columns = dict(zip(frame.columns, names, strict=True))
    found = {
        "data": {new: _column(frame[old].to_numpy()) for old, new in columns.items()},
        "units": {new: str(described[old].get("units", "")) for old, new in columns.items()},
        "meanings": {new: _meaning(described[old], old) for old, new in columns.items()},
        "names": {new: str(old) for old, new in columns.items()},
        "about": dict(zip(valid_names(map(str, about)), map(str, about.values()), strict=True)),
    }
    try:
        savemat(path, found, long_field_names=True, do_compression=True, oned_as="column")
    except MatWriteError as error:
        problem = f"a file of MATLAB cannot have so much data: {error} Use .nc or .parquet."
        raise InputError([problem], "export") from error
    with path.open("r+b") as file:
        file.write(_HEAD)


def valid_names(names: Iterable[str]) -> list[str]:
    """Return valid and distinct names for MATLAB in the same order.

    Examples
    --------
    >>> valid_names(["camber", "wheel travel", "2nd", "end", "wheel_travel"])
    ['camber', 'wheel_travel', 'x2nd', 'xend', 'wheel_travel_1']
    """
    found: dict[str, None] = {}
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", name)
        if _KEYWORD.fullmatch(plain) or not re.match("[A-Za-z]", plain):
            plain = f"x{plain}"
        unique, count = plain[:LONGEST], 0
        while unique in found:
            count += 1
            unique = f"{plain[: LONGEST - len(str(count)) - 1]}_{count}"
        found[unique] = None
    return [*found]


def _meaning(attributes: Mapping[str, Any], name: str) -> str:
    words = str(attributes.get("long_name", name)), str(attributes.get("sign", ""))
    return ", ".join(filter(None, words))


def _column(values: Any) -> Any:
    """Return a column of numbers, or the rows of a matrix of characters."""
    if values.dtype.kind in "fiub":
        return values
    return np.array([str(text) for text in values], dtype=np.str_)
