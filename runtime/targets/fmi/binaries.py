"""Shared libraries of a unit: compiled once for a model, and filled with the numbers of each."""

import hashlib
import shutil
import struct
import sys
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

from ...systems.compile.cache import appearing, cache_folder, damage, seal
from ...systems.compile.compiler import FLAGS, Compiler, CompilerError, find_compiler
from .sources import MARK

PLATFORMS = ("linux", "windows")
"""What there can be libraries for, all of them for processors of the kind x86-64."""

_MORE = (
    "-std=c11",
    "-fvisibility=hidden",
    "-ffunction-sections",
    "-fdata-sections",
    "-Wl,--gc-sections",
)
_MINGW = "x86_64-w64-mingw32-gcc"
_MARK_SIZE, _TOKEN_SIZE = 32, 64
_NO_COMPILER = (
    "there is no C compiler. Install one (on Debian: apt-get install gcc libc6-dev), or name one "
    "in CC; or export without libraries, platforms=(), for programs that compile the sources."
)
_NO_CROSS_COMPILER = (
    'a library for Windows needs a compiler for it: pip install "kintrafo[windows]", or on Debian '
    "apt-get install gcc-mingw-w64-x86-64. Or leave that platform out."
)


def library(
    sources: Mapping[str, str], name: str, platform: str, token: str, values: Sequence[float]
) -> bytes:
    """Return a shared library with some numbers.

    Parameters
    ----------
    sources : mapping
        C files by path, as of `sources.source_files`, with any numbers.
    name : str
        Of the model.
    platform : {'linux', 'windows'}
    token : str
    values : sequence of float

    Raises
    ------
    CompilerError
        If there is no compiler, or it fails.
    """
    return filled(_compiled(sources, name, platform), token, values)


def filled(content: bytes, token: str, values: Sequence[float]) -> bytes:
    """Return a library with other numbers behind its mark."""
    start = content.index(MARK.encode())
    assert content.count(MARK.encode()) == 1
    numbers = struct.pack(f"<{len(values)}d", *values)
    text = token.encode().ljust(_TOKEN_SIZE, b"\0") + numbers
    at = start + _MARK_SIZE
    return content[:at] + text + content[at + len(text) :]


def _compiled(sources: Mapping[str, str], name: str, platform: str) -> bytes:
    """Return the library of a model, from the cache or compiled now."""
    compiler = _compiler(platform)
    text = "\0".join((*sources, *sources.values(), *compiler.command, compiler.version))
    folder = cache_folder() / f"unit_{name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    file = f"{name}{'.dll' if platform == 'windows' else '.so'}"
    if damage(folder):
        with appearing(folder) as temporary:
            (temporary / file).write_bytes(_built(compiler, sources, temporary / "build", file))
            shutil.rmtree(temporary / "build")
            seal(temporary, folder.name)
    return (folder / file).read_bytes()


def _built(compiler: Compiler, sources: Mapping[str, str], folder: Path, file: str) -> bytes:
    for path, text in sources.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8", newline="\n")
    written = [folder / path for path in sources if path.endswith(".c")]
    compiler.build(written, folder / file)
    return (folder / file).read_bytes()


def _compiler(platform: str) -> Compiler:
    """Return what compiles for a platform."""
    if platform == "windows":
        return _cross_compiler()
    if platform not in sys.platform:
        message = f"a library for {platform} cannot be compiled on {sys.platform}. Leave it out."
        raise CompilerError(message)
    found = find_compiler()
    if found is None:
        raise CompilerError(_NO_COMPILER)
    return Compiler((*found.command, *_MORE, "-s"), found.version)


def _cross_compiler() -> Compiler:
    flags = tuple(flag for flag in FLAGS if flag != "-fPIC")
    if shutil.which(_MINGW):
        return Compiler((_MINGW, *flags, *_MORE, "-s", "-static-libgcc"), _MINGW)
    if find_spec("ziglang"):
        from importlib.metadata import version  # noqa: PLC0415 (only where it is installed)

        zig = (sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu")
        return Compiler((*zig, *flags, *_MORE, "-s"), f"ziglang {version('ziglang')}")
    raise CompilerError(_NO_CROSS_COMPILER)
