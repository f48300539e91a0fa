"""Shared libraries of FMUs, each compiled once for a model and filled with numbers for each export.

Those of models that come with the project are compiled with it: for this machine by `setup.py`, for
Windows when a wheel is built (`.ci/fill.py`).
"""

import hashlib
import platform as machine
import shutil
import sys
from collections.abc import Mapping, Sequence
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from sysconfig import get_config_var

from ...systems.compile.cache import appearing, cache_folder, damage, seal
from ...systems.compile.compiler import FLAGS, Compiler, CompilerError, find_compiler
from .files import digest, filled, token_of

ENDINGS = {"linux": ".so", "windows": ".dll"}
"""Endings of the files of libraries by platform; all are for x86-64 processors."""
HERE = ("linux",) if (sys.platform, machine.machine()) == ("linux", "x86_64") else ()
"""The platform of this machine, if it is among them."""

_MORE = (
    "-std=c11",
    "-fvisibility=hidden",
    "-ffunction-sections",
    "-fdata-sections",
    "-Wl,--gc-sections",
    "-fno-lto",  # else a compiler folds the numbers as constants
)
_SHARED = ("-shared",)
_MINGW = "x86_64-w64-mingw32-gcc"
_NO_DATE = ("-Wl,--no-insert-timestamp",)  # the same library at any time
_NO_COMPILER = (
    "there is no C compiler. Install one (on Debian: apt-get install gcc libc6-dev), or name one "
    "in CC; or export without libraries (platforms=(), in a command --platform none), for programs "
    "that compile the sources."
)
_NO_CROSS_COMPILER = (
    'a library for Windows needs a compiler for it: pip install "kintrafo[windows]", or on Debian '
    "apt-get install gcc-mingw-w64-x86-64. Or leave that platform out."
)


def library(
    sources: Mapping[str, str], name: str, platform: str, token: str, values: Sequence[float]
) -> bytes:
    """Return a shared library with a token and numbers, compiled from C files by path.

    The files may have other numbers. A CompilerError is raised if a compiler is needed and there is
    none, or it fails.
    """
    made = shipped(sources, name, platform)
    return filled(made or compiled(sources, name, platform), token, values)


def shipped(sources: Mapping[str, str], name: str, platform: str) -> bytes | None:
    """Return the library for a platform that was compiled with this package, from these sources.

    The result is None if there is none, or one from other sources.
    """
    built_here = [get_config_var("EXT_SUFFIX")] if platform in HERE else []
    for ending in (*built_here, ENDINGS[platform]):
        file = files("kintrafo.generated") / f"_{name}_fmu{ending}"
        if file.is_file():
            content = file.read_bytes()
            if token_of(content) == digest(sources):
                return content
    return None


def compiled(sources: Mapping[str, str], name: str, platform: str) -> bytes:
    """Return the library of a model from the cache, or compile it."""
    compiler = _compiler(platform)
    text = "\0".join((digest(sources), *compiler.command, compiler.version))
    folder = cache_folder() / f"fmu_{name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    file = f"{name}{ENDINGS[platform]}"
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
    """Return the compiler for a platform."""
    if platform == "windows":
        return _cross_compiler()
    if platform not in HERE:
        message = (
            f"a library for {platform} and processors of the kind x86-64 cannot be compiled here, "
            f"on {sys.platform} {machine.machine()}. Leave that platform out."
        )
        raise CompilerError(message)
    found = find_compiler()
    if found is None:
        raise CompilerError(_NO_COMPILER)
    return Compiler((*found.command, *_MORE, "-s"), found.version)


def _cross_compiler() -> Compiler:
    flags = (*(flag for flag in FLAGS if flag != "-fPIC"), *_MORE, "-s")
    if find_spec("ziglang"):
        from importlib.metadata import version  # noqa: PLC0415 (only where it is installed)

        zig = (sys.executable, "-m", "ziglang", "cc", "-target", "x86_64-windows-gnu")
        return Compiler((*zig, *flags), f"ziglang {version('ziglang')}", _SHARED)
    if shutil.which(_MINGW):
        return Compiler((_MINGW, *flags, "-static-libgcc", *_NO_DATE), _MINGW, _SHARED)
    raise CompilerError(_NO_CROSS_COMPILER)
