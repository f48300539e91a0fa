"""The HTML report: `write` makes one file to send to a colleague."""

from .page import write

__all__ = ["write"]
