"""The C compiler of this machine, as far as an emitted model needs one."""

import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from ...core.errors import KintrafoError

# As of the models that come with the project: no errno, so that roots become single instructions;
# no contraction into fused operations, so that every machine computes the same bits. No vectors
# out of neighbouring statements: GCC finds hardly any, and looks for them longer than for all else.
FLAGS = (
    "-std=c99",
    "-O2",
    "-fno-tree-slp-vectorize",
    "-fno-math-errno",
    "-ffp-contract=off",
    "-fPIC",
)
_LINK_FLAGS = ("-dynamiclib",) if sys.platform == "darwin" else ("-shared",)
_SHOWN_LINES = 12


class CompilerError(KintrafoError, RuntimeError):
    """The C compiler is missing, or did not compile an emitted model."""


@dataclass(frozen=True)
class Compiler:
    """A C compiler that takes the options of GCC.

    Attributes
    ----------
    command : tuple of str
        Program and options.
    version : str
        First line of what it says about itself.
    """

    command: tuple[str, ...]
    version: str

    def build(self, sources: Sequence[Path], library: Path) -> None:
        """Compile sources, side by side, into a shared library.

        Parameters
        ----------
        sources : sequence of Path
            C files, in one folder.
        library : Path
            What to write.

        Raises
        ------
        CompilerError
            With the command and what the compiler said.
        """
        objects = [source.with_suffix(".o") for source in sources]
        parts = [("-c", c, "-o", o) for c, o in zip(sources, objects, strict=True)]
        with ThreadPoolExecutor() as pool:
            list(pool.map(self._run, parts))  # a list, so that errors show
        self._run((*_LINK_FLAGS, *objects, "-o", library, "-lm"))
        for made in objects:
            made.unlink()

    def _run(self, arguments: Iterable[str | Path]) -> None:
        command = [*self.command, *map(str, arguments)]
        try:
            done = subprocess.run(
                command,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="backslashreplace",
                check=False,
            )
        except OSError as error:
            message = f"{command[0]} cannot be run: {error.strerror}. Name a C compiler in CC."
            raise CompilerError(message) from error
        if done.returncode != 0:
            said = "\n".join(done.stdout.splitlines()[:_SHOWN_LINES])
            message = (
                f"the C compiler ended with exit code {done.returncode}:\n"
                f"  {shlex.join(command)}\n{said}\n"
                'Name another compiler in the variable CC, or use backend="numpy".'
            )
            raise CompilerError(message)


def find_compiler() -> Compiler | None:
    """Return the compiler that ``CC`` names, or else the first that is installed.

    Options in ``CFLAGS`` come behind those of this project.

    Returns
    -------
    Compiler or None
        None where there is none.

    Raises
    ------
    CompilerError
        If ``CC`` names a program that there is not, or one of the variables has a quotation mark
        that nothing closes.
    """
    named, more = _words_of("CC"), _words_of("CFLAGS")
    built_by = (sysconfig.get_config_var("CC") or "").split()
    for words in [named] if named else [built_by, ["cc"], ["gcc"], ["clang"]]:
        if words and shutil.which(words[0]):
            options = (*words[1:], *FLAGS, *more)
            return Compiler((words[0], *options), _version(words[0]))
    if named:
        message = (
            f"CC = {shlex.join(named)}: there is no such program. Name a C compiler, or unset CC."
        )
        raise CompilerError(message)
    return None


def _words_of(variable: str) -> list[str]:
    """Return what an environment variable says, word by word."""
    text = os.environ.get(variable, "")
    try:
        return shlex.split(text)
    except ValueError as error:  # "No closing quotation", "No escaped character"
        problem = f"{variable} = {text}: {str(error).lower()}. Close the quotation, or unset it."
        raise CompilerError(problem) from error


def _version(program: str) -> str:
    said = subprocess.run([program, "--version"], capture_output=True, text=True, check=False)
    return (said.stdout or said.stderr).partition("\n")[0]
