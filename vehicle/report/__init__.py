"""The HTML report: `write` makes one file to send to a colleague."""

from .chapters import (
    Chapter,
    axle_chapter,
    compliance_chapter,
    elastokinematics_chapter,
    goals_chapter,
    loads_chapter,
    rest_chapter,
    ride_chapter,
    sheet_chapter,
    steady_turns_chapter,
    step_steer_chapter,
)
from .page import ENDINGS, write, write_chapters

__all__ = [
    "ENDINGS", "Chapter", "axle_chapter", "compliance_chapter", "elastokinematics_chapter",
    "goals_chapter", "loads_chapter", "rest_chapter", "ride_chapter", "sheet_chapter",
    "steady_turns_chapter", "step_steer_chapter", "write", "write_chapters",
]  # fmt: skip
