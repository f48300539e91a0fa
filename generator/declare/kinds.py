"""Kinds of a thing, each in a file of its own in one folder."""

from __future__ import annotations

import pkgutil
from importlib import import_module
from inspect import isclass


def defined_in(package: str) -> list[type]:
    """Return the classes that the files of a package define, without its ``__init__``."""
    files = (found.name for found in pkgutil.iter_modules(import_module(package).__path__))
    modules = [import_module(f"{package}.{name}") for name in files]
    return [
        c for m in modules for c in vars(m).values() if isclass(c) and c.__module__ == m.__name__
    ]
