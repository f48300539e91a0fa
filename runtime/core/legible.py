"""Text that every file, figure and terminal can show."""

import re

# Control characters, and halves of characters: bytes of a file's name that are not UTF-8 are such.
_STRANGE = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")
_BYTES = range(0xDC80, 0xDD00)  # how Python keeps bytes from 0x80 on that are not UTF-8 (PEP 383)


def legible(text: str) -> str:
    r"""Return a text with what cannot be shown as Python would write it.

    Parameters
    ----------
    text : str

    Returns
    -------
    str

    Examples
    --------
    >>> print(legible("my car"), legible("caf\udce9"), legible("two\nlines"))
    my car caf\xe9 two\x0alines
    """
    return _STRANGE.sub(_escaped, text)


def short(text: str, most: int = 80) -> str:
    """Return the beginning of a text that nobody would read to its end.

    Parameters
    ----------
    text : str
    most : int, optional
        So many characters are the most.

    Returns
    -------
    str

    Examples
    --------
    >>> short("rate = 1" + 5000 * "0", most=16)
    'rate = 100000...'
    """
    return text if len(text) <= most else f"{text[: most - 3]}..."


def _escaped(found: re.Match[str]) -> str:
    code = ord(found[0])
    if code in _BYTES:
        code -= 0xDC00
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
