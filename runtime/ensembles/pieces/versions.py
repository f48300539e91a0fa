"""What the numbers of an ensemble depend on besides its arguments."""

import hashlib
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from importlib.resources import files
from importlib.resources.abc import Traversable

from ...simulation.solvers import native_version

# What derives nothing and draws nothing: the rest makes no numbers of an ensemble.
_PACKAGES = ("ensembles", "equations", "generated", "simulation", "systems")
_ENDINGS = (".py", ".c", ".h", ".json")

FILES = "files of kintrafo"
"""A text in place of the sources that determine numbers: development versions are alike."""


@cache
def versions() -> Mapping[str, str]:
    """Return versions by name, of this process."""
    return {
        "kintrafo": version("kintrafo"),
        FILES: _digest(),
        "NumPy": version("numpy"),
        "SciPy": version("scipy"),
        "SUNDIALS": native_version(),
    }


def differences(theirs: Mapping[str, str]) -> str:
    """Say which versions are others than here; nothing if none is."""
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
