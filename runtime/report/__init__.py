"""The HTML report: `write` makes one file to send to a colleague."""

from .page import ENDINGS, write

__all__ = ["ENDINGS", "write"]
