"""Equations that were compiled on this machine, compiled for lanes at first use."""

import hashlib
from dataclasses import replace
from pathlib import Path
from types import ModuleType

from ...core.errors import InputError
from ...systems.compile.cache import appearing, damage, fingerprint, refuse_foreign, seal
from ...systems.compile.compiler import Compiler, find_compiler
from .options import OF_WIDTH, SCHEDULED

_HERE = Path(__file__).parent
# the source that compiles emitted equations for vectors, and its headers
READER, HEADERS = "model.c", ("follow.h", "vectors.h")


def is_own(equations: ModuleType) -> bool:
    """Return whether equations were compiled on this machine, and not with the project."""
    return not equations.__name__.startswith("kintrafo.")


def library_of(equations: ModuleType, width: int, part: str = "") -> Path:
    """Return the library of equations of `kintrafo.compile` in some lanes, compiled at first use.

    The processor supports `width` lanes; `part` is the suffix of the emitted file. Raises
    `InputError` if there is no compiler, the library cannot be written, or another user may have
    written to it; `CompilerError` if the compiler fails.
    """
    file = "_".join(filter(None, (equations.NAME, part)))
    compiler = _with_vectors(find_compiler(), file, width)
    folder = Path(str(equations.__file__)).parent
    name = f"{file}_lanes_{width}"
    key = fingerprint(f"{folder.name} {_digest()}", built_by=" ".join(compiler.command))
    target = folder.parent / f"{name}-{key}"
    library = f"lib{name}.so"
    if damage(target):
        with appearing(target) as temporary:
            emitted = (*folder.glob("*.c"), *folder.glob("*.h"))
            for text in (*emitted, *map(_HERE.joinpath, HEADERS)):
                (temporary / text.name).write_bytes(text.read_bytes())
            reader = temporary / f"_{READER}"  # no name of a model begins with an underscore
            reader.write_bytes((_HERE / READER).read_bytes())
            compiler.build([reader], temporary / library)
            seal(temporary, target.name)
    refuse_foreign(target)
    return target / library


def _with_vectors(compiler: Compiler | None, file: str, width: int) -> Compiler:
    """Return a compiler with its options for a file in some lanes."""
    if compiler is None:
        problem = (
            f"the equations of {file} are not compiled in lanes, and there is no C compiler to do "
            "that. Install one (on Debian: apt-get install gcc libc6-dev), or call simulate for "
            "each."
        )
        raise InputError([problem], "ensemble")
    scheduled = [] if "clang" in compiler.version else SCHEDULED
    macros = [f'-DMODEL="{file}.c"', f"-DWIDTH={width}"]
    options = (*compiler.command, *OF_WIDTH[width], *scheduled, *macros)
    return replace(compiler, command=options)


def _digest() -> str:
    """Return a hash of the files that compile equations for vectors."""
    texts = b"\0".join((_HERE / name).read_bytes() for name in (READER, *HEADERS))
    return hashlib.sha256(texts).hexdigest()
