"""Reading files of users and of other programs: limits of size, and decoding.

A file of a suspension has some thousand bytes, and a measurement of an hour at 1 kHz some ten
million. The limits for all readers are here.
"""

import os
from importlib.resources.abc import Traversable
from pathlib import Path

from .errors import InputError
from .files import reason

MIB = 1 << 20
MOST_OF_DATA = 4 * MIB
"""Most bytes of a file that describes a suspension or a study: TOML, JSON, TeimOrbit, points."""
MOST_OF_MEASUREMENTS = 256 * MIB
"""Most bytes of a table of measurements."""


def is_path(text: str) -> bool:
    """Return whether a text, of any length, is the path of a file or folder that exists."""
    return os.path.exists(text)  # noqa: PTH110 (that of pathlib takes no text longer than a path)


def bytes_of(file: str | Path | Traversable, most: int = MOST_OF_DATA) -> bytes:
    """Return the contents of a file; InputError if it is unreadable or exceeds `most` bytes."""
    try:
        with (Path(file) if isinstance(file, str) else file).open("rb") as opened:
            content: bytes = opened.read(most + 1)
    except OSError as error:
        raise InputError([f"The file cannot be read: {reason(error)}"], str(file)) from None
    except ValueError:  # a name with a zero byte in it
        raise InputError(["No name of a file has a zero byte in it."], str(file)) from None
    if len(content) > most:
        problem = (
            f"The file has more than {most // MIB} MiB, which no such file needs. Give another one."
        )
        raise InputError([problem], str(file))
    return content


def text_of(file: str | Path | Traversable, most: int = MOST_OF_DATA) -> str:
    """Return the text of a UTF-8 file, without the byte order mark of some Windows editors.

    Raises `InputError` if it cannot be read, has more than `most` bytes or is not a text in UTF-8.
    """
    content = bytes_of(file, most)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        problem = (
            f"Line {line} has a character that is not UTF-8. Save the file with UTF-8 encoding."
        )
        raise InputError([problem], str(file)) from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        problem = f"Line {line} has a zero byte, so it is not a text. Save it as plain text."
        raise InputError([problem], str(file))
    return text
