"""The kinds of suspension: a file each, which is all that there is to do for another one.

`Suspension` is taken from here, so that every reader of files knows all of its kinds.
"""

from importlib import import_module
from pkgutil import iter_modules

from ..corner.base import Suspension, known_kinds

__all__ = ["KINDS", "Suspension"]

for _found in iter_modules(__path__):
    import_module(f"{__name__}.{_found.name}")

KINDS: dict[str, type[Suspension]] = known_kinds()
"""By the names that a file calls them."""
