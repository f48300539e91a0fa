"""``python -m kintrafo``."""

from .cli import run

run()
