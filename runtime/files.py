"""Writing files whole or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import InputError


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """Let a caller write a file that appears only when it is complete.

    Parameters
    ----------
    path : str or pathlib.Path
        The file to write; its folder is made if there is none. A file that is there already is
        replaced at the end, and stays as it was if anything goes wrong before.

    Yields
    ------
    pathlib.Path
        A temporary file in the same folder, with the same ending, to be written.

    Raises
    ------
    InputError
        If something that is no ordinary file is in the way.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with replacing(Path(folder) / "curves.csv") as temporary:
    ...         _ = temporary.write_text("camber [deg]")
    ...     [file.name for file in Path(folder).iterdir()]
    ['curves.csv']
    """
    # through a link, what it points to is replaced, and not the link
    target = Path(path).resolve()
    if target.exists() and not target.is_file():
        problem = "there is something here that is not a file. Give the name of a file to write."
        raise InputError([problem], str(path))
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.stem}-{os.getpid()}{target.suffix}")
    try:
        yield temporary
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def new_file(path: str | Path, *, ending: str, force: bool) -> Path:
    """Return the path of a file that may be written.

    Parameters
    ----------
    path : str or pathlib.Path
    ending : str
        What its name has to end in.
    force : bool
        Whether a file that is there already is replaced.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If there is a file already, or the name ends otherwise.
    """
    path = Path(path)
    if path.suffix != ending:
        problem = f"an input file ends in {ending}. Write {path.with_suffix(ending)}."
        raise InputError([problem], str(path))
    if path.exists() and not force:
        problem = "this file is there already. Choose another name, or force it to be replaced."
        raise InputError([problem], str(path))
    return path
