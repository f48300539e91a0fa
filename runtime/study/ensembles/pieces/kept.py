"""A folder in which what was found of an ensemble is kept until all of it is there.

`ensemble.json` tells which ensemble it is of; each other file is what was found of some systems,
written whole or not at all.
"""

import hashlib
import io
import json
import re
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ....core.errors import InputError
from ....core.files import replacing, told
from .cutting import Span
from .identity import Identity
from .piece import Found

_NAME = "ensemble.json"
_FILE = re.compile(r"systems-(\d+)-(\d+)\.npz")
_DAMAGED = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error)


@dataclass(frozen=True)
class Kept:
    """A folder of one ensemble.

    Attributes
    ----------
    folder : Path
    ensemble : str
        A digest of all that it is known by.
    """

    folder: Path
    ensemble: str

    def found(self) -> Iterator[Found]:
        """Yield what is there; what is damaged is told of as a warning, and left out.

        Raises
        ------
        InputError
            If something that is no file has the name of one.
        """
        for path in sorted(self.folder.iterdir()):
            name = _FILE.fullmatch(path.name)
            if name is None:
                continue
            if not path.is_file():  # nor could it be replaced by one
                _refuse(path, "this is no file, where one is kept. Remove it.")
            try:
                yield self._read(path, (int(name[1]), int(name[2])))
            except _DAMAGED:
                message = (
                    f"{path}: what was kept is damaged. Systems {name[1]} to {name[2]} are "
                    "simulated again."
                )
                warnings.warn(message, RuntimeWarning, stacklevel=2)

    def keep(self, found: Found) -> None:
        """Keep what was found of some systems."""
        arrays: dict[str, Any] = {
            "ensemble": np.array(self.ensemble),
            "systems": np.array([found.first, found.last]),
            "solvers": found.solvers,
            "samples": found.samples,
            "reasons": np.array(json.dumps([*found.reasons.items()])),
            **{f"outcome {name}": values for name, values in found.outcome.items()},
            **{f"series {place}": values for place, values in enumerate(found.of_series)},
        }
        name = f"systems-{found.first:09d}-{found.last:09d}.npz"
        with replacing(self.folder / name, force=True) as temporary:
            np.savez(temporary, **arrays)

    def _read(self, path: Path, span: Span) -> Found:
        """Return what a file has; a `ValueError` if it is damaged."""
        content = path.read_bytes()
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            if archive.testzip() is not None:
                raise ValueError(path)
        with np.load(io.BytesIO(content), allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
        if (arrays["ensemble"].item(), tuple(arrays["systems"])) != (self.ensemble, span):
            raise ValueError(path)
        series = sum(name.startswith("series ") for name in arrays)
        return Found(
            *span,
            outcome={
                name.removeprefix("outcome "): values
                for name, values in arrays.items()
                if name.startswith("outcome ")
            },
            samples=arrays["samples"],
            of_series=tuple(arrays[f"series {place}"] for place in range(series)),
            solvers=arrays["solvers"],
            reasons=dict(json.loads(arrays["reasons"].item())),
        )


def kept_in(folder: str | Path, identity: Identity) -> Kept:
    """Return the folder of an ensemble, made if there is none.

    Raises
    ------
    InputError
        If it is the folder of another ensemble or of something else, or the system does not let it
        be read or written.
    """
    path = Path(folder)
    with told(path):
        if path.exists() and not path.is_dir():
            _refuse(path, "this is no folder. Name a folder that is empty, or that is not there.")
        there = {entry.name for entry in path.iterdir()} if path.exists() else set()
        if _NAME in there:
            _check(path, identity)
        elif there:
            _refuse(path, "other things are in this folder. Name one that is empty or not there.")
        else:
            with replacing(path / _NAME, force=True) as temporary:
                temporary.write_text(json.dumps(identity, indent=1), encoding="utf-8")
    whole = json.dumps(identity, sort_keys=True).encode()
    return Kept(path, hashlib.sha256(whole).hexdigest())


def _check(path: Path, identity: Identity) -> None:
    """Refuse the folder of another ensemble."""
    try:
        # a pipe would keep whoever reads it waiting
        known: Any = json.loads((path / _NAME).read_bytes()) if (path / _NAME).is_file() else None
        other = [name for name, digest in identity.items() if known.get(name) != digest]
    except (ValueError, AttributeError, RecursionError):
        _refuse(path, f"{_NAME} in it is damaged. Name another folder, or remove this one.")
    if other:
        _refuse(
            path,
            f"what is kept here is of another ensemble, with other {', '.join(other)}. Name "
            "another folder, or remove this one.",
        )


def _refuse(path: Path, problem: str) -> None:
    raise InputError([f"kept: {problem}"], str(path))
