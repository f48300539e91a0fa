"""The format of a file of another program, from its ending and its content."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Literal

from ...core.errors import InputError
from ...core.reading import MOST_OF_MEASUREMENTS, bytes_of
from . import point_table

Format = Literal["adams", "chrono", "table"]
NAMES: Mapping[Format, str] = {
    "adams": "a subsystem of Adams/Car",
    "chrono": "a file of Project Chrono",
    "table": "a table of hardpoints",
}
"""Descriptions of the imported formats."""

# The reader of a format refuses files that it cannot read: XML, data sets of Adams/Solver, and
# other spreadsheets than those of `point_table`.
_BY_ENDING: Mapping[str, Format] = {
    ".json": "chrono",
    **dict.fromkeys((".sub", ".adm", ".xml"), "adams"),
    **dict.fromkeys((*point_table.ENDINGS, ".xls", ".ods", ".shk"), "table"),
}
_TEIM_ORBIT = re.compile(
    rb"^\s*\[\s*(MDI_HEADER|SUBSYSTEM_HEADER|UNITS)\s*\]", re.IGNORECASE | re.MULTILINE
)
_JSON = re.compile(rb"(?s)(\xef\xbb\xbf)?(\s|//[^\n]*+\n|/\*.*?\*/)*+\{")


def format_of(path: str | Path) -> Format:
    """Return the format of an imported file: 'adams', 'chrono' or 'table'.

    It follows from the ending, and from the content if the ending is ``.txt`` or unknown.
    """
    file = Path(path)
    ending = file.suffix.lower()
    if ending == ".toml":
        problem = "this is a hardpoint file already. Copy it, or name it after --from."
        raise InputError([problem], str(path))
    known = _BY_ENDING.get(ending)
    if known is not None and ending != ".txt":
        return known
    content = bytes_of(file, MOST_OF_MEASUREMENTS)
    if _TEIM_ORBIT.search(content):
        return "adams"
    if known is None and _JSON.match(content):
        return "chrono"
    if known is None:
        problem = (
            "neither its ending nor its content is known. Files that are imported: subsystems of "
            "Adams/Car as text (.sub), suspensions of Project Chrono (.json), and tables of "
            f"hardpoints ({', '.join(point_table.ENDINGS)})."
        )
        raise InputError([problem], str(path))
    return known
