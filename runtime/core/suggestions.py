"""Guessing the name that was meant by a misspelt one."""

import difflib
from collections.abc import Iterable

_LONGEST = 100  # characters of a name: what is longer was never meant to be one


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known name that resembles a word most.

    Parameters
    ----------
    word : str
        What was written.
    known : iterable of str
        The names that would have been right.

    Returns
    -------
    str
        One of `known`; empty if none resembles the word.

    Examples
    --------
    >>> nearest("Spring_rate", ["length_max_mm", "spring_rate_N_per_m"])
    'spring_rate_N_per_m'
    """
    if len(word) > _LONGEST:
        return ""
    by_lower_case = {name.lower(): name for name in known}
    found = difflib.get_close_matches(word.lower(), by_lower_case, n=1, cutoff=0.5)
    return by_lower_case[found[0]] if found else ""


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return a sentence that names the nearest known name, or all of them.

    Parameters
    ----------
    word : str
        What was written.
    known : iterable of str
        The names that would have been right.

    Returns
    -------
    str
        The sentence.

    Examples
    --------
    >>> suggestion("sied", ["side"])
    'Did you mean side?'
    """
    known = list(known)
    found = nearest(word, known)
    return f"Did you mean {found}?" if found else f"Known are: {', '.join(known) or 'none'}."
