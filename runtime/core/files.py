"""Writing files completely or not at all, and never over those of other programs.

One rule holds for the whole package: an existing file is replaced only if kintrafo wrote it and it
has not changed since, or if it is empty, or with ``force``. A file that is read is never written,
and neither is anything that is not an ordinary file.
"""

import errno
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from . import interrupts, written
from .errors import InputError

Paths = Iterable[str | Path]

_REMEDIES = {
    errno.ENOSPC: "Make room, or choose another place.",
    errno.EDQUOT: "Make room, or choose another place.",
    errno.EACCES: "Choose a folder that you may write to.",
    errno.EPERM: "Choose a folder that you may write to.",
    errno.EROFS: "Choose a folder that you may write to.",
    errno.ENAMETOOLONG: "Choose a shorter name.",
}


@contextmanager
def replacing(path: str | Path, *, force: bool = False, inputs: Paths = ()) -> Iterator[Path]:
    """Yield a temporary file that replaces the target once it is complete.

    It has the same name, in a folder beside the target that no other user may enter. Where two
    programs write the same file at a time, each has a temporary one of its own. The folder of the
    target is created if necessary; of a link, the file it points to is written. An existing file
    stays as it was if anything goes wrong. It is replaced by `force` if kintrafo did not write it;
    `inputs` are files that are read, and never replaced. Raises `InputError` if the file must not
    be written (see `refuse`), or the system does not allow it.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with replacing(Path(folder) / "curves.csv") as temporary:
    ...         _ = temporary.write_text("camber [deg]")
    ...     [file.name for file in Path(folder).iterdir()]
    ['curves.csv']
    """
    _, read = _paths([path], inputs, force)  # `inputs` may be an iterator, and is used twice
    refuse([path], force=force, inputs=read)
    with as_input_errors(path):
        target = _resolved(Path(path))
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = None  # with an unpredictable name and access for this user alone
        try:
            with interrupts.held():
                folder = Path(tempfile.mkdtemp(prefix=".kintrafo-", dir=target.parent))
            temporary = folder / target.name
            yield temporary
            # nor is a file replaced that has appeared in the meantime
            refuse([path], force=force, inputs=read)
            interrupts.check()
            with interrupts.held():
                if target.exists():
                    shutil.copymode(target, temporary)
                written.note(target, temporary)
                temporary.replace(target)
        finally:
            with interrupts.held():
                if folder:
                    shutil.rmtree(folder, ignore_errors=True)


def write_text(path: str | Path, text: str, *, force: bool = False, inputs: Paths = ()) -> Path:
    """Write a file of text by the rules of `replacing`, and return its path."""
    with replacing(path, force=force, inputs=inputs) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return Path(path)


def refuse(
    paths: Paths, *, force: bool = False, inputs: Paths = (), endings: Sequence[str] = ()
) -> None:
    """Refuse to write files that kintrafo may not replace, with all problems in one `InputError`.

    A file is refused if it exists and is neither empty nor as kintrafo wrote it, without `force`;
    if it is one of the `inputs`, which are read; if it is not an ordinary file; if its name is
    given twice, or has none of the `endings`.
    """
    wanted, read = _paths(paths, inputs, force)
    found = {}
    named: set[Path] = set()
    for path in wanted:
        with as_input_errors(path):
            whole = _resolved(path)
            problem = _wrong_ending(path, endings) or _in_the_way(whole, force, read)
            problem = problem or ("it is named twice." if whole in named else "")
            named.add(whole)
        if problem:
            found[str(path)] = problem
    if len(found) > 1:
        raise InputError([f"{given}: {problem}" for given, problem in found.items()], "output")
    for given, problem in found.items():
        raise InputError([problem], given)


def _kind(value: object) -> str:
    return "None" if value is None else type(value).__name__


def _paths(paths: Paths, inputs: Paths, force: object) -> tuple[list[Path], list[str | Path]]:
    """Return the files that are written and those that are read; refuse objects that are not paths.

    A text would be one path for each of its letters. (`Validator` is slow to load, and commands
    that only print their help import this file.)
    """
    listed = {"path": _listed(paths), "inputs": _listed(inputs)}
    problems = [
        f"{name}: {_kind(wrong)} is not the path of a file, such as 'out/curves.csv'."
        for name, some in listed.items()
        for wrong in some
        if not isinstance(wrong, str | os.PathLike)
    ]
    problems += [
        f"{name}: a list of paths is needed, not a text."
        for name, some in (("path", paths), ("inputs", inputs))
        if isinstance(some, str | bytes)
    ]
    if type(force).__name__ not in ("bool", "bool_"):  # NumPy's, too
        problems.append(f"force: True or False is needed, not {_kind(force)}.")
    if problems:
        raise InputError(problems, "output")
    return [Path(path) for path in listed["path"]], listed["inputs"]


def _listed(some: Paths) -> list[str | Path]:
    """Return the elements of a list, or the argument if it is not one."""
    try:
        return list(some)
    except TypeError:
        return [some]  # type: ignore[list-item]  # refused by its type


def _resolved(path: Path) -> Path:
    """Return the location of a file, with all links resolved."""
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "a zero byte is not allowed in a name")
    try:
        return path.resolve()
    except RuntimeError as error:  # pathlib's, before Python 3.13, of links that lead in a circle
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP)) from error


def _wrong_ending(path: Path, endings: Sequence[str]) -> str:
    if not endings or path.suffix.lower() in endings:
        return ""
    named = path.with_suffix(endings[0]) if path.name else f"a name that ends in {endings[0]}"
    return f"the name of this file must end in {' or '.join(endings)}. Write {named}."


def _in_the_way(target: Path, force: bool, inputs: Paths) -> str:
    """Return why a file must not be replaced; empty if it may."""
    if not target.exists():
        return ""
    if not target.is_file():
        return "there is something here that is not a file. Give the name of a file to write."
    if any(Path(read).exists() and target.samefile(read) for read in inputs):
        return "this file is read here, and would be lost. Choose another name."
    if force or target.stat().st_size == 0 or written.known(target):
        return ""
    return (
        "this file exists already, and is not unchanged output of kintrafo. Choose another name, "
        "or have it replaced: --force (in Python: force=True)."
    )


@contextmanager
def as_input_errors(path: str | Path, what: str = "cannot be written") -> Iterator[None]:
    """Raise an `InputError` about a file and the failed operation instead of any `OSError`."""
    try:
        yield
    except OSError as error:
        raise InputError([f"{what}: {reason(error)}"], str(path)) from error


def reason(error: OSError) -> str:
    """Return the message of the system, and advice, as sentences."""
    said = error.strerror or str(error) or type(error).__name__
    remedy = _REMEDIES.get(error.errno or 0, "Check its name and folder.")
    return f"{said.rstrip('.')}. {remedy}"
