"""Versions on which the numbers of an ensemble depend."""

import hashlib
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable

from ...simulation.solvers import native_version

# Folders whose code computes the numbers of an ensemble.
_PACKAGES = ("ensembles", "equations", "generated", "simulation", "systems")
_ENDINGS = (".py", ".c", ".h", ".json")

FILES = "files of kintrafo"
"""Name of the digest of the sources, since development versions may share a version number."""


@cache
def versions() -> Mapping[str, str]:
    """Return versions of this process by name."""
    return {
        "kintrafo": version("kintrafo"),
        FILES: _digest(),
        "NumPy": version("numpy"),
        "SciPy": version("scipy"),
        "SUNDIALS": native_version(),
    }


def differences(theirs: Mapping[str, str]) -> str:
    """Return which versions differ from those of this process; empty if none does."""
    lines = [
        f"other {name}" if name == FILES else f"{name} {theirs.get(name)} instead of {own}"
        for name, own in versions().items()
        if theirs.get(name) != own
    ]
    return ", ".join(lines)


def _digest() -> str:
    digest = hashlib.sha256()
    for package in _PACKAGES:
        _add(digest, files(f"kintrafo.{package}"))
    return digest.hexdigest()


def _add(digest: "hashlib._Hash", folder: Traversable) -> None:
    for entry in sorted(folder.iterdir(), key=lambda entry: entry.name):
        if entry.is_dir():
            _add(digest, entry)
        elif entry.name.endswith(_ENDINGS):
            digest.update(entry.name.encode() + b"\0" + entry.read_bytes())
