"""Base classes of the exceptions that kintrafo raises on purpose.

All of them derive from `KintrafoError`, so that one ``except`` clause catches them, also those of
the generator and of generated code.
"""

from collections.abc import Iterable
from itertools import islice

from .legible import readable, short

__all__ = ["InputError", "KintrafoError"]


# Number of problems in an error, and characters of each.
_MOST_PROBLEMS, _LONGEST = 100, 2000


class KintrafoError(Exception):
    """An error that kintrafo raises on purpose: the base of all others."""


class InputError(KintrafoError, ValueError):
    """Input data that cannot be used, with a list of all problems.

    Parameters
    ----------
    problems : iterable of str
        A sentence or more for each problem: section and key, value with unit, the allowed values,
        and the change that is needed.
    source : str, optional
        Origin of the data, usually the name of the file.

    Attributes
    ----------
    problems : tuple of str
        The first hundred problems in the order of the file's sections, each cut to 2,000
        characters, with escapes for characters that no terminal can show.
    source : str
        Origin of the data.

    Examples
    --------
    >>> from kintrafo import InputError
    >>> print(InputError(["[tyre] rate_N_per_m is missing."], "my_car.toml"))
    my_car.toml: 1 problem
      - [tyre] rate_N_per_m is missing.
    """

    def __init__(self, problems: Iterable[str], source: str = "input data") -> None:
        self.problems = tuple(_bounded(problems))
        self.source = readable(source)
        # The base class gets the arguments unchanged: pickling hands them to __init__ again.
        super().__init__(self.problems, source)

    def __str__(self) -> str:
        """Return the source on top and one bullet for each problem."""
        count = len(self.problems)
        head = f"{self.source}: {count} problem{'' if count == 1 else 's'}"
        return "\n".join([head, *(f"  - {problem}" for problem in self.problems)])


def _bounded(problems: Iterable[str]) -> list[str]:
    """Return the first problems, shortened, and a note of more; its own result unchanged."""
    first = islice(problems, _MOST_PROBLEMS + 1)
    listed = [short(readable(problem[: _LONGEST + 1]), _LONGEST) for problem in first]
    if len(listed) > _MOST_PROBLEMS:
        listed[_MOST_PROBLEMS - 1 :] = ["and more problems."]
    return listed
