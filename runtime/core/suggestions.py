"""Suggestions for a misspelt name."""

import difflib
from collections.abc import Iterable

_LONGEST = 100  # characters; a longer text is not a name


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known name that resembles a word most; empty if none does.

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
    """Return a sentence that names the known name nearest to a word, or all of them.

    Examples
    --------
    >>> suggestion("sied", ["side"])
    'Did you mean side?'
    """
    known = list(known)
    found = nearest(word, known)
    return f"Did you mean {found}?" if found else f"Known are: {', '.join(known) or 'none'}."
