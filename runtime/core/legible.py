"""Text that every file, figure and terminal can show."""

import re
from typing import Any

# Control characters, and surrogates: bytes of a file's name that are not UTF-8 are such.
_STRANGE = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")
# The same without tabs and ends of lines.
_STRANGE_IN_TEXTS = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff]")
_MOST_KEYS = 20_000
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_BYTES = range(0xDC80, 0xDD00)  # Python's form of bytes from 0x80 on that are not UTF-8 (PEP 383)


def legible(text: str) -> str:
    r"""Return a text with escapes of Python for characters that cannot be shown, ends of lines too.

    Examples
    --------
    >>> print(legible("my car"), legible("caf\udce9"), legible("two\nlines"))
    my car caf\xe9 two\x0alines
    """
    return _STRANGE.sub(_escaped, text)


def short(text: str, most: int = 80) -> str:
    """Return a text, or its beginning if it has more than `most` characters.

    Examples
    --------
    >>> short("rate = 1" + 5000 * "0", most=16)
    'rate = 100000...'
    """
    return text if len(text) <= most else f"{text[: most - 3]}..."


def power_of_ten(exponent: int) -> str:
    """Return a power of ten as it is typeset.

    Examples
    --------
    >>> power_of_ten(-12)
    '10⁻¹²'
    """
    return f"10{str(exponent).translate(_SUPERSCRIPTS)}"


def readable(text: str) -> str:
    """Return a text of one or more lines with escapes for characters that cannot be shown."""
    return _STRANGE_IN_TEXTS.sub(_escaped, text)


def strange(data: Any) -> str:
    r"""Return a message if nested data have a text or key that cannot be shown; else an empty text.

    Data of more than 20,000 keys have a message, too: each key that is wrong costs one.

    Examples
    --------
    >>> print(strange({"name": ["a", "b\0"]}))
    the text 'b\x00' has a character that cannot be shown. Leave it out.
    """
    left, keys = [data], 0
    while left:
        item = left.pop()
        if isinstance(item, dict):
            keys += len(item)
            if keys > _MOST_KEYS:
                return f"there are more than {_MOST_KEYS} keys, which no such file needs."
            left += [*item.keys(), *item.values()]
        elif isinstance(item, list | tuple):
            left += item
        elif isinstance(item, str) and _STRANGE_IN_TEXTS.search(item):
            shown = short(legible(item))
            return f"the text '{shown}' has a character that cannot be shown. Leave it out."
    return ""


def _escaped(found: re.Match[str]) -> str:
    code = ord(found[0])
    if code in _BYTES:
        code -= 0xDC00
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}"
