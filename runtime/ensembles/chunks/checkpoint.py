"""A folder with results of an ensemble, in which it is kept until it is complete.

`ensemble.json` identifies the ensemble; each other file has the results of some systems, and is
written completely or not at all. It is a file of NumPy (.npz) followed by the digest of its bytes.
"""

import hashlib
import io
import json
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.files import as_input_errors, replacing, write_text
from ..collected import Collected
from .chunk import ChunkResult, taken
from .cutting import Span
from .identity import Identity, identity_of

_NAME = "ensemble.json"
_FILE = re.compile(r"systems-(\d+)-(\d+)\.npz")

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Checkpoint:
    """A folder of one ensemble."""

    folder: Path
    ensemble: str  # digest of its identity
    collected: Collected  # whole, of which every file has a part

    def found(self) -> Iterator[ChunkResult]:
        """Yield the results in the folder; damaged files are left out with a warning.

        Raises `InputError` if a folder, or another entry that is not a file, has the name of one.
        """
        for path in sorted(self.folder.iterdir()):
            name = _FILE.fullmatch(path.name)
            if name is None:
                continue
            if not path.is_file():  # nor could it be replaced by one
                _refuse(path, "not a file, but named as a saved chunk. Remove it.")
            span = int(name[1]), int(name[2])
            try:
                yield self._found(span, _arrays_in(path.read_bytes()))
            except (OSError, ValueError):
                message = (
                    f"{path}: the saved chunk is damaged. Systems {span[0]} to {span[1]} are "
                    "simulated again."
                )
                warnings.warn(message, RuntimeWarning, stacklevel=2)

    def keep(self, found: ChunkResult) -> None:
        """Write the results of some systems."""
        name = f"systems-{found.first:09d}-{found.last:09d}.npz"
        content = io.BytesIO()
        np.savez(content, **self._arrays(found))  # type: ignore[arg-type]  # its names are data
        with replacing(self.folder / name, force=True) as temporary:
            temporary.write_bytes(content.getvalue() + _digest(content.getvalue()))

    def _arrays(self, found: ChunkResult) -> Arrays:
        """Return the arrays of a file by name."""
        return {
            "ensemble": np.array(self.ensemble),
            "systems": np.array([found.first, found.last]),
            "solvers": found.solvers,
            "samples": found.samples,
            "reasons": np.array(json.dumps([*found.reasons.items()])),
            **{f"outcome {name}": values for name, values in found.outcome.items()},
            **{f"series {place}": values for place, values in enumerate(found.of_series)},
        }

    def _found(self, span: Span, arrays: Arrays) -> ChunkResult:
        """Return the results of some systems; a ValueError if names, shapes or systems differ."""
        wanted = self._arrays(taken(self.collected, *span))
        if _layout(arrays) != _layout(wanted):
            raise ValueError(span)
        if (arrays["ensemble"].item(), tuple(arrays["systems"])) != (self.ensemble, span):
            raise ValueError(span)
        return ChunkResult(
            *span,
            outcome={
                name.removeprefix("outcome "): values
                for name, values in arrays.items()
                if name.startswith("outcome ")
            },
            samples=arrays["samples"],
            of_series=tuple(v for name, v in arrays.items() if name.startswith("series ")),
            solvers=arrays["solvers"],
            reasons=dict(json.loads(arrays["reasons"].item())),
        )


def _arrays_in(content: bytes) -> Arrays:
    """Return the arrays of a file; a ValueError if a bit of it has changed since."""
    whole, digest = content[:-_DIGEST_SIZE], content[-_DIGEST_SIZE:]
    if digest != _digest(whole):
        message = "its digest is another"
        raise ValueError(message)
    with np.load(io.BytesIO(whole), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).digest()


_DIGEST_SIZE = len(_digest(b""))


def _layout(arrays: Arrays) -> list[tuple[str, str, tuple[int, ...]]]:
    """Return names, types and shapes in their order; texts are of any length."""
    return [
        (name, "<U" if values.dtype.str.startswith("<U") else values.dtype.str, values.shape)
        for name, values in arrays.items()
    ]


def checkpoint_in(folder: str | Path, collected: Collected) -> Checkpoint:
    """Return the folder of an ensemble, created if there is none.

    Raises `InputError` if it is of another ensemble or has other contents, or cannot be read or
    written.
    """
    path, identity = Path(folder), identity_of(collected)
    with as_input_errors(path):
        if path.exists() and not path.is_dir():
            _refuse(path, "this is not a folder. Name a folder that is empty, or a new one.")
        there = {entry.name for entry in path.iterdir()} if path.exists() else set()
        if _NAME in there:
            _check(path, identity)
        elif there:
            _refuse(path, "other things are in this folder. Name one that is empty or not there.")
        else:
            write_text(path / _NAME, json.dumps(identity, indent=1), force=True)
    whole = json.dumps(identity, sort_keys=True).encode()
    return Checkpoint(path, hashlib.sha256(whole).hexdigest(), collected)


def _check(path: Path, identity: Identity) -> None:
    """Refuse the folder of another ensemble."""
    try:
        # reading a pipe would wait forever
        known: Any = json.loads((path / _NAME).read_bytes()) if (path / _NAME).is_file() else None
        other = [name for name, digest in identity.items() if known.get(name) != digest]
    except (ValueError, AttributeError, RecursionError):
        _refuse(path, f"{_NAME} in it is damaged. Name another folder, or remove this one.")
    if other:
        _refuse(
            path,
            f"this folder is of another ensemble, with other {', '.join(other)}. Name "
            "another folder, or remove this one.",
        )


def _refuse(path: Path, problem: str) -> None:
    raise InputError([f"kept: {problem}"], str(path))
