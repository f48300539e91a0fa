"""The C compiler of this machine."""

import os
import shlex
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ...core.errors import KintrafoError
from ...core.interrupts import held

_LEVEL = "-O2"
# The flags of the models that come with the project: no errno, so that roots become single
# instructions; no contraction into fused operations, so that every machine computes the same bits;
# no vectors of neighbouring statements: GCC finds hardly any, and most of its time is the search.
FLAGS = (
    "-std=c99",
    _LEVEL,
    "-fno-tree-slp-vectorize",
    "-fno-math-errno",
    "-ffp-contract=off",
    "-fPIC",
)
# Derivatives that are cut into pieces: GCC takes two thirds of the time of -O2, the bits are the
# same, and calls take 0.94 to 1.15 times as long (two driving cars). Other functions take up to a
# quarter longer.
_OF_LONG = "-O1"
_LONG = 2_000_000  # bytes of a source
_LINK_FLAGS = ("-dynamiclib",) if sys.platform == "darwin" else ("-shared",)
_SHOWN_LINES = 12
_LOOKED_AT_S = 0.02  # time between two checks whether compilers have ended


class CompilerError(KintrafoError, RuntimeError):
    """The C compiler is missing, or did not compile an emitted model."""


@dataclass(frozen=True)
class Compiler:
    """A C compiler with the options of GCC."""

    command: tuple[str, ...]  # program and options
    version: str  # first line of its version message
    # options of a shared library; by default those of this system
    linking: tuple[str, ...] = _LINK_FLAGS

    def build(
        self, sources: Sequence[Path], library: Path, done: Callable[[int], None] | None = None
    ) -> None:
        """Compile sources, C files in one folder, into a shared library, on all cores.

        After an interruption or an error the other compilers are ended at once, and their files
        removed. `done` is called with the number of compiled sources after each. Raises
        `CompilerError` with the command and the output of the compiler.
        """
        objects = [source.with_suffix(".o") for source in sources]
        parts: list[tuple[str | Path, ...]] = [
            (*self._options(c), "-c", c, "-o", o) for c, o in zip(sources, objects, strict=True)
        ]
        # a compiler that is killed leaves its own temporary files behind
        with tempfile.TemporaryDirectory(dir=library.parent, prefix=".compiling-") as folder:
            try:
                self._run(parts, folder, done or (lambda _: None))
                self._run([(*self.linking, *objects, "-o", library, "-lm")], folder)
            except BaseException:
                library.unlink(missing_ok=True)
                raise
            finally:
                for made in objects:
                    made.unlink(missing_ok=True)

    def _options(self, source: Path) -> tuple[str, ...]:
        """Return the options of a source in addition to those of all sources."""
        long = source.stem.endswith("_derivatives") and source.stat().st_size > _LONG
        levels = [word for word in self.command if word.startswith("-O")]
        return (_OF_LONG,) if long and levels[-1:] == [_LEVEL] else ()

    def _run(
        self,
        calls: Iterable[Sequence[str | Path]],
        folder: str,
        done: Callable[[int], None] = lambda _: None,
    ) -> None:
        """Call the compiler with several lists of arguments, on all cores."""
        waiting, running, count = list(calls)[::-1], list[_Running](), 0
        try:
            while waiting or running:
                while waiting and len(running) < (os.cpu_count() or 1):
                    words = [*self.command, *map(str, waiting.pop())]
                    with held():
                        running.append(_Running.of(words, folder))
                with suppress(subprocess.TimeoutExpired):  # another one may end earlier
                    running[0].process.wait(_LOOKED_AT_S)
                for ended in [one for one in running if one.process.poll() is not None]:
                    running.remove(ended)
                    ended.check()
                    count += 1
                    done(count)
        finally:
            for one in running:
                one.stop()


@dataclass(frozen=True)
class _Running:
    """A running compiler."""

    command: list[str]
    # first of a process group of its own, which includes its children
    process: "subprocess.Popen[str]"
    output: IO[str]  # messages

    @classmethod
    def of(cls, command: list[str], folder: str) -> "_Running":
        """Start a compiler with its temporary files in a folder."""
        output = tempfile.TemporaryFile("w+", errors="backslashreplace", dir=folder)  # noqa: SIM115 (open as long as it runs)
        try:
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                text=True,
                env=os.environ | {"TMPDIR": folder},
                process_group=0 if os.name == "posix" else None,
            )
        except OSError as error:
            output.close()
            message = f"{command[0]} cannot be run: {error.strerror}. Name a C compiler in CC."
            raise CompilerError(message) from error
        return cls(command, process, output)

    def check(self) -> None:
        """Raise a CompilerError if the compiler failed."""
        with self.output as file:
            file.seek(0)
            lines = file.read().splitlines()
        if self.process.returncode != 0:
            shown = "\n".join(lines[:_SHOWN_LINES])
            # gcc itself ends with 1 if the compiler proper is killed
            killed = self.process.returncode < 0 or any("Killed" in line for line in lines)
            remedy = (
                "It was killed, as Linux does when memory runs out. End other programs"
                if killed
                else "Name another compiler in the variable CC"
            )
            message = (
                f"the C compiler ended with exit code {self.process.returncode}:\n"
                f"  {shlex.join(self.command)}\n{shown}\n"
                f'{remedy}, or use backend="numpy".'
            )
            raise CompilerError(message)

    def stop(self) -> None:
        """End the compiler with its children, since gcc is a driver of the compiler proper."""
        with self.output:
            if os.name == "posix":
                with suppress(ProcessLookupError):  # it has ended meanwhile
                    os.killpg(self.process.pid, signal.SIGKILL)
            else:
                self.process.kill()
            self.process.wait()


def find_compiler() -> Compiler | None:
    """Return the compiler that ``CC`` names, or else the first installed one; None without any.

    Options in ``CFLAGS`` follow those of this project. Raises `CompilerError` if ``CC`` names a
    program that does not exist, or a variable has an unclosed quotation mark.
    """
    named, more = _words_of("CC"), _words_of("CFLAGS")
    built_by = (sysconfig.get_config_var("CC") or "").split()
    for words in [named] if named else [built_by, ["cc"], ["gcc"], ["clang"]]:
        if words and shutil.which(words[0]):
            options = (*words[1:], *FLAGS, *more)
            shown = subprocess.run(
                [words[0], "--version"], capture_output=True, text=True, check=False
            )
            version = (shown.stdout or shown.stderr).partition("\n")[0]
            return Compiler((words[0], *options), version)
    if named:
        message = (
            f"CC = {shlex.join(named)}: there is no such program. Name a C compiler, or unset CC."
        )
        raise CompilerError(message)
    return None


def _words_of(variable: str) -> list[str]:
    """Return the words of an environment variable."""
    text = os.environ.get(variable, "")
    try:
        return shlex.split(text)
    except ValueError as error:  # "No closing quotation", "No escaped character"
        problem = f"{variable} = {text}: {str(error).lower()}. Close the quotation, or unset it."
        raise CompilerError(problem) from error
