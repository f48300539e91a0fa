"""The kinds of suspension, each in one file.

Importing `Suspension` from here registers all kinds.
"""

from importlib import import_module
from pkgutil import iter_modules

from ..corner.base import Suspension, known_kinds

__all__ = ["KINDS", "Suspension"]

for _found in iter_modules(__path__):
    import_module(f"{__name__}.{_found.name}")

KINDS: dict[str, type[Suspension]] = known_kinds()
"""The kinds by their names in files."""
