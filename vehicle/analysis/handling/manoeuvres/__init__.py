"""Manoeuvres: one module each, with the keys of its file.

A further manoeuvre is a module with a class that has a key ``manoeuvre``, its line in `loading`,
and a packaged file.
"""

from .loading import MANOEUVRES, load_manoeuvre
from .manoeuvre import Manoeuvre

__all__ = ["MANOEUVRES", "Manoeuvre", "load_manoeuvre"]
