"""The HTML report: `write` makes one file to send to a colleague."""

from .chapters import (
    Chapter,
    axle_chapter,
    compliance_chapter,
    elastokinematics_chapter,
    loads_chapter,
)
from .page import ENDINGS, write

__all__ = [
    "ENDINGS",
    "Chapter",
    "axle_chapter",
    "compliance_chapter",
    "elastokinematics_chapter",
    "loads_chapter",
    "write",
]
