"""The C files that are the same in every FMU, and the mark in a compiled library.

`setup.py` reads this file, too: it imports only the standard library.
"""

import hashlib
import struct
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

MARK = "kintrafo: numbers of a model"
_MARK_SIZE, _TOKEN_SIZE = 32, 64

EQUATIONS = "equations"
"""Folder of the emitted files."""

_CORE = ("dead_points.c", "derivatives.c", "instance.c", "instance.h", "model.h", "steps.c")
# The integrators that do not need SUNDIALS.
_NATIVE = (
    "dormand_prince.c", "dormand_prince.h", "eigenvalues.c", "eigenvalues.h", "fixed_step.c",
    "fixed_step.h", "integrate.c", "integrate.h", "margins.c", "margins.h", "number.h", "pieces.h",
    "polynomial.h", "powers.h", "rk4.c", "rodasp.c", "rodasp.h", "roots.c", "roots.h", "trust.h",
    "worker.h",
)  # fmt: skip
HEADERS = {
    "fmi2.c": ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"),
    "fmi3.c": ("fmi3Functions.h", "fmi3FunctionTypes.h", "fmi3PlatformTypes.h"),
}
"""The C file of each version of FMI, and the headers of the standard that it includes."""


def common_files(here: Any, native: Any, fronts: Iterable[str]) -> dict[str, Any]:
    """Return the files of every FMU by path below ``sources``, with fronts from `HEADERS`.

    `here` is this folder, and `native` that of the integrators in C.
    """
    chosen = list(fronts)
    headers = [header for front in chosen for header in HEADERS[front]]
    return {
        **{name: here / "core" / name for name in (*_CORE, *chosen)},
        **{name: here / "headers" / name for name in headers},
        **{name: native / name for name in _NATIVE},
    }


def digest(texts: Mapping[str, str]) -> str:
    """Return a hash of C files by name, which does not depend on their order."""
    parts = (part for name in sorted(texts) for part in (name, texts[name]))
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:32]


def filled(content: bytes, token: str, values: Sequence[float] = ()) -> bytes:
    """Return a library with another token and other numbers, which follow its mark."""
    numbers = struct.pack(f"<{len(values)}d", *values)
    text = token.encode().ljust(_TOKEN_SIZE, b"\0") + numbers
    at = _behind_mark(content)
    return content[:at] + text + content[at + len(text) :]


def token_of(content: bytes) -> str:
    """Return the token of a library; an empty text for a file without the mark."""
    if MARK.encode() not in content:
        return ""
    at = _behind_mark(content)
    return content[at : at + _TOKEN_SIZE].rstrip(b"\0").decode("ascii", errors="replace")


def _behind_mark(content: bytes) -> int:
    assert content.count(MARK.encode()) == 1
    return content.index(MARK.encode()) + _MARK_SIZE
