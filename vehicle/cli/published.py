"""The JSON Schema of all input files, manoeuvres included, and its reference page.

``python -m kintrafo.vehicle.cli.published SCHEMA PAGE`` writes both.
"""

import sys
from pathlib import Path

from ..analysis.handling import MANOEUVRES
from ..files.schema import page_text, schema_text


def published() -> tuple[str, str]:
    """Return the texts of the schema and of the page."""
    return schema_text(MANOEUVRES), page_text(MANOEUVRES)


if __name__ == "__main__":
    for name, content in zip(sys.argv[1:], published(), strict=True):
        Path(name).write_text(content, encoding="utf-8", newline="\n")
