"""The HTML report: `write` makes one file to send to a colleague."""

from .chapters.axle import axle_chapter
from .chapters.chapter import Chapter
from .chapters.compliance import compliance_chapter, elastokinematics_chapter
from .chapters.goals import goals_chapter
from .chapters.handling import steady_turns_chapter, step_steer_chapter
from .chapters.loads import loads_chapter
from .chapters.rest import rest_chapter
from .chapters.ride import ride_chapter
from .chapters.sheet import sheet_chapter
from .page import ENDINGS, write, write_chapters

__all__ = [
    "ENDINGS", "Chapter", "axle_chapter", "compliance_chapter", "elastokinematics_chapter",
    "goals_chapter", "loads_chapter", "rest_chapter", "ride_chapter", "sheet_chapter",
    "steady_turns_chapter", "step_steer_chapter", "write", "write_chapters",
]  # fmt: skip
